#include "plan/planning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "rollfix/error.hpp"

// Notation, with x as in planning.hpp, y the same of finger b, and B as in planning.hpp:
//   lambda          along the path, from 0 to 1; knots lambda_k with turns x_k, y_k: `knots_`, `turned_`
//   m_k             slopes there, `slopes_`: the secants' weighted harmonic mean, 0 where they differ in sign
//   x(lambda)       cubic between two knots from its values and slopes; beside a wheel y solves B(x, y) = 0
// Follows F. N. Fritsch and J. Butland, "A method for constructing local monotone piecewise cubic interpolants" (1984);
// regula falsi with Illinois' correction: M. Dowell and P. Jarratt (1971). docs/plan.md, "How the motion is chosen".
// Idea: contacts are asked for many at a time, as a way is walked along once for all of them.
namespace rollfix::planning {
namespace {

// A step of a search is at most this share of a turn, of the perimeter, and of the way: then a margin can't change by
// more than some degrees, and the proof that follows halves what is left.
constexpr double kStepShare = 1.0 / 240;
// A side that is nearly flat takes steps of x that are ever smaller; beyond this nothing is gained.
constexpr int kMostHalvings = 12;

// B is known to no more than this, radians.
constexpr double kBalance = 4 * std::numeric_limits<double>::epsilon();
constexpr int kMostRounds = 100;
// Rates of a balanced wheel are differences over this share of the path: rounding and curvature are alike small.
constexpr double kDifference = 1e-5;

/// Fritsch and Butland's slope between two secants: 0 at a turn, else their weighted harmonic mean.
double slope_between(double before, double after, double width_before, double width_after) {
  if (before * after <= 0) return 0;
  // between 1/3 and 2/3
  const double weight = (1 + width_after / (width_before + width_after)) / 3;
  return before * after / (weight * after + (1 - weight) * before);
}

/// A slope at each knot; at both ends the secant's. None is more than three times a neighbouring secant, so that the
/// cubic between two knots is monotone.
std::vector<double> slopes_of(const std::vector<double>& knots, const std::vector<double>& values) {
  const std::size_t n = knots.size();
  std::vector<double> secants;
  for (std::size_t k = 1; k < n; ++k) secants.push_back((values[k] - values[k - 1]) / (knots[k] - knots[k - 1]));
  std::vector<double> slopes{secants.front()};
  for (std::size_t k = 1; k + 1 < n; ++k) {
    slopes.push_back(slope_between(secants[k - 1], secants[k], knots[k] - knots[k - 1], knots[k + 1] - knots[k]));
  }
  slopes.push_back(secants.back());
  return slopes;
}

/// B of each pair (x_k, y_k), radians.
std::vector<double> tilts(const ContactWay& b, const std::vector<ContactPlace>& at_a, const std::vector<double>& y) {
  const std::vector<ContactPlace> at_b = b.places(y);
  std::vector<double> tilts(y.size());
  for (std::size_t k = 0; k < y.size(); ++k) tilts[k] = squeeze_of(at_a[k], at_b[k], false).at_b;
  return tilts;
}

}  // namespace

/// The tangent, turned by a right angle: the material is on its left.
double ContactPlace::inward() const { return angle + std::numbers::pi / 2; }

double turn_between(const ContactPlace& one, const ContactPlace& two) {
  // Theta is x less what the finger's normal turns by. Both are monotone between the contacts, so that Theta changes by
  // the larger of the two at most.
  const double turned = two.turned - one.turned;
  return std::max(std::abs(turned), std::abs(turned - (two.angle - one.angle)));
}

/// `heading` is the part's: psi is taken against it, since a way is in the part's frame.
ContactWay::ContactWay(const Part& part, const PlanFinger& finger, double heading)
    : start_(*finger.start), psi_(finger.psi - heading), u_(finger.u) {
  if (!std::isfinite(start_)) throw InputError("expected a finite start of a roll");
  track_ = track_of(part, finger.finger, start_, u_);
  // On the first lap; the start lies on the stretch that the roll leaves on.
  const double base = part.closed() ? wrap(start_, part.perimeter()).base : start_;
  const int direction = finger.length.value_or(1) < 0 || (!part.closed() && base >= part.perimeter()) ? -1 : 1;
  from_start_.start = track_->place(base, direction);
  from_start_.start_angle = track_->turning(track_->stretch(from_start_.start.index), from_start_.start.s).angle;
  from_start_.first = track_->first_contact(from_start_.start, from_start_.start_angle, psi_);
  // So that times are turns x: states_of at time x has the contact after a turn by x.
  from_start_.velocity = 1;
}

/// The roll by this length of the contact. Throws InputError where the finger can't go on the way.
Motion ContactWay::motion(double length) const {
  RollPlan plan;
  plan.start = start_;
  plan.psi = psi_;
  plan.u = u_;
  plan.rows = 2;
  plan.distance = length;
  return plan_motion(*track_, plan);
}

/// x, with the sign of the roll.
double ContactWay::turned_after(double length) const {
  if (length == 0) return 0;
  const Motion there = motion(length);
  // rotation against the part, with its sign
  return there.velocity * there.duration;
}

/// By halving, to a small share of the perimeter: below it, so that the finger can go there.
double ContactWay::furthest(int direction, double most) const {
  // That the finger can't go there only an error says.
  const auto can = [&](double length) {
    try {
      turned_after(direction * length);
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  if (!(most > 0)) return 0;
  if (can(most)) return direction * most;
  double lo = 0;
  double hi = most;
  // It can go as far as `lo`, and not as far as `hi`.
  while (hi - lo > kStepShare * kStepShare * part().perimeter()) {
    const double middle = 0.5 * (lo + hi);
    (can(middle) ? lo : hi) = middle;
  }
  return direction * lo;
}

std::vector<ContactPlace> ContactWay::places(const std::vector<double>& turned) const {
  // in the order asked for
  const std::vector<RollState> states = states_of(*track_, from_start_, turned);
  std::vector<ContactPlace> places;
  places.reserve(turned.size());
  for (std::size_t k = 0; k < turned.size(); ++k) {
    const RollState& state = states[k];
    const Vec2 point = part().point(state.s);
    places.push_back(
        {turned[k], state.s, state.angle, state.contact, point, centre_of(finger(), point, state.contact)});
  }
  return places;
}

std::vector<double> ContactWay::nodes(double lo, double hi, std::size_t steps) const {
  if (!(hi > lo)) return {lo};
  // Even steps of x to begin with.
  const double most_turn = std::min(kStepShare * (2 * std::numbers::pi), (hi - lo) / static_cast<double>(steps));
  const auto count = static_cast<std::size_t>(std::ceil((hi - lo) / most_turn));
  std::vector<double> nodes;
  for (std::size_t k = 0; k <= count; ++k) {
    nodes.push_back(lo + (hi - lo) * (static_cast<double>(k) / static_cast<double>(count)));
  }
  // 0 is the first contact, where searches start.
  if (lo < 0 && hi > 0) nodes.insert(std::upper_bound(nodes.begin(), nodes.end(), 0.0), 0.0);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  // Then halved where s makes a long step: a flat side takes little x and much s.
  const double most_length = kStepShare * part().perimeter();
  for (int round = 0; round < kMostHalvings; ++round) {
    const std::vector<ContactPlace> there = places(nodes);
    // the nodes, and the middles of the long steps
    std::vector<double> finer{nodes.front()};
    // Each round halves the long steps of the round before.
    for (std::size_t k = 1; k < nodes.size(); ++k) {
      const double middle = 0.5 * (nodes[k - 1] + nodes[k]);
      const bool is_long = std::abs(there[k].s - there[k - 1].s) > most_length;
      // The middle of two neighbouring numbers is one of them: nothing is left to halve.
      if (is_long && middle > nodes[k - 1] && middle < nodes[k]) finer.push_back(middle);
      finer.push_back(nodes[k]);
    }
    if (finer.size() == nodes.size()) break;
    nodes = std::move(finer);
  }
  return nodes;
}

std::vector<double> balanced(const ContactWay& a, const ContactWay& b, const std::vector<double>& x,
                             std::vector<double> lo, std::vector<double> hi) {
  // x stays; only y is searched. All k go on together, since a way is walked once for all of them.
  const std::vector<ContactPlace> at_a = a.places(x);
  // REQUIRES that they differ in sign; a 0 at either end is the answer already.
  std::vector<double> f_lo = tilts(b, at_a, lo);
  std::vector<double> f_hi = tilts(b, at_a, hi);
  std::vector<double> y(x.size());
  for (int round = 0; round < kMostRounds; ++round) {
    bool is_done = true;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double width = hi[k] - lo[k];
      // The secant's zero, as a share of the bracket [lo, hi], in which B changes its sign.
      const double share = f_lo[k] == f_hi[k] ? 0.5 : std::clamp(f_lo[k] / (f_lo[k] - f_hi[k]), 0.0, 1.0);
      // Every third step halves: of a kink, where the secant creeps, it does not take long either.
      y[k] = f_lo[k] == 0 ? lo[k] : f_hi[k] == 0 ? hi[k] : lo[k] + (round % 3 == 2 ? 0.5 : share) * width;
      // a bracket as narrow as rounding allows
      is_done = is_done && (f_lo[k] == 0 || f_hi[k] == 0 || std::abs(width) <= kBalance * (1 + std::abs(lo[k])));
    }
    if (is_done) break;
    const std::vector<double> f = tilts(b, at_a, y);
    for (std::size_t k = 0; k < x.size(); ++k) {
      // Done: y is at the end where B = 0.
      if (f_lo[k] == 0 || f_hi[k] == 0) continue;
      if (std::abs(f[k]) <= kBalance) {
        lo[k] = hi[k] = y[k];
        f_lo[k] = f_hi[k] = 0;
      } else if (std::signbit(f[k]) == std::signbit(f_lo[k])) {
        // The root is beyond y: the bracket's lower end moves. Else the upper one.
        lo[k] = y[k];
        f_lo[k] = f[k];
        // Illinois: the end that stays counts half, so that it does not stay for ever.
        f_hi[k] *= 0.5;
      } else {
        hi[k] = y[k];
        f_hi[k] = f[k];
        f_lo[k] *= 0.5;
      }
    }
  }
  return y;
}

/// Each turn gets slopes of its own: monotone between neighbouring knots, with a continuous derivative.
RollPath::RollPath(const ContactWay& a, const ContactWay* b, std::vector<double> knots, std::vector<Turned> turned,
                   bool squeezed)
    : a_(&a), b_(b), knots_(std::move(knots)), turned_(std::move(turned)), squeezed_(squeezed) {
  std::vector<double> of_a;
  std::vector<double> of_b;
  for (const Turned& one : turned_) {
    of_a.push_back(one.a);
    of_b.push_back(one.b);
  }
  const std::vector<double> slopes_a = slopes_of(knots_, of_a);
  const std::vector<double> slopes_b = slopes_of(knots_, of_b);
  for (std::size_t k = 0; k < knots_.size(); ++k) slopes_.push_back({slopes_a[k], slopes_b[k]});
}

/// Hermite's cubic between two knots: values and slopes by lambda at both ends. `share`: 0 to 1 between them.
struct RollPath::Cubic {
  double from = 0;
  double to = 0;
  double slope_from = 0;
  double slope_to = 0;
  double width = 0;

  /// The cubic's value.
  double value(double share) const {
    const double rest = 1 - share;
    return rest * rest * ((1 + 2 * share) * from + share * width * slope_from) +
           share * share * ((1 + 2 * rest) * to - rest * width * slope_to);
  }
  /// d value / d lambda.
  double slope(double share) const {
    const double rest = 1 - share;
    return 6 * share * rest * (to - from) / width + rest * (1 - 3 * share) * slope_from +
           share * (3 * share - 2) * slope_to;
  }
};

/// Between two knots, and where in it a lambda is.
struct RollPath::Piece {
  Cubic a;
  Cubic b;
  double share = 0;
};

/// The piece that holds lambda. At an inner knot the one that begins there.
RollPath::Piece RollPath::piece_at(double lambda) const {
  const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, lambda);
  const auto k = static_cast<std::size_t>(next - knots_.begin()) - 1;
  const double width = knots_[k + 1] - knots_[k];
  return {{turned_[k].a, turned_[k + 1].a, slopes_[k].a, slopes_[k + 1].a, width},
          {turned_[k].b, turned_[k + 1].b, slopes_[k].b, slopes_[k + 1].b, width},
          (lambda - knots_[k]) / width};
}

/// x and y at these lambda. Beside a wheel y is not interpolated but balanced, between its values at both knots.
std::vector<Turned> RollPath::turned(const std::vector<double>& at) const {
  std::vector<Turned> turned;
  std::vector<double> x;
  std::vector<double> lo;
  std::vector<double> hi;
  for (const double lambda : at) {
    const Piece piece = piece_at(lambda);
    turned.push_back({piece.a.value(piece.share), piece.b.value(piece.share)});
    x.push_back(turned.back().a);
    lo.push_back(piece.b.from);
    hi.push_back(piece.b.to);
  }
  if (!squeezed_) return turned;
  const std::vector<double> y = balanced(*a_, *b_, x, lo, hi);
  for (std::size_t k = 0; k < y.size(); ++k) turned[k].b = y[k];
  return turned;
}

/// Both contacts at these lambda; of one finger b's are empty.
std::vector<PairPlace> RollPath::places(const std::vector<double>& at) const {
  const std::vector<Turned> there = turned(at);
  std::vector<double> x;
  std::vector<double> y;
  for (const Turned& one : there) {
    x.push_back(one.a);
    y.push_back(one.b);
  }
  const std::vector<ContactPlace> of_a = a_->places(x);
  const std::vector<ContactPlace> of_b = b_ != nullptr ? b_->places(y) : std::vector<ContactPlace>(at.size());
  std::vector<PairPlace> places;
  for (std::size_t k = 0; k < at.size(); ++k) places.push_back({at[k], of_a[k], of_b[k]});
  return places;
}

/// dx / dlambda and dy / dlambda. A balanced wheel's y is known by value only: its rate is a difference, one-sided at
/// both ends.
std::vector<Turned> RollPath::rates(const std::vector<double>& at) const {
  std::vector<Turned> rates;
  // lambda a little before and after, for the differences
  std::vector<double> before;
  std::vector<double> after;
  for (const double lambda : at) {
    const Piece piece = piece_at(lambda);
    rates.push_back({piece.a.slope(piece.share), piece.b.slope(piece.share)});
    // one-sided at the path's ends
    before.push_back(std::max(0.0, lambda - kDifference));
    after.push_back(std::min(1.0, lambda + kDifference));
  }
  if (!squeezed_) return rates;
  const std::vector<Turned> first = turned(before);
  const std::vector<Turned> last = turned(after);
  for (std::size_t k = 0; k < at.size(); ++k) rates[k].b = (last[k].b - first[k].b) / (after[k] - before[k]);
  return rates;
}

}  // namespace rollfix::planning
