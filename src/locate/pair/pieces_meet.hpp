#pragma once

#include "pair_find.hpp"

namespace rollfix {

/// Do the boxes come as near as `slack` to each other?
bool boxes_meet(const PairBox& one, const PairBox& two, double slack);

/// Do the pieces, the second one moved by `shift`? As far as they may be off, they do.
bool pieces_meet(const PairPiece& one, const PairPiece& two, const Shift& shift, double slack);

}  // namespace rollfix
