#pragma once

#include <string>

#include "rollfix/touch.hpp"

namespace rollfix::app {

/// For people: the verdict, a table of the poses, what they leave open, and what was asked. `verbose`: with each
/// touch's place on the part.
std::string touches_text(const TouchAnswer& answer, bool verbose);

}  // namespace rollfix::app
