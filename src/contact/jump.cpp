#include "contact/jump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"

namespace rollfix {

namespace {

constexpr double kSurely = 10;          // standard deviations that no error reaches
constexpr double kSudden = 50;          // times the usual step
constexpr std::size_t kLeastSteps = 8;  // before that nothing is usual
constexpr double kSpareTurn = 1;        // radians, of rule 2
constexpr double kAboutTurn = 0.25;     // radians, of rule 3: logs of a part that was made a little differently ...
constexpr double kAboutLength = 0.25;   // ... and fingers whose radius is not quite what was said
constexpr double kSpareLength = 1e-6;   // of the perimeter, of rule 1

std::string step_text(const Reading& step, std::size_t line) {
  return fmt::format("the length changes by {:.6g} and the turn by {:.6g} deg since line {}", step.length[0],
                     step.turn / kDegree, line);
}

}  // namespace

StepError::StepError(LogKind kind, const std::optional<Finger>& finger, const Noise& noise) {
  const double both_rows = kind == LogKind::increments ? 1 : std::numbers::sqrt2;
  length = kSurely * both_rows * noise.contact;
  turn = kSurely * both_rows * noise.angle;
  share = kSurely * noise.slip;
  if (kind != LogKind::contact || !finger) return;
  turn += length * finger->turn_per_u() / finger->length_per_u();  // the contact's place says how its normal is turned
  if (finger->is_disk()) share += kSurely * noise.radius / finger->length_per_u();
}

double end_slack(const Finger& finger, double rounding, const Noise& noise) {
  return 2 * rounding + kSurely * noise.contact +
         (finger.outline() != nullptr ? kSpareLength * finger.outline()->perimeter() : 0);
}

std::string off_finger(const Finger& finger, double u) {
  const Interval ends = finger.ends();
  return fmt::format("u is {:.9g}, but the finger {} goes from {:g} to {:.9g} along its length", u, finger.name(),
                     ends.lo, ends.hi);
}

JumpWatch::JumpWatch(const Part& part, const StepError& error) : part_(part), error_(error), turns_(part) {}

std::optional<std::string> JumpWatch::look(std::size_t line, const Reading& before, const Reading& now,
                                           const std::optional<double>& time) {
  const bool is_first = last_line_ == 0;
  const Reading step{now.length[0] - before.length[0], now.turn - before.turn};
  const std::size_t line_before = last_line_;
  const double duration = time && last_time_ ? *time - *last_time_ : 1;
  const bool may_be_far = may_be_far_;
  last_time_ = time;
  last_line_ = line;
  may_be_far_ = false;
  if (is_first) return std::nullopt;

  if (auto why = impossible(step)) return step_text(step, line_before) + *why;
  // In laps and turns, so that neither a pivot nor a straight side counts as rest.
  const double laps = step.length[0] / part_.perimeter();
  const double size = 2 * std::numbers::pi * std::abs(laps) + std::abs(step.turn);
  const double noise = 2 * std::numbers::pi * error_.length / part_.perimeter() + error_.turn;
  if (!may_be_far && size > noise && is_sudden(size / duration) && !is_explained(step)) {
    return step_text(step, line_before) +
           fmt::format(", more than {:g} times what is usual here, and no stretch of the part is like that", kSudden);
  }
  if (!may_be_far) remember(size / duration);
  return std::nullopt;
}

/// Rules 1 and 2.
std::optional<std::string> JumpWatch::impossible(const Reading& step) const {
  const double perimeter = part_.perimeter();
  const double length = std::abs(step.length[0]) / (1 + error_.share);
  if (!part_.closed() && length > (1 + kSpareLength) * perimeter + error_.length) {
    return fmt::format(", but the open outline is only {:.6g} long", perimeter);
  }
  const double most = (1 + std::floor(length / perimeter)) * std::max(turns_.variation(), 2 * std::numbers::pi) +
                      kSpareTurn + error_.turn;
  if (std::abs(step.turn) > most) {
    return fmt::format(", but the part turns by at most {:.6g} deg over such a length", most / kDegree);
  }
  return std::nullopt;
}

/// Whether most of the recent steps were far smaller.
bool JumpWatch::is_sudden(double size) const {
  if (steps_ < kLeastSteps) return false;
  const std::size_t count = std::min(steps_, kRecent);
  const auto smaller = std::count_if(recent_.begin(), recent_.begin() + static_cast<std::ptrdiff_t>(count),
                                     [&](double usual) { return kSudden * usual < size; });
  return 2 * static_cast<std::size_t>(smaller) > count;
}

void JumpWatch::remember(double size) { recent_[steps_++ % kRecent] = size; }

/// Whether the part has a stretch of about this length that turns by about this much.
bool JumpWatch::is_explained(const Reading& step) const {
  const double length = std::abs(step.length[0]);
  if (length > part_.perimeter() * (1 + error_.share) + error_.length) return false;
  const double share = kAboutLength + error_.share;
  const Interval lengths{std::max(0.0, length / (1 + share) - error_.length), length * (1 + share) + error_.length};
  const double slack = kAboutTurn + error_.turn;
  const Interval turns = turns_.of(lengths);
  const auto is_within = [&](double turn) { return turn >= turns.lo - slack && turn <= turns.hi + slack; };
  if (is_within(step.length[0] < 0 ? -step.turn : step.turn)) return true;
  return lengths.lo == 0 && is_within(step.length[0] < 0 ? step.turn : -step.turn);
}

}  // namespace rollfix
