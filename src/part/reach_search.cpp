#include "reach_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cursor.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/reach.md, "The condition":
//   p, T, n         contact, the tangent there and the outward normal: `View::point`, `tangent`, `normal`
//   q, d            another point of the boundary, and d = q - p: `offset`
//   k               the finger's curvature, 1 / r of a disk and 0 of a jaw: `curvature_`
//   F               2 n . d - k d . d, above 0 where q is in the finger; depth h has F = h (2 - k h): `deepness`,
//                   `depth_of`
//   omega           turn of the finger against the part, d omega = d Theta + k ds; F changes by 2 T . d d omega
//   stance          contacts on a stretch of one spiral, on several, or pivots at one corner: Stance
// Follows docs/reach.md, "The condition" and "How it is decided".
// Idea: for a set of stances and a stretch of the boundary F is bounded from both sides. The stances are decided when
// all of the boundary is less deep than the slack, or one point is deeper; else whichever of the two matters more is
// halved.
namespace rollfix::part {
namespace {

// A penetration that is deeper than the slack by no more than this share of it may count either way.
constexpr double kDoubt = 1e-4;
// Rounding of F, a share of the boundary's size.
constexpr double kRounding = 1e-14;
// A stance turns by no more than this to begin with on average, radians, and none is shorter than this share of the
// perimeter.
constexpr double kStanceTurn = 0.4;
constexpr double kShortestStance = 1e-12;
// One on several spirals turns by no more than this: its ends see each other as a safe stretch has it.
constexpr double kMostTurnOfSeveral = 2 * kStanceTurn;
/// The unit vector at this angle.
Vec2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

}  // namespace

double deepness(const Vec2& normal, const Vec2& offset, double curvature) {
  return 2 * normal.dot(offset) - curvature * offset.squaredNorm();
}

// h = (1 - sqrt(1 - k F)) / k, written without the division by k, which is 0 for a jaw, and without cancellation.
double depth_of(double deepness, double curvature) {
  return deepness / (1 + std::sqrt(std::max(0.0, 1 - curvature * deepness)));
}

// The quadratic's top lies at x = slope / (2 bend); if that is not inside (0, 1), an end has the largest value.
double ChordDeepness::most() const {
  if (!(slope > 0 && slope < 2 * bend)) return most_at_ends();
  return std::max(most_at_ends(), at_start + 0.25 * slope * slope / bend);
}

/// The gradient of F by q has the size 2 k |q - centre| = 2 sqrt(1 - k F), 2 for a jaw: times the distance from the
/// chord.
double ChordDeepness::beside(double deviation, double curvature) const {
  return 2 * std::sqrt(std::max(0.0, 1 - curvature * most())) * deviation;
}

ChordDeepness deepness_on_chord(const BoundaryTree::Node& node, const Vec2& point, const Vec2& normal,
                                double curvature) {
  const Vec2 to_start = node.start - point;
  const Vec2 chord = node.end - node.start;
  // F at d = (start - p) + x (end - start), by powers of x.
  return {deepness(normal, to_start, curvature), 2 * (normal.dot(chord) - curvature * to_start.dot(chord)),
          curvature * chord.squaredNorm()};
}

/// A stance from its middle, and how far it goes from there.
struct ReachSearch::View {
  Vec2 point;           // p, at the middle
  Vec2 tangent;         // T there
  Vec2 normal;          // n there, outward: T turned clockwise
  double turn = 0;      // of the tangent, to the further end
  double rotation = 0;  // of the finger against the part
  double length = 0;    // of the contact's way
};

/// What is known of F for a stance and a stretch of the boundary.
struct ReachSearch::Comparison {
  double most = 0;   // no point is deeper
  double least = 0;  // this point is at least as deep wherever on the stance the finger is
  Vec2 at;
  double from_stretch = 0;  // how much of the difference is due to the stretch's size ...
  double from_stance = 0;   // ... and how much to the stance's
};

ReachSearch::ReachSearch(BoundaryTree& tree, double curvature, double slack, std::size_t budget)
    : tree_(tree),
      part_(tree.part()),
      turning_(part_.turning()),
      curvature_(curvature),
      slack_(slack),
      budget_(budget),
      last_hit_(part_.point(0)),
      // F of a point whose depth is the slack.
      most_(slack * (2 - curvature * slack)),
      doubt_(std::max(kDoubt * most_, kRounding * tree.diagonal())) {}

// The root holds the whole boundary.
const std::vector<Decision>& ReachSearch::run() {
  add_spirals(0, turning_.spirals().size(), {tree_.root()});
  return decisions_;
}

/// Most of a scan's many spirals are free with all their neighbours: what can't be in any of them is looked at once.
void ReachSearch::add_spirals(std::size_t first, std::size_t end, const std::vector<std::int32_t>& candidates) {
  // A single spiral: first the pivots at its start, then the rolls, which is the order of the boundary. An open
  // boundary has no joint at s = 0.
  if (end - first == 1) {
    if (part_.closed() || first > 0) add_pivots(first, candidates);
    add_rolls(first, candidates);
    return;
  }
  // What the whole run excludes, none of its spirals needs to look at again.
  std::vector<std::int32_t> left = candidates;
  if (is_one_stance(first, end)) {
    const std::vector<Spiral>& spirals = turning_.spirals();
    left = left_of({false, first, {spirals[first].lo, spirals[end - 1].hi}, end - first}, candidates);
    // Nothing can be in the finger on any of them: all are free.
    if (left.empty()) {
      for (std::size_t k = first; k < end; ++k) add({false, k, {spirals[k].lo, spirals[k].hi}}, true);
      return;
    }
  }
  const std::size_t middle = first + (end - first) / 2;
  add_spirals(first, middle, left);
  add_spirals(middle, end, left);
}

/// The finger rolls forward over all of them, without a pivot, and does not turn far on the part.
bool ReachSearch::is_one_stance(std::size_t first, std::size_t end) const {
  const std::vector<Spiral>& spirals = turning_.spirals();
  Interval angles{spirals[first].start.angle, spirals[first].start.angle};
  // A quick test first, in constant time.
  if (std::abs(spirals[end - 1].end.angle - angles.lo) > kMostTurnOfSeveral) return false;
  for (std::size_t k = first; k < end; ++k) {
    const Spiral& spiral = spirals[k];
    // 1 + r kappa > 0 at both ends, and so on the whole spiral: the finger rolls forwards. Corners would be pivots.
    if (std::min(spiral.start.curvature, spiral.end.curvature) + curvature_ <= 0) return false;
    if (std::abs(Cursor::at_spiral(turning_, k).jump()) > kTurnAccuracy) return false;
    for (const double angle : {spiral.start.angle, spiral.end.angle}) {
      angles = {std::min(angles.lo, angle), std::max(angles.hi, angle)};
    }
  }
  return angles.width() <= kMostTurnOfSeveral;
}

/// What may be in the finger somewhere on that stance.
std::vector<std::int32_t> ReachSearch::left_of(const Stance& stance, const std::vector<std::int32_t>& candidates) {
  const View view = view_of_several(stance);
  std::vector<std::int32_t> open = candidates;
  std::vector<std::int32_t> left;
  std::optional<Interval> safe;
  while (!open.empty()) {
    const std::int32_t index = open.back();
    open.pop_back();
    // Out of budget: nothing is excluded.
    if (++tests_ > budget_) return candidates;
    beat();
    const BoundaryTree::Node& node = tree_.node(index);
    const Comparison found = compare(view, node);
    // No point of the stretch is deeper than the slack, wherever on the stance the finger is.
    if (found.most <= most_ + doubt_) continue;
    if (!safe) safe = safe_stretch(tree_, curvature_, slack_, stance);
    if (is_inside(node, *safe)) continue;
    // A single stretch, or one whose bound is wide by the stance's size more than by its own, is left to smaller
    // stances.
    if (node.is_single() || found.from_stretch < found.from_stance) {
      left.push_back(index);
    } else {
      open.push_back(node.left);
      open.push_back(node.right);
    }
  }
  return left;
}

void ReachSearch::add_pivots(std::size_t spiral, const std::vector<std::int32_t>& candidates) {
  const Cursor joint = Cursor::at_spiral(turning_, spiral);
  const double before = joint.angle_before();
  const double after = joint.angle_after();
  // No convex corner: smooth, or concave, where nothing pivots.
  if (after - before <= kTurnAccuracy) return;
  const int count = 1 + static_cast<int>((after - before) / kStanceTurn);
  for (int i = 0; i < count; ++i) {
    const double lo = before + (after - before) * i / count;
    decide({true, spiral, {lo, i + 1 == count ? after : before + (after - before) * (i + 1) / count}}, candidates);
  }
}

/// The finger rolls forward where 1 + r kappa > 0, else it would roll backwards: cut there, so that its rotation is
/// monotone on each stance.
void ReachSearch::add_rolls(std::size_t index, const std::vector<std::int32_t>& candidates) {
  const Spiral& spiral = turning_.spirals()[index];
  // kappa + 1 / r: monotone on the spiral, so its sign changes once at most.
  const auto clearance = [&](double s) { return turning_.on_spiral(spiral, s).curvature + curvature_; };
  const int count = 1 + static_cast<int>(std::abs(spiral.turn()) / kStanceTurn);
  for (int i = 0; i < count; ++i) {
    double lo = i == 0 ? spiral.lo : spiral.lo + (spiral.hi - spiral.lo) * i / count;
    const double hi = i + 1 == count ? spiral.hi : spiral.lo + (spiral.hi - spiral.lo) * (i + 1) / count;
    const bool starts_positive = clearance(lo) > 0;
    // Bisection down to what arc lengths are accurate to.
    if (starts_positive != (clearance(hi) > 0)) {
      Interval bracket{lo, hi};
      while (bracket.width() > kLengthAccuracy * part_.perimeter()) {
        const double middle = bracket.middle();
        ((clearance(middle) > 0) == starts_positive ? bracket.lo : bracket.hi) = middle;
      }
      decide({false, index, {lo, bracket.hi}}, candidates);
      lo = bracket.hi;
    }
    if (hi > lo) decide({false, index, {lo, hi}}, candidates);
  }
}

/// Turn, rotation and length are largest at an end of the stance, as kappa and kappa + k keep their signs on it.
ReachSearch::View ReachSearch::view_of(const Stance& stance) const {
  View view;
  const Spiral& spiral = turning_.spirals()[stance.spiral];
  double angle = stance.range.middle();
  // A pivot turns about the corner: the contact stays.
  if (stance.is_pivot) {
    view.point = part_.point(spiral.lo);
    view.turn = view.rotation = 0.5 * stance.range.width();
  } else {
    const double middle = angle;
    angle = turning_.on_spiral(spiral, middle).angle;
    view.point = part_.point(middle);
    view.length = 0.5 * stance.range.width();
    for (const double end : {stance.range.lo, stance.range.hi}) {
      const double turn = turning_.on_spiral(spiral, end).angle - angle;
      view.turn = std::max(view.turn, std::abs(turn));
      view.rotation = std::max(view.rotation, std::abs(turn + curvature_ * (end - middle)));
    }
  }
  view.tangent = direction(angle);
  view.normal = {view.tangent.y(), -view.tangent.x()};
  return view;
}

/// The finger rolls forward on them: its rotation is largest at an end, but for what joints jump by to and fro.
ReachSearch::View ReachSearch::view_of_several(const Stance& stance) const {
  const std::vector<Spiral>& spirals = turning_.spirals();
  const Spiral& at = spirals[stance.spiral + stance.spirals / 2];
  View view;
  view.point = part_.point(at.lo);
  view.length = std::max(stance.range.hi - at.lo, at.lo - stance.range.lo);
  double jumps = 0;
  for (std::size_t k = stance.spiral; k < stance.spiral + stance.spirals; ++k) {
    jumps += std::abs(Cursor::at_spiral(turning_, k).jump());
    for (const double angle : {spirals[k].start.angle, spirals[k].end.angle}) {
      view.turn = std::max(view.turn, std::abs(angle - at.start.angle));
    }
  }
  const double before = at.start.angle - spirals[stance.spiral].start.angle;
  const double after = spirals[stance.spiral + stance.spirals - 1].end.angle - at.start.angle;
  // omega at the ends, as seen from the middle: the turn there and k times the way.
  view.rotation = jumps + std::max(std::abs(before + curvature_ * (at.lo - stance.range.lo)),
                                   std::abs(after + curvature_ * (stance.range.hi - at.lo)));
  view.tangent = direction(at.start.angle);
  view.normal = {view.tangent.y(), -view.tangent.x()};
  return view;
}

/// F of a point is at least this anywhere on the stance.
double ReachSearch::least(const View& view, const Vec2& point) const {
  const Vec2 offset = point - view.point;
  return deepness(view.normal, offset, curvature_) - change(view, offset, 0);
}

/// By how much F of a point at this offset, give or take `beside`, changes on the stance at most: T.d changes as well,
/// d(T.d) = -kappa n.d ds - ds.
double ReachSearch::change(const View& view, const Vec2& offset, double beside) const {
  // |dF / d omega| = 2 |T . d|; T . d at the middle, and `drift`: how far it gets on the way to either end, by turning
  // (|n . d| is |d| at most, and |d| grows by the way) and by moving.
  const double along = std::abs(view.tangent.dot(offset)) + beside;
  const double drift = view.turn * (offset.norm() + beside + view.length) + view.length;
  return 2 * view.rotation * (along + drift);
}

/// On the chord F is a quadratic and the changes, as bounded, are convex: below the line between the ends' values.
ReachSearch::Comparison ReachSearch::compare(const View& view, const BoundaryTree::Node& node) const {
  const Vec2 to_start = node.start - view.point;
  const ChordDeepness on_chord = deepness_on_chord(node, view.point, view.normal, curvature_);
  const double change_at_start = change(view, to_start, node.deviation);
  const double change_at_end = change(view, node.end - view.point, node.deviation);

  Comparison result;
  // A quadratic plus the line between the changes at both ends.
  const ChordDeepness with_change{on_chord.at_start + change_at_start,
                                  on_chord.slope + (change_at_end - change_at_start), on_chord.bend};
  const double beside_chord = on_chord.beside(node.deviation, curvature_);
  result.most = with_change.most() + beside_chord;
  result.from_stance = std::max(change_at_start, change_at_end);
  // What would vanish if the stretch were a point; the rest is the stance's.
  result.from_stretch = beside_chord + (with_change.most() - with_change.most_at_ends()) +
                        2 * view.rotation * (std::abs(view.tangent.dot(node.end - node.start)) + node.deviation);
  result.at = node.on_curve;
  result.least = least(view, node.on_curve);
  // The end of a single stretch is a point of the boundary as well.
  if (!node.is_single()) return result;
  const double at_end = least(view, node.end);
  if (at_end > result.least) {
    result.least = at_end;
    result.at = node.end;
  }
  return result;
}

void ReachSearch::decide(const Stance& stance, const std::vector<std::int32_t>& candidates) {
  const View view = view_of(stance);
  // What stops the finger here most often stops it next to here as well.
  if (least(view, last_hit_) > most_) {
    add(stance, false);
    return;
  }
  // It is hit from the middle, but not from everywhere: neither free nor impossible as a whole.
  if (deepness(view.normal, last_hit_ - view.point, curvature_) > most_) {
    split(stance, candidates);
    return;
  }
  std::vector<std::int32_t> open = candidates;
  std::vector<std::int32_t> left;
  std::optional<Interval> safe;
  // Each turn takes one node: it proves the stance impossible, is excluded, is halved, or is left over.
  while (!open.empty()) {
    beat();
    if (++tests_ > budget_) {
      is_decided_ = false;
      add(stance, true);
      return;
    }
    const std::int32_t index = open.back();
    open.pop_back();
    const BoundaryTree::Node& node = tree_.node(index);
    const Comparison found = compare(view, node);
    if (found.least > most_) {
      last_hit_ = found.at;
      add(stance, false);
      return;
    }
    if (found.most <= most_ + doubt_) continue;
    // Only computed for a stance that needs it.
    if (!safe) safe = safe_stretch(tree_, curvature_, slack_, stance);
    if (is_inside(node, *safe)) continue;
    if (deepness(view.normal, found.at - view.point, curvature_) > most_) {
      // Not free in its middle: no use in looking at the rest before it is split.
      last_hit_ = found.at;
      left.insert(left.end(), open.begin(), open.end());
      left.push_back(index);
      break;
    }
    // Halve the stretch while its size matters more than the stance's, down to a quarter of the doubt; else leave it to
    // the halves of the stance.
    const bool is_coarse = !node.is_single() || found.from_stretch > std::max(found.from_stance, 0.25 * doubt_);
    const auto [first, second] = is_coarse ? tree_.halves(index) : std::pair(index, index);
    if (first == second) {
      left.push_back(index);
    } else {
      open.push_back(first);
      open.push_back(second);
    }
  }
  if (left.empty()) {
    add(stance, true);
  } else {
    split(stance, left);
  }
}

void ReachSearch::split(const Stance& stance, const std::vector<std::int32_t>& candidates) {
  const double size = stance.is_pivot ? stance.range.width() : stance.range.width() / part_.perimeter();
  // Below what arc lengths, or angles, are accurate to.
  if (size <= kShortestStance) {
    add(stance, true);
    return;
  }
  const double middle = stance.range.middle();
  decide({stance.is_pivot, stance.spiral, {stance.range.lo, middle}}, candidates);
  decide({stance.is_pivot, stance.spiral, {middle, stance.range.hi}}, candidates);
}

/// Is the stretch inside, moved by a perimeter or not?
bool ReachSearch::is_inside(const BoundaryTree::Node& node, const Interval& around) const {
  const double period = part_.closed() ? part_.perimeter() : 0;
  for (const double shift : {0.0, period, -period}) {
    if (node.lo + shift >= around.lo && node.hi + shift <= around.hi) return true;
  }
  return false;
}

}  // namespace rollfix::part
