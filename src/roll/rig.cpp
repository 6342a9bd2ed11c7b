#include <fmt/format.h>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "log/wrapping.hpp"
#include "roll/motion.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::rolling {

/// What holds of a rig at one instant, and how it changes with both fingers' rotations against the part.
struct RigState {
  Vec2 rotations = Vec2::Zero();
  Walked jaw;
  Walked wheel;
  double u = 0;                                     // where on the jaw the contact is
  Vec2 pin = Vec2::Zero();                          // in the jaw's frame
  Vec2 value = Vec2::Zero();                        // what the plan says: the pin; of a squeezed rig its x, and g
  Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();  // of the value, per rotation of the jaw and of the wheel
  double margin = 0;  // length: g, whose sign stays; of a squeezed rig how stable it is, which stays above 0
};

/// The two contacts of a rig and what they say about the pin.
class RigClosure {
 public:
  /// At the start; `displacement`: the first motion of the pin, which says on which side of a corner it is. Throws
  /// InputError where a finger can't be.
  RigClosure(const Part& part, const RigPlan& plan, const Vec2& displacement);

  const RigState& first() const { return first_; }
  const Track& jaw() const { return *jaw_; }
  const Track& wheel() const { return *wheel_; }
  /// Of lengths that are small: the part's size and the wheel's.
  double size() const { return size_; }

  /// When the fingers have turned against the part by so much. Throws InputError where one of them can't.
  RigState at(const Vec2& rotations);

 private:
  RigState state(const Walked& jaw, const Walked& wheel) const;
  void start_walks(const Vec2& displacement);

  const Part& part_;
  const RigPlan& plan_;
  double size_;
  std::unique_ptr<Track> jaw_;
  std::unique_ptr<Track> wheel_;
  std::unique_ptr<Walk> jaw_walk_;
  std::unique_ptr<Walk> wheel_walk_;
  PerFinger<double> start_;  // on the first lap
  RigState first_;
};

// Notation:
//   s, Theta(s), T, n     the jaw's contact on the part, the tangent's angle there, the tangent, the outward normal
//   t                     the wheel's contact; c = p(t) + r n(t) is its centre, the pin
//   u                     the jaw's contact on the jaw: s + u stays
//   xi, eta               the pin in the jaw's frame: `pin`
//   a, b                  how far jaw and wheel have turned against the part: Theta(s), and Theta(t) + t / r
//   d                     Theta(t) - Theta(s)
//   g                     (p(t) - p(s)) . T(t): how far the wheel's normal passes by the jaw's contact
//   D                     (p(t) - p(s)) . n(t): where g = 0 the distance of the contacts
// In the jaw's frame the tangent at its contact is -x and the outward normal is y, so that
//   xi = u - (c - p(s)) . T(s),     eta = (c - p(s)) . n(s)                                        closure
//   d xi  = eta da - r cos d db,    d eta = (u - xi) da - r sin d db,    determinant r g
// By rotations the slopes have no curvature in them: a finger that pivots at a corner is like any other.
// A squeezed rig has g = 0 in place of the second equation, and its places are the zeros of g(s, t) in t:
//   dg = -cos d ds + dt - D dTheta(t),   stable iff |cos d| r ds/da + (D + r) dg/db > 0, which is the sign of d xi/db.

namespace {

/// T and n of the part where the tangent points to `angle`: the material is on the left, so that n is on the right.
Vec2 tangent_to(double angle) { return {std::cos(angle), std::sin(angle)}; }
Vec2 out_of_part(double angle) { return {std::sin(angle), -std::cos(angle)}; }
int sign_of(double value) { return value < 0 ? -1 : 1; }

// squeezed_places divides the boundary into this many equal steps. Two zeros of g in one step are missed.
constexpr int kSteps = 4000;

/// What a wheel at t, with the tangent just before or after it, says of a jaw at s.
class Opposite {
 public:
  Opposite(const Part& part, double radius, double s)
      : part_(part), radius_(radius), jaw_(part.turning().at(s)), point_(part.point(s)) {}

  /// g(s, t) of the wheel at t, length; 0 where its normal passes through the jaw's contact. At a corner with Theta
  /// just after it.
  double miss(double t) const {
    const double angle = part_.turning().angle(t);
    return (part_.point(t) - point_).dot(Vec2(std::cos(angle), std::sin(angle)));
  }

  /// On the far side, within reach of the jaw's normal, and stable.
  bool is_grip(double t) const {
    const Turning wheel = part_.turning().at(t);
    const double distance = (part_.point(t) - point_).dot(Vec2(std::sin(wheel.angle), -std::cos(wheel.angle)));
    const double cos_d = std::cos(wheel.angle - jaw_.angle);
    // The condition at the head of this file, times db / dt and kappa(s), with |cos d| = -cos d: docs/rolling.md,
    // "Squeezed".
    const double hold = -cos_d * (1 + radius_ * wheel.curvature) +
                        (1 - wheel.curvature * distance) * jaw_.curvature * (distance + radius_);
    return distance > 0 && cos_d < 0 && 1 + radius_ * wheel.curvature > 0 && jaw_.curvature > 0 && hold > 0;
  }

  /// The zero of g between two places at which its signs differ.
  double zero(double lo, double hi, double at_lo, double at_hi) const {
    std::uintmax_t iterations = 100;
    const boost::math::tools::eps_tolerance<double> full(std::numeric_limits<double>::digits);
    const auto bracket =
        boost::math::tools::toms748_solve([&](double t) { return miss(t); }, lo, hi, at_lo, at_hi, full, iterations);
    return std::abs(miss(bracket.first)) < std::abs(miss(bracket.second)) ? bracket.first : bracket.second;
  }

 private:
  const Part& part_;
  double radius_;
  Turning jaw_;
  Vec2 point_;
};

}  // namespace

RigClosure::RigClosure(const Part& part, const RigPlan& plan, const Vec2& displacement)
    : part_(part), plan_(plan), size_(part.perimeter() + plan.radius) {
  naming(kFingerNames[0], [&] { jaw_ = track_of(part, rollfix::jaw(), plan.start[0], plan.u); });
  naming(kFingerNames[1], [&] { wheel_ = track_of(part, disk(plan.radius), plan.start[1], {}); });
  for (const std::size_t k : {0U, 1U}) start_[k] = part.closed() ? part.boundary().base(plan.start[k]) : plan.start[k];
  start_walks(displacement);
}

/// Both walks from the first contacts on, to where the first motion leads.
void RigClosure::start_walks(const Vec2& displacement) {
  Walked s{start_[0], part_.turning().angle(start_[0]), 0};
  Walked t{start_[1], part_.turning().angle(start_[1]), 0};
  // As if it were smooth: of a corner this only says from which side it is left.
  s.per_rotation = 1 / part_.turning().curvature(start_[0]);
  t.per_rotation = 1 / (1 / plan_.radius + part_.turning().curvature(start_[1]));
  const Vec2 leads = state(s, t).slope.inverse() * Vec2(displacement.x(), plan_.squeezed ? 0 : displacement.y());
  // The stretch that lies ahead in the direction of the lead: of a corner the side on which the motion leaves it.
  const auto begin = [&](const Track& track, double start, double lead, Walked& first, std::unique_ptr<Walk>& walk) {
    const TrackPlace place = track.place(start, sign_of(lead));
    const Stretch stretch = track.stretch(place.index);
    walk = std::make_unique<Walk>(track, place.index);
    first = walk->to(track.rotation(stretch, place.s, track.turning(stretch, place.s).angle));
    return track.rotation(stretch, place.s, first.angle);
  };
  Vec2 rotations;
  naming(kFingerNames[0], [&] { rotations.x() = begin(*jaw_, start_[0], leads.x(), s, jaw_walk_); });
  naming(kFingerNames[1], [&] { rotations.y() = begin(*wheel_, start_[1], leads.y(), t, wheel_walk_); });
  // The contact that the walk has, so that s + u stays to the last bit.
  start_[0] = s.s;
  first_ = state(s, t);
  first_.rotations = rotations;
}

/// Both walks to these rotations, and what follows from them. Costs one Newton solution on each finger's stretch.
RigState RigClosure::at(const Vec2& rotations) {
  Walked s;
  Walked t;
  naming(kFingerNames[0], [&] { s = jaw_walk_->to(rotations.x()); });
  naming(kFingerNames[1], [&] { t = wheel_walk_->to(rotations.y()); });
  RigState result = state(s, t);
  result.rotations = rotations;
  return result;
}

/// The closure's equations and their derivatives of this file's head, from both contacts.
RigState RigClosure::state(const Walked& jaw, const Walked& wheel) const {
  const double r = plan_.radius;
  RigState result;
  result.jaw = jaw;
  result.wheel = wheel;
  result.u = plan_.u - (jaw.s - start_[0]);
  const Vec2 chord = part_.point(wheel.s) - part_.point(jaw.s);
  const Vec2 normal = out_of_part(wheel.angle);
  // c - p(s)
  const Vec2 to_pin = chord + r * normal;
  const double along = to_pin.dot(tangent_to(jaw.angle));
  const double eta = to_pin.dot(out_of_part(jaw.angle));
  const double miss = chord.dot(tangent_to(wheel.angle));  // g
  const double cos_d = std::cos(wheel.angle - jaw.angle);
  const double sin_d = std::sin(wheel.angle - jaw.angle);
  result.pin = {result.u - along, eta};
  result.value = result.pin;
  // d xi and d eta by (a, b); along = u - xi
  result.slope << eta, -r * cos_d, along, -r * sin_d;
  result.margin = miss;
  if (!plan_.squeezed) return result;
  const double distance = chord.dot(normal);  // D
  // dg / db, since dTheta(t) / db = 1 - (dt / db) / r
  const double miss_per_wheel = wheel.per_rotation - distance * (1 - wheel.per_rotation / r);
  result.value.y() = miss;
  result.slope.row(1) << -cos_d * jaw.per_rotation, miss_per_wheel;
  // above 0 where stable; over the size, so that it is a length as g is
  result.margin = (std::abs(cos_d) * r * jaw.per_rotation + (distance + r) * miss_per_wheel) / size_;
  return result;
}

}  // namespace rollfix::rolling

namespace rollfix {

std::vector<double> squeezed_places(const Part& part, double radius, double s) {
  require_valid(disk(radius));
  const double perimeter = part.perimeter();
  if (!std::isfinite(s) || (!part.closed() && !(s >= 0 && s <= perimeter))) {
    throw InputError(fmt::format("{}: expected a jaw's contact on the part, found s = {}", part.name(), s));
  }
  const rolling::Opposite opposite(part, radius, s);
  std::vector<double> places;
  double lo = 0;
  double at_lo = opposite.miss(lo);
  for (int k = 1; k <= rolling::kSteps; ++k) {
    const double hi = perimeter * k / rolling::kSteps;
    const double at_hi = opposite.miss(hi);
    if (at_lo == 0 && opposite.is_grip(lo)) places.push_back(lo);
    if (at_lo * at_hi < 0) {
      const double t = opposite.zero(lo, hi, at_lo, at_hi);
      // Across a corner g jumps, and has no zero.
      if (std::abs(opposite.miss(t)) <= 1e-9 * perimeter && opposite.is_grip(t)) places.push_back(t);
    }
    lo = hi;
    at_lo = at_hi;
  }
  return places;
}

// ---- the rig
// Notation, as in docs/rolling.md, "A jaw and a wheel on a pin", and above:
//   s, t            the jaw's and the wheel's contact on the part: `jaw.s`, `wheel.s`; r: the wheel's radius
//   (a, b)          how far jaw and wheel have turned against the part: `rotations`
//   (xi, eta)       the pin in the jaw's frame; squeezed (xi, g): `value`; D: their slopes by (a, b), `slope`
//   target          what the plan wants of the value at a time; lead: D^-1 (target - value)
//   g               how far the wheel's normal passes by the jaw's contact: `margin`, of a squeezed rig its stability
//   v               the wheel's contact angle on the wheel
// Idea: the pin's commanded place is two equations for how far both fingers have turned against the part (the closure,
// above). Newton's method solves them anew in every row, so that the contacts never drift apart; their
// derivatives only predict where it starts. What the last row was is followed in steps so short that the next solution
// lies where the prediction says: a solution further off would be another way to hold the part.

namespace {

// Newton's method gives up after so many steps.
constexpr int kMostIterations = 40;
// Of the part's size and the wheel's. Closed to less than the first, iterations that gain nothing any more are over;
// never is a row taken that is not closed to the second.
constexpr double kClosed = 1e-15;
constexpr double kLeastClosed = 1e-12;
// A solution is the same way to hold the part if it is no further from the prediction than this share of the step.
constexpr double kNear = 0.25;
// Both fingers may be over a tiny concave joint, and the one's moves the other.
constexpr double kFalls = 8;
// Rotations this small are rounding, radians.
constexpr double kRigRounding = 1e-11;
// Steps are halved down to this share of a row.
constexpr double kShortest = 1e-10;
// At the start, the margin as a share of the size: below it the pin's motion says nothing about the part's.
constexpr double kLeastMargin = 1e-6;
// A finger goes further than this, in sizes per radian, where it hardly fits: a reason to stop.
constexpr double kHardlyFits = 100;
// Of a squeezed rig: cosines this small between the wheel's normal and the jaw's are a reason to stop as well.
constexpr double kAlongJaw = 1e-3;
// A rig that stops with a larger margin than this, as a share of the size, does not stop because of it.
constexpr double kMarginGone = 1e-4;
// A joint lies ahead if so small a step, radians, changes what holds the part.
constexpr double kAhead = 1e-6;
// Contacts nearer to each other than this, as a share of the size, leave nothing between them.
constexpr double kNothingBetween = 1e-6;
// Of a squeezed rig's start: how far the wheel's normal may miss the jaw's contact, as a share of the size.
constexpr double kOnNormal = 1e-9;

/// Throws InputError for a number that is not finite.
void require_number(double value, const char* what) {
  if (!std::isfinite(value)) throw InputError(fmt::format("expected a finite {} of a rig, found {}", what, value));
}

/// Throws InputError for numbers out of range. Whether the pin can move as planned is found only by following it.
void require_consistent(const RigPlan& plan) {
  if (plan.start.size() != 2) throw InputError("expected two starts of a rig, the jaw's and the wheel's, found one");
  require_number(plan.start[0], "start of the jaw");
  require_number(plan.start[1], "start of the wheel");
  require_number(plan.u, "first contact on the jaw");
  require_number(plan.psi, "orientation psi of the wheel at the start");
  require_number(plan.pose.x + plan.pose.y + plan.pose.heading, "pose of the part at the start");
  if (!(plan.duration > 0 && std::isfinite(plan.duration))) {
    throw InputError(fmt::format("expected a duration of a rig's motion above 0, found {}", plan.duration));
  }
  if (!plan.pin) throw InputError("expected how the pin of a rig moves by time, found nothing");
  if (plan.rows < 2) throw InputError(fmt::format("expected at least 2 rows of a log, found {}", plan.rows));
  require_valid(disk(plan.radius));
}

/// The rig in motion.
class Course {
 public:
  Course(const Part& part, const RigPlan& plan, const std::vector<double>& times)
      : plan_(plan), times_(times), closure_(part, plan, first_displacement()), now_(closure_.first()) {
    start_value_ = now_.value;
    require_start(part);
    sign_ = now_.margin < 0 ? -1 : 1;
    fall_ = largest_fall();
  }

  /// The rig at the last row that was reached.
  const rolling::RigState& now() const { return now_; }
  const rolling::RigClosure& closure() const { return closure_; }

  /// On to the time of this row, in as many steps as it needs.
  void go_to(std::size_t row) {
    double from = times_[row - 1];
    const double whole = times_[row] - from;
    // At each turn `now_` is the rig at `from`, closed. A step that works is doubled, one that does not is halved.
    double step = whole;
    while (from < times_[row]) {
      const bool is_last = from + step >= times_[row];
      const double to = is_last ? times_[row] : from + step;
      if (const auto next = try_step(to)) {
        refusal_.clear();
        now_ = *next;
        from = to;
        step *= 2;
        continue;
      }
      step = (to - from) / 2;
      if (step < kShortest * whole) stop(row, from);
    }
  }

 private:
  /// How far the plan has the pin from its first place.
  Vec2 displacement(double time) const {
    Vec2 moved = plan_.pin(time) - plan_.pin(0);
    if (plan_.squeezed) moved.y() = 0;
    require_number(moved.x() + moved.y(), "motion of the pin");
    return moved;
  }

  /// The first motion of the pin that is not 0: the direction in which the rig leaves its start.
  Vec2 first_displacement() const {
    for (const double time : times_) {
      Vec2 moved = displacement(time);
      if (moved != Vec2::Zero()) return moved;
    }
    throw InputError(plan_.squeezed
                         ? "expected a pin that moves along the jaw, found one that stays: nothing would roll"
                         : "expected a pin that moves in the jaw's frame, found one that stays: nothing would roll");
  }

  /// What the value has to be at this time.
  Vec2 target(double time) const { return start_value_ + displacement(time); }

  /// Throws InputError where the closure does not say how the part moves: g = 0, where the determinant r g vanishes. Of
  /// a squeezed rig: a wheel's normal that misses the jaw's contact, a wheel that is not opposite, or a grip that is
  /// not stable.
  void require_start(const Part& part) {
    const std::string where = places_text();
    // Not squeezed: the determinant r g of the closure must not vanish.
    if (!plan_.squeezed) {
      if (std::abs(now_.margin) > kLeastMargin * closure_.size()) return;
      throw InputError(
          fmt::format("{}: at the start the wheel's normal passes through the jaw's contact ({}): the pin's "
                      "motion does not say how the part rolls; start the wheel elsewhere, or squeeze",
                      part.name(), where));
    }
    if (std::abs(now_.value.y()) > kOnNormal * closure_.size()) {
      throw InputError(
          fmt::format("{}: expected a squeezed wheel whose normal passes through the jaw's contact, found "
                      "one that passes by at {:.6g} ({}); squeezed_places finds where it does",
                      part.name(), std::abs(now_.value.y()), where));
    }
    // g at the start is rounding: from here on it is held at 0, so that the error does not go along.
    start_value_.y() = 0;
    // The wheel's normal points against the jaw's, and the pin is on the part's side of the jaw.
    const bool is_opposite = std::cos(now_.wheel.angle - now_.jaw.angle) < 0 && now_.pin.y() < 0;
    if (is_opposite && now_.margin > kLeastMargin * closure_.size()) return;
    throw InputError(
        fmt::format("{}: expected a stable grip, found one out of which the wheel's spring would turn the "
                    "part ({}); start elsewhere, or take another wheel",
                    part.name(), where));
  }

  /// Where both touch, on the first lap, for messages.
  std::string places_text() const {
    const Boundary boundary = closure_.jaw().part().boundary();
    return fmt::format("the jaw at s = {:.9g}, the wheel at {:.9g}", boundary.base(now_.jaw.s),
                       boundary.base(now_.wheel.s));
  }

  /// How far a row may be from closed. Where a finger hardly fits, a rotation's own rounding is a long way along the
  /// part, which matters to what is squeezed.
  double closed_to(const rolling::RigState& state) const {
    constexpr double kEpsilon = 8 * std::numeric_limits<double>::epsilon();
    const Vec2 rounding = kEpsilon * (Vec2::Ones() + state.rotations.cwiseAbs());
    const double off = plan_.squeezed ? rounding.dot(state.slope.row(1).cwiseAbs()) : 0;
    return kLeastClosed * closure_.size() + std::min(off, kOnNormal * closure_.size());
  }

  /// Over the tiny concave joints of a drawing the contact goes on by as far as the finger would have turned back, as a
  /// finger does that touches on both sides of one: so far from the prediction a solution may be, radians.
  double largest_fall() const {
    double most = 0;
    for (const Corner& corner : closure_.jaw().part().corners()) {
      if (corner.turn < 0 && !corner.is_concave()) most = std::max(most, -corner.turn);
    }
    return most;
  }

  /// The rig at this time if it can be followed there in one step.
  std::optional<rolling::RigState> try_step(double to) {
    const Vec2 wanted = target(to);
    // One step of Newton's method from where the rig is now: the prediction. A solution further away than `reach` would
    // be another way to hold the part.
    const Vec2 lead = now_.slope.inverse() * (wanted - now_.value);
    const double reach = kNear * lead.norm() + kRigRounding + kFalls * fall_;
    const Vec2 predicted = now_.rotations + lead;
    Vec2 rotations = predicted;
    double best = std::numeric_limits<double>::infinity();
    // the best so far: closest to the wanted value
    std::optional<rolling::RigState> found;
    for (int k = 0; k < kMostIterations; ++k) {
      if (!((rotations - predicted).norm() <= reach)) return std::nullopt;
      try {
        const rolling::RigState state = closure_.at(rotations);
        const double off = (state.value - wanted).norm();
        // It gets no closer. Whether that is close enough is checked below.
        if (!(off < best)) break;
        best = off;
        found = state;
        if (off <= kClosed * closure_.size()) break;
        rotations += state.slope.inverse() * (wanted - state.value);
      } catch (const InputError& error) {
        // A finger can't turn so far: for `stop` to say, if no shorter step works either.
        refusal_ = error.what();
        return std::nullopt;
      }
    }
    // The margin keeps its sign on one branch of solutions; it is 0 where two branches meet.
    return found && best <= closed_to(*found) && found->margin * sign_ > 0 ? found : std::nullopt;
  }

  /// Which finger hardly fits where it is, if one does, or that no jaw could take the force.
  std::string tightness_text() const {
    const Part& part = closure_.jaw().part();
    if ((part.point(now_.jaw.s) - part.point(now_.wheel.s)).norm() < kNothingBetween * closure_.size()) {
      return ": both touch it at one and the same place, and nothing of it is left between them";
    }
    if (plan_.squeezed && std::abs(std::cos(now_.wheel.angle - now_.jaw.angle)) < kAlongJaw) {
      return ": the wheel's force lies along the jaw, where no friction holds it";
    }
    if (now_.jaw.per_rotation > kHardlyFits * closure_.size()) {
      return fmt::format(": under the jaw the part is nearly flat, its curvature only {:.3g}",
                         1 / now_.jaw.per_rotation);
    }
    if (now_.wheel.per_rotation > kHardlyFits * closure_.size()) return ": the wheel hardly fits into the concavity";
    return "";
  }

  /// Whether the margin is gone, or is a little further on: at a joint of the part it jumps.
  bool is_margin_gone(std::size_t row) {
    if (std::abs(now_.margin) <= kMarginGone * closure_.size()) return true;
    const Vec2 lead = now_.slope.inverse() * (target(times_[row]) - now_.value);
    try {
      return closure_.at(now_.rotations + kAhead * lead.normalized()).margin * sign_ <= 0;
    } catch (const InputError&) {
      return false;
    }
  }

  /// Says why the rig can't go on.
  [[noreturn]] void stop(std::size_t row, double time) {
    const Vec2 moved = displacement(time);
    const std::string possible = plan_.squeezed ? fmt::format("{:.6g} along the jaw", moved.x())
                                                : fmt::format("({:.6g}, {:.6g})", moved.x(), moved.y());
    const std::string head = fmt::format("row {} of the log, at {:.6g} s: ", row + 1, time);
    // What can be said of the plan: how far the pin gets.
    const std::string cure = fmt::format("the pin can move by {}", possible);
    const std::string tightness = tightness_text();
    const bool is_gone = tightness.empty() && is_margin_gone(row);
    // A finger that can't go there is the reason, unless the margin is gone too.
    if (!is_gone && !refusal_.empty()) throw InputError(head + refusal_ + "; " + cure);
    if (!is_gone) {
      throw InputError(
          fmt::format("{}the rig can't be followed any further ({}){}; {}", head, places_text(), tightness, cure));
    }
    if (plan_.squeezed) {
      throw InputError(
          fmt::format("{}the grip is not stable any more ({}): the wheel's spring would turn the part out of "
                      "it; {}, the other way perhaps further",
                      head, places_text(), cure));
    }
    throw InputError(
        fmt::format("{}the wheel's normal passes through the jaw's contact ({}): from there on the pin's "
                    "motion does not say how the part rolls; {}; or start the wheel elsewhere, or squeeze",
                    head, places_text(), cure));
  }

  const RigPlan& plan_;
  const std::vector<double>& times_;
  rolling::RigClosure closure_;
  rolling::RigState now_;
  /// xi, eta at the start; squeezed xi, 0
  Vec2 start_value_ = Vec2::Zero();
  /// of the margin, the same as long as the rig can be followed
  double sign_ = 1;
  /// largest_fall(), radians
  double fall_ = 0;
  std::string refusal_;  // where a finger could not go there: why a step from here was impossible
};

/// Writes down what is in the world, row by row.
class Recorder {
 public:
  Recorder(const Part& part, const RigPlan& plan, const rolling::RigState& first)
      : part_(part), plan_(plan), first_(first) {
    // Of the jaw u is given and psi follows; of the wheel psi is given and v follows.
    const double tangent = first.jaw.angle + plan.pose.heading;
    const Contact on_jaw = contact_at(jaw(), tangent, plan.u);
    const Vec2 origin = centre_of(jaw(), plan.pose.world(part.point(first.jaw.s)), on_jaw);
    jaw_ = {origin.x(), origin.y(), on_jaw.psi};
    first_v_ = contact_on(first.wheel.angle + plan.pose.heading, plan.psi).u;
    roll_.log.name = "the rig on " + part.name();
    roll_.log.unit = part.unit();
    roll_.log.fingers.resize(2);
    roll_.s = roll_.angle = PerFinger<std::vector<double>>::of(2);
    roll_.log.fingers[0].u_period = jaw().period();
  }

  /// One row: the part, the wheel and the pin follow from the jaw's pose in the world and from both contacts.
  void add(double time, const rolling::RigState& state) {
    // What the jaw itself does in the world moves everything along and changes no contact.
    const Pose moved = plan_.jaw ? plan_.jaw(time) : Pose{};
    const Pose jaw_pose{jaw_.x + moved.x, jaw_.y + moved.y, jaw_.heading + moved.heading};
    // The jaw's normal N stays on the jaw: phi + Theta(s) turns with the jaw alone.
    Pose part{0, 0, plan_.pose.heading + moved.heading - (state.jaw.angle - first_.jaw.angle)};
    // The contacts coincide: (u, 0) of the jaw and p(s) of the part.
    const Vec2 origin = jaw_pose.world({state.u, 0}) - part.turned(part_.point(state.jaw.s));
    part.x = origin.x();
    part.y = origin.y();
    // rolling without slip: L = -r (v - v_0)
    const double v = first_v_ - (state.wheel.s - first_.wheel.s) / plan_.radius;
    // How far the tangent at the wheel has turned in the world. By eq. (3) that is the change of v plus that of psi.
    const double turned = state.wheel.angle - first_.wheel.angle + part.heading - plan_.pose.heading;
    const Contact on_wheel{v, plan_.psi + turned - (v - first_v_)};
    const Vec2 touched = part.world(part_.point(state.wheel.s));
    const Vec2 pin = centre_of(disk(plan_.radius), touched, on_wheel);
    roll_.log.time.push_back(time);
    add_row(0, {state.u, jaw_pose.heading}, {jaw_pose.x, jaw_pose.y}, state.jaw);
    add_row(1, on_wheel, pin, state.wheel);
    roll_.pose.push_back(part);
  }

  /// The finished roll. Throws InputError if its rows are so far apart that a reader would take u or psi as wrapped.
  Roll roll() {
    for (const FingerRows& rows : roll_.log.fingers) require_readable(rows, roll_.log.name);
    return std::move(roll_);
  }

 private:
  /// What finger k's sensors say, and where it touches.
  void add_row(std::size_t finger, const Contact& contact, const Vec2& centre, const Walked& place) {
    FingerRows& rows = roll_.log.fingers[finger];
    rows.u.push_back(contact.u);
    rows.psi.push_back(contact.psi);
    rows.x.push_back(centre.x());
    rows.y.push_back(centre.y());
    roll_.s[finger].push_back(place.s);
    roll_.angle[finger].push_back(place.angle);
  }

  const Part& part_;
  const RigPlan& plan_;
  rolling::RigState first_;
  /// of the jaw's frame in the world
  Pose jaw_;  // at the start
  /// v at the start, radians
  double first_v_ = 0;
  Roll roll_;
};

}  // namespace

/// Row by row from the start: each is solved anew, so that errors do not add up.
Roll roll_rig(const Part& part, const RigPlan& plan) {
  require_consistent(plan);
  std::vector<double> times(plan.rows);
  const auto last = static_cast<double>(plan.rows - 1);
  for (std::size_t k = 0; k < plan.rows; ++k) times[k] = plan.duration * (static_cast<double>(k) / last);
  Course course(part, plan, times);
  Recorder recorder(part, plan, course.now());
  recorder.add(0, course.now());
  for (std::size_t row = 1; row < plan.rows; ++row) {
    course.go_to(row);
    recorder.add(times[row], course.now());
  }
  return recorder.roll();
}

/// Leaves out what the wheel's sensors do not measure. The pin's x and y always stay.
Log sensed_by(WheelSensors sensors, Log log) {
  if (log.fingers.size() != 2) throw InputError("expected the log of a rig, of two fingers, found one of one finger");
  FingerRows& wheel = log.fingers[1];
  if (sensors != WheelSensors::skin) wheel.u.clear();
  if (sensors == WheelSensors::pin) wheel.psi.clear();
  return log;
}

}  // namespace rollfix
