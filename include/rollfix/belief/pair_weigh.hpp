#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/belief/pair_belief.hpp"
#include "rollfix/belief/pose_spread.hpp"
#include "rollfix/locate/locate_pair.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What the samples of two fingers' whole roll make of the placements that a few readings of it allow.
struct WeighedPairs {
  std::vector<PairPlacement> placements;  // the most probable first
  std::vector<PairMode> modes;            // of each
  std::vector<PairPlacement> improbable;  // within the tolerance for the readings, but not for all the samples
};

/// As `weigh` of one finger: a placement for each mode, of which a search with PairBelief::tolerance() at least says
/// what kind it is and which exact roots it holds. The sensitivity is of the search's own start.
WeighedPairs weigh(const Part& part, const std::vector<PairReading>& readings, const std::optional<double>& facing,
                   const PairSearch& found, PairBelief& belief);

/// What a finger feels at an instant: where its contact is in the world, and where the part's inward normal points
/// there, radians.
struct FeltContact {
  Vec2 where = Vec2::Zero();
  double facing = 0;
  double finger_curvature = 0;
};

/// The part's pose at the first contacts, given that they are one of a mode's: means of what both fingers say, as
/// `poses` has them. `mass`: of the whole posterior; what belongs to mode number `mode` counts. What the
/// samples tell of the errors with which the first contacts were felt is taken off; what they don't tell adds its own.
PoseSpread pose_spread(const Part& part, std::size_t mode, const std::vector<PairMass>& mass,
                       const std::array<FeltContact, 2>& felt, const Noise& noise);

}  // namespace rollfix
