#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/belief/pair_weigh.hpp"
#include "rollfix/weighing.hpp"

namespace rollfix::app {

/// What all samples of two fingers together say, beyond the search. Entry k is of placement k.
struct PairWeighing {
  Weighing common;  // what is the same for one finger; its modes are empty, its poses in use
  std::vector<PairMode> modes;
  std::vector<PairPlacement> improbable;  // within the tolerance for the readings, but not for all the samples
};

/// "probability", "mean", "sd", ...: what a placement's JSON gets.
void add_weight(const PairWeighing& weighing, std::size_t k, Json& placement);

/// What the document gets.
void add_weighing(const PairWeighing& weighing, Json& document);

/// "noise      contact 0.1, ..." and what the samples are like.
std::string weighing_lines(const PairWeighing& weighing);

/// What to do, by the verdict.
std::string advice(const PairWeighing& weighing);

}  // namespace rollfix::app
