#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/reading.hpp"

namespace rollfix {

/// A reading, and how far it may be off.
struct Clue {
  PerFinger<double> length;
  double turn = 0;
  double length_slack = 0;             // of each length
  double turn_slack = 0;               // radians
  double turn_slack_by_curvature = 0;  // so much more, times the part's largest curvature
  double turn_sd = 0;                  // besides, an error that only this reading has: its squares are added up

  double slack(double most_curvature) const { return turn_slack + turn_slack_by_curvature * most_curvature; }
};

/// All readings of a roll together; none: nothing is known, and every part may be it.
struct Clues {
  std::vector<Clue> clues;
  std::optional<double> facing{};  // of two fingers, as LocateOptions has it
  double facing_slack = 0;
  double facing_slack_by_curvature = 0;
  std::size_t fingers = 1;
  double shared_sd = 0;  // besides, an error of the tangent at the start that all readings share
  double most_cost = 0;  // the squares of both, in standard deviations, may come to so much together
};

}  // namespace rollfix
