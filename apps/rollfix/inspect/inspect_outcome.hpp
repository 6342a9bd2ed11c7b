#pragma once

#include <string>

#include "rollfix/files/inspection.hpp"

namespace rollfix::app {

/// What `inspect` says of a part, for people.
std::string inspect_text(const Inspection& inspection);

}  // namespace rollfix::app
