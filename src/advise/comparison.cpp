#include "advise/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "belief/posterior.hpp"

// Notation:
//   i, j, p_i       places that are left, and their probabilities: Hypothesis
//   x               length of a roll; y_i, V_i: the turn that place i would measure then, and its variance: Seen
//   d_ij^2          the largest (y_i - y_j)^2 / (V_i + V_j) on the way: `distance_`
//   q_j             p_j exp(-d_ij^2 / 2) over their sum: what j is worth where i is true: `left`
//   bits            H(p) - sum over i of p_i H(q), H being the entropy
// Follows docs/belief.md, "The next roll", and docs/two_fingers.md, "The next roll".
// Idea: a roll is read all along, so that what has told two places apart stays told: their largest distance counts.
namespace rollfix::belief {
namespace {

// What tells two places apart only in part, at this share of the squared distance that is wanted, is still gone for
// where nothing within the travel tells more.
constexpr double kInPart = 0.5;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Squared: from there on a place is left with less probability, beside the true one, than counts.
double distance_wanted(double of_true, double of_other) {
  return 2 * std::log(std::max(of_other / (kHypothesisCounts * of_true), 1 + kHypothesisCounts));
}

/// Finger a's turn counts with this sign, finger b's with the other.
double sign_of(std::size_t finger) { return finger == 0 ? 1 : -1; }

}  // namespace

double entropy(const std::vector<double>& weights) {
  double bits = 0;
  for (const double p : weights) {
    if (p > 0) bits -= p * std::log2(p);
  }
  return bits;
}

double shortest_perimeter(const std::vector<PartHypothesis>& hypotheses) {
  double shortest = kNever;
  for (const PartHypothesis& one : hypotheses) shortest = std::min(shortest, one.part->perimeter());
  return shortest;
}

Comparison::Comparison(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options,
                       const PerFinger<double>& direction)
    : hypotheses_(hypotheses), options_(options), direction_(direction) {
  const std::size_t n = hypotheses.size();
  distance_.assign(n * n, 0);
  told_.assign(n * n, {kNever, kNever});
  for (const PartHypothesis& one : hypotheses) {
    PerFinger<Turning>& start = start_.emplace_back(PerFinger<Turning>::of(direction.size()));
    for (std::size_t k = 0; k < direction.size(); ++k) start[k] = one.part->turning().at(one.hypothesis.place[k]);
  }
}

ExpectedGain Comparison::roll_to(double x) {
  compare_at(x);
  note_told(std::abs(x));
  return expected(x);
}

/// What this hypothesis would read at x, and how badly that is known.
Comparison::Seen Comparison::seen_by(std::size_t hypothesis, double x) const {
  const PartHypothesis& one = hypotheses_[hypothesis];
  if (options_.foresees) {
    const Foreseen foreseen = options_.foresees(one, Way{direction_, {}}.rolled(x));
    return {foreseen.value, foreseen.variance};
  }
  Seen seen{0, square(options_.turn_sd) / options_.rows};
  PerFinger<double> by_place = PerFinger<double>::of(direction_.size());
  for (std::size_t k = 0; k < direction_.size(); ++k) {
    const double length = x * direction_[k];
    const Turning now = one.part->turning().at(one.hypothesis.place[k] + length);
    const Turning& start = start_[hypothesis][k];
    seen.turn += sign_of(k) * (now.angle - start.angle);
    by_place[k] = sign_of(k) * (now.curvature - start.curvature);
    seen.variance += (square(options_.length_sd) / options_.rows + square(options_.length_share_sd * length)) *
                         square(now.curvature) +
                     square(one.hypothesis.sd[k] * by_place[k]);
  }
  if (direction_.size() == 2) seen.variance += 2 * by_place[0] * by_place[1] * one.hypothesis.covariance;
  return seen;
}

void Comparison::compare_at(double x) {
  const std::size_t n = hypotheses_.size();
  std::vector<Seen> seen;
  seen.reserve(n);
  for (std::size_t i = 0; i < n; ++i) seen.push_back(seen_by(i, x));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double squared = square(seen[i].turn - seen[j].turn) / (seen[i].variance + seen[j].variance);
      double& most = distance_[i * n + j];
      most = std::max(most, squared);
      distance_[j * n + i] = most;
    }
  }
}

void Comparison::note_told(double travel) {
  const std::size_t n = hypotheses_.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      std::array<double, 2>& told = told_[i * n + j];
      if (told[0] < kNever) continue;
      const double wanted =
          distance_wanted(hypotheses_[i].hypothesis.probability, hypotheses_[j].hypothesis.probability);
      const double distance = distance_[i * n + j];
      if (distance >= wanted) told[0] = travel;
      if (distance >= kInPart * wanted) told[1] = std::min(told[1], travel);
    }
  }
}

ExpectedGain Comparison::expected(double x) const {
  const std::size_t n = hypotheses_.size();
  std::vector<double> prior(n);
  std::size_t labels = 0;
  for (std::size_t i = 0; i < n; ++i) {
    prior[i] = hypotheses_[i].hypothesis.probability;
    labels = std::max(labels, hypotheses_[i].hypothesis.label + 1);
  }
  ExpectedGain gain{x, 0, entropy(prior)};
  std::vector<double> left(n);
  std::vector<double> of_label(labels);
  for (std::size_t i = 0; i < n; ++i) {
    // Hypothesis i is the true one: what the others are worth then.
    double total = 0;
    for (std::size_t j = 0; j < n; ++j) total += left[j] = prior[j] * std::exp(-0.5 * distance_[i * n + j]);
    std::fill(of_label.begin(), of_label.end(), 0);
    for (std::size_t j = 0; j < n; ++j) {
      left[j] /= total;
      of_label[hypotheses_[j].hypothesis.label] += left[j];
    }
    gain.bits -= prior[i] * entropy(left);
    const auto counts =
        std::count_if(of_label.begin(), of_label.end(), [](double p) { return p >= kHypothesisCounts; });
    gain.placements += prior[i] * static_cast<double>(counts);
  }
  return gain;
}

}  // namespace rollfix::belief
