#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "centre_tree.hpp"
#include "held.hpp"

namespace rollfix_verify {

/// What an encoder's zero can be: intervals, counted modulo a period if that is above 0.
class Zeros {
 public:
  explicit Zeros(double period) : period_(period) {}

  bool is_empty() const { return known_ && known_->empty(); }
  /// What is in these as well is left.
  void keep(std::vector<Interval> others);

 private:
  double period_;
  std::optional<std::vector<Interval>> known_;  // nothing: any
};

/// Where a finger's contact is at one instant, on the part and in the world.
struct SeenFrom {
  double x = 0;  // on the part: no further than `reach` from here
  double y = 0;
  double world_x = 0;
  double world_y = 0;
  double reach = 0;  // with what the measured place may be off by
};

/// One wheel beside the part: whether its pin can be where it was, touching the part.
class PinLook {
 public:
  /// `turn`: of the tangent around the part, 0 of an open one.
  PinLook(const Boundary& boundary, const HeldWheel& wheel, double turn);

  const HeldWheel& wheel() const { return wheel_; }
  const CentreTree& path() const { return path_; }
  double period() const { return period_; }

  /// Whether the wheel may touch for some heading within `half` of the middle one. Adds what its encoder's zero can be.
  bool may_touch(const SeenFrom& from, std::size_t instant, double heading, double half, std::vector<Interval>& zeros);

 private:
  struct Question;
  bool look(Question& question, double heading, double half);
  bool is_near(double x, double y, double reach);
  bool suits(const Question& question, double heading, double half, const CentreTree::Node& node) const;

  const HeldWheel& wheel_;
  CentreTree path_;
  double period_ = 0;
  double rounding_ = 0;
};

}  // namespace rollfix_verify
