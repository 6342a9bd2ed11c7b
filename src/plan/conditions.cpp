#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "finger/convex_body.hpp"
#include "plan/planning.hpp"
#include "rollfix/locate.hpp"

// Notation as in planning.hpp. Between two instants, each contact going one way, a bound of the stability takes each
// term's worst: curvatures are monotone on spirals, so that their ends and the joints between them are all that is
// looked at.
namespace rollfix::planning {
namespace {

/// Direction of a vector, radians.
double angle_of(const Vec2& vector) { return std::atan2(vector.y(), vector.x()); }

/// From one direction to another, in [-pi, pi].
double angle_between(double from, double to) { return std::remainder(to - from, 2 * std::numbers::pi); }

/// The part's outward normal.
Vec2 outward_at(const ContactPlace& place) { return {std::sin(place.angle), -std::cos(place.angle)}; }

/// The gap of a jaw and a disk: the jaw's surface is the tangent at its contact, its body outside of it.
double of_disk_and_jaw(const ContactPlace& jaw, const ContactPlace& disk, double radius) {
  return -(disk.centre - jaw.point).dot(outward_at(jaw)) - radius;
}

/// Of the finger's frame, in the part's.
Pose frame_at(const ContactPlace& place) { return {place.centre.x(), place.centre.y(), place.contact.psi}; }

/// What of a finger's body is farthest from where it touches, at most; how far a disk is, its centre tells.
double arm_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.outline()->closed() ? finger.outline()->perimeter() / 2 : finger.outline()->perimeter();
}

/// A finger that rolls turns about its contact, which is somewhere on it.
double moved(const Finger& finger, const ContactPlace& from, const ContactPlace& to) {
  return arm_of(finger) * std::abs(to.turned - from.turned);
}

/// Of a body seen from a jaw, which turns and goes along the part.
double change_at_jaw(const ContactPlace& jaw, const ContactPlace& next_jaw, const Finger& body,
                     const ContactPlace& from, const ContactPlace& to) {
  // The jaw's line turns by `turn` and its contact goes along the part by `along`; the body moves by `by`.
  const double turn = std::abs(next_jaw.turned - jaw.turned);
  const double along = std::abs(next_jaw.s - jaw.s);
  const double by = moved(body, from, to);
  const double away =
      body.is_disk() ? (from.centre - jaw.point).norm() : (from.point - jaw.point).norm() + arm_of(body);
  return (away + along + by) * turn + along * std::min(1.0, turn) + by;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void include(Interval& range, double value) {
  range.lo = std::min(range.lo, value);
  range.hi = std::max(range.hi, value);
}

/// What the curvature is between two places, ends and both sides of joints included; infinite above where there is a
/// convex corner. On a spiral it is monotone, so that its values at the ends are all that is needed.
Interval curvatures_between(const Part& part, double one, double other) {
  const double rounding = kLengthAccuracy * part.perimeter();
  const double lo = std::min(one, other) - rounding;
  const double hi = std::max(one, other) + rounding;
  const double P = part.perimeter();
  const double first_lap = part.closed() ? std::floor(lo / P) : 0;
  const double last_lap = part.closed() ? std::floor(hi / P) : 0;
  Interval range{kInfinite, -kInfinite};
  // On each lap that the way touches: the pieces of spirals in it.
  for (double lap = first_lap; lap <= last_lap; ++lap) {
    for (const Spiral& spiral : part.turning().spirals()) {
      const double from = std::max(lo - lap * P, spiral.lo);
      const double to = std::min(hi - lap * P, spiral.hi);
      if (from > to) continue;
      include(range, part.turning().on_spiral(spiral, from).curvature);
      include(range, part.turning().on_spiral(spiral, to).curvature);
    }
    for (const Corner& corner : part.corners()) {
      const double at = corner.s + lap * P;
      // On a corner's pivot the curvature is infinite, and Theta turns while s stays.
      if (corner.turn >= kJointTurn && lo <= at && at <= hi) range.hi = kInfinite;
    }
  }
  return range;
}

/// The finger's own curvature between two contacts: constant of a disk or a jaw.
Interval finger_curvatures(const ContactWay& way, const ContactPlace& one, const ContactPlace& two) {
  const Part* const outline = way.finger().outline();
  if (outline != nullptr) return curvatures_between(*outline, one.contact.u, two.contact.u);
  const double curvature = way.finger_curvature(one);
  return {curvature, curvature};
}

/// w of planning.hpp
double share_of(double bend, double distance, double radius) { return 1 / (1 + bend * (distance + radius)); }

/// The least b: it falls with kappa.
double least_bent(double kappa, const Interval& distance, double radius) {
  // The limit at a corner.
  if (std::isinf(kappa)) return -distance.hi / radius;
  return (1 - kappa * (kappa > 0 ? distance.hi : distance.lo)) / (1 + radius * kappa);
}

}  // namespace

/// A and B of planning.hpp: the line through both contacts against each inward normal.
Squeeze squeeze_of(const ContactPlace& a, const ContactPlace& b, bool expanding) {
  // Two fingers at one place press nothing together: as if they pulled.
  if (a.point == b.point) return {std::numbers::pi, std::numbers::pi, 0};
  const Vec2 to_b = expanding ? Vec2(a.point - b.point) : Vec2(b.point - a.point);
  const double line = angle_of(to_b);
  // The way from b to a is opposite to that from a to b.
  return {angle_between(a.inward(), line), angle_between(b.inward(), line + std::numbers::pi), to_b.norm()};
}

/// Exact for disks and a jaw; of outlines by the distance of convex bodies.
std::optional<double> gap_between(const Finger& finger_a, const ContactPlace& a, const Finger& finger_b,
                                  const ContactPlace& b, double enough) {
  if (finger_a.is_jaw() && finger_b.is_jaw()) return std::nullopt;
  if (finger_a.is_disk() && finger_b.is_disk()) {
    return (a.centre - b.centre).norm() - finger_a.disk()->radius - finger_b.disk()->radius;
  }
  if (finger_a.is_jaw() && finger_b.is_disk()) return of_disk_and_jaw(a, b, finger_b.disk()->radius);
  if (finger_a.is_disk() && finger_b.is_jaw()) return of_disk_and_jaw(b, a, finger_a.disk()->radius);
  const ConvexBody of_a(finger_a, frame_at(a));
  const ConvexBody of_b(finger_b, frame_at(b));
  // A jaw and an outline: minus how deep the outline is beyond the jaw's line.
  if (finger_a.is_jaw()) return -depth_of_overlap(frame_at(a), of_b);
  if (finger_b.is_jaw()) return -depth_of_overlap(frame_at(b), of_a);
  // A lower bound of the distance, from one direction alone: mostly that is enough.
  const double straight = -depth_along(of_a, of_b, angle_of(b.point - a.point));
  return straight >= enough ? straight : distance_between(of_a, of_b, enough);
}

double gap_change(const Finger& finger_a, const ContactPlace& a, const ContactPlace& next_a, const Finger& finger_b,
                  const ContactPlace& b, const ContactPlace& next_b) {
  if (finger_a.is_jaw() && finger_b.is_jaw()) return 0;
  // A jaw has no end: how far its line moves grows with the distance from its contact.
  if (finger_a.is_jaw()) return change_at_jaw(a, next_a, finger_b, b, next_b);
  if (finger_b.is_jaw()) return change_at_jaw(b, next_b, finger_a, a, next_a);
  // The distance of two bodies changes by what their points move, at most.
  return moved(finger_a, a, next_a) + moved(finger_b, b, next_b);
}

double size_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.is_jaw() ? 0 : finger.outline()->perimeter() / (2 * std::numbers::pi);
}

double stability_of(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& place) {
  return stability_between(way_a, way_b, place, place);
}

double stability_between(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& one, const PairPlace& two) {
  const double r = way_b.finger().disk()->radius;
  // D
  const auto distance_of = [](const PairPlace& place) { return (place.b.point - place.a.point).norm(); };
  // Both contacts together go by `moved`, and the contacts' distance changes by no more, from either instant.
  const double moved = std::abs(two.a.s - one.a.s) + std::abs(two.b.s - one.b.s);
  const Interval distance{std::max({distance_of(one), distance_of(two)}) - moved,
                          std::min({distance_of(one), distance_of(two)}) + moved};
  // No bound: the caller halves the interval.
  if (distance.lo <= 0) return -kInfinite;
  const auto across_of = [](const PairPlace& place) { return std::abs(std::cos(place.b.angle - place.a.angle)); };
  // A lower bound of |cos d|, which changes by no more than d does.
  const double across =
      std::max(across_of(one), across_of(two)) - turn_between(one.a, two.a) - turn_between(one.b, two.b);
  // Bounds of the curvatures on the way: corners and joints on it included.
  const Interval kappa_s = curvatures_between(way_a.part(), one.a.s, two.a.s);
  // K is the sum of kappa_s and of_a
  const Interval of_a = finger_curvatures(way_a, one.a, two.a);
  const double kappa_t = curvatures_between(way_b.part(), one.b.s, two.b.s).hi;
  // A lower bound of b, at the largest kappa.
  const double bent = least_bent(kappa_t, distance, r);
  // w |cos d| + (1 - w) b is linear in w: its least value is at the least or at the largest w. K is at least 0.
  double least = kInfinite;
  for (const double share : {share_of(kappa_s.hi + of_a.hi, distance.hi, r),
                             share_of(std::max(0.0, kappa_s.lo + of_a.lo), distance.lo, r)}) {
    least = std::min(least, share * across + (1 - share) * bent);
  }
  return least;
}

// ---- conditions
// Notation:
//   A, B, D, p, q     planning.hpp
//   v                 the most that something can change between two instants: `change_between`
// Between two instants x, y, s and t are monotone. So p moves by ds at most, q by dt, and the line through both turns
// by asin((ds + dt) / D) at most. Theta = x - N with N, the turn of the finger's normal, monotone as well: it changes
// by dx or dN at most. A disk's centre moves by r dx, any point of a body by dx times how far it is from the contact.
// What is left at an instant, less v, is left all the way to the
// next; where that is not enough, the interval is halved.

namespace {

constexpr std::size_t kConditions = 4;  // friction of a, of b, apart, and stable
constexpr std::size_t kStable = 3;
// of these four, in this order: radians, radians, a length, and stability, which has no unit
using Values = std::array<double, kConditions>;
constexpr std::size_t kMostInstants = 200000;  // before it is left undecided
constexpr int kWorstRounds = 12;               // of halving about the worst instant
constexpr double kNone = std::numeric_limits<double>::infinity();

struct Instant {
  PairPlace place;
  Squeeze squeeze;
  Values left{kNone, kNone, kNone, kNone};  // above what is asked for
};

/// Looks at a path, closer and closer.
class Looker {
 public:
  Looker(const PlanProblem& problem, const RollPath& path, bool expanding)
      : problem_(problem), path_(path), expanding_(expanding) {
    add(path.knots());
  }

  /// Proves that something is left everywhere, or finds where it is not. Whether it could.
  /// False where kMostInstants are not enough: a margin is then near 0.
  bool prove() {
    // At each turn: all intervals before the first failing instant that are not proved are halved.
    while (true) {
      std::vector<double> halves;
      for (std::size_t k = 1; k < instants_.size(); ++k) {
        if (fails(instants_[k - 1]) || fails(instants_[k])) break;  // before it all is proved: that is the first
        if (!is_proved(k)) halves.push_back(0.5 * (instants_[k - 1].place.at + instants_[k].place.at));
      }
      // Everything is proved, up to the first instant that fails if there is one.
      if (halves.empty()) return true;
      if (instants_.size() + halves.size() > kMostInstants) return false;
      add(halves);
    }
  }

  /// Closer instants about the worst of each condition.
  void sharpen() {
    // Both neighbouring intervals of the worst instant, again and again: its place to a small share of the interval.
    for (std::size_t c = 0; c < kConditions; ++c) {
      for (int round = 0; round < kWorstRounds; ++round) {
        const std::size_t k = worst(c);
        std::vector<double> halves;
        if (k > 0) halves.push_back(0.5 * (instants_[k - 1].place.at + instants_[k].place.at));
        if (k + 1 < instants_.size()) halves.push_back(0.5 * (instants_[k].place.at + instants_[k + 1].place.at));
        add(halves);
      }
    }
  }

  /// Index of the instant with the least left of a condition.
  std::size_t worst(std::size_t condition) const {
    const auto least = std::min_element(
        instants_.begin(), instants_.end(),
        [&](const Instant& one, const Instant& two) { return one.left[condition] < two.left[condition]; });
    return static_cast<std::size_t>(least - instants_.begin());
  }

  /// The first instant at which this condition fails, or the worst.
  const Instant& telling(std::size_t condition) const {
    const auto first =
        std::find_if(instants_.begin(), instants_.end(), [&](const Instant& one) { return one.left[condition] < 0; });
    return first != instants_.end() ? *first : instants_[worst(condition)];
  }
  const std::vector<Instant>& instants() const { return instants_; }

 private:
  /// Any condition is below what is asked for.
  static bool fails(const Instant& instant) {
    return std::any_of(instant.left.begin(), instant.left.end(), [](double left) { return left < 0; });
  }

  /// Looks at these lambda too. The instants stay in order, each once.
  void add(const std::vector<double>& at) {
    for (const PairPlace& place : path_.places(at)) instants_.push_back(seen(place));
    std::sort(instants_.begin(), instants_.end(),
              [](const Instant& one, const Instant& two) { return one.place.at < two.place.at; });
    const auto is_same = [](const Instant& one, const Instant& two) { return one.place.at == two.place.at; };
    instants_.erase(std::unique(instants_.begin(), instants_.end(), is_same), instants_.end());
  }

  /// What is left of each condition at one instant; infinite where it is not asked for.
  Instant seen(const PairPlace& place) const {
    Instant instant{place, squeeze_of(place.a, place.b, expanding_), {kNone, kNone, kNone, kNone}};
    instant.left[0] = cone_of(problem_.fingers[0]) - std::abs(instant.squeeze.at_a) - problem_.margin;
    // A wheel has no friction of its own: its force goes through the pin, B = 0.
    if (!path_.squeezed()) {
      instant.left[1] = cone_of(problem_.fingers[1]) - std::abs(instant.squeeze.at_b) - problem_.margin;
    }
    if (path_.squeezed()) instant.left[kStable] = stability_of(path_.way_a(), *path_.way_b(), place);
    if (problem_.may_overlap) return instant;
    // nothing of two jaws
    const auto gap = gap_between(path_.way_a().finger(), place.a, path_.way_b()->finger(), place.b);
    if (gap) instant.left[2] = *gap - problem_.clearance;
    return instant;
  }

  /// Whether all conditions hold between instant k - 1 and k: of one of both more is left than can be lost on the way.
  bool is_proved(std::size_t k) const {
    const Instant& one = instants_[k - 1];
    const Instant& two = instants_[k];
    const Values change = change_between(one, two);
    for (std::size_t c = 0; c < kStable; ++c) {
      if (!(std::max(one.left[c], two.left[c]) - change[c] >= 0)) return false;
    }
    return !path_.squeezed() || stability_between(path_.way_a(), *path_.way_b(), one.place, two.place) > 0;
  }

  /// v of each condition. The line through the contacts turns by `line` at most, and each normal by turn_between.
  Values change_between(const Instant& one, const Instant& two) const {
    const ContactPlace& a = one.place.a;
    const ContactPlace& b = one.place.b;
    const double ds = std::abs(two.place.a.s - a.s);
    const double dt = std::abs(two.place.b.s - b.s);
    const double share = (ds + dt) / std::min(one.squeeze.distance, two.squeeze.distance);
    const double line = share < 1 ? std::asin(share) : std::numbers::pi;
    // what the distance can change by, length
    const double gap = problem_.may_overlap ? 0
                                            : gap_change(path_.way_a().finger(), a, two.place.a,
                                                         path_.way_b()->finger(), b, two.place.b);
    return {line + turn_between(a, two.place.a), line + turn_between(b, two.place.b), gap, 0};
  }

  const PlanProblem& problem_;
  const RollPath& path_;
  /// the fingers press apart
  bool expanding_;
  /// in order of lambda
  std::vector<Instant> instants_;
};

/// A condition's result without time and row, which follow from the motion.
Looked looked_at(Condition condition, std::size_t finger, double value, double allowed, const PairPlace& place,
                 bool fails) {
  Looked looked;
  looked.margin = {condition, finger, value, allowed, 0, 0, {place.a.s, place.b.s}, fails, false};
  looked.at = place.at;
  return looked;
}

/// Of finger a (0) or b (1).
const ContactPlace& of(const PairPlace& place, std::size_t which) { return which == 0 ? place.a : place.b; }

}  // namespace

double cone_of(const PlanFinger& finger) {
  if (finger.wheel) return 0;
  return finger.friction ? std::atan(*finger.friction) : 0.5 * std::numbers::pi;
}

SqueezeLook look_at_squeeze(const PlanProblem& problem, const RollPath& path, bool expanding) {
  Looker looker(problem, path, expanding);
  SqueezeLook look;
  look.decided = looker.prove();
  looker.sharpen();
  // the largest angles of the force, from which the friction that is needed follows
  look.tilt = PerFinger<double>::of(2);
  for (const Instant& instant : looker.instants()) {
    look.tilt[0] = std::max(look.tilt[0], std::abs(instant.squeeze.at_a));
    if (!path.squeezed()) look.tilt[1] = std::max(look.tilt[1], std::abs(instant.squeeze.at_b));
  }
  const std::array<Condition, kConditions> conditions{Condition::friction, Condition::friction, Condition::apart,
                                                      Condition::stable};
  // Each condition that is asked for: what is left where it is worst, and if it fails, the place where it first does.
  for (std::size_t c = 0; c < kConditions; ++c) {
    const Instant& worst = looker.instants()[looker.worst(c)];
    if (std::isinf(worst.left[c])) continue;
    const bool fails = worst.left[c] < 0;
    // friction of b, and the balance on the wheel, are finger b's; the rest is told of finger a
    const std::size_t finger = c == 1 || c == kStable ? 1 : 0;
    const bool is_friction = conditions[c] == Condition::friction;
    // `left` counts from what is asked for, the value that is reported from 0.
    const double asked = is_friction ? problem.margin : c == kStable ? 0 : problem.clearance;
    const Instant& told = fails ? looker.telling(c) : worst;
    look.looked.push_back(looked_at(conditions[c], finger, worst.left[c] + asked,
                                    is_friction ? cone_of(problem.fingers[finger]) : 0, told.place, fails));
    look.looked.back().margin.proved = look.decided && !fails;
  }
  return look;
}

/// The rolled interval as a whole: what of it finger `which` cannot reach. The reach itself is proved, docs/reach.md.
std::optional<Looked> look_at_reach(const Reach& reach, const RollPath& path, std::size_t which) {
  const Part& part = path.way_a().part();
  const std::vector<PairPlace> places = path.places(path.knots());
  const double start = of(places.front(), which).s;
  // how far the contact goes back and on from its start
  Interval roll;
  for (const PairPlace& place : places) {
    roll.lo = std::min(roll.lo, of(place, which).s - start);
    roll.hi = std::max(roll.hi, of(place, which).s - start);
  }
  const auto obstruction = obstruction_of(part, reach, start, roll);
  if (!obstruction) return std::nullopt;
  // Of the knots the one that is nearest to the obstacle.
  const auto met = std::min_element(places.begin(), places.end(), [&](const PairPlace& one, const PairPlace& two) {
    return part.distance(of(one, which).s, obstruction->s) < part.distance(of(two, which).s, obstruction->s);
  });
  Looked looked = looked_at(Condition::reach, which, -obstruction->hit.depth, 0, *met, true);
  looked.margin.proved = true;
  return looked;
}

}  // namespace rollfix::planning
