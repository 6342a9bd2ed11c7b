#pragma once

#include <array>
#include <vector>

#include "clue.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// What a roll says to every part of a catalog, so that bounds can rule parts out.
struct RollClues {
  Clues few;   // some rows: for cells
  Clues many;  // more of them: for stretches of one part
};

/// For each way in which the roll may have gone, of which one has to fit; [0] on parts that are stored as they were
/// given, [1] on those that are stored reversed. Where nothing can be told, as with stray rows among them, there are no
/// clues.
/// `excess`: so many times the noise that was said is let pass.
std::array<std::vector<RollClues>, 2> clues_of(const Catalog& catalog, const Problem& like, double excess);

}  // namespace rollfix
