#include "outlier_sets.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "answer_poses.hpp"
#include "locate/remaining.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"
#include "pose_sets.hpp"
#include "posterior.hpp"
#include "problem.hpp"

// Notation:
//   S, w(S)   a set of outliers and its weight, docs/touch.md, "Outliers": `outliers`, `log_weights_`
//   p         a pose's probability among those of its set: `probability`, in the end times w(S) / sum of all w
//   m, C      mean and covariance of a pose (x, y, heading): `spread`; d is what two means differ by: `apart`
//   a, b      shares of two poses that are one; their moments are those of the mixture, a m_1 + b m_2 and
//             a C_1 + b C_2 + a b d d^T: `absorb`
// Poses by different sets are one where d^T (C_1 + C_2)^-1 d is small, continua where their intervals overlap.
namespace rollfix::touch {
namespace {

// Poses by different touches are one where they are no further apart than this, in standard deviations of both.
constexpr double kSameBySets = 3;

/// From `one` to `other`; the heading on the shorter way round. NaN in x and y where nothing tells the place.
Eigen::Vector3d apart(const TouchPose& one, const TouchPose& other) {
  const Pose& a = one.spread.mean;
  const Pose& b = other.spread.mean;
  return {b.x - a.x, b.y - a.y, nearest_angle(b.heading - a.heading)};
}

/// Closed intervals.
bool overlap(const Interval& one, const Interval& other) { return one.lo <= other.hi && other.lo <= one.hi; }

/// Whether two continua have poses in common, as far as their intervals say.
bool overlap(const TouchPose& one, const TouchPose& other) {
  const double lap = apart(one, other).z() - (other.spread.mean.heading - one.spread.mean.heading);
  const Interval headings{other.interval[2].lo + lap, other.interval[2].hi + lap};
  // Without a place the headings alone decide.
  const bool by_place = std::isnan(one.interval[0].lo) ||
                        (overlap(one.interval[0], other.interval[0]) && overlap(one.interval[1], other.interval[1]));
  return by_place && overlap(one.interval[2], headings);
}

/// A continuum is never one with a pose that is held.
bool is_same(const TouchPose& one, const TouchPose& other) {
  if (one.continuum != other.continuum || one.any_heading != other.any_heading) return false;
  if (one.outliers == other.outliers) return false;  // two of one answer
  if (one.continuum) return overlap(one, other);
  const Eigen::Vector3d off = apart(one, other);
  const Eigen::Matrix3d covariance = one.spread.covariance + other.spread.covariance;
  // The heading alone.
  if (std::isnan(off.x())) return off.z() * off.z() <= kSameBySets * kSameBySets * covariance(2, 2);
  return off.dot(covariance.ldlt().solve(off)) <= kSameBySets * kSameBySets;
}

/// Takes another set's pose into one: moments, densities and extents of both. REQUIRES that it is the same.
void absorb(TouchPose& pose, TouchPose other) {
  const Eigen::Vector3d off = apart(pose, other);
  const double lap = off.z() - (other.spread.mean.heading - pose.spread.mean.heading);
  const double total = pose.probability + other.probability;
  // b of the notation; a = 1 - b.
  const double share = other.probability / total;
  Pose& mean = pose.spread.mean;
  mean = {mean.x + share * off.x(), mean.y + share * off.y(), mean.heading + share * off.z()};
  // a C_1 + b C_2 + a b d d^T.
  pose.spread.covariance = (1 - share) * pose.spread.covariance + share * other.spread.covariance +
                           share * (1 - share) * off * off.transpose();
  for (std::size_t i = 0; i < 3; ++i) {
    // Terms of both densities, weighted; headings of the other on the lap of this one.
    for (MixtureTerm& term : pose.density[i]) term.weight *= 1 - share;
    for (MixtureTerm term : other.density[i]) {
      pose.density[i].push_back({share * term.weight, term.mean + (i == 2 ? lap : 0), term.sd});
    }
    const double shift = i == 2 ? lap : 0;
    pose.extent[i].lo = std::min(pose.extent[i].lo, other.extent[i].lo + shift);
    pose.extent[i].hi = std::max(pose.extent[i].hi, other.extent[i].hi + shift);
  }
  pose.probability = total;
}

/// One contact for each roll and each touch, of outliers where they are nearest.
/// `outliers` ascend, so that each stands at its own number when it is inserted. `rolls`: their contacts come first.
void add_contacts_of_outliers(const PoseFit& fit, std::size_t rolls, TouchPose& pose) {
  for (const std::size_t k : pose.outliers) {
    pose.contacts.insert(pose.contacts.begin() + static_cast<std::ptrdiff_t>(rolls + k),
                         nearest_contact(fit, pose.pose, k));
  }
}

}  // namespace

void PoseMixture::add(std::vector<TouchPose> poses, const std::vector<std::size_t>& outliers, double log_weight) {
  for (TouchPose& pose : poses) {
    pose.outliers = outliers;
    poses_.push_back(std::move(pose));
    log_weights_.push_back(log_weight);
  }
}

/// From the most probable on, each pose joins the first one that it is the same as. Intervals of mixed poses are
/// computed anew; of the others they stay.
void PoseMixture::finish(const TouchProblem& problem, double log_total, TouchAnswer& answer) {
  for (std::size_t k = 0; k < poses_.size(); ++k) poses_[k].probability *= std::exp(log_weights_[k] - log_total);
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const TouchPose& a, const TouchPose& b) { return a.probability > b.probability; });
  std::vector<TouchPose> merged;
  std::vector<bool> is_mixed;
  for (TouchPose& pose : poses_) {
    const auto home =
        std::find_if(merged.begin(), merged.end(), [&](const TouchPose& one) { return is_same(one, pose); });
    if (home == merged.end()) {
      merged.push_back(std::move(pose));
      is_mixed.push_back(false);
    } else {
      is_mixed[static_cast<std::size_t>(home - merged.begin())] = true;
      absorb(*home, std::move(pose));
    }
  }
  TouchProblem of_touches = problem;
  // Numbers of outliers are those of touches, without rolls.
  of_touches.rolls.clear();
  const AllContacts contacts(of_touches, answer.radius);
  const PoseFit fit(contacts.each, {});
  // What is listed is taken off below.
  answer.rest = 1;
  for (std::size_t k = 0; k < merged.size(); ++k) {
    TouchPose& pose = merged[k];
    if (!(pose.probability >= kLeastListed)) {
      ++answer.improbable;
      continue;
    }
    answer.rest -= pose.probability;
    for (std::size_t i = 0; is_mixed[k] && i < 3; ++i) {
      if (!std::isnan(pose.interval[i].lo)) pose.interval[i] = middle_share(pose.density[i], 0.95);
    }
    add_contacts_of_outliers(fit, problem.rolls.size(), pose);
    answer.poses.push_back(std::move(pose));
  }
  answer.rest = std::max(0.0, answer.rest);
  put_in_order(answer.poses);
}

}  // namespace rollfix::touch
