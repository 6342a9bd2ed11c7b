#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "belief/grid.hpp"
#include "belief/posterior.hpp"

namespace rollfix::belief {

namespace {

/// What decides how a finger's samples are weighed; from the first one on.
struct OneFingersGrid {
  OneFingersGrid(const Part& part, LogKind kind, const BeliefOptions& options, double curvature)
      : finger_curvature(curvature),
        errors(options, kind, curvature, part.perimeter()),
        boundary(part, tilt(part, errors.row(curvature)), accuracy(part, errors.row(curvature))),
        nodes(errors, boundary.tilt(), options.robust),
        grid(boundary, errors, options, part.boundary(), corner_length(curvature, part)) {}

  /// A disk's curvature; else what makes lengths and angles, as uncertain as they are, count alike.
  double tilt(const Part& part, const RowCovariance& own) const {
    return tilt_of(finger_curvature, std::sqrt(own.turn / own.length), part);
  }
  static double accuracy(const Part& part, const RowCovariance& own) {
    return accuracy_of(std::sqrt(own.length), part);
  }

  double finger_curvature;  // at the first contact
  ErrorModel errors;
  TiltedBoundary boundary;
  Nodes nodes;
  Grid grid;
};

class OneFingersPosterior : public Posterior {
 public:
  OneFingersPosterior(const Part& part, LogKind kind, const BeliefOptions& options)
      : part_(part), kind_(kind), options_(options) {}

  void add(const Sample& sample) override {
    const bool is_first = !state_;
    last_ = sample;
    if (is_first) state_.emplace(part_, kind_, options_, sample.finger_curvature[0]);
    // Row 1 of a log of contacts is what all others are measured from: it says nothing by itself.
    if (is_first && kind_ == LogKind::contact) return;
    state_->nodes.add(sample.reading, sample.finger_curvature[0]);
  }

  std::size_t samples() const override { return state_ ? state_->nodes.rows() : 0; }
  bool has_begun() const override { return samples() > 0; }

  Outcome settle() override {
    if (!has_begun()) return {};
    state_->grid.settle(state_->nodes);
    const ModeQuestion question{&state_->boundary, last_.reading, state_->errors.row(last_.finger_curvature[0]),
                                part_.boundary()};
    return {modes_of(state_->grid, question), state_->grid.excess(), state_->grid.rest()};
  }

  double credible_length(const std::vector<PerFinger<Interval>>& /*intervals*/) const override {
    return belief::credible_length(state_->grid);
  }

  double variance_of_miss(const std::vector<Reading>& /*readings*/, const std::vector<Mode>& modes) const override {
    const SharedCovariance& shared = state_->errors.start();
    const RowCovariance own = state_->errors.row(last_.finger_curvature[0]);
    double most = 0;
    for (const Mode& mode : modes) {
      const double kappa = part_.turning().curvature(mode.end[0]);
      // f is off by the turn's error less kappa times the length's.
      const Eigen::Vector3d by_error(-kappa, 1, -kappa * last_.reading.length[0]);
      const double variance =
          by_error.dot(shared * by_error) + own.turn - 2 * kappa * own.both + kappa * kappa * own.length;
      most = std::max(most, variance);
    }
    return most;
  }

  /// With other errors the samples' nodes stay what they are; what the rows gather is looked at by lengths alone.
  Diagnosis supposing(Cause cause) const override {
    const ErrorModel other(options_, kind_, state_->finger_curvature, part_.perimeter(), cause);
    Nodes nodes(other, state_->boundary.tilt(), options_.robust);
    for (const Node& node : state_->nodes.complete()) nodes.add({node.length, node.turn}, last_.finger_curvature[0]);
    Grid grid(state_->boundary, other, options_, part_.boundary(), corner_length(last_.finger_curvature[0], part_));
    grid.settle(nodes);
    return {cause, grid.excess(), 1 / (1 + grid.best().now.errors()[2])};
  }

  std::vector<Piece> pieces(std::size_t /*index*/, const Mode& mode) const override {
    std::vector<Piece> pieces;
    pieces.push_back({mode.start, mode.tangent, 0, 0.0, Eigen::Matrix2d::Zero()});
    for (Piece& piece : pieces_of(state_->grid, state_->boundary, part_.perimeter())) {
      if (part_.boundary().contains(mode.region[0], piece.s[0])) pieces.push_back(std::move(piece));
    }
    return pieces;
  }

 private:
  Part part_;
  LogKind kind_;
  BeliefOptions options_;
  std::optional<OneFingersGrid> state_;
  Sample last_;
};

}  // namespace

std::unique_ptr<Posterior> posterior_of_one(const Part& part, LogKind kind, const BeliefOptions& options) {
  return std::make_unique<OneFingersPosterior>(part, kind, options);
}

}  // namespace rollfix::belief
