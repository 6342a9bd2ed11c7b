#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "plan/roll_path.hpp"

namespace rollfix::planning {

/// What a search for a path is asked.
struct PathQuestion {
  /// both ways have to outlive the search
  const ContactWay* a = nullptr;
  const ContactWay* b = nullptr;
  double goal_a = 0;                                                       // x at the end, not 0
  std::optional<double> goal_b;                                            // y at the end; nothing: any
  Interval range_b;                                                        // of y, 0 and the goal inside
  std::function<double(const ContactPlace&, const ContactPlace&)> margin;  // radians, of what is to be kept largest
};

/// A path from both first contacts: its knots in [0, 1] and both turns there.
struct FoundPath {
  /// lambda, from 0 to 1, growing
  std::vector<double> knots;
  /// x and y at the knots
  std::vector<Turned> turned;
};

/// The path whose worst margin is largest, up to the grid's step, and of those with that margin a short one that keeps
/// off the edges where it can. Finger a always rolls on, finger b may turn back.
FoundPath widest_path(const PathQuestion& question);

/// Both turn at a constant ratio.
FoundPath even_path(const ContactWay& a, double goal_a, const ContactWay* b, double goal_b);

/// The path beside a wheel that is balanced at y = start: as far as x = goal, or until it turns back.
struct BalancedPath {
  /// up to the goal, or to where the wheel turns back
  FoundPath path;
  bool turns_back = false;  // before the goal: at the last knot
};
BalancedPath balanced_path(const ContactWay& a, double goal_a, const ContactWay& b, double start,
                           const Interval& range_b);

/// All y in the range at which a wheel is in balance at finger a's first contact.
std::vector<double> balances(const ContactWay& a, const ContactWay& b, const Interval& range_b);

}  // namespace rollfix::planning
