#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/identify.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::catalog {

/// A reading, and how far it may be off.
struct Clue {
  PerFinger<double> length;            // L of each finger, in the catalog's unit
  double turn = 0;                     // theta, radians
  double length_slack = 0;             // of each length
  double turn_slack = 0;               // radians
  double turn_slack_by_curvature = 0;  // so much more, times the part's largest curvature
  double turn_sd = 0;                  // besides, an error that only this reading has: its squares are added up

  /// How far the turn may be off on a part with this largest |kappa|, radians, `turn_sd` aside.
  double slack(double most_curvature) const { return turn_slack + turn_slack_by_curvature * most_curvature; }
};

/// All readings of a roll together; none: nothing is known, and every part may be it.
struct Clues {
  std::vector<Clue> clues;         // far apart ones first
  std::optional<double> facing{};  // of two fingers, as LocateOptions has it
  double facing_slack = 0;
  double facing_slack_by_curvature = 0;
  std::size_t fingers = 1;
  double shared_sd = 0;  // besides, an error of the tangent at the start that all readings share
  double most_cost = 0;  // the squares of both, in standard deviations, may come to so much together
};

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

}  // namespace rollfix::catalog
