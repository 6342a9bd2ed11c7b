#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <numbers>
#include <optional>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"

// What one finger's posterior and two fingers' have in common.
namespace rollfix::belief {

// Rows that are off by more than this many times the noise: nothing fits, the verdict is `inconsistent`.
inline constexpr double kMostExcess = 2.5;
// The farthest of the errors that are let pass, in standard deviations.
inline constexpr double kFarthest = 4.5;
// With `robust` this share of the rows is taken to be outliers.
inline constexpr double kOutlierShare = 0.02;
// The samples' cost is beyond what chance makes of it: this many standard deviations of a chi-square.
inline constexpr double kExcessSigma = Fit::kMostSigmas;
// Neighbouring samples are not taken to be more alike than this.
inline constexpr double kMostAlike = 0.95;

// The scale of lengths is not believed beyond these many standard deviations, nor beyond this share.
inline constexpr double kMostErrorSigmas = 8;
inline constexpr double kMostScale = 0.5;
// Two peaks are two places when the density on the best way between them is below exp(-3) = 5 % of the lower one.
inline constexpr double kValley = 3;
// What an interval of a mode holds.
inline constexpr double kCredible = 0.95;
// A piece of the posterior with less of it is left out.
inline constexpr double kLeastShare = 1e-9;

/// Throws InputError: noise that is not valid, that is none, or beyond which a row says nothing.
void require_weighable(const Noise& noise);

inline double square(double x) { return x * x; }

/// The probability of a chi-square at least as large, of `freedom` > 0 degrees of freedom.
double p_of_chi_square(double chi_square, double freedom);

/// The standard normal deviate that is as unlikely as this chi-square (Wilson and Hilferty 1931): its cube root is
/// nearly normal, with mean 1 - 2 / (9 n) and variance 2 / (9 n) for chi_square / n, n = `freedom` > 0.
inline double normal_deviate(double chi_square, double freedom) {
  const double spread = 2 / (9 * freedom);
  return (std::cbrt(chi_square / freedom) - (1 - spread)) / std::sqrt(spread);
}

/// Innovations of each of a filter's equations, in standard deviations, in the order of the rows. An equation that the
/// filter does not have is empty.
using Innovations = std::array<std::pmr::vector<double>, 3>;

/// Whether a filter's innovations, each in its standard deviations, are as they should be: independent, none far out.
class Whiteness {
 public:
  /// All that follow are kept as well, there.
  void record_to(std::pmr::vector<double>* kept) { kept_ = kept; }

  void add(double innovation) {
    if (kept_ != nullptr) kept_->push_back(innovation);
    most_ = std::max(most_, innovation * innovation);
    lag_ += innovation * last_;
    last_ = innovation;
    squares_ += innovation * innovation;
    sum_ += innovation;
    sums_ += sum_ * sum_;
    ++count_;
  }

  /// Of neighbours, below 1. Innovations smaller than stated are not scaled up: that they are alike then shows little,
  /// and the answer is not too sure.
  double correlation() const { return count_ > 0 ? lag_ / std::max(squares_, count_) : 0; }
  /// How unlikely it is that independent ones run like these: as a standard normal deviate.
  double sigmas() const {
    // Of independent innovations the lag-one correlation has the standard deviation 1 / sqrt(n).
    if (count_ < kFewestToCompare) return 0;
    const double neighbours = correlation() * std::sqrt(count_);
    // The integral of a squared Wiener process: nearly all of it is 4 / pi^2 times a chi-square of one degree.
    const double wander = sums_ / (count_ * std::max(squares_, count_));
    const double drift = std::sqrt(std::max(0.0, wander - kWanderOfRest) / kWanderOfFirst);
    return std::max(neighbours, drift);
  }
  /// How unlikely it is that the farthest of so many is so far out (Bonferroni: n normal tails of exp(-x^2 / 2) each).
  double farthest() const { return std::sqrt(std::max(0.0, most_ - 2 * std::log(std::max(1.0, count_)))); }

 private:
  static constexpr double kFewestToCompare = 8;
  // The integral of W^2 over [0, 1] is a sum of chi-squares by 4 / ((2 k - 1) pi)^2, k = 1, 2, ...: its mean is 1/2.
  // The first is taken as it is, all others by their mean.
  static constexpr double kWanderOfFirst = 4 / (std::numbers::pi * std::numbers::pi);
  static constexpr double kWanderOfRest = 0.5 - kWanderOfFirst;

  double last_ = 0;     // innovation
  double most_ = 0;     // the largest square
  double lag_ = 0;      // sum of the products of neighbours
  double sum_ = 0;      // of all so far
  double sums_ = 0;     // of the squares of these sums
  double squares_ = 0;  // sum of the squares
  double count_ = 0;
  std::pmr::vector<double>* kept_ = nullptr;  // see record_to
};

/// How innovations run in the long term.
struct Trend {
  double sigmas = 0;   // how unlikely it is that independent ones do: a standard normal deviate
  double widened = 1;  // by how many times they are larger there than they should be
  double jitter = 1;   // from one to the next: the variance of independent ones that differ so
  double count = 0;    // of them, of each equation
};

/// Their slowest cosine components, which are independent and as large as any other where the innovations are (Neyman's
/// smooth test, 1937): what a bias that drifts makes is in them, far below what neighbours or the farthest row show.
/// `freedom`: so many innovations are independent.
Trend trend_of(const Innovations& innovations, double freedom);

/// Of a row's N equations, given the inverse of their covariance, made independent of each other.
template <int N>
void add_innovation(const Eigen::Matrix<double, N, N>& inverse, const Eigen::Matrix<double, N, 1>& innovation,
                    std::array<Whiteness, 3>& equations) {
  if constexpr (N == 1) {
    equations[0].add(std::sqrt(inverse(0, 0)) * innovation[0]);
  } else {
    // With S^-1 = U^T U the numbers U e are independent and have the variance 1.
    const Eigen::Matrix<double, N, 1> independent = inverse.llt().matrixU() * innovation;
    for (int k = 0; k < N; ++k) equations[static_cast<std::size_t>(k)].add(independent[k]);
  }
}

/// With neighbours that are so much alike, so many times the noise: the root of how many rows are worth one (Bartlett
/// 1935).
inline double widened_by(double correlation) {
  const double alike = std::clamp(correlation, 0.0, kMostAlike);
  return std::sqrt((1 + alike) / (1 - alike));
}

/// What the likeliest place leaves of the samples: its cost, as much as is to be expected of it, and how the
/// innovations of each equation run.
inline Fit fit_of(double cost, double freedom, const std::array<Whiteness, 3>& equations) {
  Fit fit;
  fit.chi_square = cost;
  fit.freedom = freedom;
  // No rows: nothing to compare.
  if (!(freedom > 0)) return fit;
  fit.sigmas = normal_deviate(cost, freedom);
  for (const Whiteness& each : equations) fit.row_sigmas = std::max(fit.row_sigmas, each.farthest());
  // The equation whose innovations are least like independent ones speaks for all.
  const Whiteness& least_white =
      *std::max_element(equations.begin(), equations.end(),
                        [](const Whiteness& a, const Whiteness& b) { return a.sigmas() < b.sigmas(); });
  fit.correlation = least_white.correlation();
  fit.correlation_sigmas = least_white.sigmas();
  // The noise is taken as larger only where chance does not explain the chi-square.
  if (fit.sigmas > kExcessSigma) fit.excess = std::max(1.0, std::sqrt(cost / freedom));
  fit.widened = fit.excess;
  if (fit.is_correlated()) {
    fit.widened *= widened_by(fit.correlation);
  }
  return fit;
}

// So unlikely is a place at which more rows are outliers than are right: what the few others fit, they may fit
// anywhere.
inline constexpr double kMostlyStray = 10;

/// Of rows of which some may be outliers: by those that are right, so many of all. That one is far off contradicts
/// nothing there.
inline Fit robust_fit_of(double right_cost, double right_rows, double rows, const std::array<Whiteness, 3>& equations) {
  Fit fit = fit_of(right_cost, right_rows, equations);
  fit.row_sigmas = right_rows < 0.5 * rows ? kMostlyStray : 0;
  fit.stray = rows - right_rows;
  return fit;
}

/// Innovations that run so in the long term are alike as well. `step`: from one to the next the finger rolls so far; 0:
/// neighbours can't be said to be alike.
inline void add_trend(const Trend& trend, double step, Fit& fit) {
  fit.trend_sigmas = trend.sigmas;
  const double widened = fit.excess * std::min(trend.widened, widened_by(kMostAlike));
  if (trend.sigmas > kExcessSigma) fit.widened = std::max(fit.widened, widened);
  // The variogram: of innovations with variance 1 and correlation exp(-step / length), half the mean squared difference
  // of neighbours is 1 - exp(-step / length). Solved for the length.
  const bool may_be_alike = fit.is_too_good() && trend.jitter > 0 && trend.jitter < 1;
  // Of rows that are alike from end to end it can't be told how much longer it is than the roll.
  fit.alike_over = may_be_alike ? step * std::min(-1 / std::log1p(-trend.jitter), trend.count) : 0;
}

/// The highest density of a normal distribution, given the inverse of its variance.
inline double peak_of(double inverse) { return std::sqrt(inverse / (2 * std::numbers::pi)); }

/// How far a scale of lengths is believed, given its variance.
inline double most_scale(double variance) { return std::min(kMostScale, kMostErrorSigmas * std::sqrt(variance)); }

/// A row that is right, or an outlier: then it says nothing.
struct Mixture {
  double weight;   // probability that it is right, given how far it is off
  double cost;     // minus twice the logarithm of its density over the highest one: at least 0, and bounded
  double density;  // the highest density of the mixture
};

/// `share`: of outliers. `stray`: density of an outlier, times that share. `peak`: the highest density of a right row,
/// which is off by `squared`, in standard deviations, squared.
inline Mixture mixture_of(double share, double stray, double peak, double squared) {
  const double right = (1 - share) * peak;
  const double fits = right * std::exp(-0.5 * squared);
  return {fits / (fits + stray), -2 * std::log((fits + stray) / (right + stray)), right + stray};
}

/// A little of the posterior: first contacts, and the share of the probability that they stand for.
struct MassPiece {
  PerFinger<double> s;        // unwrapped
  PerFinger<double> tangent;  // radians, unwrapped
  double share = 0;
  std::optional<PoseSpread> pose{};  // of one finger: of the part, as far as the rows tell it for these
  PerFinger<double> slid{};          // how much further round each finger the first contact was than felt, length
  Eigen::Matrix2d slid_covariance = Eigen::Matrix2d::Zero();
};

/// What all samples together come to.
struct Outcome {
  std::vector<Mode> modes;  // the most probable first
  Fit fit;
  Evidence evidence{};
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

  /// How well all samples so far fit, where that is known long before what they leave; else nothing.
  virtual std::optional<Fit> fit_alone() { return std::nullopt; }

  /// See Belief. Not after settle().
  virtual bool is_hopeless(const Rival& /*rival*/) { return false; }

  /// As much of the boundary as holds 95 %, length; `intervals`: of the modes that count.
  virtual double credible_length(const std::vector<PerFinger<Interval>>& intervals) const = 0;
  /// Of f of these readings, at these modes, the largest.
  virtual double variance_of_miss(const std::vector<Reading>& readings, const std::vector<Mode>& modes) const = 0;
  /// Of a mode. The first is the one that poses are compared with; its share may be 0.
  virtual std::vector<MassPiece> pieces(std::size_t index, const Mode& mode) const = 0;
  /// See Belief, but for Fit::widened.
  virtual std::vector<PosePiece> pose_pieces() const { return {}; }
  /// See Belief::density. `modes`: of settle().
  virtual PerFinger<Density> density(const std::vector<Mode>& modes) const = 0;
};

std::unique_ptr<Posterior> posterior_of_one(const Part& part, LogKind kind, const BeliefOptions& options,
                                            const FingerGeometry& contacts);
std::unique_ptr<Posterior> posterior_of_two(const Part& part, LogKind kind, const BeliefOptions& options,
                                            const FingerGeometry& contacts);

/// What is left of all places: how many remain (how_many_remain), and as much of the boundary as holds 95 %, length.
struct Remaining {
  std::size_t places = 0;
  double credible_length = 0;
  double unresolved = 0;  // so much of the probability is anywhere: points did not suffice to tell
};
/// docs/belief.md has the table.
Verdict verdict_of(const Fit& fit, const Remaining& remaining, const Boundary& places);

/// The pieces of a mode, added up along one finger's boundary.
void add_density(const std::vector<MassPiece>& pieces, const Mode& mode, std::size_t finger, const Boundary& places,
                 Density& density);

/// See Belief::pose_spread. `pieces`: of the mode.
PoseSpread pose_spread_of(const Part& part, const std::vector<MassPiece>& pieces,
                          const PerFinger<MeasuredContact>& felt, const Noise& noise);

}  // namespace rollfix::belief
