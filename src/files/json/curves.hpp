#pragma once

#include <vector>

#include "files/json/fields.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// The curves of one entry of "curves". Throws InputError with its place.
std::vector<Curve> json_curves(const JsonFields& entry);

}  // namespace rollfix
