#pragma once

#include <string>

#include "rollfix/curve.hpp"

namespace rollfix::app {

/// --travel as typed: a length either way, or BACK,FORWARD. `unit`: the part's. Throws InputError.
Interval read_travel(const std::string& text, const std::string& unit);

}  // namespace rollfix::app
