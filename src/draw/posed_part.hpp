#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "labels.hpp"
#include "plot.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"
#include "rollfix/touch.hpp"
#include "trace.hpp"

namespace rollfix::draw {

/// The part's outline, near enough to be drawn in the world; `size`: the larger side of its box.
Trace coarse_outline(const Part& part, double size);

/// A finger's outline in its own frame, as so many sides; of a jaw what is drawn about its place `u`, by the part's
/// size.
std::vector<Vec2> shape_of(const Finger& finger, int sides, double part_size, double u = 0);

/// What a legend says of one of an answer's poses.
struct PoseWords {
  Pose pose;
  double probability = 0;  // NaN: not known
  bool continuum = false;
  bool any_heading = false;
};

/// The part of an answer that has poses of it. Where its place is not known it is turned as in the world, about the
/// origin.
class PosedPart {
 public:
  /// The part has to outlive it.
  PosedPart(const Part& part, PlaceKnown place, bool mirrored);

  const Trace& outline() const { return outline_; }
  std::vector<Vec2> in_world(const std::vector<Vec2>& points, const Pose& pose) const;
  std::vector<Vec2> at(const Pose& pose) const { return in_world(outline_.points, pose); }

  std::string frame_words() const;  // of the world's frame

  /// In pose number `k`: in the first one strong, with its material and what else its drawing holds.
  void draw(Svg& svg, const World& world, std::size_t k, const Pose& pose, const std::vector<Outline>& others) const;

  /// What the legend says of pose number `k`, after `lead`.
  LegendEntry entry(std::size_t k, const std::string& lead, const PoseWords& words) const;

 private:
  const Part& part_;
  PlaceKnown place_;
  bool mirrored_;
  Trace outline_;
};

}  // namespace rollfix::draw
