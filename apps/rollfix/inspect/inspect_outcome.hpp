#pragma once

#include <string>

#include "rollfix/files.hpp"
#include "rollfix/inspect.hpp"

namespace rollfix::app {

/// What `inspect` says of a part, for people.
std::string inspect_text(const Inspection& outcome, const LoadedPart& loaded);

}  // namespace rollfix::app
