#include "pair_boxes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "check.hpp"
#include "document.hpp"

// Notation:
//   F(s, t)         A(s) - B(t), the equations
//   line            t = t0 + w (s - s0), w = 1 or -1: `from_`, `way_`
//   (s', t)         on the line: `partner`
//   d/ds (A - B)    sum of weights (kappa(s + La_c) - w kappa(t + Lb_c)) along the line
// Follows docs/certificates.md, "Two fingers": the proof `family`.
// Idea: along the line the slope is a Taylor polynomial in s, whose coefficients cancel where the curves that both
// fingers roll on are the same. Beside it F(s, t) is F(s', t) plus the integral of A' from s' to s.
namespace rollfix_verify {
namespace {

constexpr int kLineDepth = 60;
// A line that goes round is begun at one of these shares of the perimeter, a stretch of it is halved at one of these
// shares: the next one where contacts can't be told from joints.
constexpr double kLineSplits[] = {0.4990234375, 0.5166015625, 0.4697265625, 0.27, 0.73, 0.13, 0.87};
// A line's places are no further than so many perimeters from the outline's first one.
constexpr double kFarthest = 4;

/// What smooth joints may add to an equation, at most.
Ball jumps_of(const std::vector<Ball>& weights, const std::vector<Ball>& jumps) {
  Ball sum = 0.0;
  for (std::size_t c = 0; c < weights.size(); ++c) sum = sum + abs(weights[c]) * abs(jumps[c]);
  return sum;
}

}  // namespace

/// Of slope 1 or -1 to kLengthSlack. Finger a moves ahead along it; a line as long as the perimeter goes round.
PairLine::PairLine(const Boundary& boundary, const std::array<std::vector<Ball>, 2>& lengths,
                   std::array<double, 2> from, std::array<double, 2> to)
    : boundary_(boundary), lengths_(lengths), period_(boundary.perimeter().middle()) {
  if (from[0] > to[0]) std::swap(from, to);
  const double slack = kLengthSlack * period_;
  const double length = to[0] - from[0];
  const double size = std::max({std::abs(from[0]), std::abs(from[1]), std::abs(to[0]), std::abs(to[1])});
  way_ = to[1] < from[1] ? -1 : 1;
  if (!(size <= kFarthest * period_ && length > slack && std::abs(std::abs(to[1] - from[1]) - length) <= slack)) {
    refuse("a family's line has no slope of 1 or -1");
  }
  is_round_ = boundary.closed() && length >= period_ - slack;
  from_ = from;
  to_ = to[0];
}

/// Whether finger b's place t is paired with one at s, within the slack.
bool PairLine::holds(double s, double t, double slack) const {
  const std::optional<Interval> found = partners({t, t}, {s, s}, slack);
  return found && Interval{s, s}.holds(*found, slack);
}

/// Finger a's first contacts that the line pairs with those of finger b, on the lap that is nearest to others. `slack`:
/// by which they may be beyond its ends.
std::optional<Interval> PairLine::partners(const Interval& of_b, const Interval& near, double slack) const {
  const double round = kRounding * period_;
  Interval found{partner(of_b.lo), partner(of_b.hi)};
  if (way_ < 0) std::swap(found.lo, found.hi);
  // By whole laps, so that the middle is nearest to another one.
  const auto move_to = [&](double middle) {
    const double lap = boundary_.closed() ? std::round((middle - 0.5 * (found.lo + found.hi)) / period_) : 0;
    found = {found.lo + lap * period_, found.hi + lap * period_};
  };
  // Next to the line itself first, for its ends; then next to the place that is asked about.
  move_to(0.5 * (from_[0] + to_));
  if (!is_round_ && !Interval{from_[0], to_}.holds(found, slack)) return std::nullopt;
  move_to(0.5 * (near.lo + near.hi));
  return Interval{found.lo - round, found.hi + round};
}

/// Both fingers' contacts are at the same places all along, so that what each equation is off by is its right side.
bool PairLine::is_same_for_both() const {
  if (way_ < 0 || from_[0] != from_[1]) return false;
  return std::equal(lengths_[0].begin(), lengths_[0].end(), lengths_[1].begin(),
                    [](const Ball& a, const Ball& b) { return abs(a - b).upper() == 0; });
}

/// All contacts of both fingers at the pair of the line that starts at s; nothing where one can't be told from a joint.
std::optional<PairLine::Row> PairLine::row(double s) const {
  Row result{s, {}};
  // Both first contacts: finger b's moves by w times what finger a's does.
  const std::array<Ball, 2> first = {s, Ball(from_[1]) + way_ * (Ball(s) - from_[0])};
  for (std::size_t finger = 0; finger < 2; ++finger) {
    for (const Ball& length : lengths_[finger]) {
      const std::optional<Place> place = boundary_.after(first[finger] + length);
      if (!place) return std::nullopt;
      result.contacts[finger].push_back(*place);
    }
  }
  return result;
}

/// Equal rolls from equal places: each equation is its right side, no computation is needed. Else by halves along the
/// line, a little beyond its ends.
bool PairLine::fits(const PairEquations& equations, double most) const {
  if (is_same_for_both()) {
    for (std::size_t k = 0; k < equations.count(); ++k) {
      const Ball& right = equations.all()[k].right;
      if (!(abs(equations.is_facing(k) ? to_nearest_turn(right) : right).upper() <= most)) return false;
    }
    return true;
  }
  if (!is_round_) {
    const double round = kRounding * period_;
    const std::optional<Row> from = row(from_[0] - round);
    const std::optional<Row> to = row(to_ + round);
    return from && to && fit(equations, *from, *to, most, 0);
  }
  // A line that goes round has no ends: it is begun where no contact is at a joint.
  for (const double share : kLineSplits) {
    const std::optional<Row> from = row(from_[0] + share * period_);
    const std::optional<Row> to = row(from_[0] + (1 + share) * period_ + kRounding * period_);
    if (from && to) return fit(equations, *from, *to, most, 0);
  }
  return false;
}

/// kappa of a contact as a series in the arc length that finger a moves ahead. Across joints only bounds on it.
Series PairLine::curvature(std::size_t finger, const Place& from, const Place& to) const {
  const bool is_back = finger == 1 && way_ < 0;
  if (from.curve != to.curve) {
    return curvatures(boundary_, is_back ? segments(boundary_, to, from) : segments(boundary_, from, to));
  }
  Series result = with_remainder(boundary_.curvature_ahead(from.curve, from.u),
                                 boundary_.curvature_ahead(from.curve, hull(from.u, to.u)), kOrder - 1);
  // Finger b moves backwards: odd powers of the way change their sign.
  for (slong power = 1; is_back && power < kOrder; power += 2) result.set(power, -result[power]);
  return result;
}

/// Each equation at the first row; how much it changes up to the second one at the most.
std::vector<Ball> PairLine::off(const PairEquations& equations, const Row& from, const Row& to) const {
  // From 0 to the length of this stretch.
  const Ball ahead = up_to(Ball(to.s) - from.s);
  std::array<Stretch, 2> at;
  std::array<std::vector<Series>, 2> bends;
  std::array<std::vector<Ball>, 2> turned;
  for (std::size_t finger = 0; finger < 2; ++finger) {
    // The first row as a place, for its angles.
    at[finger].pivot = true;
    for (std::size_t c = 0; c < lengths_[finger].size(); ++c) {
      const Place& first = from.contacts[finger][c];
      const Place& last = to.contacts[finger][c];
      const bool is_ahead = first.curve <= last.curve;
      at[finger].from.push_back(first.angle);
      bends[finger].push_back(curvature(finger, first, last));
      turned[finger].push_back(jumps(boundary_, segments(boundary_, is_ahead ? first : last, is_ahead ? last : first)));
    }
  }
  std::vector<Ball> result = equations.off(at[0], at[1]);
  for (std::size_t k = 0; k < equations.count(); ++k) {
    const std::vector<Ball>& weights = equations.all()[k].weights;
    Series slope;
    for (std::size_t c = 0; c < weights.size(); ++c) {
      // d(A - B)/ds: finger b's part with the direction in which it moves.
      slope = slope + Series(weights[c]) * (bends[0][c] - Series(way_) * bends[1][c]);
    }
    // Smooth joints may lie anywhere in between.
    const Ball jumped = jumps_of(weights, turned[0]) + jumps_of(weights, turned[1]);
    result[k] = result[k] + ahead * value(slope, ahead) + around_zero(jumped);
  }
  return result;
}

/// From row to row, or in both halves. A corner in between would move a finger's angles on their own.
bool PairLine::fit(const PairEquations& equations, const Row& from, const Row& to, double most, int depth) const {
  for (std::size_t finger = 0; finger < 2; ++finger) {
    for (std::size_t c = 0; c < lengths_[finger].size(); ++c) {
      const Place& first = from.contacts[finger][c];
      const Place& last = to.contacts[finger][c];
      if (has_corner(boundary_, first, last) || has_corner(boundary_, last, first)) return false;
    }
  }
  const std::vector<Ball> off = this->off(equations, from, to);
  if (std::all_of(off.begin(), off.end(), [&](const Ball& one) { return abs(one).upper() <= most; })) return true;
  if (depth == kLineDepth) return false;
  for (const double share : kLineSplits) {
    const std::optional<Row> middle = row(from.s + share * (to.s - from.s));
    if (!middle || !(middle->s > from.s && middle->s < to.s)) continue;
    return fit(equations, from, *middle, most, depth + 1) && fit(equations, *middle, to, most, depth + 1);
  }
  return false;
}

std::optional<Polygon> PairLine::beside(const FingerCurve& curve_a, const PairEquations& equations, const Stretch& a,
                                        const Stretch& b, double tolerance) const {
  // A pivot has no slope: nothing can be said beside the line.
  if (a.pivot || b.pivot) return std::nullopt;
  // s' of all t in stretch b; without it some t has no partner.
  const std::optional<Interval> pairs = partners({b.lo, b.hi}, {a.lo, a.hi}, kRounding * period_);
  if (!pairs) return std::nullopt;
  // The curvatures on all from s to s'.
  const std::optional<Stretch> all = curve_a.plain(std::min(a.lo, pairs->lo), std::max(a.hi, pairs->hi));
  if (!all) return std::nullopt;
  const double farthest = std::max({pairs->hi - a.lo, a.hi - pairs->lo, 0.0});
  double reach = farthest;  // from s to s', where all fits
  std::vector<Ball> slopes;
  std::vector<Ball> jumped;
  for (std::size_t k = 0; k < equations.count(); ++k) {
    slopes.push_back(weighted(equations.all()[k].weights, all->rate));
    jumped.push_back(jumps_of(equations.all()[k].weights, all->jump));
    if (!slopes[k].is_finite()) return std::nullopt;
    // Both ends are within the tolerance, so that the integral is at most twice that, and joints between.
    const Ball most = 2 * tolerance + jumped[k];
    const bool is_plain = !equations.is_facing(k) || (abs(slopes[k]) * farthest + most).is_below(0.5 * full_turn());
    // |s - s'| min |A'| <= most.
    if (is_plain && sign_of(slopes[k]) != 0) reach = std::min(reach, (most / abs(slopes[k])).upper());
  }
  for (std::size_t k = 0; k < equations.count(); ++k) {
    // All within reach must be near to fitting, for the sets of a placement are.
    if (!((abs(slopes[k]) * reach + tolerance + jumped[k]).upper() <= kNear * tolerance)) return std::nullopt;
  }
  const double at = (way_ < 0 ? pairs->hi : pairs->lo) - a.lo;
  const double most = reach + 2 * kRounding * period_;
  // The strip |s - s'(t)| <= reach, in shares of both stretches.
  Polygon set{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  set = clipped(set, at, {-a.width(), way_ * b.width()}, most);
  return clipped(set, -at, {a.width(), -way_ * b.width()}, most);
}

// ---- boxes ----
// Notation:
//   (s, t)          first contacts of finger a and of finger b
//   F(s, t)         A(s) - B(t), the equations: `equations_`
//   cover           text: `s` and `t` halve a box, and leaves follow: Leaf
//   stretch         first contacts of one finger between two cuts, where a contact comes to a corner: Stretch
// Follows docs/certificates.md, "Two fingers".
// Idea: each pair of two stretches of a box is proved by itself, by bounds on F there, or on both halves of the one
// that changes more.

namespace {

constexpr int kMostSplits = 200;
constexpr double kLeafWork = 0.1;  // in expansions
const std::string kLevels = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdef";

/// Reads the tree by recursive descent: `read` of a box reads its cell, or both of its halves.
class Reader {
 public:
  Reader(const std::string& text, const std::function<void(const Leaf&)>& use) : text_(text), use_(use) {}

  void read(const Box& box, int depth) {
    // Each node costs: a tree of any size ends.
    Budget::spend(kLeafWork);
    const char token = next();
    if (token == 's' || token == 't') {
      if (depth == kMostSplits) throw std::domain_error("its cells are halved too often");
      const std::size_t finger = token == 's' ? 0 : 1;
      // One double for both halves: they share their edge exactly.
      const double middle = box[finger].lo + 0.5 * box[finger].width();
      Box half = box;
      half[finger].hi = middle;
      read(half, depth + 1);
      half[finger] = {middle, box[finger].hi};
      read(half, depth + 1);
      return;
    }
    // `?` until something else is read.
    Leaf leaf{Leaf::unproved, box};
    if (token == '[') {
      leaf.kind = Leaf::placement;
      leaf.number = number();
    } else if (token != '?') {
      const std::size_t level = kLevels.find(token);
      if (level == std::string::npos) throw std::domain_error("its cells have an unknown letter");
      leaf.kind = Leaf::apart;
      // 2^-level.
      leaf.bound = std::ldexp(1.0, -static_cast<int>(level));
    }
    use_(leaf);
  }

  bool is_at_end() const { return at_ == text_.size(); }

 private:
  /// Throws std::domain_error at the end of the text.
  char next() {
    if (is_at_end()) throw std::domain_error("its cells do not cover everything");
    return text_[at_++];
  }

  /// The digits up to `]`.
  std::size_t number() {
    std::size_t value = 0;
    const char* const end = text_.data() + text_.size();
    const auto [behind, error] = std::from_chars(text_.data() + at_, end, value);
    if (error != std::errc() || behind == end || *behind != ']') {
      throw std::domain_error("its cells name a placement by no number");
    }
    at_ = static_cast<std::size_t>(behind - text_.data()) + 1;
    return value;
  }

  const std::string& text_;
  const std::function<void(const Leaf&)>& use_;
  std::size_t at_ = 0;
};

constexpr int kDeepest = 120;
constexpr std::size_t kMostPairs = 400000;  // of a box, before it is given up
constexpr std::size_t kMostParts = 24;      // of a box in which what may fit is looked for
constexpr std::size_t kMostBeside = 400;    // the same of a box by a line that fits, ...
constexpr int kDeepestBeside = 16;          // ... halved so often at the most

}  // namespace

/// The text must be one tree: so its leaves hold the whole box, without gaps.
void read_cover(const std::string& text, const Box& whole, const std::function<void(const Leaf&)>& use) {
  Reader reader(text, use);
  reader.read(whole, 0);
  if (!reader.is_at_end()) throw std::domain_error("its cells go on behind the last one");
}

/// Whether that is so of each pair of two stretches in a box.
template <class Is>
bool PairBoxes::all_of(const Box& box, Cuts cuts, const Is& is) {
  const std::vector<Stretch>& all_b = curves_[1].over(box[1].lo, box[1].hi, cuts);
  // Stretches are cached by finger: both lists stay valid here.
  for (const Stretch& a : curves_[0].over(box[0].lo, box[0].hi, cuts)) {
    for (const Stretch& b : all_b) {
      if (!is(a, b)) return false;
    }
  }
  return true;
}

/// Of the one on which the angles change more; nothing: on neither they do.
std::optional<PairBoxes::Halves> PairBoxes::halves(const Stretch& a, const Stretch& b) {
  // Radians.
  const double by_a = a.change();
  const double by_b = b.change();
  if (!(std::max(by_a, by_b) > 0)) return std::nullopt;
  if (by_a > by_b || (by_a == by_b && a.width() > b.width())) {
    // Of equal change the longer one.
    const auto& [first, second] = curves_[0].halved(a);
    return Halves{{{&first, &b}, {&second, &b}}};
  }
  const auto& [first, second] = curves_[1].halved(b);
  return Halves{{{&a, &first}, {&a, &second}}};
}

/// All pairs of stretches share one count of parts.
void PairBoxes::prove_apart(const Box& box, double bound) {
  std::size_t parts = 0;
  all_of(box, Cuts::corners, [&](const Stretch& a, const Stretch& b) {
    prove_apart(a, b, bound, 0, parts);
    return true;
  });
}

void PairBoxes::prove_apart(const Stretch& a, const Stretch& b, double bound, int depth, std::size_t& parts) {
  if (equations_.are_apart(a, b, bound)) return;
  // Not excluded as a whole: both halves must be.
  const std::optional<Halves> both = depth == kDeepest || ++parts > kMostPairs ? std::nullopt : halves(a, b);
  if (!both) refuse("it could not be proved near s = " + std::to_string(a.lo) + ", t = " + std::to_string(b.lo));
  for (const auto& [half_a, half_b] : *both) prove_apart(*half_a, *half_b, bound, depth + 1, parts);
}

/// Exactly one pair of stretches has one root; each other one is proved apart, or the answer is unknown.
PairBoxes::Roots PairBoxes::roots_in(const Box& box, double tolerance) {
  Roots result = Roots::unknown;
  std::size_t parts = 0;
  const auto is_the_only_one = [&](const Stretch& a, const Stretch& b) {
    if (!equations_.have_one_root(curves_[0], a, curves_[1], b, tolerance)) {
      // Throws where it can't be proved: then the answer is unknown.
      prove_apart(a, b, tolerance, 0, parts);
      return true;
    }
    // A second root.
    if (result != Roots::unknown) return false;
    result = a.pivot || b.pivot ? Roots::one_pivot : Roots::one;
    return true;
  };
  try {
    return all_of(box, Cuts::corners, is_the_only_one) ? result : Roots::unknown;
  } catch (const std::domain_error&) {
    return Roots::unknown;
  }
}

bool PairBoxes::may_fit(const Box& box, double most) {
  return !all_of(box, Cuts::corners,
                 [&](const Stretch& a, const Stretch& b) { return !equations_.fit_together(a, b, most); });
}

/// Cut at jumps of curvature as well, beyond which equations are no planes.
std::optional<std::vector<Polygon>> PairBoxes::remains(const Box& box, double tolerance, const PairLine* line) {
  std::vector<Polygon> result;
  std::size_t parts = 0;
  try {
    const bool is_told = all_of(box, Cuts::bends, [&](const Stretch& a, const Stretch& b) {
      return add_remains(a, b, tolerance, line, 0, parts, result);
    });
    return is_told ? std::optional(result) : std::nullopt;
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

/// By the shares of two stretches that are behind. Where equations are planes to some tolerances, a convex set holds
/// all that fits, and what it holds is off by kNear tolerances at the most; so it is beside a line that fits.
std::optional<Polygon> PairBoxes::remains(const Stretch& a, const Stretch& b, double tolerance,
                                          const PairLine* line) const {
  const std::vector<PairEquations::Plane> planes = equations_.planes(a, b);
  // A set where |plane| <= tolerance + off has |equation| <= tolerance + 2 off: no more than kNear tolerances.
  const auto is_flat = [&](const PairEquations::Plane& plane) { return plane.off <= 0.5 * (kNear - 1) * tolerance; };
  if (planes.empty() || !std::all_of(planes.begin(), planes.end(), is_flat)) {
    return line != nullptr ? line->beside(curves_[0], equations_, a, b, tolerance) : std::nullopt;
  }
  Polygon set{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const PairEquations::Plane& plane : planes) {
    set = clipped(set, plane.at, {plane.by_a, plane.by_b}, tolerance + plane.off);
    set = clipped(set, -plane.at, {-plane.by_a, -plane.by_b}, tolerance + plane.off);
  }
  return set;
}

/// False where what may fit can't be told within the allowed number of parts.
bool PairBoxes::add_remains(const Stretch& a, const Stretch& b, double tolerance, const PairLine* line, int depth,
                            std::size_t& parts, std::vector<Polygon>& remains) {
  if (equations_.are_apart(a, b, tolerance)) return true;
  if (std::optional<Polygon> set = this->remains(a, b, tolerance, line)) {
    // From shares of both stretches to arc lengths.
    for (auto& [s, t] : *set) {
      s = a.lo + s * a.width();
      t = b.lo + t * b.width();
    }
    if (!set->empty()) remains.push_back(*set);
    return true;
  }
  // Beside a line many small parts are needed; elsewhere few parts tell, or none.
  const std::size_t most = line != nullptr ? kMostBeside : kMostParts;
  const bool is_too_deep = line != nullptr && depth == kDeepestBeside;
  const std::optional<Halves> both = ++parts > most || is_too_deep ? std::nullopt : halves(a, b);
  return both && std::all_of(both->begin(), both->end(), [&](const auto& half) {
           return add_remains(*half[0], *half[1], tolerance, line, depth + 1, parts, remains);
         });
}

}  // namespace rollfix_verify
