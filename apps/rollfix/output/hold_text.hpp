#pragma once

#include <string>

#include "rollfix/hold.hpp"

namespace rollfix::app {

/// For people: the verdict, a table of the first contacts, poses, each finger, and what was asked.
std::string hold_text(const HoldAnswer& answer);

}  // namespace rollfix::app
