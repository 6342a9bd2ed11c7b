#include "least_worst.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "answer_poses.hpp"
#include "outline/turn.hpp"

// Notation:
//   t_j         residuals in tolerances: of each touch its distance, and its turn where a normal was measured
//   w_j         weights, of all together 1; each residual's unit is then its tolerance / sqrt(w_j)
//   w . t^2     the sum of squares that is least at the fitted pose: `FittedPose::square`
// Follows C. L. Lawson, "Contributions to the theory of linear least maximum approximation" (1961).
// Idea: residuals that are large are given more weight, round by round, which makes the largest smaller. The weights
// tell as well when to give up: as max t^2 >= w . t^2, no pose nearby is within its tolerances where the least sum of
// squares is more than 1. That is no proof, but the boxes of poses that are asked next are one.
namespace rollfix::touch {
namespace {

// Starts on a set of cells, and rounds of weighting.
constexpr std::size_t kMostWitnesses = 8;
constexpr int kLawsonRounds = 30;
// A weight is made smaller in one round by no more than this factor: a residual of nothing can grow again.
constexpr double kLeastFactor = 1e-6;

/// The residuals of a touch in a fitted pose, as shares of their tolerances.
struct Shares {
  double place = 0;
  double angle = 0;
};

class LeastWorst {
 public:
  explicit LeastWorst(const PoseFit& fit) : fit_(fit), touches_(fit.touches()), weighed_(touches_, {}) {}
  LeastWorst(const LeastWorst&) = delete;
  LeastWorst& operator=(const LeastWorst&) = delete;

  FittedPose from(const Pose& start) {
    reset();
    FittedPose fitted = weighed_.fit(start);
    FittedPose best = fitted;
    double least = worst_of(fit_, fitted);
    for (int round = 0; round < kLawsonRounds && least > 1 && fitted.square <= 1; ++round) {
      weigh(fitted);
      fitted = weighed_.fit(fitted);
      const double worst = worst_of(fit_, fitted);
      if (worst >= least) continue;
      least = worst;
      best = fitted;
    }
    return fit_.at(best.pose, best.places);
  }

 private:
  /// All residuals alike.
  void reset() {
    std::size_t count = 0;
    for (const Measured& touch : touches_) count += (touch.has_place ? 1 : 0) + (touch.tangent ? 1 : 0);
    weights_.assign(touches_.size(), {1.0 / static_cast<double>(count), 1.0 / static_cast<double>(count)});
    set_units();
  }

  void set_units() {
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      touches_[k].place_unit = touches_[k].place_most / std::sqrt(weights_[k].place);
      touches_[k].angle_unit = touches_[k].angle_most / std::sqrt(weights_[k].angle);
    }
  }

  /// Each weight by its residual.
  void weigh(const FittedPose& fitted) {
    double sum = 0;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const InPart at = fit_.in_part(fitted.pose, k);
      const CentrePoint point = fit_.path(k).at(fitted.places[k]);
      if (at.has_place) {
        weights_[k].place *= kLeastFactor + (at.at - point.centre).norm() / touches_[k].place_most;
        sum += weights_[k].place;
      }
      if (at.tangent) {
        weights_[k].angle *= kLeastFactor + std::abs(nearest_angle(*at.tangent - point.angle)) / touches_[k].angle_most;
        sum += weights_[k].angle;
      }
    }
    for (Shares& weight : weights_) weight = {weight.place / sum, weight.angle / sum};
    set_units();
  }

  const PoseFit& fit_;
  std::vector<Measured> touches_;  // with units that follow the weights
  PoseFit weighed_;
  std::vector<Shares> weights_;
};

}  // namespace

FittedPose best_within(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair) {
  LeastWorst least_worst(fit);
  FittedPose best;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t starts = std::min(cells.size(), kMostWitnesses);
  for (std::size_t start = 0; start < starts && least > 1; ++start) {
    const Cell& cell = cells[(2 * start + 1) * cells.size() / (2 * starts)];
    const PathTree::Node& node = fit.tree(pair.first).node(cell.first);
    const Held held{pair.first, {static_cast<std::size_t>(node.stretch), node.u.middle()}};
    FittedPose found = least_worst.from(fit.pose_at(held, cell.heading.middle));
    const double worst = worst_of(fit, found);
    if (worst >= least) continue;
    least = worst;
    best = std::move(found);
  }
  return best;
}

}  // namespace rollfix::touch
