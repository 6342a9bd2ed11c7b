#pragma once

#include <vector>

#include "belief/pair_candidates.hpp"
#include "belief/pair_filter.hpp"

namespace rollfix::belief {

/// A local maximum of the likelihood.
struct PairPeak {
  PairStart start;
  PairScore score;
};

/// The first contacts at arc lengths s and t, where a finger can be there.
std::vector<PairStart> starts_at(const PairModel& model, double s, double t);

/// A step's worth of two first contacts on: w kept within an arc that is not a loop.
PairStart moved(const PairStart& start, const Eigen::Vector2d& by);

/// The likelihood's local maxima among the candidates, the likeliest first: Gauss-Newton (Levenberg 1944) from the
/// candidates that no neighbour of theirs surpasses, with some of the rows first and then with all.
std::vector<PairPeak> pair_peaks(const PairModel& model, const PairCandidates& candidates,
                                 const std::vector<PairNode>& nodes);

}  // namespace rollfix::belief
