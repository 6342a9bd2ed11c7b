#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "rollfix/advise.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix {
namespace {

// A wide placement is this many hypotheses.
constexpr std::size_t kOfAWidePlacement = 15;
// One is wide from this share of the perimeter on.
constexpr double kWidePlacement = 1e-3;
// A mode is wide from this standard deviation on, a share of the perimeter: it is this many hypotheses then, at the
// quantiles 1/14, 3/14, ... of a normal distribution.
constexpr double kWideSpread = 0.005;
constexpr std::array<double, 7> kSevenDeviates = {-1.465, -0.792, -0.366, 0, 0.366, 0.792, 1.465};

/// All alike; of one finger's wide ones several.
std::vector<Hypothesis> without_noise(const Part& part, const std::vector<Placement>& placements) {
  std::vector<Hypothesis> hypotheses;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Interval& extent = placements[k].extent[0];
    const PerFinger<double>& end = placements[k].end;
    const double share = 1 / static_cast<double>(placements.size());
    const double rolled = end[0] - placements[k].start[0];
    // Of two fingers a wide one is a curve in the plane of both places: the box around it says little of where.
    if (end.size() == 2 || extent.width() < kWidePlacement * part.perimeter()) {
      hypotheses.push_back({end, PerFinger<double>::of(end.size()), share, k});
      continue;
    }
    for (std::size_t i = 0; i < kOfAWidePlacement; ++i) {
      const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(kOfAWidePlacement);
      const double s = extent.lo + t * extent.width() + rolled;
      hypotheses.push_back({part.boundary().on_first_lap(s), 0, share / static_cast<double>(kOfAWidePlacement), k});
    }
  }
  return hypotheses;
}

/// Of two fingers, along the direction in which they are known worst: as many pairs of places of the same probability.
void add_along_ridge(const Part& part, const Hypothesis& whole, std::vector<Hypothesis>& hypotheses) {
  Mat2 covariance;
  covariance << whole.sd[0] * whole.sd[0], whole.covariance, whole.covariance, whole.sd[1] * whole.sd[1];
  Eigen::SelfAdjointEigenSolver<Mat2> axes;  // the larger one last
  axes.computeDirect(covariance);
  const double along = std::sqrt(std::max(0.0, axes.eigenvalues()(1)));
  const Vec2 axis = axes.eigenvectors().col(1);
  constexpr auto kPieces = static_cast<double>(kSevenDeviates.size());
  // What is left within each of them: as much less along the ridge as there are of them.
  const Mat2 within = covariance - (1 - 1 / (kPieces * kPieces)) * along * along * axis * axis.transpose();
  for (const double deviate : kSevenDeviates) {
    Hypothesis one = whole;
    one.probability /= kPieces;
    one.covariance = within(0, 1);
    for (const std::size_t finger : {0U, 1U}) {
      const auto k = static_cast<Eigen::Index>(finger);
      one.place[finger] = part.boundary().base(whole.place[finger] + deviate * along * axis(k));
      one.sd[finger] = std::sqrt(std::max(0.0, within(k, k)));
    }
    hypotheses.push_back(one);
  }
}

/// The covariance of where the contacts are now: the errors that both places share are those of the first contacts.
template <class Remaining>
double covariance_now(const Remaining& one) {
  const double first = one.sd[0] * one.sd[1];
  if (one.sd.size() < 2 || !(first > 0)) return 0;
  return one.covariance(0, 1) / first * one.end_sd[0] * one.end_sd[1];
}

/// `Remaining`: a placement or a mode, of which the samples say how probable it is.
template <class Remaining>
std::vector<Hypothesis> with_noise(const Part& part, const std::vector<Remaining>& all) {
  std::vector<Hypothesis> hypotheses;
  double total = 0;
  for (const Remaining& one : all) total += one.probability;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Hypothesis whole{all[k].end_mean, all[k].end_sd, all[k].probability / total, k, covariance_now(all[k])};
    double widest = 0;
    for (const double sd : whole.sd) widest = std::max(widest, sd);
    if (widest < kWideSpread * part.perimeter()) {
      hypotheses.push_back(whole);
      continue;
    }
    if (whole.sd.size() == 2) {
      add_along_ridge(part, whole, hypotheses);
      continue;
    }
    // As many places of the same probability, as if it were normal.
    for (const double deviate : kSevenDeviates) {
      const double place = part.boundary().base(whole.place[0] + deviate * whole.sd[0]);
      hypotheses.push_back({place, whole.sd[0] / kSevenDeviates.size(), whole.probability / kSevenDeviates.size(), k});
    }
  }
  return hypotheses;
}

}  // namespace

std::vector<Hypothesis> hypotheses_of(const Part& part, const std::vector<Placement>& placements) {
  const bool has_noise = !placements.empty() && !std::isnan(placements.front().probability);
  return has_noise ? with_noise(part, placements) : without_noise(part, placements);
}

std::vector<Hypothesis> hypotheses_of(const Part& part, const std::vector<Mode>& modes) {
  return with_noise(part, modes);
}

}  // namespace rollfix
