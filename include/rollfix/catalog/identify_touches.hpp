#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/catalog/catalog.hpp"
#include "rollfix/catalog/identify.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// A part that the touches and rolls may have been on.
struct PartTouched {
  std::size_t part = 0;  // its place in the catalog
  TouchAnswer answer;    // as of this part alone: probabilities of poses are given that it is this part
  double probability = std::numeric_limits<double>::quiet_NaN();  // that it is; NaN: no noise
  std::vector<std::size_t> congruent{};                           // parts that can't be told from it, by their places
};

/// A roll on whichever part it is.
struct RollGiven {
  std::string name{};                // of its log
  std::vector<std::size_t> lines{};  // of the file: its first and its last row; of simulated rows none
  std::size_t rows = 0;
};

/// Every part of a catalog that touches and rolls fit.
struct IdentifiedByTouches {
  std::vector<PartTouched> parts{};  // the likeliest first, without noise in the catalog's order
  std::string verdict{};             // "unique part, unique pose", "3 parts", "none", ...
  Status status = Status::complete;
  double rest = 0;                       // with noise: probability of all that is not listed; NaN where undecided
  std::size_t asked = 0;                 // parts
  std::size_t searched = 0;              // of them, that bounds did not rule out
  std::vector<std::size_t> left{};       // parts that remain, as far as it was looked at: no other can be it
  bool counted = false;                  // there are more than most_searched of them: nothing else is known
  std::vector<std::size_t> undecided{};  // of them, whose search ran out of its budget
  std::vector<PartRefused> refused{};

  // As in the problem.
  std::vector<RollGiven> rolls{};
  std::vector<MeasuredTouch> touches{};
  std::vector<TouchTolerance> tolerance{};  // that was searched with, for each of the touches
  std::vector<Clear> clear{};
  double radius = 0;  // of the finger; 0: a point
  std::optional<Noise> noise{};
  bool mirrored = false;
};

/// Every part of a catalog that the touches and rolls can have been on, and every pose of it: what `solve` says of each
/// part by itself, to the bit, but that bounds rule out most parts at once, which loses none. `asked`: the problem; its
/// part does not matter, and lengths are in the catalog's unit. With noise parts are weighed by the likelihood of all
/// touches and rows, averaged over the poses and over contacts that are anywhere on the boundary alike, times their
/// count. One touch fits every part. See docs/identify.md.
/// Throws InputError: one roll and no touch (which is a Problem), and what `solve` throws where it throws it of all
/// parts.
IdentifiedByTouches identify(const Catalog& catalog, const TouchProblem& asked, const IdentifyOptions& options = {});

}  // namespace rollfix
