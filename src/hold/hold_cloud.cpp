#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "steps.hpp"
#include "work/pulse.hpp"

// Notation:
//   u, H            unknowns, and their information with all poses eliminated: Reduced::matrix
//   F               the first contacts that are held: `held`; d: how many
//   log p           -chi^2 / 2 + log volume - log det(H without F) / 2: HoldNode::log_density
//   D               scale of each unknown: see inverse_within
//   g               the root above 1 of x^(d + 1) = x + 1: for d = 1 the golden ratio
// Idea: fingers on straight sides whose normals are all that is known of them may be anywhere there, each for itself.
// Over such a continuum p has no ridge. Points F_n = lo + (hi - lo) frac(1/2 + n g^-j), j = 1 ... d, are spread evenly
// over it, also as each first contact sees them alone (M. Roberts, "The unreasonable effectiveness of quasirandom
// sequences", 2018); at each the rest is fitted, and the density is what a node counts.
namespace rollfix::hold {
namespace {

constexpr std::size_t kPointsOfCloud = 128;  // for each direction
constexpr double kCloudEnd = 12.5;           // below the highest density by this much nothing counts: five sd
constexpr double kCloudStep = 1.0 / 24;      // of a set's width, from point to point to the continuum's ends, ...
constexpr int kHalvings = 6;                 // ... and so often halved there
constexpr double kThin = 0.25;               // fewer of the points count: they are drawn again, closer together

/// By Newton's method, from above.
double generalized_golden_ratio(std::size_t d) {
  const double power = static_cast<double>(d) + 1;
  double x = 2;
  for (int round = 0; round < 60; ++round) x -= (std::pow(x, power) - x - 1) / (power * std::pow(x, power - 1) - 1);
  return x;
}

class Cloud {
 public:
  Cloud(const HoldFit& fit, const Boundary& boundary, const HeldState& state, const Held& held, const Scale& scale)
      : fit_(fit), boundary_(boundary), held_(held), scale_(scale), start_(node_at(fit, state, held, scale)) {
    most_ = start_.log_density;
  }

  HoldCloud run() {
    HoldCloud cloud;
    for (const Eigen::Index axis : held_) cloud.box.push_back(extent(axis));
    cloud.nodes = spread_over(cloud.box);
    if (static_cast<double>(cloud.nodes.size()) < kThin * static_cast<double>(count())) {
      cloud.nodes = spread_over(about(cloud.nodes, cloud.box));
    }
    return cloud;
  }

 private:
  std::size_t count() const { return kPointsOfCloud * held_.size(); }

  /// From the start to both sides, with everything else fitted, as far as it counts.
  Interval extent(Eigen::Index axis) {
    const double from = start_.state.unknowns(axis);
    const double room = boundary_.closed ? 0.5 * boundary_.perimeter : boundary_.perimeter;
    Interval extent{from, from};
    for (const int direction : {-1, 1}) {
      HoldNode at = start_;
      double step = kCloudStep * std::sqrt(12.0) * scale_(axis);
      for (int halved = 0; halved <= kHalvings && std::abs(at.state.unknowns(axis) - from) < room;) {
        beat();
        Unknowns unknowns = at.state.unknowns;
        unknowns(axis) += direction * step;
        HoldNode next = node_at(fit_, fit_.fit(fit_.at(unknowns, at.state), {axis}), held_, scale_);
        most_ = std::max(most_, next.log_density);
        if (next.log_density > most_ - kCloudEnd) {
          at = std::move(next);
        } else {
          step *= 0.5;
          ++halved;
        }
      }
      (direction < 0 ? extent.lo : extent.hi) = at.state.unknowns(axis) + direction * step;
    }
    return extent;
  }

  /// Nodes that count, spread evenly over a box of what is held.
  std::vector<HoldNode> spread_over(const std::vector<Interval>& box) {
    const double ratio = generalized_golden_ratio(held_.size());
    std::vector<HoldNode> nodes{start_};
    for (std::size_t n = 1; n <= count(); ++n) {
      beat();
      Unknowns point = Unknowns::Zero(scale_.size());
      for (std::size_t j = 0; j < held_.size(); ++j) {
        const double share = 0.5 + static_cast<double>(n) * std::pow(ratio, -static_cast<double>(j + 1));
        point(held_[j]) = box[j].lo + box[j].width() * (share - std::floor(share));
      }
      const HeldState& near = nearest(nodes, point, box).state;
      Unknowns unknowns = near.unknowns;
      for (const Eigen::Index axis : held_) unknowns(axis) = point(axis);
      nodes.push_back(node_at(fit_, fit_.fit(fit_.at(unknowns, near), held_), held_, scale_));
      most_ = std::max(most_, nodes.back().log_density);
    }
    nodes.erase(nodes.begin());  // the start is none of the points
    std::erase_if(nodes, [&](const HoldNode& node) { return !(node.log_density > most_ - kCloudEnd); });
    if (nodes.empty()) nodes.push_back(start_);
    // Each stands for as much of the box: over it what is held is uniform.
    const double share = 1 / static_cast<double>(count());
    const double edge = std::pow(share, 1 / static_cast<double>(held_.size()));
    for (HoldNode& node : nodes) {
      node.width = share;
      for (std::size_t j = 0; j < held_.size(); ++j) {
        node.width *= box[j].width();
        node.covariance(held_[j], held_[j]) = std::pow(edge * box[j].width(), 2) / 12;
      }
    }
    return nodes;
  }

  /// In widths of the box.
  const HoldNode& nearest(const std::vector<HoldNode>& nodes, const Unknowns& point,
                          const std::vector<Interval>& box) const {
    return *std::ranges::min_element(nodes, {}, [&](const HoldNode& node) {
      double square = 0;
      for (std::size_t j = 0; j < held_.size(); ++j) {
        square += std::pow((node.state.unknowns(held_[j]) - point(held_[j])) / box[j].width(), 2);
      }
      return square;
    });
  }

  /// The box of these nodes and of what they stand for, in the box they were drawn from.
  std::vector<Interval> about(const std::vector<HoldNode>& nodes, const std::vector<Interval>& box) const {
    std::vector<Interval> result;
    for (std::size_t j = 0; j < held_.size(); ++j) {
      const double start = start_.state.unknowns(held_[j]);
      Interval range{start, start};
      for (const HoldNode& node : nodes) {
        const double reach = std::sqrt(12 * node.covariance(held_[j], held_[j]));
        range.lo = std::min(range.lo, node.state.unknowns(held_[j]) - reach);
        range.hi = std::max(range.hi, node.state.unknowns(held_[j]) + reach);
      }
      result.push_back({std::max(range.lo, box[j].lo), std::min(range.hi, box[j].hi)});
    }
    return result;
  }

  const HoldFit& fit_;
  Boundary boundary_;
  Held held_;
  Scale scale_;
  HoldNode start_;
  double most_ = 0;  // log p, so far
};

}  // namespace

Inverse inverse_within(const UnknownsMatrix& information, const Scale& scale) {
  Inverse inverse;
  inverse.covariance = UnknownsMatrix::Zero(scale.size(), scale.size());
  if (scale.size() == 0) return inverse;
  // In units of the scales an eigenvalue of 1 is a direction known as well as its scale; less is set to 1.
  const UnknownsMatrix scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<UnknownsMatrix> eigen(scaled);
  Unknowns values = eigen.eigenvalues();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    // NaN counts as free.
    if (!(values(k) > 1)) {
      values(k) = 1;
      ++inverse.free;
    }
    inverse.log_determinant += std::log(values(k)) - 2 * std::log(scale(k));
  }
  // D V diag(1 / values) V^T D, and log det = sum of log values - 2 sum of log D.
  const UnknownsMatrix vectors = scale.asDiagonal() * eigen.eigenvectors();
  inverse.covariance = vectors * values.cwiseInverse().asDiagonal() * vectors.transpose();
  return inverse;
}

HoldNode node_at(const HoldFit& fit, const HeldState& state, const Held& held, const Scale& scale) {
  std::vector<Eigen::Index> rest;
  for (Eigen::Index k = 0; k < fit.size(); ++k) {
    if (std::ranges::find(held, k) == held.end()) rest.push_back(k);
  }
  HoldNode node;
  node.state = state;
  const Reduced now = fit.reduced(state);
  const Inverse inverse = inverse_within(now.matrix(rest, rest), scale(rest));
  node.log_density = -0.5 * state.square + now.log_volume - 0.5 * inverse.log_determinant;
  node.covariance = UnknownsMatrix::Zero(fit.size(), fit.size());
  node.covariance(rest, rest) = inverse.covariance;
  return node;
}

HoldCloud cloud_about(const HoldFit& fit, const Boundary& boundary, const HeldState& state, const Held& held,
                      const Scale& scale) {
  return Cloud(fit, boundary, state, held, scale).run();
}

}  // namespace rollfix::hold
