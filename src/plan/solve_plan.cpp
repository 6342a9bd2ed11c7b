#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "plan/planning.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"

// Notation, with x, y as in planning.hpp and A, B as in planning.hpp:
//   goal            x at the end of finger a's length; y is as long, or any in `range_of`, or what balances a wheel
//   margin          the least of cone - |A| and cone - |B|, where the fingers are apart: `margin_between`, `cone_of`
//   looked          each condition with what is left of it where it is worst: Looked
// Follows docs/plan.md, "What is checked" and "How the motion is chosen".
// Idea: even turns are tried first, then the widest path; what is found is looked at as if it had been given.
namespace rollfix::planning {
namespace {

// Speeds and travels are looked at in so many instants: they change smoothly, and their largest is known to 1e-5 of it.
constexpr std::size_t kLimitInstants = 1001;
// How far a wheel may be from the balance that it settles into, as a share of the perimeter: what is typed is rounded.
constexpr double kSettling = 0.01;
// Balances on two laps are one: found to rounding, as a share of the perimeter.
constexpr double kSamePlace = 1e-9;
// Fingers that a search keeps apart are so far apart, as a share of their size: what is just touching proves nothing.
constexpr double kApartShare = 0.01;

/// Says which finger an error is about. Of one finger alone the message stays as it is.
template <class Action>
auto about(const PlanProblem& problem, std::size_t which, const Action& action) {
  try {
    return action();
  } catch (const InputError& error) {
    if (problem.fingers.size() == 1) throw;
    throw InputError(fmt::format("{}: {}", name_of_finger(problem, which), error.what()));
  }
}

/// Where each finger can be on the part; nothing of a finger with an outline, whose reach is not known.
std::vector<std::optional<Reach>> reaches_of(const PlanProblem& problem) {
  std::vector<std::optional<Reach>> reaches;
  for (const PlanFinger& finger : problem.fingers) {
    reaches.push_back(has_reach(finger.finger) ? std::optional<Reach>(reach_of(problem.part, finger.finger))
                                               : std::nullopt);
  }
  return reaches;
}

/// All turns of finger b, up to half a lap more than finger a goes, and a lap at most, within its reach.
Interval range_of(const PlanProblem& problem, const ContactWay& way, const std::optional<Reach>& reach) {
  const double P = problem.part.perimeter();
  // As a travel of the contact, either way.
  const double most = std::min(P, 0.5 * P + std::abs(*problem.fingers[0].length));
  Interval lengths{-most, most};
  const double start = way.places({0}).front().s;
  if (reach) {
    const auto arc = reach->arc_at(problem.part.closed() ? problem.part.boundary().base(start) : start);
    // The arc of the part that this finger can be on, around its start.
    if (arc && !reach->whole_loop) {
      const double base = problem.part.closed() ? problem.part.boundary().base(start) : start;
      lengths.lo = std::max(lengths.lo, arc->lo - base);
      lengths.hi = std::min(lengths.hi, arc->hi - base);
    }
  }
  // As turns y; 0, the first contact, is always in the range.
  const double back = way.furthest(-1, std::max(0.0, -lengths.lo));
  const double on = way.furthest(1, std::max(0.0, lengths.hi));
  return {std::min(0.0, way.turned_after(back)), std::max(0.0, way.turned_after(on))};
}

/// Whether the fingers press apart, as in a hole: the line through the contacts then leaves the material.
bool presses_apart(const ContactPlace& a, const ContactPlace& b) {
  // A cosine below 0: that inward normal points away from the other contact. Their sum decides.
  const Squeeze squeeze = squeeze_of(a, b, false);
  return std::cos(squeeze.at_a) + std::cos(squeeze.at_b) < 0;
}

/// What a search keeps largest: the smaller distance to an edge of a cone, where the fingers are apart.
double margin_between(const PlanProblem& problem, bool expanding, const ContactPlace& a, const ContactPlace& b) {
  const Squeeze squeeze = squeeze_of(a, b, expanding);
  // Distance to the nearer edge of a cone, radians.
  const double left = std::min(cone_of(problem.fingers[0]) - std::abs(squeeze.at_a),
                               cone_of(problem.fingers[1]) - std::abs(squeeze.at_b));
  const Finger& of_a = problem.fingers[0].finger;
  const Finger& of_b = problem.fingers[1].finger;
  const double size = size_of(of_a) + size_of(of_b);
  const auto gap =
      problem.may_overlap ? std::nullopt : gap_between(of_a, a, of_b, b, problem.clearance + kApartShare * size);
  if (!gap) return left;
  // Fingers too close: below the margin that is asked for, by as much as they are too close, as a share of their size.
  const double apart = (*gap - problem.clearance) / size - kApartShare;
  return apart < 0 ? std::min(left, apart + problem.margin) : left;
}

/// The friction that holds a force at this angle to the normal; none does at a right angle.
double friction_of(double tilt) {
  return tilt < 0.5 * std::numbers::pi ? std::tan(tilt) : std::numeric_limits<double>::infinity();
}

/// A plan that is being made.
struct Making {
  const PlanProblem& problem;
  std::vector<std::optional<Reach>> reaches;
  Plan plan;
  /// conditions in the order in which they were looked at; becomes plan.margins
  std::vector<Looked> looked;
};

/// The motion's duration, and the limits of speed, turning, travel and rotation, at kLimitInstants equal times.
void look_at_motion(Making& making, const RollPath& path) {
  std::vector<double> times;
  for (std::size_t k = 0; k < kLimitInstants; ++k) {
    times.push_back(static_cast<double>(k) / static_cast<double>(kLimitInstants - 1));
  }
  const std::vector<MotionState> states = motion_at(making.problem, path, times, making.plan.expanding);
  making.plan.duration = duration_of(making.problem, states);
  const std::vector<Looked> limits = look_at_limits(making.problem, states, times, making.plan.duration);
  // The limits come last: a condition that fails earlier on the path is still the first, by `at`.
  making.looked.insert(making.looked.end(), limits.begin(), limits.end());
}

/// What a path can be judged by without its time: reach, and of two fingers friction, distance and balance. Replaces
/// what was looked at before.
void look_at_path(Making& making, const RollPath& path) {
  making.looked.clear();
  Plan& plan = making.plan;
  plan.friction_needed = PerFinger<double>::of(making.problem.fingers.size());
  plan.decided = true;
  for (std::size_t which = 0; which < making.reaches.size(); ++which) {
    if (!making.reaches[which]) continue;
    if (const auto hit = look_at_reach(*making.reaches[which], path, which)) making.looked.push_back(*hit);
  }
  if (path.way_b() == nullptr) return;
  // Of two fingers: friction, distance and balance, and what friction the roll needs.
  const SqueezeLook squeeze = look_at_squeeze(making.problem, path, plan.expanding);
  making.looked.insert(making.looked.end(), squeeze.looked.begin(), squeeze.looked.end());
  for (std::size_t which = 0; which < 2; ++which) plan.friction_needed[which] = friction_of(squeeze.tilt[which]);
  plan.decided = squeeze.decided;
}

/// The margins in the plan's time, and which fails first.
void conclude(Making& making, const RollPath& path) {
  Plan& plan = making.plan;
  // lambda of the first failure; beyond 1: none
  double first = 2;
  for (Looked& looked : making.looked) {
    // A condition knows where on the path it is worst; the easing makes that a time.
    looked.margin.time = time_of(looked.at) * plan.duration;
    const auto rows = static_cast<double>(making.problem.rows - 1);
    looked.margin.row = static_cast<std::size_t>(std::lround(time_of(looked.at) * rows));
    // The failure that comes first on the way is the one that is told.
    if (looked.margin.fails && looked.at < first) {
      first = looked.at;
      plan.failure = plan.margins.size();
    }
    plan.margins.push_back(looked.margin);
  }
  plan.length = PerFinger<double>::of(making.problem.fingers.size());
  // The lengths of the path itself, also where none was given.
  const std::vector<PairPlace> ends = path.places({0, 1});
  plan.length[0] = ends[1].a.s - ends[0].a.s;
  if (plan.length.size() == 2) plan.length[1] = ends[1].b.s - ends[0].b.s;
  write_rows(making.problem, path, plan.expanding, plan);
}

/// The path is final: its motion, and the plan's rows.
void finish(Making& making, const RollPath& path) {
  look_at_motion(making, path);
  conclude(making, path);
}

/// Any of the conditions fails.
bool fails(const std::vector<Looked>& looked) {
  return std::any_of(looked.begin(), looked.end(), [](const Looked& one) { return one.margin.fails; });
}

/// One finger: its length fixes everything, only the time is chosen.
void plan_one(Making& making) {
  const PlanFinger& finger = making.problem.fingers[0];
  const ContactWay way(making.problem.part, finger, making.problem.pose.heading);
  // with no finger b, the path is a's turn alone
  const FoundPath found = even_path(way, way.turned_after(*finger.length), nullptr, 0);
  const RollPath path(way, nullptr, found.knots, found.turned);
  look_at_path(making, path);
  finish(making, path);
}

/// Both lengths given: an even roll if it holds, else the widest path to the same end. Only a's given: the widest path,
/// whose end is free.
void plan_two(Making& making) {
  const PlanProblem& problem = making.problem;
  // Errors of a start or of a length name the finger.
  const auto way_of = [&](std::size_t which) {
    return about(problem, which,
                 [&] { return ContactWay(problem.part, problem.fingers[which], problem.pose.heading); });
  };
  const auto goal_of = [&](const ContactWay& way, std::size_t which) {
    return about(problem, which, [&] { return way.turned_after(*problem.fingers[which].length); });
  };
  const ContactWay a = way_of(0);
  const ContactWay b = way_of(1);
  const double goal_a = goal_of(a, 0);
  // y at the end; nothing: free
  std::optional<double> goal_b;
  if (problem.fingers[1].length) goal_b = goal_of(b, 1);
  // Judged at the first contacts, and kept for the whole roll.
  making.plan.expanding = presses_apart(a.places({0}).front(), b.places({0}).front());
  if (goal_b) {
    const FoundPath even = even_path(a, goal_a, &b, *goal_b);
    const RollPath path(a, &b, even.knots, even.turned);
    look_at_path(making, path);
    // Without a roll of a there are no columns to search on: the even path is the answer, whatever fails.
    if (goal_a == 0 || (!fails(making.looked) && making.plan.decided)) return finish(making, path);
  }
  const bool expanding = making.plan.expanding;
  Interval range = range_of(problem, b, making.reaches[1]);
  // The goal belongs to the range even where the reach would leave it out: the check then says why it fails.
  if (goal_b) range = {std::min(range.lo, *goal_b), std::max(range.hi, *goal_b)};
  const FoundPath found =
      widest_path({&a, &b, goal_a, goal_b, range, [&](const ContactPlace& one, const ContactPlace& two) {
                     return margin_between(problem, expanding, one, two);
                   }});
  const RollPath path(a, &b, found.knots, found.turned);
  making.plan.path = PlanPath::searched;
  look_at_path(making, path);
  finish(making, path);
}

/// The y at which the wheel is in balance at its start. Throws InputError where there is none, or several to choose
/// from.
double balance_at(const PlanProblem& problem, const ContactWay& a, const ContactWay& b, const Interval& range) {
  // Those that hold: within finger a's cone, stable, and each place of the part once.
  std::vector<double> good;
  const ContactPlace first = a.places({0}).front();
  const std::vector<double> all = balances(a, b, range);
  const std::vector<ContactPlace> places = b.places(all);
  std::string names;
  for (std::size_t k = 0; k < all.size(); ++k) {
    // Where finger a's friction holds the force and the part does not roll out.
    const bool holds = std::abs(squeeze_of(first, places[k], false).at_a) <= cone_of(problem.fingers[0]) &&
                       stability_of(a, b, {0, first, places[k]}) > 0;
    // The same place of the part on another lap.
    const bool is_told = std::any_of(good.begin(), good.end(), [&](double y) {
      return problem.part.distance(b.places({y}).front().s, places[k].s) <= kSamePlace * problem.part.perimeter();
    });
    if (!holds || is_told) continue;
    good.push_back(all[k]);
    // for the message, as places of the first lap
    names += fmt::format("{}{:.9g}", names.empty() ? "" : ", ", problem.part.boundary().on_first_lap(places[k].s));
  }
  const std::string none = fmt::format(
      "squeezed between {} at s = {:.9g} and a wheel, the part is in balance nowhere: there is no wheel's place that "
      "friction and stability allow; start finger a elsewhere",
      name_of_finger(problem, 0), *problem.fingers[0].start);
  if (!problem.fingers[1].start) {
    if (good.empty()) throw InputError(none);
    // More than one: the user has to choose, from the list.
    if (good.size() == 1) return good.front();
    throw InputError(
        fmt::format("the wheel can be in balance at several places, t = {}: give one as its start", names));
  }
  // With a start: the nearest balance, if it is within kSettling; what is typed is rounded.
  if (all.empty()) throw InputError(none);
  const double start = b.places({0}).front().s;
  // how far a balance is from the start that was given, along the part
  const auto off = [&](double y) { return std::abs(b.places({y}).front().s - start); };
  const double nearest =
      *std::min_element(all.begin(), all.end(), [&](double one, double two) { return off(one) < off(two); });
  if (off(nearest) <= kSettling * problem.part.perimeter()) return nearest;
  throw InputError(
      fmt::format("a wheel at t = {:.9g} is not in balance: its force misses the contact of finger a, and the part "
                  "would roll until it does not{}",
                  start, names.empty() ? "; start finger a elsewhere" : ": give as its start t = " + names));
}

/// Finger a and a wheel: the wheel's first contact is where it is in balance, and its way what keeps it so.
void plan_beside_wheel(Making& making) {
  PlanProblem problem = making.problem;
  const ContactWay a =
      about(problem, 0, [&] { return ContactWay(problem.part, problem.fingers[0], problem.pose.heading); });
  const double goal_a = about(problem, 0, [&] { return a.turned_after(*problem.fingers[0].length); });
  const PlanFinger& wheel = problem.fingers[1];
  PlanFinger from = wheel;
  // Where none is given any place will do to begin with: one that the wheel reaches.
  if (!from.start) from.start = making.reaches[1]->arcs.empty() ? 0 : making.reaches[1]->arcs.front().middle();
  const auto way_of = [&] {
    return about(problem, 1, [&] { return ContactWay(problem.part, from, problem.pose.heading); });
  };
  // A second way, from the balance itself: turns y count from a finger's first contact.
  if (!wheel.start) {
    const ContactWay any = way_of();
    from.start = any.places({balance_at(problem, a, any, range_of(problem, any, making.reaches[1]))}).front().s;
    problem.fingers[1].start = from.start;
  }
  // From the wheel's start, given or found: y = 0 is there.
  const ContactWay b = way_of();
  const Interval range = range_of(problem, b, making.reaches[1]);
  // Near 0: off by what a given start is rounded by.
  const double start = balance_at(problem, a, b, range);
  const BalancedPath found = balanced_path(a, goal_a, b, start, range);
  making.plan.path = PlanPath::squeezed;
  // One knot is the start alone.
  if (found.path.knots.size() < 2) {
    throw InputError("the wheel turns back at once: squeezed, finger a can't roll from there this way; try the other");
  }
  const RollPath path(a, &b, found.path.knots, found.path.turned, true);
  look_at_path(making, path);
  // The path ends before the goal: a failure of its own, at the last knot.
  if (found.turns_back) {
    const PairPlace last = path.places({1}).front();
    Looked looked;
    looked.margin = {Condition::turns_back, 1, 0, 0, 0, 0, {last.a.s, last.b.s}, true, true};
    looked.at = 1;
    making.looked.push_back(looked);
  }
  finish(making, path);
}

/// What no condition has looked at, as phrases for the user.
std::vector<std::string> unchecked_of(const PlanProblem& problem) {
  std::vector<std::string> unchecked;
  for (const PlanFinger& finger : problem.fingers) {
    if (has_reach(finger.finger)) continue;
    unchecked.push_back(fmt::format("whether the finger {} would hit the part elsewhere", finger.finger.name()));
  }
  if (problem.fingers.size() == 1) return unchecked;
  const Finger& a = problem.fingers[0].finger;
  const Finger& b = problem.fingers[1].finger;
  if (a.is_jaw() && b.is_jaw() && !problem.may_overlap) {
    unchecked.emplace_back("whether the fingers hit each other: two jaws without ends always would");
  }
  return unchecked;
}

}  // namespace

}  // namespace rollfix::planning

namespace rollfix {

Plan solve(const PlanProblem& problem) {
  planning::require_valid(problem);
  // A part that lies face down is planned as the mirror shows it, and the plan is mirrored back.
  if (problem.mirrored) {
    const PlanProblem seen = planning::in_mirror(problem);
    Plan plan = solve(seen);
    planning::out_of_mirror(seen, plan);
    return plan;
  }
  planning::Making making{problem, planning::reaches_of(problem), {}, {}};
  making.plan.unchecked = planning::unchecked_of(problem);
  if (problem.fingers.size() == 1) {
    planning::plan_one(making);
  } else if (problem.fingers[1].wheel) {
    planning::plan_beside_wheel(making);
  } else {
    planning::plan_two(making);
  }
  return std::move(making.plan);
}

/// The reason why a roll can't be done, an InputError's message included; nothing: it can.
std::optional<std::string> plannable(const PlanProblem& problem) {
  try {
    const Plan plan = solve(problem);
    if (plan.feasible()) return std::nullopt;
    return verdict_text(plan, problem);
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace rollfix
