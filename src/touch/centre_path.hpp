#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
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

/// A place of the path: which stretch, and u on it, within the stretch's `u`.
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

  /// Outlives the path.
  const Part& part() const { return part_; }
  double radius() const { return radius_; }
  const std::vector<CentreStretch>& stretches() const { return stretches_; }
  /// REQUIRES a place of this path.
  CentrePoint at(const PathPlace& place) const;
  Vec2 contact(const PathPlace& place) const;  // the point of the boundary
  /// The numbers of places go round with this period; 0: not at all.
  double period() const { return period_; }
  double diagonal() const { return diagonal_; }  // of the boundary's box
  /// How far the centre goes from u to another on one stretch, at most.
  double length(const CentreStretch& stretch, const Interval& u) const;

 private:
  // The steps of the constructor, in order.
  void add_spirals(const Confined* confined);
  void add_corner(std::size_t spiral, const std::vector<Interval>& angles);
  void add(CentreStretch stretch);
  void connect();

  const Part& part_;
  double radius_;
  // In order along the boundary; empty: the finger fits nowhere.
  std::vector<CentreStretch> stretches_;
  double period_ = 0;
  double diagonal_ = 0;
};

/// A tree of stretches of the path. Each lies in a disc, and its tangents in an interval; single ones are split when
/// somebody asks for it. Every place has a number, which grows along the path: neighbours have neighbouring numbers.
class PathTree {
 public:
  struct Node {
    Vec2 middle = Vec2::Zero();  // of the disc
    double radius = 0;
    double angle = 0;  // of the tangent, radians: at most half_turn from this
    double half_turn = 0;
    Vec2 along = Vec2::UnitX();  // of a single one: the direction of `angle`, ...
    double flat = 0;             // ... and how far its centres are, at most, from the line through the middle along it;
                                 // of others, of which there is no such line, the radius
    Interval number;             // of its places
    std::int32_t stretch = -1;   // of a single one, with ...
    Interval u;                  // ... its places
    std::int32_t left = -1;
    std::int32_t right = -1;

    bool is_single() const { return stretch >= 0; }
  };

  /// REQUIRES a path that is not empty.
  explicit PathTree(const CentrePath& path);

  const CentrePath& path() const { return path_; }
  std::int32_t root() const { return root_; }
  const Node& node(std::int32_t index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// The two halves; equal to the node itself where it is too short to have any. References to nodes do not outlive it.
  std::pair<std::int32_t, std::int32_t> halves(std::int32_t index);

 private:
  // Each appends a node, `join` also those below it, and returns its index.
  std::int32_t add_single(std::int32_t stretch, const Interval& u, const Interval& number);
  std::int32_t join(std::size_t from, std::size_t to);

  const CentrePath& path_;
  // Grows with `halves`; indices stay, references do not.
  std::vector<Node> nodes_;
  std::int32_t root_ = -1;
};

}  // namespace rollfix::touch
