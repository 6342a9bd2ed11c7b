#pragma once

#include <cstddef>
#include <vector>

#include "profile.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// A disc in the part's frame.
struct Disc {
  Vec2 middle = Vec2::Zero();
  double radius = 0;
};

/// What a profile says of where a round finger's centre is while it touches a cell: the tangent's angles in the cell,
/// and how far and which way it is from one cell to another. The boundary is the integral of its tangent.
class CentreCells {
 public:
  /// `radius`: the finger's; 0: a point.
  template <std::size_t N>
  CentreCells(const Profile<N>& profile, double perimeter, bool closed, double radius)
      : CentreCells(profile.least.data(), profile.most.data(), N, perimeter, closed, radius) {}

  std::size_t size() const { return angle_.size(); }
  /// Of the tangent in a cell, radians: at most half_turn from this.
  double angle(std::size_t cell) const { return angle_[cell]; }
  double half_turn(std::size_t cell) const { return half_turn_[cell]; }
  /// Holds the vector from the centre at any contact in one cell to that at any in another.
  Disc between(std::size_t from, std::size_t to) const;

 private:
  CentreCells(const float* least, const float* most, std::size_t count, double perimeter, bool closed, double radius);
  Disc forwards(std::size_t from, std::size_t to) const;

  double step_ = 0;  // of a cell, length
  double slack_ = 0;
  bool closed_ = true;
  std::vector<double> angle_, half_turn_;
  std::vector<Disc> part_of_;  // from a cell's start to any place in it, and from there to its end
  std::vector<Disc> up_to_;    // from the outline's start to a cell's start; one more for the outline's end
  std::vector<Disc> offset_;   // from the contact to the finger's centre
};

}  // namespace rollfix
