#include "rollfix/belief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/posterior.hpp"
#include "locate/remaining.hpp"
#include "part/part_data.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"

// The facade: which posterior, and the verdict on what it settles at.
// Notation:
//   peak            log L at the likeliest place, with the prior or by the rows alone: `evidence.peak`
//   cost            2 (peak by the rows alone - peak with the prior), a chi-square of as many degrees as the prior has
//   widened         by how much the rows are noisier than said; it divides costs as its square
//   places             how many remain: Remaining
//   credible_length    the boundary that 95 % need
// Follows docs/belief.md, "What the verdict says" and "When the rows fit badly".
namespace rollfix {

namespace {

using namespace belief;

// Even the only place is not known where it holds more than this share of the boundary.
constexpr double kWide = 0.1;
// Where no place is more probable than another, 95 % need 95 % of the boundary: it can be anywhere where they need this
// share of that.
constexpr double kAnywhere = 0.9;

/// Throws InputError: noise, a prior or a facing with which nothing can be computed.
void require_valid(const Part& part, const BeliefOptions& options, const FingerGeometry& contacts) {
  belief::require_weighable(options.noise);
  if (options.prior &&
      !(std::isfinite(options.prior->s) && std::isfinite(options.prior->sd) && options.prior->sd > 0)) {
    throw InputError(fmt::format("prior: expected a place and a standard deviation above 0, found {} and {}",
                                 options.prior->s, options.prior->sd));
  }
  if (options.prior) require_not_lost(part, options.prior->sd, "a prior with a standard deviation", "");
  if (contacts.facing && !std::isfinite(*contacts.facing)) {
    throw InputError(fmt::format("expected a finite facing angle, found {}", *contacts.facing));
  }
}

/// The number if it is one that people write, with up to four digits; else another.
std::string short_number(double value, const char* other) {
  const std::string text = fmt::format("{:.4g}", value);
  return parse_number(text) == value ? text : other;
}

}  // namespace

void belief::require_weighable(const Noise& noise) {
  rollfix::require_valid(noise);
  if (noise.contact <= 0 && noise.angle <= 0) {
    throw InputError(
        "noise: expected a standard deviation of the contact or of the angle above 0, found neither; give one "
        "of them as well");
  }
  if (noise.angle > BeliefOptions::kMostAngle) {
    throw InputError(fmt::format(
        "noise: an angle's standard deviation of {} rad is {:.3g} deg, expected at most {} rad: beyond that a "
        "row says nothing; a number without a unit is in radians, degrees are written as in {}deg",
        noise.angle, noise.angle * 180 / std::numbers::pi, BeliefOptions::kMostAngle, short_number(noise.angle, "2")));
  }
}

/// Belief's own: one posterior with what is known beforehand and, to test that, one by the rows alone.
struct Belief::State {
  /// Takes the samples since the last time; nothing to do where there are none.
  void settle();
  /// How well the rows fit, without modes where the posterior can tell that alone.
  const Fit& fit();
  /// Tests the prior: it can only sharpen what the rows allow. Sets Fit::prior_sigmas.
  void hold_against_rows_alone();
  /// `places`: modes or placements, the most probable first.
  template <class Place>
  Verdict verdict_on(const std::vector<Place>& places);

  Part part;
  BeliefOptions options;
  FingerGeometry contacts;
  std::unique_ptr<Posterior> posterior;
  std::unique_ptr<Posterior> of_rows_alone;  // without the prior; none where there is none
  std::size_t settled_at;                    // after so many samples; none: the largest
  Outcome outcome;
};

void Belief::State::settle() {
  if (posterior->samples() == settled_at) return;
  outcome = posterior->settle();
  settled_at = posterior->samples();
  hold_against_rows_alone();
}

// Of two fingers the fit is known long before the modes are. With a prior it needs both posteriors: settle().
const Fit& Belief::State::fit() {
  const bool is_settled = posterior->samples() == settled_at;
  if (!is_settled && !of_rows_alone) {
    if (std::optional<Fit> alone = posterior->fit_alone()) return outcome.fit = *alone;
  }
  settle();
  return outcome.fit;
}

// The best cost with the prior less the best one without is a chi-square, of as many degrees as the prior has. It is no
// less than the square of how far the place is from the prior: rows that allow that place, but another one far better,
// make it larger.
void Belief::State::hold_against_rows_alone() {
  if (!of_rows_alone || !posterior->has_begun()) return;
  const Outcome alone = of_rows_alone->settle();
  const double more = 2 * (alone.evidence.peak - outcome.evidence.peak);
  // Nothing fits at all, with or without the prior.
  if (!std::isfinite(more)) return;
  // What is noisier than said, or alike, says less.
  const double of_prior = square(outcome.fit.prior_sigmas);
  const double cost = of_prior + std::max(0.0, more - of_prior) / square(alone.fit.widened);
  // A prior of s and a heading have one degree each, a whole pose has three.
  const double degrees = (options.prior ? 1 : 0) + (options.pose ? std::isfinite(options.pose->place_sd) ? 3 : 1 : 0);
  outcome.fit.prior_sigmas = degrees > 1 ? normal_deviate(cost, degrees) : std::sqrt(cost);
}

namespace {

/// The verdict of rows that fit: docs/belief.md has the table. A closed boundary of which 95 % need nearly all is
/// `unobservable`; one place that is wide is `ambiguous`, one stretch.
Verdict verdict_of_places(const Remaining& remaining, const Boundary& places) {
  const double length = remaining.credible_length;
  if (places.closed && length > kAnywhere * kSureProbability * places.perimeter) return {Verdict::unobservable};
  if (remaining.places > 1) return {Verdict::ambiguous, remaining.places};
  return length > kWide * places.perimeter ? Verdict{Verdict::ambiguous, 1, 1} : Verdict{Verdict::unique, 1};
}

}  // namespace

Verdict belief::verdict_of(const Fit& fit, const Remaining& remaining, const Boundary& places) {
  // The best that was seen need not be near the best there is.
  if (remaining.unresolved > 1 - kSureProbability) return {Verdict::undecided};
  // Nothing is listed, or all that is listed is off by more than kMostExcess times the noise.
  if (remaining.places == 0 || fit.excess > kMostExcess) return {Verdict::inconsistent};
  Verdict verdict = verdict_of_places(remaining, places);
  verdict.fits_badly = fit.is_bad();
  return verdict;
}

template <class Place>
Verdict Belief::State::verdict_on(const std::vector<Place>& places) {
  settle();
  // No row yet: every place is as good as any other.
  if (!posterior->has_begun()) return {Verdict::unobservable};
  Remaining remaining;
  remaining.places = how_many_remain(places, &Place::probability);
  if (!places.empty()) {
    // Only places that count: improbable ones do not widen the answer.
    const double least = least_that_counts(places, &Place::probability);
    std::vector<PerFinger<Interval>> that_count;
    for (const Place& each : places) {
      if (each.probability >= least) that_count.push_back(each.interval);
    }
    remaining.credible_length = posterior->credible_length(that_count);
  }
  remaining.unresolved = outcome.unresolved;
  return verdict_of(outcome.fit, remaining, part.boundary());
}

Belief::Belief(const Part& part, LogKind kind, const BeliefOptions& options, const FingerGeometry& contacts) {
  require_valid(part, options, contacts);
  // A taught part adds its own accuracy to the noise.
  BeliefOptions on_part = options;
  on_part.noise = noise_on(part, options.noise);
  const auto posterior = [&](const BeliefOptions& with) {
    const bool is_one = contacts.finger_curvature.size() == 1;
    return is_one ? posterior_of_one(part, kind, with, contacts) : posterior_of_two(part, kind, with, contacts);
  };
  state_ = std::make_unique<State>(
      State{part, on_part, contacts, posterior(on_part), nullptr, std::numeric_limits<std::size_t>::max(), Outcome{}});
  // Without a prior there is nothing to test; a glance leaves it untested.
  if ((!options.prior && !options.pose) || options.glance) return;
  on_part.prior.reset();
  on_part.pose.reset();
  state_->of_rows_alone = posterior(on_part);
}
Belief::~Belief() = default;
Belief::Belief(Belief&&) noexcept = default;
Belief& Belief::operator=(Belief&&) noexcept = default;

void Belief::add(const Sample& sample) {
  const std::size_t fingers = state_->contacts.finger_curvature.size();
  if (sample.reading.fingers() != fingers) {
    throw InputError(fmt::format("expected a sample of {}, found one of {}",
                                 fingers == 1 ? "one finger" : "two fingers", fingers == 1 ? "two" : "one"));
  }
  state_->posterior->add(sample);
  if (state_->of_rows_alone) state_->of_rows_alone->add(sample);
}

void Belief::add(const Reading& reading) {
  Sample sample;
  sample.reading = reading;
  sample.finger_curvature = state_->contacts.finger_curvature;
  add(sample);
}

std::size_t Belief::samples() const { return state_->posterior->samples(); }

const std::vector<Mode>& Belief::modes() {
  state_->settle();
  return state_->outcome.modes;
}

double Belief::rest() {
  state_->settle();
  double listed = 0;
  // What is not listed, and what was not looked at closely.
  for (const Mode& mode : state_->outcome.modes) listed += mode.probability;
  return std::min(1.0, std::max(0.0, 1 - listed) + state_->outcome.unresolved);
}

PerFinger<Density> Belief::density() {
  state_->settle();
  return state_->posterior->density(state_->outcome.modes);
}

double Belief::excess() { return fit().excess; }

const Fit& Belief::fit() { return state_->fit(); }

const Evidence& Belief::evidence() {
  state_->settle();
  return state_->outcome.evidence;
}

bool Belief::is_hopeless(const Rival& rival) { return state_->posterior->is_hopeless(rival); }

double Belief::tolerance(const std::vector<Reading>& readings) {
  state_->settle();
  // Nothing is known: any turn is possible.
  if (!state_->posterior->has_begun()) return std::numbers::pi;
  const double variance = state_->posterior->variance_of_miss(readings, state_->outcome.modes);
  // With noise as it seems to be, up to where nothing fits any more.
  return kFarthest * std::min(fit().widened, kMostExcess) * std::sqrt(variance);
}

Verdict Belief::verdict() { return verdict_on(modes()); }

Verdict Belief::verdict_on(const std::vector<Mode>& modes) { return state_->verdict_on(modes); }

Verdict Belief::verdict_on(const std::vector<Placement>& placements) { return state_->verdict_on(placements); }

PoseSpread Belief::pose_spread(std::size_t mode, const PerFinger<MeasuredContact>& measured) {
  const std::vector<MassPiece> pieces = state_->posterior->pieces(mode, modes()[mode]);
  return pose_spread_of(state_->part, pieces, measured, state_->options.noise);
}

std::vector<PosePiece> Belief::pose_pieces() {
  state_->settle();
  if (!state_->posterior->has_begun()) return {};
  std::vector<PosePiece> pieces = state_->posterior->pose_pieces();
  for (PosePiece& piece : pieces) {
    for (PosePiece::End* end : {&piece.lo, &piece.hi}) end->pose.covariance *= square(fit().widened);
  }
  return pieces;
}

}  // namespace rollfix
