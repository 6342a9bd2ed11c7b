#include "steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "answer/explanations.hpp"
#include "held_rows.hpp"
#include "rollfix/error.hpp"

// Notation:
//   trial           the problem as it would be without a mistake, and its answer; glance: by some of the rows
//   excess          square root of chi-square over what is expected of it
//   evidence        logarithm of the probability of all measurements, as noisy as they seem: answer/explanations.hpp
// Follows docs/two_fingers.md, "What may be wrong with three fingers".
// Idea: as of one finger and of two, see answer/diagnosis.cpp. Each mistake is undone, and the problem solved again,
// first at a glance. The noise is then taken as large as the residuals are, so that mistakes are compared by how well
// the rows fit, and not by the stated noise.
namespace rollfix::hold {
namespace {

// Rows and comparisons of a glance, comparisons of a trial: many mistakes are tried, each in a fraction of a search.
constexpr std::size_t kGlanceRows = 24;
constexpr std::size_t kGlanceBudget = kHoldBudget / 400;
constexpr std::size_t kTrialBudget = kHoldBudget / 10;
// At a glance what is off by more, and by much more than before, is not looked at with all rows.
constexpr double kWorthLooking = 1.6;
constexpr std::size_t kMostSecondLooks = 3;
constexpr std::size_t kMostExplanations = 4;
// Noise of logs of which none was said: shares of the perimeter, radians.
constexpr double kSupposedLength = 3e-4;
constexpr double kSupposedAngle = 2e-3;
constexpr double kMostNoisier = 32;
// Scales of lengths that are settled, the best at a glance.
constexpr std::size_t kScalesToSettle = 2;
constexpr int kSettleSteps = 3;
constexpr double kScaleDiffers = 3;  // standard deviations from 1
// Rows that a log is shifted by, in units of the glance's rows, at first with more noise, so that it shows from afar.
constexpr std::array<int, 7> kShifts = {1, 2, 3, 4, 6, 8, 12};
constexpr double kNoiseFromAfar = 2;
constexpr double kOddsAgainstLate = 4;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// How well an answer fits.
struct Seen {
  double excess = kNever;
  double evidence = -kNever;
};

/// Of an answer that is complete, has a placement and was fitted; else nothing fits: infinitely bad.
Seen seen(const std::optional<HoldAnswer>& answer) {
  if (!answer || answer->status != Status::complete || answer->placements.empty() || !answer->fit) return {};
  const double freedom = std::max(1, answer->fit->freedom);
  return {std::sqrt(answer->fit->chi_square / freedom),
          as_noisy_as_it_seems(answer->log_evidence, answer->fit->chi_square, freedom)};
}

/// The answer to a mended problem, within a trial's budget; none: it is refused, as logs that nothing can have
/// measured.
std::optional<HoldAnswer> attempt(HoldProblem problem, Care care = Care::full) {
  const std::size_t budget = care == Care::full ? kTrialBudget : kGlanceBudget;
  problem.budget = std::min(problem.budget.value_or(budget), budget);
  try {
    return solve_plain(problem, care);
  } catch (const InputError&) {  // what no logs can be explains nothing
    return std::nullopt;
  }
}

/// Small noise for a problem without; of the position where some log has x and y.
Noise supposed_noise(const HoldProblem& problem) {
  Noise noise;
  noise.contact = kSupposedLength * problem.part.perimeter();
  noise.angle = kSupposedAngle;
  const bool any = std::any_of(problem.logs.begin(), problem.logs.end(),
                               [](const Log& log) { return !log.fingers.front().x.empty(); });
  if (any) noise.position = noise.contact;
  return noise;
}

/// In the part's unit, and cut to the same instants.
HoldProblem with_noise_and_same_rows(const HoldProblem& problem) {
  HoldProblem result = problem;
  if (!result.noise) result.noise = supposed_noise(problem);
  // With noise neither tolerances nor chosen instants are taken.
  result.tolerance.reset();
  result.at.clear();
  std::vector<Log> logs = logs_of(problem);
  for (std::size_t k = 0; k < logs.size(); ++k) log_of(result, k) = std::move(logs[k]);
  return result;
}

/// With lengths so many times as long, give or take; of a wheel its radius.
std::optional<HoldProblem> with_open_lengths(const HoldProblem& problem, std::optional<std::size_t> whose,
                                             double scale) {
  std::optional<HoldProblem> open = with_lengths(problem, whose, scale);
  if (!open) return open;
  // The estimate of the lengths then says how far off the scale still is.
  const bool is_wheel = whose && *whose >= problem.logs.size();
  if (is_wheel) {
    const double radius = open->wheels[*whose - problem.logs.size()].radius;
    open->noise->radius = std::hypot(open->noise->radius, kOpenScale * radius);
  } else {
    open->noise->slip = std::hypot(open->noise->slip, kOpenScale);
  }
  return open;
}

/// A trial that is only worth it if nothing explains the rows.
struct PutOff {
  HoldDiagnosis what;
  HoldProblem mended;
  double log_odds = 0;
  double excess = 0;  // at a glance
};

class Mistakes {
 public:
  /// Looks at the problem as it is, by all rows and at a glance, to compare with.
  Mistakes(const HoldProblem& problem, const HoldAnswer& answer)
      : has_noise_(problem.noise.has_value()), problem_(with_noise_and_same_rows(problem)) {
    const std::optional<HoldAnswer> as_said = has_noise_ ? answer : attempt(problem_);
    as_said_ = seen(as_said);
    // Any place fits the logs as they are: then an explanation may leave that so.
    is_anything_ = as_said && as_said->verdict.name == Verdict::unobservable;
    glance_ = glance(problem_);
  }

  /// Tries each usual mistake in turn. Those that only seemed far better at a glance come last, and only if nothing
  /// else explains the rows.
  std::vector<HoldDiagnosis> run() {
    try_noise();
    try_prior();
    try_mirror();
    for (const auto& all : {without_column_mistakes(problem_), without_exchanged_axes(problem_),
                            without_units(problem_), without_swaps(problem_)}) {
      for (const Mended& one : all) take(one.what, one.problem, one.log_stretch);
    }
    try_lengths(std::nullopt);
    for (std::size_t k = 0; k < count_of_logs(problem_); ++k) try_lengths(k);
    try_squeezed();
    try_stray();
    for (std::size_t k = 0; k < count_of_logs(problem_); ++k) try_late(k);
    try_slip();
    if (std::none_of(trials_.begin(), trials_.end(), [](const auto& trial) { return trial.is_right; })) look_again();
    return the_likeliest(std::move(trials_), kMostExplanations);
  }

 private:
  /// How well the best place fits some of the rows: quick, and it may miss it.
  Seen glance(const HoldProblem& problem) const { return seen(attempt(thinned(problem, kGlanceRows), Care::glance)); }

  void take(HoldDiagnosis what, const HoldProblem& mended, double log_odds = 0) {
    // About as noisy as stated: all rows decide. Far better than before: kept for later.
    const double excess = glance(mended).excess;
    if (excess <= kWorthLooking) {
      add(std::move(what), mended, attempt(mended), log_odds);
    } else if (excess < kMuchBetter * glance_.excess) {
      put_off_.push_back({std::move(what), mended, log_odds, excess});
    }
  }

  /// Where nothing explains the rows: what seemed far better.
  void look_again() {
    std::stable_sort(put_off_.begin(), put_off_.end(),
                     [](const PutOff& a, const PutOff& b) { return a.excess < b.excess; });
    for (std::size_t k = 0; k < std::min(put_off_.size(), kMostSecondLooks); ++k) {
      add(put_off_[k].what, put_off_[k].mended, attempt(put_off_[k].mended), put_off_[k].log_odds);
    }
  }

  /// Counts where it explains the rows, which is returned, or explains them much better.
  bool add(HoldDiagnosis what, const HoldProblem& mended, const std::optional<HoldAnswer>& answer,
           double log_odds = 0) {
    const Seen now = seen(answer);
    if (!std::isfinite(now.excess)) return false;
    const bool is_right = !answer->is_contradicted();
    // Neither explains the rows nor comes much closer.
    if (!is_right && !(now.excess < kMuchBetter * as_said_.excess)) return false;
    // What would have any place fit explains nothing.
    if (answer->verdict.name == Verdict::unobservable && !is_anything_) return false;
    what.noise = *mended.noise;
    what.fit = *answer->fit;
    what.verdict = answer->verdict;
    what.placements = answer->placements;
    // Of a shifted log some rows are left.
    const double rows = static_cast<double>(problem_.logs.front().rows()) / static_cast<double>(answer->rows);
    // Per row, as if none were left out.
    const double evidence = now.evidence * (what.cause == HoldCause::late ? rows : 1) + log_odds;
    // Both evidences let the noise be as large as the rows have it: the mistake competes with plain noise.
    what.log_odds = evidence - as_said_.evidence;
    trials_.push_back({std::move(what), is_right, evidence});
    return is_right;
  }

  /// As noisy as they are, the rows may be nothing but that.
  void try_noise() {
    if (!has_noise_) {
      HoldDiagnosis what{HoldCause::noise};
      const std::optional<HoldAnswer> answer = attempt(problem_);
      if (add(what, problem_, answer)) {
        trials_.back().diagnosis.factor = as_said_.excess;
        trials_.back().diagnosis.noise = *noisier(problem_, as_said_.excess).noise;
        return;
      }
    }
    // Doubled until a glance fits; from there the factor follows from the excess.
    for (double factor = 2; factor <= kMostNoisier; factor *= 2) {
      const Seen now = glance(noisier(problem_, factor));
      if (!(now.excess <= 1)) continue;
      // The excess that is left, times what was tried.
      const double times = factor * now.excess;
      HoldDiagnosis what{HoldCause::noise};
      what.factor = times;
      const HoldProblem without = noisier(problem_, times);
      const std::optional<HoldAnswer> answer = attempt(without);
      add(what, without, answer, -std::log(times));
      return;
    }
  }

  /// What was known beforehand is wrong.
  void try_prior() {
    if (!problem_.prior && !problem_.pose) return;
    HoldProblem without = problem_;
    without.prior.reset();
    without.pose.reset();
    take({HoldCause::prior}, without);
  }

  /// The part lies the other way up.
  void try_mirror() {
    HoldProblem without = problem_;
    without.mirrored = !problem_.mirrored;
    take({HoldCause::mirrored}, without);
  }

  /// Scales of lengths: at a glance each of a coarse list, with a slip that leaves the scale open about it; the best
  /// are settled. `whose`: a finger's or a wheel's radius; none: all lengths.
  void try_lengths(std::optional<std::size_t> whose) {
    std::vector<std::pair<double, double>> by_evidence;
    for (const double scale : kScalesAboutOne) {
      const std::optional<HoldProblem> scaled = with_open_lengths(problem_, whose, scale);
      if (!scaled) return;
      const Seen now = glance(*scaled);
      if (now.excess <= kWorthLooking) by_evidence.emplace_back(-now.evidence, scale);
    }
    std::sort(by_evidence.begin(), by_evidence.end());
    if (by_evidence.size() > kScalesToSettle) by_evidence.resize(kScalesToSettle);
    for (const auto& [cost, scale] : by_evidence) {
      if (settle_lengths(whose, scale)) return;
    }
  }

  /// The scale by some rows, and whether with it all of them fit.
  bool settle_lengths(std::optional<std::size_t> whose, double scale) {
    double sd = 0;
    for (int step = 0; step < kSettleSteps; ++step) {
      const HoldProblem open = *with_open_lengths(problem_, whose, scale);
      const std::optional<HoldAnswer> answer = attempt(thinned(open, kGlanceRows), Care::glance);
      if (!answer || answer->placements.empty()) return false;
      double sum = 0, weights = 0;
      for (std::size_t k = 0; k < count_of_logs(problem_); ++k) {
        // One finger's estimate, or that of all fingers, each by 1 / variance.
        if (whose ? *whose != k : k >= problem_.logs.size()) continue;
        const HoldContact& contact = answer->placements.front().contacts[k];
        const double weight = 1 / std::max(1e-18, contact.length_scale_sd * contact.length_scale_sd);
        sum += weight * contact.length_scale;
        weights += weight;
      }
      const double by = sum / weights;
      scale *= by;
      sd = scale / std::sqrt(weights);
      // Settled: the last correction is small against its error.
      if (std::abs(by - 1) * scale < 0.2 * sd) break;
    }
    // As good as 1: the lengths are not the mistake.
    if (std::abs(scale - 1) < kScaleDiffers * sd) return false;
    HoldDiagnosis what{HoldCause::radius};
    what.finger = whose;
    what.factor = scale;
    what.factor_sd = sd;
    const HoldProblem mended = *with_lengths(problem_, whose, scale);
    return add(what, mended, attempt(mended));
  }

  /// The part is not squeezed.
  void try_squeezed() {
    if (!problem_.squeezed) return;
    HoldProblem without = problem_;
    without.squeezed.reset();
    take({HoldCause::squeezed}, without);
  }

  /// A few outliers. The robust answer has to find one at least, and no more than a few are believed.
  void try_stray() {
    if (problem_.robust) return;
    HoldProblem robust = problem_;
    robust.robust = true;
    const std::optional<HoldAnswer> answer = attempt(robust);
    if (!answer) return;
    // Measurements that do not count, and rows that jump away.
    const std::size_t strays = answer->strays + answer->jumps.size();
    const auto all = static_cast<double>(count_of_logs(problem_) * problem_.logs.front().rows());
    if (strays < 1 || static_cast<double>(strays) > std::max(kMostStray, kMostStrayShare * all)) return;
    HoldDiagnosis what{HoldCause::stray};
    what.strays = strays;
    add(what, robust, answer);
  }

  /// Of two logs either may be late.
  void try_late(std::size_t log) {
    if (count_of_logs(problem_) == 2 && log == 0) return;
    const auto rows = static_cast<int>(problem_.logs.front().rows());
    const int unit = std::max(1, rows / static_cast<int>(2 * kGlanceRows));
    // No shift leaves out more than half of the rows.
    const auto evidence = [&](int shift) {
      return 2 * std::abs(shift) > rows ? -kNever
                                        : glance(noisier(shifted(problem_, log, shift), kNoiseFromAfar)).evidence;
    };
    // The best shift of a coarse list, then halving strides about it.
    int best = 0;
    double most = evidence(0);
    for (const int step : kShifts) {
      for (const int shift : {step * unit, -step * unit}) {
        const double now = evidence(shift);
        if (now <= most) continue;
        most = now;
        best = shift;
      }
    }
    if (best == 0) return;
    for (int stride = std::max(1, std::abs(best) / 4); stride > 0; stride /= 2) {
      for (const int shift : {best - stride, best + stride}) {
        const double now = evidence(shift);
        if (now <= most) continue;
        most = now;
        best = shift;
      }
    }
    if (best == 0) return;
    HoldDiagnosis what{HoldCause::late};
    what.finger = log;
    what.rows = best;
    take(what, shifted(problem_, log, best), -kOddsAgainstLate);
  }

  /// Lengths that slip: a little, then much, the latter only where nothing else explains the rows.
  void try_slip() {
    for (const auto& [slip, log_odds] : kUnsaidSlips) {
      // As much was stated already.
      if (slip <= problem_.noise->slip) continue;
      if (slip == kUnsaidSlips.back().slip && is_explained(trials_)) return;
      HoldProblem slipping = problem_;
      slipping.noise->slip = slip;
      const std::optional<HoldAnswer> answer = attempt(slipping);
      if (add({HoldCause::slip}, slipping, answer, -log_odds)) return;
    }
  }

  bool has_noise_;
  HoldProblem problem_;
  Seen as_said_;
  Seen glance_;  // the same by some rows
  bool is_anything_ = false;
  std::vector<Trial<HoldDiagnosis>> trials_;
  std::vector<PutOff> put_off_;
};

}  // namespace

std::vector<HoldDiagnosis> mistakes(const HoldProblem& problem, const HoldAnswer& as_said) {
  return Mistakes(problem, as_said).run();
}

}  // namespace rollfix::hold
