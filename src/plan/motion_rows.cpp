#include "log/wrapping.hpp"
#include "plan/planning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>

// Notation:
//   x, y               turns of the fingers against the part, with rates x', y'; c, p as in planning.hpp
//   phi, X             the part's heading and where its frame's origin is
//   w                  velocity of a finger's origin if X rested: J is a turn by a right angle,
//                      w = phi' J R(phi) c + x' J R(phi) (c - p), since the finger turns about its contact
// Idea: rolling fixes all but how the three bodies move and turn together. phi is chosen so that the force keeps its
// direction in the world, as a gripper's closing does, X so that the middle between both fingers stays: then each moves
// by half of what one would.
namespace rollfix::planning {
namespace {

// Without a duration and without limits of speed and turning the faster finger reaches this rate at its fastest.
constexpr double kUsualTurn = 1;  // rad/s against the part, as in a simulated roll

/// J: turned by a right angle, counter-clockwise.
Vec2 crosswise(const Vec2& vector) { return {-vector.y(), vector.x()}; }

/// The law's value at each time.
std::vector<double> along(const std::vector<double>& times, double (*law)(double)) {
  std::vector<double> values;
  for (const double time : times) values.push_back(law(time));
  return values;
}

/// A wheel turns by itself: limits of turning are not for it.
bool is_turned(const PlanProblem& problem, std::size_t which) { return !problem.fingers[which].wheel; }

/// How something turns, and how fast by lambda.
struct LineAngle {
  /// radians since the start
  double turned = 0;
  double rate = 0;
};

/// The direction of the line through both contacts in the part's frame, since the start; unwrapped from knot to knot,
/// which are so close together that it turns by little.
class LineTurn {
 public:
  explicit LineTurn(const RollPath& path) : path_(path) {
    for (const PairPlace& place : path.places(path.knots())) {
      const double angle = angle_of(place);
      angles_.push_back(angles_.empty() ? angle : near(angle, angles_.back()));
    }
  }

  /// At these lambda, in any order; rates by differences.
  std::vector<LineAngle> at(const std::vector<double>& lambda) const {
    constexpr double kStep = 1e-5;  // of lambda: rounding and curvature are alike small
    std::vector<double> before;
    std::vector<double> after;
    for (const double value : lambda) {
      before.push_back(std::max(0.0, value - kStep));
      after.push_back(std::min(1.0, value + kStep));
    }
    // One walk for all places of a kind, since a way is walked once for each call.
    const std::vector<PairPlace> here = path_.places(lambda);
    const std::vector<PairPlace> first = path_.places(before);
    const std::vector<PairPlace> last = path_.places(after);
    std::vector<LineAngle> turns;
    for (std::size_t k = 0; k < lambda.size(); ++k) {
      turns.push_back(
          {turned(here[k]) - angles_.front(), (turned(last[k]) - turned(first[k])) / (after[k] - before[k])});
    }
    return turns;
  }

 private:
  /// Direction of the line from p to q in the part's frame, in (-pi, pi].
  static double angle_of(const PairPlace& place) {
    const Vec2 line = place.b.point - place.a.point;
    return std::atan2(line.y(), line.x());
  }
  /// The same angle next to the other one.
  static double near(double angle, double other) { return other + std::remainder(angle - other, 2 * std::numbers::pi); }
  /// The line's direction, unwrapped: next to that of the knot that follows.
  double turned(const PairPlace& place) const {
    const std::vector<double>& knots = path_.knots();
    const auto next = std::lower_bound(knots.begin(), knots.end() - 1, place.at);
    return near(angle_of(place), angles_[static_cast<std::size_t>(next - knots.begin())]);
  }

  const RollPath& path_;
  /// of the line at the knots, unwrapped
  std::vector<double> angles_;
};

/// How the part turns: as is asked; beside a wheel so that finger a does not; else so that the force keeps its
/// direction.
std::vector<LineAngle> headings_of(const PlanProblem& problem, const RollPath& path,
                                   const std::vector<PairPlace>& places, const std::vector<Turned>& rates) {
  std::vector<LineAngle> headings(places.size());
  // One finger: the part is at rest.
  if (path.way_b() == nullptr) return headings;
  std::vector<double> lambda;
  for (std::size_t k = 0; k < places.size(); ++k) {
    lambda.push_back(places[k].at);
    // Beside a wheel phi' = -x': finger a keeps its orientation in the world.
    if (problem.part_rotation)
      headings[k] = {*problem.part_rotation * places[k].at, *problem.part_rotation};
    else if (path.squeezed())
      headings[k] = {-places[k].a.turned, -rates[k].a};
  }
  // The force lies along the line: phi turns back what the line turns in the part's frame.
  if (problem.part_rotation || path.squeezed()) return headings;
  // Only this last choice needs the line's turn, which costs four walks.
  const std::vector<LineAngle> lines = LineTurn(path).at(lambda);
  for (std::size_t k = 0; k < places.size(); ++k) headings[k] = {-lines[k].turned, -lines[k].rate};
  return headings;
}

/// A finger as if the part's origin rested at 0.
/// `rate`: x', `heading_rate`: phi'; both by the same time.
BodyState carried(const ContactPlace& place, double rate, const Pose& turned, double heading_rate) {
  // R(phi) c, and w of this file's head
  const Vec2 at = turned.turned(place.centre);
  const Vec2 velocity =
      heading_rate * crosswise(at) + rate * crosswise(turned.turned(Vec2(place.centre - place.point)));
  return {{at.x(), at.y(), place.contact.psi + turned.heading}, velocity.x(), velocity.y(), rate + heading_rate};
}

/// Moves a body along, without turning it.
void shift(BodyState& body, const Vec2& by, const Vec2& velocity) {
  body.pose.x += by.x();
  body.pose.y += by.y();
  body.vx += velocity.x();
  body.vy += velocity.y();
}

/// Of the point that stays, where it is and how fast it moves.
/// What PlanProblem::staying asks for: the part, finger a, finger b, or the middle between both fingers.
BodyState staying(const PlanProblem& problem, const MotionState& state) {
  if (problem.staying == Staying::part || state.finger.size() == 1) return state.part;
  if (problem.staying == Staying::a) return state.finger[0];
  if (problem.staying == Staying::b) return state.finger[1];
  const BodyState& a = state.finger[0];
  const BodyState& b = state.finger[1];
  return {{0.5 * (a.pose.x + b.pose.x), 0.5 * (a.pose.y + b.pose.y), 0}, 0.5 * (a.vx + b.vx), 0.5 * (a.vy + b.vy), 0};
}

/// One instant, with what stays at the origin. `speed`: lambda by time.
/// Rates by lambda times `speed` are rates by time.
MotionState state_at(const PlanProblem& problem, const RollPath& path, const PairPlace& place, const Turned& rate,
                     const LineAngle& heading, double speed) {
  MotionState state;
  state.place = place;
  state.part.pose.heading = problem.pose.heading + heading.turned;
  state.part.omega = speed * heading.rate;
  state.finger = PerFinger<BodyState>::of(path.way_b() != nullptr ? 2 : 1);
  state.finger[0] = carried(place.a, speed * rate.a, state.part.pose, state.part.omega);
  if (state.finger.size() == 2) state.finger[1] = carried(place.b, speed * rate.b, state.part.pose, state.part.omega);
  // All bodies move by the same, so that what stays is at 0 and at rest.
  const BodyState still = staying(problem, state);
  const Vec2 by(-still.pose.x, -still.pose.y);
  const Vec2 velocity(-still.vx, -still.vy);
  shift(state.part, by, velocity);
  for (BodyState& finger : state.finger) shift(finger, by, velocity);
  return state;
}

/// What a limit is about, at an instant; `first` is the first instant
using Measure = std::function<double(const MotionState&, const MotionState& first)>;

/// Of a frame's origin, length per time.
double speed_of(const BodyState& body) { return std::hypot(body.vx, body.vy); }

/// The instant at which a measure is largest.
std::size_t largest(const std::vector<MotionState>& states, const Measure& measure) {
  std::size_t most = 0;
  for (std::size_t k = 1; k < states.size(); ++k) {
    if (measure(states[k], states[0]) > measure(states[most], states[0])) most = k;
  }
  return most;
}

}  // namespace

/// lambda = 10 t^3 - 15 t^4 + 6 t^5: minimum jerk (Flash and Hogan 1985), from 0 to 1.
double eased(double time) { return time * time * time * (10 + time * (6 * time - 15)); }

/// d lambda / dt: 0 at both ends.
double eased_rate(double time) { return 30 * time * time * (1 - time) * (1 - time); }

/// eased() grows from 0 to 1, so that there is one time.
double time_of(double along) {
  if (along <= 0 || along >= 1) return along <= 0 ? 0 : 1;
  std::uintmax_t rounds = 100;
  const auto [lo, hi] = boost::math::tools::toms748_solve([&](double time) { return eased(time) - along; }, 0.0, 1.0,
                                                          boost::math::tools::eps_tolerance<double>(50), rounds);
  return 0.5 * (lo + hi);
}

/// Each instant is made with what stays at the origin, and then all are shifted to where that is at the start.
std::vector<MotionState> motion_at(const PlanProblem& problem, const RollPath& path, const std::vector<double>& times,
                                   bool expanding) {
  // Equal times are unequal lambda: the roll starts and ends at rest.
  const std::vector<double> lambda = along(times, &eased);
  const std::vector<PairPlace> places = path.places(lambda);
  const std::vector<Turned> rates = path.rates(lambda);
  // What stays is where the part's pose at the start has it.
  const MotionState first = state_at(problem, path, path.places({0}).front(), {}, {}, 0);
  const std::vector<LineAngle> headings = headings_of(problem, path, places, rates);
  const Vec2 anchor(problem.pose.x - first.part.pose.x, problem.pose.y - first.part.pose.y);
  std::vector<MotionState> states;
  for (std::size_t k = 0; k < times.size(); ++k) {
    MotionState state = state_at(problem, path, places[k], rates[k], headings[k], eased_rate(times[k]));
    // Places only: what stays is at rest, so that velocities are right already.
    shift(state.part, anchor, Vec2::Zero());
    for (BodyState& finger : state.finger) shift(finger, anchor, Vec2::Zero());
    if (state.finger.size() == 2) {
      // from p to q in the world; where the fingers press apart the other way
      const Vec2 to_b = state.part.pose.turned(Vec2(places[k].b.point - places[k].a.point)) * (expanding ? -1 : 1);
      state.force = std::atan2(to_b.y(), to_b.x());
    }
    states.push_back(state);
  }
  return states;
}

/// Rates go with 1 / duration: `states` are those of a duration of 1, and the least duration that keeps all limits is
/// the largest quotient.
double duration_of(const PlanProblem& problem, const std::vector<MotionState>& states) {
  if (problem.duration) return *problem.duration;
  double duration = 0;
  for (std::size_t which = 0; which < states.front().finger.size(); ++which) {
    for (const MotionState& state : states) {
      const BodyState& body = state.finger[which];
      if (problem.limits.speed) duration = std::max(duration, speed_of(body) / *problem.limits.speed);
      if (problem.limits.turn && is_turned(problem, which)) {
        duration = std::max(duration, std::abs(body.omega) / *problem.limits.turn);
      }
      const bool is_free = !problem.limits.speed && !problem.limits.turn;
      if (is_free) duration = std::max(duration, std::abs(body.omega - state.part.omega) / kUsualTurn);
    }
  }
  return duration > 0 ? duration : 1;
}

std::vector<Looked> look_at_limits(const PlanProblem& problem, const std::vector<MotionState>& states,
                                   const std::vector<double>& times, double duration) {
  std::vector<Looked> found;
  for (std::size_t which = 0; which < states.front().finger.size(); ++which) {
    // The instant at which most of the limit is used; if it fails, the first instant beyond the limit.
    const auto look = [&](Condition condition, const std::optional<double>& limit, double rounding,
                          const Measure& measure) {
      if (!limit) return;
      std::size_t most = largest(states, measure);
      const double value = *limit - measure(states[most], states[0]);
      const bool fails = value < -rounding * *limit;
      for (std::size_t k = 0; fails && k < most; ++k) {
        if (measure(states[k], states[0]) > *limit) most = k;
      }
      const PairPlace& place = states[most].place;
      Looked looked;
      looked.margin = {condition, which, value, *limit, 0, 0, {place.a.s, place.b.s}, fails, false};
      looked.at = eased(times[most]);
      found.push_back(looked);
    };
    constexpr double kRounding = 1e-9;  // the shortest duration is just at a limit
    look(Condition::speed, problem.limits.speed, kRounding,
         [&](const MotionState& state, const MotionState&) { return speed_of(state.finger[which]) / duration; });
    // Travel and rotation are from the first instant, and do not depend on the duration.
    look(Condition::travel, problem.limits.travel, 0, [&](const MotionState& state, const MotionState& first) {
      return std::hypot(state.finger[which].pose.x - first.finger[which].pose.x,
                        state.finger[which].pose.y - first.finger[which].pose.y);
    });
    if (!is_turned(problem, which)) continue;
    look(Condition::turn, problem.limits.turn, kRounding,
         [&](const MotionState& state, const MotionState&) { return std::abs(state.finger[which].omega) / duration; });
    look(Condition::rotation, problem.limits.rotation, 0, [&](const MotionState& state, const MotionState& first) {
      return std::abs(state.finger[which].pose.heading - first.finger[which].pose.heading);
    });
  }
  return found;
}

/// Fills the log, the true contacts, the part's poses, the rates and the force's direction of the plan. A plan that
/// fails is written too, but its log need not be readable.
void write_rows(const PlanProblem& problem, const RollPath& path, bool expanding, Plan& plan) {
  std::vector<double> times;
  const auto last = static_cast<double>(problem.rows - 1);
  for (std::size_t k = 0; k < problem.rows; ++k) times.push_back(static_cast<double>(k) / last);
  const std::vector<MotionState> states = motion_at(problem, path, times, expanding);
  const std::size_t fingers = states.front().finger.size();
  Roll& roll = plan.roll;
  roll.log.name = "the plan on " + problem.part.name();
  roll.log.unit = problem.part.unit();
  roll.log.fingers.resize(fingers);
  roll.s = roll.angle = PerFinger<std::vector<double>>::of(fingers);
  plan.rates = PerFinger<PlanRates>::of(fingers);
  const auto add_rates = [&](PlanRates& rates, const BodyState& body) {
    rates.vx.push_back(body.vx / plan.duration);
    rates.vy.push_back(body.vy / plan.duration);
    rates.omega.push_back(body.omega / plan.duration);
  };
  for (std::size_t k = 0; k < states.size(); ++k) {
    const MotionState& state = states[k];
    // times[k] goes from 0 to 1
    roll.log.time.push_back(times[k] * plan.duration);
    for (std::size_t which = 0; which < fingers; ++which) {
      // u is the contact's; psi, x, y are of the finger's frame in the world.
      const ContactPlace& place = which == 0 ? state.place.a : state.place.b;
      FingerRows& rows = roll.log.fingers[which];
      rows.u_period = problem.fingers[which].finger.period();
      rows.u.push_back(place.contact.u);
      rows.psi.push_back(state.finger[which].pose.heading);
      rows.x.push_back(state.finger[which].pose.x);
      rows.y.push_back(state.finger[which].pose.y);
      roll.s[which].push_back(place.s);
      roll.angle[which].push_back(place.angle);
      add_rates(plan.rates[which], state.finger[which]);
    }
    // A part at rest has no poses, and one finger no force to go along.
    if (fingers == 1) continue;
    roll.pose.push_back(state.part.pose);
    add_rates(plan.part_rates, state.part);
    plan.force.push_back(state.force);
  }
  if (plan.failure) return;  // there is nothing to play
  for (const FingerRows& rows : roll.log.fingers) require_readable(rows, roll.log.name);
}

}  // namespace rollfix::planning
