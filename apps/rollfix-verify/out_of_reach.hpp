#pragma once

#include <optional>

#include "centre_tree.hpp"

namespace rollfix_verify {

/// A contact by arc length at which a finger of this radius, infinity of a flat jaw, is not shown to enter the part,
/// though it is not among those that are considered; nothing: at all of them some point of the boundary is inside of
/// the finger.
std::optional<double> not_out_of_reach(const Boundary& boundary, double radius, const Considered& considered);

}  // namespace rollfix_verify
