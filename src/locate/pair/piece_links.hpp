#pragma once

#include <vector>

#include "family_line.hpp"
#include "pair_find.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// Of each piece those that it touches, across s = 0 and t = 0 on a closed outline; exact ones first, so that a walk
/// along a family leaves it only where it must. Elsewhere it is enough that what hangs together does so by some links.
/// `same_place`: pieces that come as near as this are one.
std::vector<std::vector<PieceLink>> links_of(const std::vector<PairPiece>& pieces, const Boundary& boundary,
                                             double same_place);

}  // namespace rollfix
