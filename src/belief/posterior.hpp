#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"

// What one finger's posterior and two fingers' have in common.
namespace rollfix::belief {

// Samples that are off by more than this many times the noise can't be of this part and this finger.
inline constexpr double kMostExcess = 2.5;
// The farthest of the errors that are let pass, in standard deviations.
inline constexpr double kFarthest = 4.5;
// A place with this probability is the only one.
inline constexpr double kCertain = 0.95;
// One with less than this is not counted among those that remain.
inline constexpr double kCounts = 0.01;
// Of samples that are asked to be robust, this share is taken to be stray.
inline constexpr double kOutlierShare = 0.02;
// The samples' cost is beyond what chance makes of it: this many standard deviations of a chi-square.
inline constexpr double kExcessSigma = 3;

// The scale of lengths is not believed beyond these many standard deviations, nor beyond this share.
inline constexpr double kMostSigmas = 8;
inline constexpr double kMostScale = 0.5;
// Two peaks are two places when the density on the best way between them is below exp(-3) = 5 % of the lower one.
inline constexpr double kValley = 3;
// A mode with less probability than this is not listed.
inline constexpr double kLeastProbability = 1e-4;
// What an interval of a mode holds.
inline constexpr double kCredible = 0.95;
// A piece of the posterior with less of it is not told of.
inline constexpr double kLeastShare = 1e-9;

inline double square(double x) { return x * x; }

/// The standard normal deviate that is as unlikely as this chi-square (Wilson and Hilferty 1931).
inline double normal_deviate(double chi_square, double freedom) {
  const double spread = 2 / (9 * freedom);
  return (std::cbrt(chi_square / freedom) - (1 - spread)) / std::sqrt(spread);
}

/// By how many times more the samples are off than the noise allows, given what the best place costs.
inline double excess_of(double cost, double freedom, bool robust) {
  const bool is_excess = freedom > 0 && !robust && normal_deviate(cost, freedom) > kExcessSigma;
  return is_excess ? std::max(1.0, std::sqrt(cost / freedom)) : 1.0;
}

/// How far a scale of lengths is believed, given its variance.
inline double most_scale(double variance) { return std::min(kMostScale, kMostSigmas * std::sqrt(variance)); }

/// A row that is right, or stray: then it says nothing.
struct Mixture {
  double weight;   // probability that it is right
  double cost;     // minus twice the logarithm of its likelihood, as a share of what it can be at most, ...
  double density;  // ... which is this
};

/// `stray`: density of a stray row. `inverse`: of the variance of a right one, which is off by so much, squared, in
/// standard deviations.
inline Mixture mixture_of(double share, double stray, double inverse, double squared) {
  const double right = (1 - share) * std::sqrt(inverse / (2 * std::numbers::pi));
  const double fits = right * std::exp(-0.5 * squared);
  return {fits / (fits + stray), -2 * std::log((fits + stray) / (right + stray)), right + stray};
}

/// A little of the posterior: first contacts, and the share of the probability that they stand for.
struct Piece {
  PerFinger<double> s;        // unwrapped
  PerFinger<double> tangent;  // radians, unwrapped
  double share = 0;
  PerFinger<double> slid;  // how much further round each finger the first contact was than felt, length
  Eigen::Matrix2d slid_covariance = Eigen::Matrix2d::Zero();
};

/// What all samples together come to.
struct Outcome {
  std::vector<Mode> modes;  // the most probable first
  double excess = 1;
  double unresolved = 0;  // bound on the probability where the density was not looked at closely
};

/// What one finger's posterior and two fingers' have in common: Belief does the rest.
class Posterior {
 public:
  virtual ~Posterior() = default;

  virtual void add(const Sample& sample) = 0;
  virtual std::size_t samples() const = 0;
  /// Anything is known at all.
  virtual bool has_begun() const = 0;

  /// Takes all samples so far. What follows is not asked before.
  virtual Outcome settle() = 0;

  /// As much of the boundary as holds 95 %, length; `intervals`: of the modes that count.
  virtual double credible_length(const std::vector<PerFinger<Interval>>& intervals) const = 0;
  /// Of f of these readings, at these modes, the largest.
  virtual double variance_of_miss(const std::vector<Reading>& readings, const std::vector<Mode>& modes) const = 0;
  /// How well another cause explains the samples.
  virtual Diagnosis supposing(Cause cause) const = 0;
  /// Of a mode. The first is the one that poses are compared with; its share may be 0.
  virtual std::vector<Piece> pieces(std::size_t index, const Mode& mode) const = 0;
};

std::unique_ptr<Posterior> posterior_of_one(const Part& part, LogKind kind, const BeliefOptions& options);
std::unique_ptr<Posterior> posterior_of_two(const Part& part, LogKind kind, const BeliefOptions& options,
                                            const Contacts& contacts);

/// See Belief::pose_spread. `pieces`: of the mode.
PoseSpread pose_spread_of(const Part& part, const std::vector<Piece>& pieces, const PerFinger<FeltContact>& felt,
                          const Noise& noise);

}  // namespace rollfix::belief
