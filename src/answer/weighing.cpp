#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "log/jitter.hpp"
#include "work/pulse.hpp"

// Notation:
//   mode            a place of the posterior, with its probability; `rest`: what all modes leave out
//   trust           1 / (1 + e^odds): how far the rows are believed where something else explains them as well
//   evidence        log of the integral of the likelihood over all places, peak and volume: `Evidence`
// Follows docs/belief.md, "What the verdict says", "What may be wrong", and of centres "Centres as evidence".
// Idea: what the samples leave takes the place of what the search found. Centres that are not stated as evidence still
// must not contradict the answer: they are weighed as if they were known badly.
namespace rollfix::answer {
namespace {

// A posterior of two fingers is complete when it leaves out no more than this.
constexpr double kMostRest = 0.01;
// Centres that nothing was said of are taken to be off by so many times a contact's noise, or what they jitter by, or
// this share of the perimeter, and a few rows are looked at first.
constexpr double kBadCentre = 5;
constexpr double kLeastCentre = 2e-4;
constexpr std::size_t kRowsOfGlance = 96;
// What was said of a log is not held to be less likely than exp(-this).
constexpr double kMostDoubt = 30;
// Where fingers can have none of the places, what is left is taken as this: its logarithm is finite.
constexpr double kNoProbability = 1e-300;

/// What a finger measured at its first contact, where the log has it.
std::optional<MeasuredContact> first_felt(const Problem& problem, std::size_t which) {
  if (problem.fingers.empty() || !problem.measured.is_log()) return std::nullopt;
  const FingerRows& rows = problem.measured.log->fingers[which];
  if (problem.measured.log->kind != LogKind::contact || rows.x.empty()) return std::nullopt;
  const Finger& finger = *finger_of(problem.fingers, which);
  const Contact first{rows.u.front(), rows.psi.front()};
  const Vec2 where = Vec2(rows.x.front(), rows.y.front()) - centre_of(finger, Vec2::Zero(), first);
  return MeasuredContact{where, normal_direction(finger, first), finger.curvature(first.u)};
}

/// The part's pose with its covariance for each placement, from the centres at the first contact. Nothing where some
/// finger's log has none.
void add_pose_spreads(const Problem& problem, Belief& belief, std::vector<Placement>& placements) {
  if (placements.empty()) return;
  PerFinger<MeasuredContact> felt = PerFinger<MeasuredContact>::of(placements.front().start.size());
  for (std::size_t which = 0; which < felt.size(); ++which) {
    const std::optional<MeasuredContact> first = first_felt(problem, which);
    if (!first) return;
    felt[which] = *first;
  }
  for (std::size_t k = 0; k < placements.size(); ++k) placements[k].pose_spread = belief.pose_spread(k, felt);
}

/// How far the stated problem is believed, 1 / (1 + e^odds); 1 where nothing else explains the rows. More noise and
/// correlation do not move the places, and so cast no doubt. Correlated rows are worth fewer independent ones: the odds
/// are divided by (widened / excess)^2.
double trust(const Answer& answer) {
  if (answer.diagnoses.empty()) return 1;
  const Fit& fit = answer.weighing->fit;
  const Diagnosis& likeliest = answer.diagnoses.front();
  if (likeliest.cause == Cause::noise || likeliest.cause == Cause::correlation) return 1;
  const double alike = fit.widened * fit.widened / (fit.excess * fit.excess);
  return 1 / (1 + std::exp(std::clamp(likeliest.log_odds / alike, 0.0, kMostDoubt)));
}

/// The probability of a placement if that diagnosis holds: of its modes whose intervals meet the placement's, for each
/// finger.
double probability_if(const Diagnosis& diagnosis, const Placement& placement, const Boundary& places) {
  double sum = 0;
  for (const Mode& mode : diagnosis.modes) {
    bool is_same = true;
    for (std::size_t which = 0; which < mode.interval.size(); ++which) {
      is_same = is_same && places.intersects(mode.interval[which], placement.interval[which]);
    }
    if (is_same) sum += mode.probability;
  }
  return sum;
}

/// Centres that are not said to be evidence still must not contradict the answer: they are held against it as if they
/// were known badly. What is wrong if they do; nothing else: that they are as noisy as they are is no fault of the
/// rows. One finger's.
std::vector<Diagnosis> diagnoses_by_centres(const Problem& problem, const Observation& observed) {
  const bool has_centres = problem.measured.is_log() && observed.contacts && !problem.fingers.empty() &&
                           problem.measured.log->fingers.size() == 1 && !problem.measured.log->fingers[0].x.empty();
  // With position noise stated the centres were weighed already.
  if (!has_centres || problem.noise->position > 0 || problem.robust) return {};
  Problem looked_at = problem;
  looked_at.noise->position = kBadCentre * std::max({problem.noise->contact, kLeastCentre * problem.part.perimeter(),
                                                     jitter_of_centres(*problem.measured.log)});
  // A few rows first: centres that fit are the rule.
  if (!believe(looked_at, observed, {0, kRowsOfGlance})->fit().is_bad()) return {};
  std::optional<Belief> belief = believe(looked_at, observed);
  std::vector<Diagnosis> found = diagnose(looked_at, observed, *belief);
  const bool is_noise =
      !found.empty() && (found.front().cause == Cause::noise || found.front().cause == Cause::correlation);
  return is_noise ? std::vector<Diagnosis>{} : found;
}

}  // namespace

/// Copies of the belief's modes, the most probable first.
std::vector<Mode> modes_of(Belief& belief) {
  std::vector<Mode> modes = belief.modes();
  for (Mode& mode : modes) mode.probability = std::min(1.0, mode.probability);
  return modes;
}

namespace {

/// Sums and quotients of probabilities may come out beyond 1 by rounding.
void keep_probabilities(std::vector<Placement>& placements, Weighing& weighing) {
  for (Placement& placement : placements) placement.probability = std::min(1.0, placement.probability);
  for (Placement& placement : weighing.improbable) placement.probability = std::min(1.0, placement.probability);
  weighing.rest = std::clamp(weighing.rest, 0.0, 1.0);
}

}  // namespace

/// Copies what the belief says into the answer's fields. `searched`: placements of the search, which give each mode its
/// kind.
RowsWeighed weigh(const Problem& problem, const Observation& observed, bool explains, const Answer& searched,
                  Belief& belief) {
  const Doing doing("weighing all rows");
  RowsWeighed rows;
  Weighing& weighing = rows.weighing;
  weighing.noise = *problem.noise;
  weighing.prior = problem.prior;
  weighing.pose = problem.pose;
  weighing.robust = problem.robust;
  weighing.samples = belief.samples();
  weighing.rest = belief.rest();
  weighing.fit = belief.fit();
  weighing.evidence = belief.evidence();
  if (explains) rows.diagnoses = diagnose(problem, observed, belief);
  weighing.density = belief.density();
  if (explains && rows.diagnoses.empty()) {
    rows.diagnoses = diagnoses_by_centres(problem, observed);
    rows.centres_contradict = !rows.diagnoses.empty();
  }
  const Verdict::Name verdict = belief.verdict().name;
  Weighed weighed = rollfix::weigh(searched.part, searched.readings, searched.facing, searched.placements, belief);
  weighing.improbable = std::move(weighed.improbable);
  add_pose_spreads(problem, belief, weighed.placements);
  // Nothing explains the rows: no place is listed, all are kept as improbable.
  if (verdict == Verdict::inconsistent) {
    for (Placement& placement : weighed.placements) weighing.improbable.push_back(std::move(placement));
    weighed.placements.clear();
  }
  rows.placements = std::move(weighed.placements);
  rows.status = searched.status;
  if (searched.finger_count() == 2) {  // what is listed is the posterior's: the search only says what kinds they are
    rows.status = weighing.rest <= kMostRest ? Status::complete : Status::incomplete;
  } else if (verdict == Verdict::undecided) {
    rows.status = Status::incomplete;
  }
  keep_probabilities(rows.placements, weighing);
  return rows;
}

/// Probabilities are divided by what is left, and the evidence loses the share that was dropped.
void conclude(Belief& belief, Answer& answer, bool is_reweighed, bool fits_badly) {
  if (!answer.impossible.empty() || is_reweighed) {
    double total = 0;
    for (const Placement& placement : answer.placements) total += placement.probability;
    for (Placement& placement : answer.placements) placement.probability /= total;
    const double left = std::max(total, kNoProbability);
    answer.weighing->rest = std::min(1.0, answer.weighing->rest / left);
    answer.weighing->evidence.volume += std::log(left);
    answer.verdict = belief.verdict_on(answer.placements);
  } else {
    answer.verdict = belief.verdict();
  }
  answer.verdict.fits_badly |= fits_badly;
  const double as_said = trust(answer);
  // Nothing else explains the rows.
  if (as_said == 1) return keep_probabilities(answer.placements, *answer.weighing);
  double listed = 0;
  for (Placement& placement : answer.placements) {
    // Mixed over two hypotheses: as stated, and with the likeliest mistake.
    placement.probability *= as_said;
    placement.probability +=
        (1 - as_said) * probability_if(answer.diagnoses.front(), placement, answer.part.boundary());
    listed += placement.probability;
  }
  answer.weighing->rest = std::max(0.0, 1 - listed);
  keep_probabilities(answer.placements, *answer.weighing);
}

}  // namespace rollfix::answer
