#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "rollfix/part.hpp"

namespace rollfix::touch {

/// A contact, with where the finger's centre is then, in the part's frame.
struct CentrePoint {
  Vec2 centre = Vec2::Zero();
  Vec2 along = Vec2::Zero();  // d centre / du
  double angle = 0;           // of the tangent, radians
  double bend = 0;            // d angle / du
  double s = 0;               // of the contact, in [0, P]
};

/// A smooth piece of the path: along a spiral u is the arc length, at a corner the tangent's angle.
struct CentreStretch {
  Interval u;
  bool corner = false;
  std::size_t spiral = 0;               // that it lies on, or that starts at the corner
  double s = 0;                         // of a corner
  Vec2 point = Vec2::Zero();            // of a corner
  Interval angle{};                     // tangent's angles, unwrapped along the boundary
  double number = 0;                    // its places have the numbers from this to the next whole one, see PathTree
  std::optional<std::size_t> before{};  // the stretch that ends where it starts
  std::optional<std::size_t> after{};
};

struct PathPlace {
  std::size_t stretch = 0;
  double u = 0;
};

/// What a contact is confined to: some arcs of the boundary, and at a corner on them some of the tangent's angles.
struct Confined {
  std::vector<Interval> arcs;
  std::function<Interval(double, const Interval&)> angles{};  // at the corner s, of its own: empty where hi < lo
};

/// Where the centre of a round finger can be while it touches a part: the boundary's offset p + r n, with an arc around
/// each convex corner, as far as the finger can be there (see Reach). Radius 0: the boundary itself.
class CentrePath {
 public:
  /// `confined`: nullptr: to nothing. Throws InputError as reach_of_disk does.
  CentrePath(const Part& part, double radius, const Confined* confined = nullptr);

  const Part& part() const { return part_; }
  double radius() const { return radius_; }
  const std::vector<CentreStretch>& stretches() const { return stretches_; }
  CentrePoint at(const PathPlace& place) const;
  Vec2 contact(const PathPlace& place) const;  // the point of the boundary
  /// The numbers of places go round with this period; 0: not at all.
  double period() const { return period_; }
  double diagonal() const { return diagonal_; }  // of the boundary's box
  /// How far the centre goes from u to another on one stretch, at most.
  double length(const CentreStretch& stretch, const Interval& u) const;

 private:
  void add_spirals(const Confined* confined);
  void add_corner(std::size_t spiral, const std::vector<Interval>& angles);
  void add(CentreStretch stretch);
  void connect();

  const Part& part_;
  double radius_;
  std::vector<CentreStretch> stretches_;
  double period_ = 0;
  double diagonal_ = 0;
};

}  // namespace rollfix::touch
