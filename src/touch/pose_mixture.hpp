#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

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
