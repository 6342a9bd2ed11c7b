#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Solves a problem in which every touch counts.
using SolveCounted = std::function<void(const TouchProblem&, TouchAnswer&)>;

/// The poses if any touch may be an outlier, and the verdict is yet to be made. REQUIRES noise, and two contacts or
/// more.
/// `solve_counted` is called for each set of outliers with the other touches; it gets an answer with part, touches,
/// radius and noise.
void solve_with_outliers(const TouchProblem& problem, const SolveCounted& solve_counted, TouchAnswer& answer);

/// Whether chance makes so many touches outliers less than once in a thousand times.
bool has_many_outliers(const TouchAnswer& answer);

/// Poses by several sets of touches, each the weighed mean of what the sets say.
class PoseMixture {
 public:
  /// The poses that all touches but the `outliers` leave, ascending, and the weight of all of them together.
  void add(std::vector<TouchPose> poses, const std::vector<std::size_t>& outliers, double log_weight);

  /// Puts those that are probable enough into the answer, with contacts of all touches. `log_total`: of all weights.
  void finish(const TouchProblem& problem, double log_total, TouchAnswer& answer);

 private:
  std::vector<TouchPose> poses_;     // `probability`: among those of the same set
  std::vector<double> log_weights_;  // of the set
};

}  // namespace rollfix::touch
