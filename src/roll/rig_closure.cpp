#include "roll/rig_closure.hpp"

#include <fmt/format.h>
#include <Eigen/LU>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "roll/motion.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

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
namespace rollfix::rolling {
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

}  // namespace rollfix
