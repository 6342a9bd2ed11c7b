#include "rollfix/belief/pair_belief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/error_model.hpp"
#include "belief/felt_turning.hpp"
#include "belief/pair_candidates.hpp"
#include "belief/pair_filter.hpp"
#include "belief/pair_lattice.hpp"
#include "belief/pair_modes.hpp"
#include "belief/pair_starts.hpp"
#include "belief/policy.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

using namespace belief;

// The tangent where a contact is felt is known to this share of the angles' noise.
constexpr double kShareOfAngle = 1e-3;
// Where errors of kFarthest leave nothing good, larger ones are let pass, up to this many standard deviations.
constexpr double kFarthestOfAll = 40;
constexpr double kWider = 3;
// Squares of the search are as long as so many standard deviations of a contact's place.
constexpr double kSquareSigmas = 3;
constexpr double kLargestSquareShare = 1.0 / 128;

}  // namespace

struct PairBelief::State {
  State(const Part& the_part, LogKind the_kind, const BeliefOptions& the_options, const PairContacts& the_contacts);

  using PairShared = belief::PairShared;
  using PairModes = belief::PairModes;

  /// Everything that the samples' errors decide, and what comes out.
  struct Outcome {
    double excess = 1;
    PairModes found;
    double rest = 1;
    PairShared errors = PairShared::Zero();  // at the best start
  };

  Outcome weigh(const belief::PairErrors& with_errors, bool integrate) const;
  Diagnosis explain(Cause cause) const;
  belief::PairErrors errors_supposing(Cause cause) const;
  void settle();
  double corner_length(std::size_t finger) const;
  double tilt(std::size_t finger) const;

  Part part;
  LogKind kind;
  BeliefOptions options;
  PairContacts contacts;
  belief::PairErrors errors;
  std::array<std::optional<belief::TiltedBoundary>, 2> boundary;
  belief::TurningRange range;
  std::vector<PairReading> rows;
  std::size_t settled_at = static_cast<std::size_t>(-1);
  Outcome outcome;
};

PairBelief::State::State(const Part& the_part, LogKind the_kind, const BeliefOptions& the_options,
                         const PairContacts& the_contacts)
    : part(the_part),
      kind(the_kind),
      options(the_options),
      contacts(the_contacts),
      errors(errors_supposing(Cause::none)),
      range(the_part.turning()) {
  const double P = part.perimeter();
  for (const std::size_t finger : {0U, 1U}) {
    const double accuracy = std::max(kShareOfPerimeter * P, kShareOfNoise * errors.contact_sd());
    boundary[finger].emplace(part, tilt(finger), std::min(accuracy, 1e-4 * P));
  }
}

/// A disk's curvature; else what makes lengths and angles, as uncertain as they are, count alike.
double PairBelief::State::tilt(std::size_t finger) const {
  const double P = part.perimeter();
  if (contacts.finger_curvature[finger] > 0) return contacts.finger_curvature[finger];
  const double even = std::sqrt(0.5 * errors.turn_variance() / errors.contact_variance());
  return std::min(std::max(even, 8 * std::numbers::pi / P), 1e6 / P);
}

// As for one finger: about a corner a finger's centre goes along an arc of its radius.
double PairBelief::State::corner_length(std::size_t finger) const {
  const double curvature = contacts.finger_curvature[finger];
  return curvature > 0 ? 1 / curvature : part.perimeter() / (2 * std::numbers::pi);
}

PairBelief::State::Outcome PairBelief::State::weigh(const belief::PairErrors& with_errors, bool integrate) const {
  const double P = part.perimeter();
  const std::optional<double> facing = contacts.facing;
  const std::vector<belief::PairNode> nodes = belief::pair_nodes(rows, facing, with_errors.absolute(), options.robust);
  const double accuracy = kShareOfAngle * std::sqrt(with_errors.turn_variance());
  std::array<std::optional<belief::FeltTurning>, 2> felt;
  const bool alike = contacts.finger_curvature[0] == contacts.finger_curvature[1];
  for (const std::size_t finger : {0U, 1U}) {
    if (finger == 1 && alike) break;
    felt[finger].emplace(part.turning(), with_errors.contact_sd(), corner_length(finger),
                         with_errors.normal_turn(finger), accuracy);
  }
  belief::PairModel model;
  model.errors = &with_errors;
  model.boundary = {&*boundary[0], &*boundary[1]};
  model.felt = {&*felt[0], alike ? &*felt[0] : &*felt[1]};
  model.outliers.share = options.robust ? kOutlierShare : 0;
  model.prior = options.prior;
  model.closed = part.closed();

  Outcome result;
  const auto freedom = static_cast<double>(nodes.size());
  const double resolution = std::clamp(kSquareSigmas * with_errors.contact_sd(), 0.0, kLargestSquareShare * P);
  std::vector<belief::PairPeak> peaks;
  double sigmas = kFarthest;
  double missed = 1;
  // Where the noise is larger than said, what it allows is wider.
  while (true) {
    const belief::PairCandidates candidates = pair_candidates(model, range, nodes, sigmas, resolution);
    const std::vector<belief::PairPeak> again = pair_peaks(model, candidates, nodes);
    if (!again.empty() &&
        (peaks.empty() || again.front().score.log_likelihood() >= peaks.front().score.log_likelihood())) {
      peaks = again;
    }
    missed = candidates.missed;
    const double needed =
        peaks.empty() ? kWider * sigmas : kFarthest * excess_of(peaks.front().score.cost, freedom, options.robust);
    if (needed <= 1.2 * sigmas || sigmas >= kFarthestOfAll) break;
    sigmas = std::min(kFarthestOfAll, std::max(needed, kWider * sigmas));
  }
  if (peaks.empty()) peaks = pair_peaks(model, belief::all_squares(), nodes);
  if (peaks.empty()) {
    result.excess = std::numeric_limits<double>::infinity();
    return result;
  }
  result.excess = excess_of(peaks.front().score.cost, freedom, options.robust);
  result.errors = peaks.front().score.errors;
  if (!integrate) return result;
  const belief::PairDensity density =
      pair_density(model, peaks, nodes, result.excess, {corner_length(0), corner_length(1)});
  result.found = modes_of(density, model, rows.empty() ? PairReading{} : rows.back());
  double listed = 0;
  for (const PairMode& mode : result.found.modes) listed += mode.probability;
  result.rest = std::min(1.0, std::max(0.0, 1 - listed) + density.rest + missed);
  return result;
}

void PairBelief::State::settle() {
  if (rows.size() == settled_at) return;
  outcome = weigh(errors, true);
  settled_at = rows.size();
}

belief::PairErrors PairBelief::State::errors_supposing(Cause cause) const {
  return {options, kind, contacts.finger_curvature, contacts.facing.has_value(), part.perimeter(), cause};
}

Diagnosis PairBelief::State::explain(Cause cause) const {
  const Outcome again = weigh(errors_supposing(cause), false);
  // Of both fingers the one whose lengths are further off.
  const double a = 1 / (1 + again.errors[2]);
  const double b = 1 / (1 + again.errors[3]);
  return {cause, again.excess, std::abs(a - 1) >= std::abs(b - 1) ? a : b};
}

PairBelief::PairBelief(const Part& part, LogKind kind, const BeliefOptions& options, const PairContacts& contacts) {
  // The one-finger form says what noise and prior are valid.
  const Belief validated(part, kind, options);
  if (contacts.facing && !std::isfinite(*contacts.facing)) {
    throw InputError(fmt::format("expected a finite facing angle, found {}", *contacts.facing));
  }
  state_ = std::make_unique<State>(part, kind, options, contacts);
}
PairBelief::~PairBelief() = default;
PairBelief::PairBelief(PairBelief&&) noexcept = default;
PairBelief& PairBelief::operator=(PairBelief&&) noexcept = default;

void PairBelief::add(const PairReading& sample) {
  const bool is_first = state_->rows.empty() && sample.length_a == 0 && sample.length_b == 0 && sample.turn == 0;
  // The first contacts are what the others are measured from; their facing is a row of its own.
  if (is_first && state_->kind == LogKind::contact) return;
  state_->rows.push_back(sample);
}

std::size_t PairBelief::samples() const { return state_->rows.size(); }

const std::vector<PairMode>& PairBelief::modes() {
  state_->settle();
  return state_->outcome.found.modes;
}

double PairBelief::rest() {
  state_->settle();
  return state_->outcome.rest;
}

double PairBelief::excess() {
  state_->settle();
  return state_->outcome.excess;
}

std::vector<PairMass> PairBelief::mass() {
  state_->settle();
  return state_->outcome.found.mass;
}

double PairBelief::tolerance(const std::vector<PairReading>& readings) {
  state_->settle();
  const belief::PairErrors& errors = state_->errors;
  const TurningFunction& turning = state_->part.turning();
  double most = state_->contacts.facing ? errors.facing_variance() : 0;
  for (const PairMode& mode : state_->outcome.found.modes) {
    for (const PairReading& reading : readings) {
      const std::array<double, 2> lengths{reading.length_a, reading.length_b};
      double variance = errors.turn_variance() + errors.facing_variance();
      for (const std::size_t finger : {0U, 1U}) {
        const auto i = static_cast<Eigen::Index>(finger);
        const double kappa = turning.curvature(mode.start[finger] + lengths[finger]);
        const double gain = std::abs(kappa) + errors.normal_turn(finger);
        variance += gain * gain * (errors.contact_variance() + errors.start()(i, i)) +
                    kappa * kappa * errors.start()(2 + i, 2 + i) * lengths[finger] * lengths[finger];
      }
      most = std::max(most, variance);
    }
  }
  return kFarthest * std::min(excess(), kMostExcess) * std::sqrt(most);
}

Diagnosis PairBelief::diagnosis() {
  if (!(excess() > kMostExcess)) return {Cause::none, excess(), 1};
  return likelier(state_->explain(Cause::radius), state_->explain(Cause::slip), excess());
}

std::string PairBelief::verdict() { return verdict_on(modes()); }

std::string PairBelief::verdict_on(const std::vector<PairMode>& modes) {
  state_->settle();
  if (state_->rows.empty() && !state_->contacts.facing) return "unobservable";
  if (excess() > kMostExcess || modes.empty()) return "inconsistent";
  // Where one mode goes all the way round, no such roll can tell.
  const double P = state_->part.perimeter();
  const bool goes_round = state_->part.closed() && std::any_of(modes.begin(), modes.end(), [&](const PairMode& mode) {
                            return mode.probability >= kCounts &&
                                   std::max(mode.interval[0].width(), mode.interval[1].width()) > 0.9 * kCertain * P;
                          });
  if (goes_round) return "unobservable";
  std::size_t count = 0;
  for (const PairMode& mode : modes) count += mode.probability >= kCounts ? 1 : 0;
  if (count <= 1 || modes.front().probability >= kCertain) return "unique";
  return fmt::format("ambiguous ({})", count);
}

}  // namespace rollfix
