#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/touch/touch.hpp"

// Which touch tells apart the poses that remain: docs/touch.md.
namespace rollfix {

/// A straight way of the finger's centre towards the part, until it touches.
struct Approach {
  Vec2 from = Vec2::Zero();  // in the world, off the part
  double direction = 0;      // of the motion, radians
};

/// What an approach comes to in one pose.
struct ExpectedTouch {
  std::size_t placement = 0;  // the pose's number in the answer; of a continuum several are looked at
  double probability = 0;     // of all together 1
  Pose pose;
  bool hits = false;       // false: the finger goes past the part
  Vec2 at = Vec2::Zero();  // the centre as it touches
  double normal = 0;       // there, out of the part, in the world
  double travel = 0;       // of the centre until then
};

/// What is to be expected of an approach.
struct TouchProspect {
  Approach approach;
  double poses = 0;    // that remain, on average
  double bits = 0;     // information gained, on average
  double head_on = 0;  // cosine of the way's angle with the normal where it touches, 0 where it misses; on average
};

/// A roll from the last touch, and the information that it gains on average.
struct RollProspect {
  double length = 0;  // of the contact's way, positive along the stored outline
  double bits = 0;
};

/// Which approach tells the poses apart.
struct NextTouch {
  std::vector<TouchProspect> prospects;  // as the approaches were given; of the less promising ones an upper bound
  std::size_t best = 0;                  // of them
  std::vector<ExpectedTouch> expected;   // of the best approach, in each pose
  std::optional<RollProspect> roll{};    // instead: the shortest that gains about most; none: see `next_touch`
  double bits_wanted = 0;                // what it takes to tell all of them apart
  bool helps = false;                    // false: no approach does
  std::string why{};                     // if none helps, in words; else empty

  const TouchProspect& advised() const { return prospects[best]; }
};

/// Looks at each approach in each pose of an answer: two poses are told apart by where the finger would touch, by the
/// normal there if the answer's touches have normals, and by whether it touches at all; all in standard deviations,
/// with what the poses themselves are uncertain by. Advised is what gains most information, and of what gains about as
/// much what goes at the part head on. Without approaches many all around are looked at. After a single touch, which
/// fits all along the boundary, a sample of its poses is looked at; `expected` is empty then. `roll` is told where a
/// finger rolls, and its direction is measured: its turn counts alone, over at most 24 % of the perimeter. Throws
/// InputError: numbers that are not finite, an answer that is not complete.
NextTouch next_touch(const TouchAnswer& answer, const std::vector<Approach>& approaches = {});

}  // namespace rollfix
