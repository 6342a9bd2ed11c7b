#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "explanations.hpp"
#include "roll/noise.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation:
//   odds            log of how much likelier the rows are with a mistake than without: `Diagnosis::log_odds`
//   stretch         by how much a mistake stretches the numbers of a row, and their density with them
// Follows docs/belief.md, "What may be wrong".
// Idea: each usual mistake is mended and the rows are weighed again, by a few of them first. Those that explain the
// rows are said, the likeliest first; else those with which they fit far better: explanations.hpp.
namespace rollfix::answer {
namespace {

// A scale that differs from 1 by less, in standard deviations, explains nothing, and two that differ by less than this
// are the same.
constexpr double kOtherScale = 1;
constexpr double kSameScale = 3;
// What a few rows fit no better than this, and not much better than before, is not looked at with all of them.
constexpr double kWorthALook = 1.5;
// What a trial leaves open of the probability.
constexpr double kMostLeftOpen = 0.5;
// What would leave less than this of a roll, radians, is no explanation where of the chi-square that is to be expected
// less than this share is left as well.
constexpr double kShortRoll = 1;
constexpr double kShareOfShort = 0.5;
// Of a mistake that makes no roll shorter.
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A gyroscope of which nothing is said is off by a few hundredths; that psi is measured by one is rarer.
constexpr double kUnsaidGyro = 0.03;
constexpr double kOddsAgainstGyro = 2;
constexpr double kOddsAgainstGyroOfPsi = 6;

/// Tries each mistake once and keeps those that explain the rows. The order of trying is the order of how common
/// mistakes are.
class Diagnostician {
 public:
  Diagnostician(const Problem& problem, const Observation& observed, Belief& belief)
      : problem_(problem), observed_(observed), scales_(problem, observed), verdict_(belief.verdict()) {
    // Two fingers' rows are always joined for their number alone.
    std::optional<Belief> joined;
    if (!is_of_two()) joined = by_rows(problem, observed);
    Belief& as_said = joined ? *joined : belief;
    as_said_ = as_said.fit();
    log_evidence_ = with_noise_as_it_seems(as_said.evidence(), as_said_);
  }

  /// The explanations, the likeliest first; `correlation` or `part` if there is none.
  std::vector<Diagnosis> diagnoses() {
    try_noise();
    if (problem_.prior || problem_.pose) try_prior();
    try_column_mistakes();
    try_swapped_fingers();
    try_scale();
    if (is_of_two()) {
      for (const std::size_t finger : {0U, 1U}) try_scale(finger);
    }
    try_gyroscope();
    if (!problem_.robust) try_robust();
    try_slip();
    std::vector<Diagnosis> found = the_likeliest(std::move(trials_));
    if (found.empty()) {
      // The size of the errors is as stated, only their likeness is not: correlation.
      found.push_back(as_it_is(as_said_.sigmas <= Fit::kMostSigmas ? Cause::correlation : Cause::part));
    }
    return found;
  }

 private:
  /// Explanations differ in their noise: they are compared by the same rows, joined for their number alone. With
  /// `rows`, at a glance by so many.
  static std::optional<Belief> by_rows(const Problem& problem, const Observation& observed, std::size_t rows = 0) {
    Supposed supposed;
    if (rows > 0) supposed = {0, rows, true};
    supposed.by_rows = true;
    return believe(problem, observed, supposed);
  }

  static double with_noise_as_it_seems(const Evidence& evidence, const Fit& fit) {
    return as_noisy_as_it_seems(evidence.with(1) + evidence.gathered, fit.chi_square, fit.freedom);
  }

  /// Cause::noise: independent errors, larger than stated by the factor `excess`.
  void try_noise() {
    // More noise of the rows does not cure what the prior contradicts.
    if (as_said_.prior_sigmas > Fit::kMostSigmas) return;
    // Errors that are alike are what every other mistake looks like as well: they come last.
    if (as_said_.is_correlated()) return;
    Problem noisier = problem_;
    noisier.noise = with_rows_as_noisy(*problem_.noise, as_said_.excess);
    // Beyond that angle a belief is not computed.
    if (!(noisier.noise->angle <= BeliefOptions::kMostAngle)) return;
    // Of two fingers as the answer itself is: what wide noise leaves may be long, and it is the likeliest of all.
    std::optional<Belief> belief = is_of_two() ? believe(noisier, observed_) : by_rows(noisier, observed_);
    Diagnosis diagnosis = of(Cause::noise, belief->fit());
    diagnosis.noise_scale = as_said_.excess;
    add(std::move(diagnosis), *belief, -std::log(as_said_.excess));
  }

  /// A cause without a cure: no new verdict and no places.
  Diagnosis as_it_is(Cause cause) const {
    Diagnosis diagnosis;
    diagnosis.cause = cause;
    diagnosis.excess = as_said_.excess;
    return diagnosis;
  }

  /// Cause::prior: the rows without what was stated of the first contact or of the part's pose.
  void try_prior() {
    Problem without = problem_;
    without.prior.reset();
    without.pose.reset();
    take(Cause::prior, without);
  }

  /// Units, signs and names of columns; and a part that lies face down.
  void try_column_mistakes() {
    for (const ColumnMistake& mistake : column_mistakes(problem_.measured)) {
      // A problem of readings has lengths and turns only: `column_mistakes` lists what those can have.
      take(mistake.cause, without(mistake, problem_), mistake.log_stretch, mistake.left_of_roll);
    }
    // Of a part that lies face down the centres go as they are seen: only angles would not do.
    const bool of_contact = problem_.measured.is_log() && problem_.measured.log->kind == LogKind::contact;
    const bool has_places = problem_.noise->position > 0 || problem_.pose;
    if (of_contact && has_places) take(Cause::both_clockwise, View{true, false}.of(problem_));
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
    for (const double scale : scales_.worth_a_look(whose)) {
      std::optional<SettledScale> settled = scales_.settled(whose, scale);
      // Scales that differ from 1 by less than a standard deviation explain nothing; two valleys may settle at one
      // scale.
      if (!settled || std::abs(settled->scale - 1) < kOtherScale * settled->sd || is_tried(whose, *settled)) continue;
      Diagnosis diagnosis = of(Cause::radius, settled->belief.fit());
      diagnosis.length_scale = settled->scale;
      diagnosis.length_scale_sd = settled->sd;
      diagnosis.finger = whose;
      // The density of a row stretches with its length: of one of two fingers half of the rows' lengths.
      add(std::move(diagnosis), settled->belief, (whose ? 0.5 : 1) * std::log(settled->scale));
    }
  }
  /// Whether a trial with the same scale, to some standard deviations, was kept.
  bool is_tried(const Whose& whose, const SettledScale& settled) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const Trial<Diagnosis>& trial) {
      const Diagnosis& known = trial.diagnosis;
      return known.cause == Cause::radius && known.finger == whose &&
             std::abs(known.length_scale - settled.scale) < kSameScale * settled.sd;
    });
  }

  /// A diagnosis with the misfit that is left.
  static Diagnosis of(Cause cause, const Fit& fit) {
    Diagnosis diagnosis;
    diagnosis.cause = cause;
    diagnosis.excess = fit.excess;
    return diagnosis;
  }

  /// Cause::stray: a few rows are outliers, all others fit.
  void try_robust() {
    Problem robust = problem_;
    robust.robust = true;
    std::optional<Belief> belief = by_rows(robust, observed_);
    const Fit fit = belief->fit();
    const auto rows = static_cast<double>(belief->samples());
    // None or too many outliers.
    if (fit.stray < 1 || fit.stray > std::max(kMostStray, kMostStrayShare * rows)) return;
    Diagnosis diagnosis = of(Cause::stray, fit);
    diagnosis.stray = static_cast<std::size_t>(fit.stray);
    add(std::move(diagnosis), *belief);
  }

  /// Cause::gyroscope: turns are wrong by one factor. One finger's logs, unless as large a scale error was stated.
  void try_gyroscope() {
    const bool is_of_log = problem_.measured.is_log() && problem_.measured.log->fingers.size() == 1;
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
    const bool is_of_psi = problem_.measured.log->kind == LogKind::contact;
    add(std::move(diagnosis), *belief, 0, is_of_psi ? kOddsAgainstGyroOfPsi : kOddsAgainstGyro);
  }

  /// Cause::slip: lengths are wrong here and there. The smaller slip first; it ends with the first that explains the
  /// rows.
  void try_slip() {
    for (const auto& [slip, log_odds] : kUnsaidSlips) {
      if (slip <= problem_.noise->slip) continue;
      // See `kUnsaidSlips`: the largest takes long and explains nearly anything.
      if (slip == kUnsaidSlips.back().slip && is_explained(trials_)) return;
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
      // A few rows first: most mistakes are seen to be none by them.
      const Fit glance = by_rows(mended, observed, kRowsToCompare)->fit();
      if (!std::isfinite(glance.excess)) return;
      if (glance.is_bad() && glance.excess > std::max(kWorthALook, kMuchBetter * glance_excess())) return;
      std::optional<Belief> belief = by_rows(mended, observed);
      // Of a short roll little is left that could misfit: a fit that is too good explains nothing.
      const Fit& fit = belief->fit();
      if (left_of_roll < kShortRoll && fit.chi_square < kShareOfShort * fit.freedom) return;
      Diagnosis diagnosis = of(cause, belief->fit());
      if (problem_.measured.is_log()) diagnosis.columns = columns_without(cause, *problem_.measured.log);
      add(std::move(diagnosis), *belief, log_stretch);
    } catch (const InputError&) {  // what no log can be explains nothing
    }
  }

  /// What the rows leave as they are, by a few of them.
  /// Computed when it is first needed.
  double glance_excess() {
    if (glance_excess_ <= 0) glance_excess_ = by_rows(problem_, observed_, kRowsToCompare)->fit().excess;
    return glance_excess_;
  }

  /// Counts where it explains the rows, which is returned, or explains them much better.
  bool add(Diagnosis diagnosis, Belief& belief, double log_stretch = 0, double log_odds_against = 0) {
    const Fit& fit = belief.fit();
    // Right: the rows fit. Better: they are off by much less, and their errors are independent.
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
    // In the numbers as they were given: the density is stretched by the mistake, for each degree of freedom.
    const double log_evidence =
        with_noise_as_it_seems(belief.evidence(), fit) + fit.freedom * log_stretch - log_odds_against;
    diagnosis.log_odds = log_evidence - log_evidence_;
    trials_.push_back({std::move(diagnosis), is_right, log_evidence});
    return is_right;
  }

  bool is_of_two() const { return rows_felt(problem_, observed_).front().fingers() == 2; }

  const Problem& problem_;
  const Observation& observed_;  // of the problem as it was stated
  LengthScales scales_;
  Fit as_said_;              // of the problem as it was stated
  double log_evidence_ = 0;  // of the same, with as much noise as the rows seem to have
  Verdict verdict_;          // of the same
  std::vector<Trial<Diagnosis>> trials_;
  double glance_excess_ = 0;
};

}  // namespace

/// Nothing where the rows fit.
std::vector<Diagnosis> diagnose(const Problem& problem, const Observation& observed, Belief& belief) {
  if (!belief.fit().is_bad()) return {};
  const Doing doing("looking for what explains the misfit");
  return Diagnostician(problem, observed, belief).diagnoses();
}

}  // namespace rollfix::answer
