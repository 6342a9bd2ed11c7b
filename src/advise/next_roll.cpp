#include "rollfix/advise.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/turning_function.hpp"

// Notation, as in docs/belief.md, "The next roll":
//   hypothesis      a place where the contacts may be: a placement's, of a wide one several, along the direction in
//                   which it is known worst; before any contact places all along the boundary, evenly
//   sigma_t^2       of a turn, the errors of two rows: 2 (angle^2 + (contact kappa_f)^2) for each finger: `turn_sd`
//   sigma_l         of a length, sqrt(2) contact, and in proportion to it by slip and radius: `length_sd`,
//                   `length_share_sd`
//   n               rows whose mean is what is known of a turn: `rows`
// Idea: what a roll would tell is asked of `advise`; with friction once more, of those rolls that the fingers can do
// from every place where they can hold the part.
namespace rollfix {
namespace {

// A wide placement is this many hypotheses.
constexpr std::size_t kOfAWidePlacement = 15;
// One is wide from this share of the perimeter on.
constexpr double kWidePlacement = 1e-3;
// A mode is wide from this standard deviation on, a share of the perimeter: it is this many hypotheses then, at the
// quantiles 1/14, 3/14, ... of a normal distribution.
constexpr double kWideSpread = 0.005;
constexpr std::array<double, 7> kSevenDeviates = {-1.465, -0.792, -0.366, 0, 0.366, 0.792, 1.465};

/// All alike; of one finger's wide ones several.
std::vector<Hypothesis> without_noise(const Part& part, const std::vector<Placement>& placements) {
  std::vector<Hypothesis> hypotheses;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    // of starts; `rolled` brings them to where the contact is now
    const Interval& extent = placements[k].extent[0];
    const PerFinger<double>& end = placements[k].end;
    const double share = 1 / static_cast<double>(placements.size());
    const double rolled = end[0] - placements[k].start[0];
    // Of two fingers a wide one is a curve in the plane of both places: the box around it says little of where.
    if (end.size() == 2 || extent.width() < kWidePlacement * part.perimeter()) {
      hypotheses.push_back({end, PerFinger<double>::of(end.size()), share, k});
      continue;
    }
    // The middles of equal pieces of the extent, all as probable.
    for (std::size_t i = 0; i < kOfAWidePlacement; ++i) {
      const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(kOfAWidePlacement);
      const double s = extent.lo + t * extent.width() + rolled;
      hypotheses.push_back({part.boundary().on_first_lap(s), 0, share / static_cast<double>(kOfAWidePlacement), k});
    }
  }
  return hypotheses;
}

/// Of two fingers, along the direction in which they are known worst: as many pairs of places of the same probability.
void add_along_ridge(const Part& part, const Hypothesis& whole, std::vector<Hypothesis>& hypotheses) {
  Mat2 covariance;
  // of both places; its longest axis is the ridge
  covariance << whole.sd[0] * whole.sd[0], whole.covariance, whole.covariance, whole.sd[1] * whole.sd[1];
  Eigen::SelfAdjointEigenSolver<Mat2> axes;  // the larger one last
  axes.computeDirect(covariance);
  // standard deviation along the ridge, length
  const double along = std::sqrt(std::max(0.0, axes.eigenvalues()(1)));
  const Vec2 axis = axes.eigenvectors().col(1);
  // As many hypotheses as deviates, each with the same part of the probability.
  constexpr auto kPieces = static_cast<double>(kSevenDeviates.size());
  // What is left within each of them: as much less along the ridge as there are of them.
  const Mat2 within = covariance - (1 - 1 / (kPieces * kPieces)) * along * along * axis * axis.transpose();
  for (const double deviate : kSevenDeviates) {
    Hypothesis one = whole;
    one.probability /= kPieces;
    one.covariance = within(0, 1);
    for (const std::size_t finger : {0U, 1U}) {
      const auto k = static_cast<Eigen::Index>(finger);
      one.place[finger] = part.boundary().base(whole.place[finger] + deviate * along * axis(k));
      one.sd[finger] = std::sqrt(std::max(0.0, within(k, k)));
    }
    hypotheses.push_back(one);
  }
}

/// The covariance of where the contacts are now: the errors that both places share are those of the first contacts.
template <class Remaining>
double covariance_now(const Remaining& one) {
  // The correlation at the first contacts is kept; the standard deviations are those of now.
  const double first = one.sd[0] * one.sd[1];
  if (one.sd.size() < 2 || !(first > 0)) return 0;
  return one.covariance(0, 1) / first * one.end_sd[0] * one.end_sd[1];
}

/// `Remaining`: a placement or a mode, of which the samples say how probable it is.
template <class Remaining>
std::vector<Hypothesis> with_noise(const Part& part, const std::vector<Remaining>& all) {
  std::vector<Hypothesis> hypotheses;
  double total = 0;
  for (const Remaining& one : all) total += one.probability;
  for (std::size_t k = 0; k < all.size(); ++k) {
    // The whole mode as one hypothesis, if it is narrow.
    const Hypothesis whole{all[k].end_mean, all[k].end_sd, all[k].probability / total, k, covariance_now(all[k])};
    // the largest standard deviation of the fingers' places
    double widest = 0;
    for (const double sd : whole.sd) widest = std::max(widest, sd);
    if (widest < kWideSpread * part.perimeter()) {
      hypotheses.push_back(whole);
      continue;
    }
    if (whole.sd.size() == 2) {
      add_along_ridge(part, whole, hypotheses);
      continue;
    }
    // As many places of the same probability, as if it were normal.
    for (const double deviate : kSevenDeviates) {
      // Within each a seventh of the mode's standard deviation is left.
      const double place = part.boundary().base(whole.place[0] + deviate * whole.sd[0]);
      hypotheses.push_back({place, whole.sd[0] / kSevenDeviates.size(), whole.probability / kSevenDeviates.size(), k});
    }
  }
  return hypotheses;
}

// So many that each counts where all are as probable (kLeastProbability, 1 %); of two fingers pairs.
constexpr std::size_t kPlacesBefore = 90;
constexpr std::size_t kPlacesOfEach = 9;

/// A place at which the fingers may be, however they will be there.
Placement at(const Part& part, const PerFinger<double>& s) {
  Placement placement;
  // A pretended find at s, without a roll: start and end are one.
  placement.kind = Kind::crossing;
  placement.start = placement.end = s;
  placement.extent = PerFinger<Interval>::of(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) placement.extent[k] = {s[k], s[k]};
  placement.whole_loop = PerFinger<bool>::of(s.size(), false);
  placement.tangent = PerFinger<double>::of(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) placement.tangent[k] = part.tangent(s[k]);
  return placement;
}

/// Evenly spread places, or for two fingers pairs of them, in the order of s.
std::vector<Placement> places_before(const Part& part, std::size_t fingers) {
  std::vector<Placement> places;
  // Of two fingers 9 times 9 pairs.
  const std::size_t of_each = fingers == 1 ? kPlacesBefore : kPlacesOfEach;
  const double step = part.perimeter() / static_cast<double>(of_each);
  for (std::size_t i = 0; i < of_each; ++i) {
    const double s = (static_cast<double>(i) + 0.5) * step;
    if (fingers == 1) {
      places.push_back(at(part, s));
      continue;
    }
    // Halfway between the first one's, so that both fingers are nowhere at one place.
    for (std::size_t j = 0; j < of_each; ++j) places.push_back(at(part, {s, static_cast<double>(j) * step}));
  }
  return places;
}

// Without noise a turn can be read this well: well below what tells two places apart, well above rounding.
constexpr double kTurnSd = 1e-4;
// Rows of a log at about the same place, of which the turn there is known: a tenth of the log, and no more than this,
// as neighbours may be off alike.
constexpr double kMostRowsTogether = 10;
constexpr double kTogether = 0.1;
/// Why a part can't be told apart from itself.
std::string why_no_roll(const Part& part) {
  const int fold = symmetry(part);
  // A circle: from any place it looks the same.
  if (fold == 0) return "the part looks the same from every place on its boundary";
  if (fold > 1) return fmt::format("the part looks the same from {} places", fold);
  return "within the travel the places that remain look alike";
}

/// Throws InputError where `plan` can't be asked: one finger, or other fingers than disks and jaws.
void require_fingers_to_plan(const Answer& answer) {
  if (answer.finger_count() < 2) {
    throw InputError("friction: one finger on a part at rest needs none to roll: leave it out");
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const Finger* const finger = finger_of(answer.fingers, k);
    if (finger != nullptr && (finger->is_disk() || finger->is_jaw())) continue;
    throw InputError(fmt::format("friction: expected two fingers that are disks or jaws, found {}",
                                 finger == nullptr ? "none" : finger->name()));
  }
}

/// A thousandth of a roll: where even that can't be planned the part could not be held, so that it is not the true
/// place.
PerFinger<double> hardly(PerFinger<double> by) {
  constexpr double kHardly = 1e-3;
  for (double& length : by) length *= kHardly;
  return by;
}

/// Why two fingers can't roll on by these lengths from a place; nothing: they can.
std::optional<std::string> why_not_planned(const Answer& answer, const Hypothesis& from, const PerFinger<double>& by,
                                           const PerFinger<double>& friction) {
  // Both fingers as they are in the answer, from this place, with these lengths: what `plan` is asked.
  PlanProblem problem{answer.part, PerFinger<PlanFinger>(PlanFinger{}, PlanFinger{})};
  for (std::size_t k = 0; k < 2; ++k) {
    PlanFinger& finger = problem.fingers[k];
    finger.finger = *finger_of(answer.fingers, k);
    finger.start = from.place[k];
    finger.length = by[k];
    finger.friction = friction[k];
  }
  return plannable(problem);
}

}  // namespace

/// Without noise a placement has no probability: it is not a number.
std::vector<Hypothesis> hypotheses_of(const Part& part, const std::vector<Placement>& placements) {
  const bool has_noise = !placements.empty() && !std::isnan(placements.front().probability);
  return has_noise ? with_noise(part, placements) : without_noise(part, placements);
}

std::vector<Hypothesis> hypotheses_of(const Part& part, const std::vector<Mode>& modes) {
  return with_noise(part, modes);
}

Answer before_contact(const Part& part, const std::vector<Finger>& fingers, const std::optional<Noise>& noise,
                      bool may_overlap) {
  if (fingers.empty() || fingers.size() > 2) {
    throw InputError(fmt::format("before any contact: expected one finger or two, found {}", fingers.size()));
  }
  for (const Finger& finger : fingers) require_valid(finger);
  Answer answer{part, fingers};
  // A reading of length 0: the contacts are where they start.
  Reading none;
  none.length = PerFinger<double>::of(fingers.size());
  answer.readings = {none};
  // All of them fit: nothing is measured yet.
  answer.placements = places_before(part, fingers.size());
  if (noise) {
    answer.weighing = Weighing{};
    answer.weighing->noise = *noise;
  }
  // Of places the finger can't touch nothing needs to be told apart.
  if (std::all_of(fingers.begin(), fingers.end(), has_reach)) {
    PerFinger<Reach> reach = PerFinger<Reach>::of(fingers.size());
    for (std::size_t k = 0; k < fingers.size(); ++k) reach[k] = reach_of(part, fingers[k]);
    answer.has_reach = true;
    answer.impossible = drop_unreachable(part, reach, {}, answer.placements, {}, 0, may_overlap);
  }
  answer.verdict = verdict_of(Status::complete, answer.placements);
  return answer;
}

/// The answer's noise as errors of turns and lengths; without noise a turn's sd is kTurnSd, and lengths are exact.
AdviceOptions advice_options(const Answer& answer, const std::optional<Interval>& travel) {
  AdviceOptions options;
  options.turn_sd = kTurnSd;
  if (answer.weighing) {
    const Noise& noise = answer.weighing->noise;
    // From one row to another: the errors of both, of each finger.
    double turn_variance = 0;
    for (std::size_t k = 0; k < answer.finger_count(); ++k) {
      // 1 / r of a disk: a contact that is off on the finger turns its normal by that.
      const double curvature = answer.fingers.empty() ? 0 : finger_of(answer.fingers, k)->curvature(0);
      // N + psi at both rows: psi by `angle`, N by the contact's error times the finger's curvature
      turn_variance += 2 * (std::pow(noise.angle, 2) + std::pow(noise.contact * curvature, 2));
      // Slip and a wrong radius are in proportion to the length.
      options.length_share_sd = std::max(options.length_share_sd, std::hypot(noise.slip, noise.radius * curvature));
    }
    options.turn_sd = std::max(std::sqrt(turn_variance), kTurnAccuracy);
    options.length_sd = noise.contact * std::numbers::sqrt2;
    options.rows = std::clamp(kTogether * static_cast<double>(answer.weighing->samples), 1.0, kMostRowsTogether);
  }
  options.travel = travel;
  return options;
}

/// Reaches of the fingers for which one is known, disks and jaws.
ReachForAdvice::ReachForAdvice(const Answer& answer) {
  for (std::size_t k = 0; k < answer.finger_count(); ++k) {
    const Finger* const finger = finger_of(answer.fingers, k);
    if (finger != nullptr && has_reach(*finger)) each_[k] = reach_of(answer.part, *finger);
  }
}

PerFinger<const Reach*> ReachForAdvice::pointers() const {
  PerFinger<const Reach*> pointers = PerFinger<const Reach*>::of(2);
  for (const std::size_t k : {0U, 1U}) pointers[k] = each_[k] ? &*each_[k] : nullptr;
  return pointers;
}

/// Other shapes than disks are not looked at: nothing.
std::optional<PerFinger<double>> disks_for_advice(const Answer& answer, bool may_overlap) {
  if (answer.finger_count() < 2 || may_overlap) return std::nullopt;
  PerFinger<double> radii(0, 0);
  for (const std::size_t k : {0U, 1U}) {
    const Finger* const finger = finger_of(answer.fingers, k);
    if (finger == nullptr || !finger->is_disk()) return std::nullopt;
    radii[k] = finger->length_per_u();
  }
  return radii;
}

double NextRoll::turn_ahead(const Hypothesis& hypothesis) const {
  return rollfix::turn_ahead(answer.part, hypothesis, advice->lengths());
}

NextRoll next_roll(const Answer& answer, const std::optional<Interval>& travel, bool may_overlap,
                   const std::optional<PerFinger<double>>& friction) {
  if (friction) require_fingers_to_plan(answer);
  NextRoll next{answer, hypotheses_of(answer.part, answer.placements)};
  if (next.hypotheses.empty()) {
    next.why = "nothing fits: there is nothing to tell apart";
    return next;
  }
  if (next.hypotheses.size() == 1 || (answer.weighing && answer.verdict.name == Verdict::unique)) {
    next.why = "there is only one place left";
    return next;
  }
  // Without noise, and contradicted by other rows: none of them is where the finger is.
  if (!answer.weighing && answer.verdict.fits_badly) {
    next.why = "the rows contradict all of these places; first find what is wrong, by `locate`";
    return next;
  }
  AdviceOptions options = advice_options(answer, travel);
  const ReachForAdvice reach(answer);
  // The pointers live as long as `reach`, which outlives the calls below.
  options.reach = reach.pointers();
  options.disks = disks_for_advice(answer, may_overlap);
  // Without friction first: the plans of the second round cost more, and are not needed if no roll helps.
  const Advice any = advise(answer.part, next.hypotheses, options);
  next.advice = any;
  if (friction && any.helps) {
    bool can_any = false;
    // A place where the fingers can't hold the part at all is not the true one, and does not forbid a roll.
    options.can_roll = [&](const PartHypothesis& from, const PerFinger<double>& by) {
      const bool can = !why_not_planned(answer, from.hypothesis, by, *friction);
      can_any = can_any || can;
      return can || why_not_planned(answer, from.hypothesis, hardly(by), *friction);
    };
    next.advice = advise(answer.part, next.hypotheses, options);
    // None of the rolls that were asked for can be planned, from any place.
    if (!can_any) {
      next.advice->helps = false;
      next.why = "with this friction the fingers could not hold the part in any of them";
    } else if (!next.advice->helps) {
      next.why = "with this friction the fingers can do none that would, from every place where they can hold the part";
    }
  } else if (!any.helps) {
    next.why = why_no_roll(answer.part);
  }
  return next;
}

}  // namespace rollfix
