#pragma once

#include <string>

#include "rollfix/files.hpp"

namespace rollfix::app {

/// What `inspect` says of a part, for people.
std::string inspect_text(const Inspection& outcome);

}  // namespace rollfix::app
