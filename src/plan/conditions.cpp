#include "plan/conditions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "plan/squeeze.hpp"
#include "rollfix/locate.hpp"

// Notation:
//   A, B, D, p, q     squeeze.hpp
//   v                 the most that something can change between two instants: `change_between`
// Between two instants x, y, s and t are monotone. So p moves by ds at most, q by dt, and the line through both turns
// by asin((ds + dt) / D) at most. Theta = x - N with N, the turn of the finger's normal, monotone as well: it changes
// by dx or dN at most. A disk's centre moves by r dx, any point of a body by dx times how far it is from the contact.
// What is left at an instant, less v, is left all the way to the
// next; where that is not enough, the interval is halved.
namespace rollfix::planning {
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
