#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "centre_path.hpp"

namespace rollfix::touch {

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
  std::int32_t add_single(std::int32_t stretch, const Interval& u, const Interval& number);
  std::int32_t join(std::size_t from, std::size_t to);

  const CentrePath& path_;
  std::vector<Node> nodes_;
  std::int32_t root_ = -1;
};

}  // namespace rollfix::touch
