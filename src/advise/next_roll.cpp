#include "rollfix/advise.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/solve.hpp"

// Notation, as in docs/belief.md, "The next roll":
//   hypothesis      a place where the contacts may be; before any contact places all along the boundary, evenly
//   sigma_t^2       of a turn, the errors of two rows: 2 (angle^2 + (contact kappa_f)^2) for each finger: `turn_sd`
//   sigma_l         of a length, sqrt(2) contact, and in proportion to it by slip and radius: `length_sd`,
//                   `length_share_sd`
//   n               rows whose mean is what is known of a turn: `rows`
// Idea: what a roll would tell is asked of `advise`; with friction once more, of those rolls that the fingers can do
// from every place where they can hold the part.
namespace rollfix {
namespace {

// So many that each counts where all are as probable (kHypothesisCounts, 1 %); of two fingers pairs.
constexpr std::size_t kPlacesBefore = 90;
constexpr std::size_t kPlacesOfEach = 9;

/// A place at which the fingers may be, however they will be there.
Placement at(const Part& part, const PerFinger<double>& s) {
  Placement placement;
  placement.kind = Kind::crossing;
  placement.start = placement.end = s;
  placement.extent = PerFinger<Interval>::of(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) placement.extent[k] = {s[k], s[k]};
  placement.whole_loop = PerFinger<bool>::of(s.size(), false);
  placement.tangent = PerFinger<double>::of(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) placement.tangent[k] = part.tangent(s[k]);
  return placement;
}

std::vector<Placement> places_before(const Part& part, std::size_t fingers) {
  std::vector<Placement> places;
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
  if (fold == 0) return "the part looks the same from every place on its boundary";
  if (fold > 1) return fmt::format("the part looks the same from {} places", fold);
  return "within the travel the places that remain look alike";
}

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

/// Next to nothing: where that can't be planned the part could not be held, so that it is not the true place.
PerFinger<double> hardly(PerFinger<double> by) {
  constexpr double kHardly = 1e-3;
  for (double& length : by) length *= kHardly;
  return by;
}

/// Why two fingers can't roll on by these lengths from a place; nothing: they can.
std::optional<std::string> why_not_planned(const Answer& answer, const Hypothesis& from, const PerFinger<double>& by,
                                           const PerFinger<double>& friction) {
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

Answer before_contact(const Part& part, const std::vector<Finger>& fingers, const std::optional<Noise>& noise,
                      bool may_overlap) {
  if (fingers.empty() || fingers.size() > 2) {
    throw InputError(fmt::format("before any contact: expected one finger or two, found {}", fingers.size()));
  }
  for (const Finger& finger : fingers) require_valid(finger);
  Answer answer{part, fingers};
  Reading none;
  none.length = PerFinger<double>::of(fingers.size());
  answer.readings = {none};
  answer.placements = places_before(part, fingers.size());
  if (noise) {
    answer.weighing = Weighing{};
    answer.weighing->noise = *noise;
  }
  if (std::all_of(fingers.begin(), fingers.end(), has_reach)) {
    PerFinger<Reach> reach = PerFinger<Reach>::of(fingers.size());
    for (std::size_t k = 0; k < fingers.size(); ++k) reach[k] = reach_of(part, fingers[k]);
    answer.has_reach = true;
    answer.impossible = drop_unreachable(part, reach, {}, answer.placements, {}, 0, may_overlap);
  }
  answer.verdict = verdict_of(Status::complete, answer.placements);
  return answer;
}

AdviceOptions advice_options(const Answer& answer, const std::optional<Interval>& travel) {
  AdviceOptions options;
  options.turn_sd = kTurnSd;
  if (answer.weighing) {
    const Noise& noise = answer.weighing->noise;
    // From one row to another: the errors of both, of each finger.
    double turn_variance = 0;
    for (std::size_t k = 0; k < answer.finger_count(); ++k) {
      const double curvature = answer.fingers.empty() ? 0 : finger_of(answer.fingers, k)->curvature(0);
      turn_variance += 2 * (std::pow(noise.angle, 2) + std::pow(noise.contact * curvature, 2));
      options.length_share_sd = std::max(options.length_share_sd, std::hypot(noise.slip, noise.radius * curvature));
    }
    options.turn_sd = std::max(std::sqrt(turn_variance), kTurnAccuracy);
    options.length_sd = noise.contact * std::numbers::sqrt2;
    options.rows = std::clamp(kTogether * static_cast<double>(answer.weighing->samples), 1.0, kMostRowsTogether);
  }
  options.travel = travel;
  return options;
}

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
  AdviceOptions options = advice_options(answer, travel);
  const ReachForAdvice reach(answer);
  options.reach = reach.pointers();
  options.disks = disks_for_advice(answer, may_overlap);
  const Advice any = advise(answer.part, next.hypotheses, options);
  next.advice = any;
  if (friction && any.helps) {
    bool can_any = false;
    options.can_roll = [&](const PartHypothesis& from, const PerFinger<double>& by) {
      const bool can = !why_not_planned(answer, from.hypothesis, by, *friction);
      can_any = can_any || can;
      return can || why_not_planned(answer, from.hypothesis, hardly(by), *friction);
    };
    next.advice = advise(answer.part, next.hypotheses, options);
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
