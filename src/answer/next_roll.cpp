#include "rollfix/answer/next_roll.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rollfix/answer/part_facts.hpp"
#include "rollfix/answer/solve.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace {

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

}  // namespace

AdviceOptions advice_options(const Answer& answer, const std::optional<Interval>& travel) {
  AdviceOptions options;
  options.turn_sd = kTurnSd;
  if (answer.weighing) {
    const Noise& noise = answer.weighing->noise;
    const double curvature = answer.fingers.empty() ? 0 : answer.fingers.front().curvature(0);
    // From one row to another: the errors of both.
    options.turn_sd = std::max(std::hypot(noise.angle, noise.contact * curvature) * std::numbers::sqrt2, kTurnAccuracy);
    options.length_sd = noise.contact * std::numbers::sqrt2;
    options.length_share_sd = std::hypot(noise.slip, noise.radius * curvature);
    options.rows = std::clamp(kTogether * static_cast<double>(answer.weighing->samples), 1.0, kMostRowsTogether);
  }
  options.travel = travel;
  return options;
}

std::optional<Reach> reach_for_advice(const Answer& answer) {
  if (answer.fingers.empty() || !has_reach(answer.fingers.front())) return std::nullopt;
  return reach_of(answer.part, answer.fingers.front());
}

double NextRoll::turn_ahead(const Contender& contender) const {
  const TurningFunction& turning = answer.part.turning();
  return turning.angle(contender.place + advice->advised().length) - turning.angle(contender.place);
}

NextRoll next_roll(const Answer& answer, const std::optional<Interval>& travel) {
  if (answer.finger_count() != 1) throw InputError("advise: expected what one finger read, found two fingers");
  NextRoll next{answer, contenders_of(answer.part, answer.placements)};
  if (next.contenders.empty()) {
    next.why = "nothing fits: there is nothing to tell apart";
    return next;
  }
  if (next.contenders.size() == 1 || (answer.weighing && answer.verdict.name == Verdict::unique)) {
    next.why = "there is only one place left";
    return next;
  }
  AdviceOptions options = advice_options(answer, travel);
  const std::optional<Reach> reach = reach_for_advice(answer);
  if (reach) options.reach = &*reach;
  next.advice = advise(answer.part, next.contenders, options);
  if (!next.advice->helps) next.why = why_no_roll(answer.part);
  return next;
}

}  // namespace rollfix
