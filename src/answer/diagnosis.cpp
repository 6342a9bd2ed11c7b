#include "diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "column_cure.hpp"
#include "mirror.hpp"
#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"
#include "slips_of_the_pen.hpp"
#include "weighing.hpp"

namespace rollfix {
namespace {

// Scales of lengths are tried as far apart as this, each with an open scale about it of this standard deviation.
constexpr double kScaleStep = 1.08;
constexpr double kOpenScale = 0.04;
// From a thousandth of what was measured, a unit that is taken for another, to where the turn forbids it.
constexpr double kLeastScale = 0.9e-3;
constexpr double kMostScale = 1.1e3;
constexpr std::size_t kRadiiOfTwo = 9;  // the first of these
constexpr std::array<double, 17> kScalesOfTwo = {0.5,      0.79, 0.86, 0.93, 1.0,   1.08,  1.16, 1.26, 2.0,
                                                 1 / 25.4, 0.1,  10.0, 25.4, 0.001, 1000., 0.01, 100.0};
// ... with which the longest roll is between these, in perimeters: shorter ones say nothing, longer ones nobody rolls.
constexpr double kLeastRollOfTwo = 0.01;
constexpr double kMostRollOfTwo = 8;
// Beyond what Theta's own range allows, radians: noise.
constexpr double kTurnBeyond = 0.5;
constexpr double kTurnSigmas = 6;
// Rows that scales are compared by, and scales that are looked at with all rows.
constexpr std::size_t kRowsToCompare = 48;
constexpr std::size_t kScalesToCompare = 5;
// Those only that fit so many times as badly as the best one, give or take as much as there are rows.
constexpr double kCloseCost = 3;
constexpr int kMostSteps = 6;
// A step of the scale that is this much of its standard deviation is the last one.
constexpr double kSmallStep = 0.2;
// A scale that differs from 1 by less, in standard deviations, explains nothing, and two that differ by less than this
// are the same.
constexpr double kOtherScale = 1;
constexpr double kSameScale = 3;
// What a few rows fit no better than this, and not much better than before, is not looked at with all of them.
constexpr double kWorthALook = 1.5;
// An explanation with which the rows are off by this share of what they are without it is better, where none is right.
constexpr double kMuchBetter = 0.6;
// No more rows than this share, or this many, are stray.
constexpr double kMostStrayShare = 0.05;
constexpr double kMostStray = 3;
// An explanation is the likelier one where its evidence is larger, in steps of this much of a logarithm: what is about
// as likely stays in the order of how common it is.
constexpr double kEvidenceStep = 6;
// ... and what is this much less likely than the likeliest is not worth a word.
constexpr double kFarLessLikely = 12;
// What a trial leaves open of the probability.
constexpr double kMostLeftOpen = 0.5;
// Rows that are this much less noisy than said are exact.
constexpr double kLeastNoise = 1e-3;
// Slip of so much per length all along, and five times as much here and there, is what nobody says beforehand; the
// larger the rarer: the logarithm of the odds against it. The largest explains nearly anything, and takes long: it is
// tried where nothing else explains the rows.
struct RareSlip {
  double slip;
  double log_odds;
};
constexpr std::array<RareSlip, 2> kUnsaidSlips = {{{0.04, 6}, {0.2, 18}}};
// What would leave less than this of a roll, radians, is no explanation where of the chi-square that is to be expected
// less than this share is left as well.
constexpr double kShortRoll = 1;
constexpr double kShareOfShort = 0.5;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A gyroscope of which nothing is said is off by a few hundredths; that psi is measured by one is rarer.
constexpr double kUnsaidGyro = 0.03;
constexpr double kOddsAgainstGyro = 2;
constexpr double kOddsAgainstGyroOfPsi = 6;

/// A problem as it would be without a mistake, and what the rows make of it.
struct Trial {
  Diagnosis diagnosis;
  bool is_right = false;  // the rows fit
  double log_evidence = 0;
};

/// The fingers whose lengths are scaled: all, or one of two.
using Whose = std::optional<std::size_t>;

bool is_of(const Whose& whose, std::size_t finger) { return !whose || *whose == finger; }

/// Lengths this many times as long: of a disk with a radius that is.
Problem with_lengths(const Problem& problem, const Whose& whose, double scale) {
  Problem scaled = problem;
  if (whose && scaled.fingers.size() == 1) scaled.fingers.push_back(scaled.fingers.front());
  for (std::size_t k = 0; k < scaled.fingers.size(); ++k) {
    Finger& finger = scaled.fingers[k];
    if (is_of(whose, k) && finger.is_disk()) finger = disk(scale * finger.disk()->radius);
  }
  return scaled;
}

Observation with_lengths(const Observation& observed, const Whose& whose, double scale) {
  Observation scaled = observed;
  for (std::vector<Reading>* readings : {&scaled.readings, &scaled.rolls}) {
    for (Reading& reading : *readings) {
      for (std::size_t k = 0; k < reading.length.size(); ++k) {
        if (is_of(whose, k)) reading.length[k] *= scale;
      }
    }
  }
  return scaled;
}

class Diagnostician {
 public:
  Diagnostician(const Problem& problem, const Observation& observed, Belief& belief)
      : problem_(problem), observed_(observed), verdict_(belief.verdict()) {
    // Two fingers' rows are always joined for their number alone.
    std::optional<Belief> joined;
    if (!is_of_two()) joined = by_rows(problem, observed);
    Belief& as_said = joined ? *joined : belief;
    as_said_ = as_said.fit();
    log_evidence_ = with_noise_as_it_seems(as_said.evidence(), as_said_);
  }

  std::vector<Diagnosis> diagnoses() {
    try_noise();
    if (problem_.prior || problem_.pose) try_prior();
    try_slips_of_the_pen();
    try_swapped_fingers();
    try_scale();
    if (is_of_two()) {
      for (const std::size_t finger : {0U, 1U}) try_scale(finger);
    }
    try_gyroscope();
    if (!problem_.robust) try_robust();
    try_slip();
    std::stable_sort(trials_.begin(), trials_.end(), [](const Trial& a, const Trial& b) {
      return a.is_right != b.is_right ? a.is_right : steps_of(a) > steps_of(b);
    });
    std::vector<Diagnosis> found;
    for (Trial& trial : trials_) {
      const Trial& likeliest = trials_.front();
      if (trial.is_right != likeliest.is_right) break;
      if (trial.log_evidence > likeliest.log_evidence - kFarLessLikely) found.push_back(std::move(trial.diagnosis));
    }
    if (found.empty()) {
      found.push_back(as_it_is(as_said_.sigmas <= Fit::kMostSigmas ? Cause::correlation : Cause::part));
    }
    return found;
  }

 private:
  static double steps_of(const Trial& trial) { return std::round(trial.log_evidence / kEvidenceStep); }

  /// Explanations differ in their noise: they are compared by the same rows, joined for their number alone. With
  /// `rows`, at a glance by so many.
  static std::optional<Belief> by_rows(const Problem& problem, const Observation& observed, std::size_t rows = 0) {
    Supposed supposed;
    if (rows > 0) supposed = {0, rows, true};
    supposed.by_rows = true;
    return believe(problem, observed, supposed);
  }

  /// How noisy the rows are is not known better than they say themselves: what was said may be too much as well.
  static double with_noise_as_it_seems(const Evidence& evidence, const Fit& fit) {
    const double times = std::max(kLeastNoise, std::sqrt(fit.chi_square / std::max(1.0, fit.freedom)));
    const double less = 0.5 * fit.chi_square * (1 - 1 / (times * times));
    return evidence.with(1) + evidence.gathered + less - fit.freedom * std::log(times);
  }

  /// As noisy as they are, the rows may be nothing but that.
  void try_noise() {
    if (as_said_.prior_sigmas > Fit::kMostSigmas) return;
    // Errors that are alike are what every other mistake looks like as well: they come last.
    if (as_said_.is_correlated()) return;
    Problem noisier = problem_;
    noisier.noise->contact *= as_said_.excess;
    noisier.noise->angle *= as_said_.excess;
    noisier.noise->position *= as_said_.excess;
    if (!(noisier.noise->angle <= BeliefOptions::kMostAngle)) return;
    // Of two fingers as the answer itself is: what wide noise leaves may be long, and it is the likeliest of all.
    std::optional<Belief> belief = is_of_two() ? believe(noisier, observed_) : by_rows(noisier, observed_);
    Diagnosis diagnosis = of(Cause::noise, belief->fit());
    diagnosis.noise_scale = as_said_.excess;
    add(std::move(diagnosis), *belief, -std::log(as_said_.excess));
  }

  Diagnosis as_it_is(Cause cause) const {
    Diagnosis diagnosis;
    diagnosis.cause = cause;
    diagnosis.excess = as_said_.excess;
    return diagnosis;
  }

  void try_prior() {
    Problem without = problem_;
    without.prior.reset();
    without.pose.reset();
    take(Cause::prior, without);
  }

  void try_slips_of_the_pen() {
    for (const SlipOfThePen& slip : slips_of_the_pen(problem_.felt)) {
      take(slip.cause, without(slip, problem_), slip.log_stretch, slip.left_of_roll);
    }
    // Of a part that lies face down the centres go as they are seen: only angles would not do.
    const bool of_contact = problem_.felt.is_log() && problem_.felt.log->kind == LogKind::contact;
    const bool has_places = problem_.noise->position > 0 || problem_.pose;
    if (of_contact && has_places) take(Cause::both_clockwise, in_mirror(problem_));
  }

  /// Logs or radii of two fingers that were given in the wrong order.
  void try_swapped_fingers() {
    if (problem_.fingers.size() != 2) return;
    Problem swapped = problem_;
    std::swap(swapped.fingers[0], swapped.fingers[1]);
    take(Cause::fingers_swapped, swapped);
  }

  /// Lengths by one factor, of any size; or of one of two fingers.
  void try_scale(const Whose& whose = std::nullopt) {
    std::vector<std::pair<double, double>> by_cost;
    for (const double scale : scales(whose)) {
      const std::optional<Fit> fit = fit_with(whose, scale, kRowsToCompare);
      if (fit && std::isfinite(fit->chi_square)) by_cost.emplace_back(fit->chi_square, scale);
    }
    std::sort(by_cost.begin(), by_cost.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    std::vector<std::pair<double, double>> valleys;
    for (std::size_t k = 0; k < by_cost.size(); ++k) {
      const bool is_valley = (k == 0 || by_cost[k - 1].first >= by_cost[k].first) &&
                             (k + 1 == by_cost.size() || by_cost[k + 1].first >= by_cost[k].first);
      if (is_valley) valleys.push_back(by_cost[k]);
    }
    std::sort(valleys.begin(), valleys.end());
    if (valleys.size() > kScalesToCompare) valleys.resize(kScalesToCompare);
    for (const auto& [cost, scale] : valleys) {
      if (cost <= kCloseCost * (valleys.front().first + kRowsToCompare)) settle_scale(whose, scale);
    }
  }

  /// Those to try: two fingers, whose search takes long, about 1 and where units are mistaken.
  std::vector<double> scales(const Whose& whose) const {
    std::vector<double> scales;
    if (is_of_two()) {
      // One finger's unit is the other's as well.
      const auto end = whose ? kScalesOfTwo.begin() + kRadiiOfTwo : kScalesOfTwo.end();
      std::copy_if(kScalesOfTwo.begin(), end, std::back_inserter(scales),
                   [&](double scale) { return may_be_of_two(scale); });
      return scales;
    }
    for (double scale = kLeastScale; scale < kMostScale; scale *= kScaleStep) {
      if (may_be(scale)) scales.push_back(scale);
    }
    return scales;
  }

  bool may_be_of_two(double scale) const {
    double longest = 0;
    for (const Reading& row : observed_rows()) {
      for (const double length : row.length) longest = std::max(longest, std::abs(length));
    }
    const double laps = scale * longest / problem_.part.perimeter();
    return laps >= kLeastRollOfTwo && laps <= kMostRollOfTwo;
  }

  /// Theta's own range and the turn that was felt confine what a length can be.
  bool may_be(double scale) const {
    const TurningFunction& turning = problem_.part.turning();
    const double P = problem_.part.perimeter();
    if (turn_beyond_ < 0) {
      double lo = 0;
      double hi = 0;
      const double per_length = turning.period_turn() / P;
      for (const Spiral& spiral : turning.spirals()) {
        for (const double off :
             {spiral.start.angle - per_length * spiral.lo, spiral.end.angle - per_length * spiral.hi}) {
          lo = std::min(lo, off);
          hi = std::max(hi, off);
        }
      }
      turn_beyond_ = 2 * (hi - lo) + kTurnBeyond + kTurnSigmas * problem_.noise->angle;
    }
    if (!problem_.part.closed()) {
      return std::all_of(observed_rows().begin(), observed_rows().end(),
                         [&](const Reading& row) { return std::abs(row.length[0]) * scale <= 1.1 * P; });
    }
    return std::all_of(observed_rows().begin(), observed_rows().end(), [&](const Reading& row) {
      return std::abs(row.turn - turning.period_turn() * row.length[0] * scale / P) <= turn_beyond_;
    });
  }

  void settle_scale(const Whose& whose, double scale) {
    std::optional<Belief> belief;
    Fit fit;
    for (int step = 0; step < kMostSteps; ++step) {
      belief = belief_with(whose, scale, observed_rows().size());
      if (!belief) return;
      fit = belief->fit();
      const double by = whose ? fit.length_scale[*whose] : common_scale(fit.length_scale);
      const double sd = std::max(fit.length_scale_sd[whose.value_or(0)], 1e-12);
      scale *= by;
      // What is far off everywhere asks for any scale.
      if (!(scale >= kLeastScale / kScaleStep && scale <= kMostScale * kScaleStep)) return;
      if (std::abs(by - 1) < kSmallStep * sd) break;
    }
    const double sd = scale * fit.length_scale_sd[whose.value_or(0)];
    if (std::abs(scale - 1) < kOtherScale * sd) return;
    for (const Trial& trial : trials_) {
      const Diagnosis& known = trial.diagnosis;
      if (known.cause == Cause::radius && known.finger == whose &&
          std::abs(known.length_scale - scale) < kSameScale * sd)
        return;
    }
    Diagnosis diagnosis = of(Cause::radius, fit);
    diagnosis.length_scale = scale;
    diagnosis.length_scale_sd = sd;
    diagnosis.finger = whose;
    add(std::move(diagnosis), *belief, (whose ? 0.5 : 1) * std::log(scale));
  }

  static Diagnosis of(Cause cause, const Fit& fit) {
    Diagnosis diagnosis;
    diagnosis.cause = cause;
    diagnosis.excess = fit.excess;
    return diagnosis;
  }

  static double common_scale(const PerFinger<double>& scale) {
    if (scale.size() == 1) return scale[0];
    return std::sqrt(scale[0] * scale[1]);
  }

  void try_robust() {
    Problem robust = problem_;
    robust.robust = true;
    std::optional<Belief> belief = by_rows(robust, observed_);
    const Fit fit = belief->fit();
    const auto rows = static_cast<double>(belief->samples());
    if (fit.stray < 1 || fit.stray > std::max(kMostStray, kMostStrayShare * rows)) return;
    Diagnosis diagnosis = of(Cause::stray, fit);
    diagnosis.stray = static_cast<std::size_t>(fit.stray);
    add(std::move(diagnosis), *belief);
  }

  void try_gyroscope() {
    const bool is_of_log = problem_.felt.is_log() && problem_.felt.log->fingers.size() == 1;
    if (!is_of_log || problem_.noise->gyro >= kUnsaidGyro) return;
    Problem scaled = problem_;
    scaled.noise->gyro = kUnsaidGyro;
    std::optional<Belief> belief = by_rows(scaled, observed_);
    const Fit fit = belief->fit();
    if (std::abs(fit.turn_scale - 1) < kOtherScale * fit.turn_scale_sd) return;
    Diagnosis diagnosis = of(Cause::gyroscope, fit);
    diagnosis.gyro = kUnsaidGyro;
    diagnosis.turn_scale = fit.turn_scale;
    diagnosis.turn_scale_sd = fit.turn_scale_sd;
    const bool is_of_psi = problem_.felt.log->kind == LogKind::contact;
    add(std::move(diagnosis), *belief, 0, is_of_psi ? kOddsAgainstGyroOfPsi : kOddsAgainstGyro);
  }

  /// By more than that the rows are noisier.
  bool is_explained() const {
    return std::any_of(trials_.begin(), trials_.end(),
                       [](const Trial& trial) { return trial.is_right && trial.diagnosis.cause != Cause::noise; });
  }

  void try_slip() {
    for (const auto& [slip, log_odds] : kUnsaidSlips) {
      if (slip <= problem_.noise->slip) continue;
      if (slip == kUnsaidSlips.back().slip && is_explained()) return;
      Problem slipping = problem_;
      slipping.noise->slip = slip;
      std::optional<Belief> belief = by_rows(slipping, observed_);
      Diagnosis diagnosis = of(Cause::slip, belief->fit());
      diagnosis.slip = slip;
      if (add(std::move(diagnosis), *belief, 0, log_odds)) return;
    }
  }

  /// `log_stretch`: by how much each row's numbers are stretched, their density with them. `left_of_roll`: of a mistake
  /// without which the roll is shorter.
  void take(Cause cause, const Problem& mended, double log_stretch = 0, double left_of_roll = kInfinity) {
    try {
      const Observation observed = observe(mended);
      const Fit glance = by_rows(mended, observed, kRowsToCompare)->fit();
      if (!std::isfinite(glance.excess)) return;
      if (glance.is_bad() && glance.excess > std::max(kWorthALook, kMuchBetter * glance_excess())) return;
      std::optional<Belief> belief = by_rows(mended, observed);
      // Of a short roll next to nothing is left that could misfit.
      const Fit& fit = belief->fit();
      if (left_of_roll < kShortRoll && fit.chi_square < kShareOfShort * fit.freedom) return;
      Diagnosis diagnosis = of(cause, belief->fit());
      if (problem_.felt.is_log()) diagnosis.columns = columns_without(cause, *problem_.felt.log);
      add(std::move(diagnosis), *belief, log_stretch);
    } catch (const InputError&) {  // what no log can be explains nothing
    }
  }

  /// What the rows leave as they are, by a few of them.
  double glance_excess() {
    if (glance_excess_ <= 0) glance_excess_ = by_rows(problem_, observed_, kRowsToCompare)->fit().excess;
    return glance_excess_;
  }

  /// Counts where it explains the rows, which is returned, or explains them much better.
  bool add(Diagnosis diagnosis, Belief& belief, double log_stretch = 0, double log_odds_against = 0) {
    const Fit& fit = belief.fit();
    const bool is_right = !fit.is_bad();
    const bool is_better = !fit.is_correlated() && fit.excess < kMuchBetter * as_said_.excess;
    if (!is_right && !is_better) return false;
    diagnosis.verdict = belief.verdict();
    diagnosis.modes = modes_of(belief);
    // What would have any place fit explains nothing, unless they all look alike; nor does what leaves so many that no
    // trial has the time for them.
    const bool is_empty = verdict_.name != Verdict::unobservable &&
                          (diagnosis.verdict.name == Verdict::unobservable || belief.rest() > kMostLeftOpen);
    if (diagnosis.modes.empty() || is_empty) return false;
    const double log_evidence =
        with_noise_as_it_seems(belief.evidence(), fit) + fit.freedom * log_stretch - log_odds_against;
    diagnosis.log_odds = log_evidence - log_evidence_;
    trials_.push_back({std::move(diagnosis), is_right, log_evidence});
    return is_right;
  }

  bool is_of_two() const { return observed_rows().front().fingers() == 2; }
  const std::vector<Reading>& observed_rows() const {
    return problem_.felt.is_log() ? observed_.rolls : observed_.readings;
  }

  std::optional<Belief> belief_with(const Whose& whose, double scale, std::size_t rows) const {
    try {
      return believe(with_lengths(problem_, whose, scale), with_lengths(observed_, whose, scale),
                     {kOpenScale, rows, true, {}, true, {}, whose});
    } catch (const InputError&) {
      return std::nullopt;
    }
  }
  std::optional<Fit> fit_with(const Whose& whose, double scale, std::size_t rows) const {
    std::optional<Belief> belief = belief_with(whose, scale, rows);
    return belief ? std::optional<Fit>(belief->fit()) : std::nullopt;
  }

  const Problem& problem_;
  const Observation& observed_;
  Fit as_said_;
  double log_evidence_ = 0;  // with it, and with as much noise as the rows seem to have
  Verdict verdict_;          // with it
  std::vector<Trial> trials_;
  double glance_excess_ = 0;
  mutable double turn_beyond_ = -1;
};

}  // namespace

std::vector<Diagnosis> diagnose(const Problem& problem, const Observation& observed, Belief& belief) {
  if (!belief.fit().is_bad()) return {};
  const Doing doing("looking for what explains the misfit");
  return Diagnostician(problem, observed, belief).diagnoses();
}

}  // namespace rollfix
