#pragma once

#include <vector>

#include "rollfix/contact/reading.hpp"
#include "rollfix/part/boundary.hpp"

namespace rollfix::draw {

/// A part of a roll without a change of direction.
struct Run {
  double from = 0;  // length travelled at its ends, measured from the first contact
  double to = 0;
  int lane = 0;  // of its drawing, counted from the roll's own first lane

  double size() const { return to > from ? to - from : from - to; }
};

/// What the drawings of all placements have in common: the way along the boundary that the readings tell of.
struct Roll {
  std::vector<Run> runs;         // empty where nothing rolled
  std::vector<double> contacts;  // length travelled at each reading
  Interval hull;                 // least and greatest length travelled
  int lanes = 1;                 // that it needs side by side
  bool tangled = false;          // changes its direction so often that one run stands for all
};

/// Whether a run covers a closed boundary more than once and has to wind outward.
bool goes_round(const Run& run, const Boundary& boundary);

Roll roll_of(const std::vector<Reading>& readings, const Boundary& boundary);

inline constexpr double kFirstLane = 8;  // from the boundary to the first lane, pixels
inline constexpr double kLaneSpacing = 6.5;
inline constexpr double kEndGap = 14;  // between neighbours on a lane

/// Lanes on which stretches of a boundary can be drawn side by side without overlapping.
struct Lanes {
  std::vector<int> of;  // each stretch's lane, 0 is the nearest to the boundary
  int count = 0;
};

/// Puts each stretch on the nearest lane where it is `gap` away from its neighbours.
Lanes assign_lanes(const std::vector<Interval>& stretches, const Boundary& boundary, double gap);

}  // namespace rollfix::draw
