#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/turning_function.hpp"

namespace rollfix {

/// The least and the largest Theta anywhere on an arc, unwrapped, the jumps of corners at its ends included. Theta is
/// monotone on a spiral: exact. Of an open boundary what lies on it.
Interval angles_over(const TurningFunction& turning, const Interval& arc);

/// Bounds on the same, at once however long the arc: from a table over equal cells, which are looked at as a whole.
class TurningRange {
 public:
  /// `cells`: of one perimeter.
  TurningRange(const TurningFunction& turning, std::size_t cells);

  /// Of a closed boundary everything is possible on a lap or more.
  Interval over(double lo, double hi) const;

 private:
  double step_;
  Boundary boundary_;
  double period_turn_;
  std::vector<std::vector<float>> least_;  // [j][i]: over the cells i, ..., i + 2^j - 1
  std::vector<std::vector<float>> most_;
};

/// Bounds on the turning function over runs of neighbouring spirals: each within a strip along its chord, as in a strip
/// tree (Ballard 1981), so that bounds on a difference of two runs see how both rise. The blocks of level l are 2^l
/// spirals each (the last one fewer), from pairs on level 1 to all of them on the top level. Made with the part, in
/// linear time; 56 bytes a spiral.
class TurningTree {
 public:
  /// A run of spirals: chord + below <= Theta(s) <= chord + above, chord = angle + slope (s - lo), one-sided limits
  /// included.
  struct Block {
    double lo = 0;     // arc length where it starts
    double angle = 0;  // Theta just after that, radians
    double slope = 0;
    double below = 0;     // radians, at most 0
    double above = 0;     // at least 0
    double jump = 0;      // of Theta at the joint where it ends
    double steepest = 0;  // of Theta and of all chords in it: the largest slope in size

    double chord(double s) const { return angle + slope * (s - lo); }
  };

  /// Of a part with fewer spirals there is none: looking at all of them is as good.
  static constexpr std::size_t kFewest = 48;

  TurningTree() = default;
  explicit TurningTree(const TurningFunction& turning);

  bool is_empty() const { return blocks_.empty(); }
  std::size_t top() const { return first_.size(); }
  /// How many blocks a level has, from 1 to the top.
  std::size_t count(std::size_t level) const {
    return (level < top() ? first_[level] : blocks_.size()) - first_[level - 1];
  }
  const Block& block(std::size_t level, std::size_t k) const { return blocks_[first_[level - 1] + k]; }

 private:
  template <class Below>
  void add_level(std::size_t count, double perimeter, const Below& below);

  std::vector<Block> blocks_;       // level by level
  std::vector<std::size_t> first_;  // of each level, from 1 on
};

}  // namespace rollfix
