#include "pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "boundary.hpp"
#include "centre_tree.hpp"
#include "check.hpp"
#include "document.hpp"

// Notation:
//   Theta(s)        the tangent's angle
//   L, theta        of a reading: RollReading
//   alpha           the tangent's angle at the start: Theta(s), or at a corner that of the pivot
//   f               Theta(s + L) - alpha - theta: `misses`
// Follows docs/certificates.md, "Touches".
// Idea: a roll can have started at a place if every |f| is within the tolerance. At a convex corner Theta(s + L) may be
// anything between its two sides. Everything is a ball, so that what is excluded is excluded.
namespace rollfix_verify {
namespace {

// A roll's end is moved off a joint by so much of the perimeter, then further and further: only outwards.
constexpr double kStepOff = kLengthSlack;
constexpr double kFurther = 8;
constexpr int kMostSteps = 9;
// Rolls that end on a stretch over more joints than this are told on shorter stretches.
constexpr long kMostEndJoints = 6;
constexpr double kUnknownSpread = std::numeric_limits<double>::infinity();

/// How far a reading can be off at the ends in these sets, with the tangent at the start in this one.
std::vector<Ball> misses(const std::vector<Ball>& ends, const Ball& start, const Ball& turn) {
  std::vector<Ball> result;
  for (const Ball& end : ends) result.push_back(end - start - turn);
  return result;
}

/// Every possible value is certainly outside.
bool are_beyond(const std::vector<Ball>& misses, double most) {
  return std::all_of(misses.begin(), misses.end(),
                     [&](const Ball& f) { return f.is_above(most) || f.is_below(-most); });
}

/// Every possible value is certainly inside.
bool are_within(const std::vector<Ball>& misses, double most) {
  return std::all_of(misses.begin(), misses.end(), [&](const Ball& f) { return abs(f).is_below(most); });
}

/// Half the width of the widest set, radians; infinite where nothing is known.
double widest(const std::vector<Ball>& misses) {
  double most = 0;
  for (const Ball& f : misses) most = f.is_finite() ? std::max(most, 0.5 * spread(f)) : kUnknownSpread;
  return most;
}

}  // namespace

RollStarts::RollStarts(const Boundary& boundary, const CentreTree& tree, std::vector<RollReading> readings,
                       double tolerance)
    : boundary_(boundary),
      tree_(tree),
      readings_(std::move(readings)),
      tolerance_(tolerance),
      period_(boundary.perimeter().middle()),
      base_(tree.direction(boundary.front(0))) {}

/// Computed once for each node, and kept.
const RollStarts::On& RollStarts::on(int node) {
  const auto index = static_cast<std::size_t>(node);
  if (index >= known_.size()) known_.resize(index + 1);
  if (!known_[index]) known_[index] = look(tree_.node(node));
  return *known_[index];
}

/// The place so far along, or beyond it that way where a joint is too near to tell; of an open outline no further than
/// its ends.
std::optional<Place> RollStarts::clear_of_joints(const Ball& s, int way) const {
  double step = 0;
  for (int k = 0; k < kMostSteps; ++k) {
    if (std::optional<Place> place = boundary_.after_or_end(s + way * step * period_)) return place;
    step = step > 0 ? kFurther * step : kStepOff;
  }
  return std::nullopt;
}

/// The tangent's angles where rolls by this length end that start between two places, as sets; none: not known.
std::optional<std::vector<Ball>> RollStarts::ends(const Ball& from, const Ball& to, const Ball& length) const {
  const std::optional<Place> first = clear_of_joints(from + length, -1);
  const std::optional<Place> last = clear_of_joints(to + length, 1);
  if (!first || !last || last->curve - first->curve > kMostEndJoints) return std::nullopt;
  return angles(boundary_, segments(boundary_, *first, *last));
}

/// Whether such rolls all end beyond an end of an open outline.
bool RollStarts::leaves(const Ball& from, const Ball& to, const Ball& length) const {
  if (boundary_.closed()) return false;
  const double slack = kLengthSlack * period_;
  return (to + length).is_below(-slack) || (from + length).is_above(boundary_.perimeter() + slack);
}

/// Of a reading on a stretch without corners at rolls' ends: from what it is at its first place by its slope, the
/// difference of the curvatures, which is all there is along lines and circles. None: not known.
std::optional<Ball> RollStarts::by_slope(const CentreTree::Node& node, const RollReading& reading) const {
  if (node.is_corner) return std::nullopt;
  const Place from = boundary_.at(node.curve, node.u.lo);
  const Place to = boundary_.at(node.curve, node.u.hi);
  const std::optional<Place> first = boundary_.after(from.s + reading.length);
  const std::optional<Place> last = boundary_.after(to.s + reading.length);
  if (!first || !last || last->curve - first->curve > kMostEndJoints) return std::nullopt;
  if (has_corner(boundary_, *first, *last)) return std::nullopt;
  const std::vector<Segment> ends = segments(boundary_, *first, *last);
  const Ball slope = curvatures(boundary_, ends) - curvatures(boundary_, segments(boundary_, from, to));
  const Ball off = first->angle - from.angle - reading.turn + up_to(to.s - from.s) * slope;
  return off + jumps(boundary_, ends);
}

/// All readings on a node: beyond by one of them excludes it; within by all of them on all of it proves it.
RollStarts::On RollStarts::look(const CentreTree::Node& node) const {
  if (node.curve < 0) return {true, false, kUnknownSpread};  // of several curves: its halves say
  const Ball from = node.s.lo;
  const Ball to = node.s.hi;
  // alpha on all of the node, from Theta at s = 0 on.
  const Ball start = Ball(node.angle) + around_zero(node.half_turn) - base_;
  On result{true, true, 0};
  for (const RollReading& reading : readings_) {
    if (leaves(from, to, reading.length)) return {false, false, 0};
    const std::optional<std::vector<Ball>> ends = this->ends(from, to, reading.length);
    if (!ends) {
      result.all_start = false;
      result.spread = kUnknownSpread;
      continue;
    }
    std::vector<Ball> off = misses(*ends, start, reading.turn);
    if (are_beyond(off, tolerance_)) return {false, false, 0};
    // Bounds on both tangents do not know that these change together; the slope of f does.
    if (const std::optional<Ball> finer = are_within(off, tolerance_) ? std::nullopt : by_slope(node, reading)) {
      if (are_beyond({*finer}, tolerance_)) return {false, false, 0};
      if (finer->is_finite() && widest({*finer}) < widest(off)) off = {*finer};
    }
    if (are_within(off, tolerance_)) continue;
    result.all_start = false;
    result.spread = std::max(result.spread, widest(off) / tolerance_);
  }
  return result;
}

/// The test of one stated place, to the slack of stated lengths and angles: no reading excludes it, and it is known of
/// each where its roll ends.
bool RollStarts::may_start(const Place& place, const Ball& direction) const {
  const Ball own = place.angle;
  const Ball start = own + to_nearest_turn(direction - base_ - own) + around_zero(kTurnSlack);
  const Ball reach = kLengthSlack * period_;
  return std::all_of(readings_.begin(), readings_.end(), [&](const RollReading& reading) {
    if (leaves(place.s, place.s, reading.length)) return false;
    const std::optional<std::vector<Ball>> ends = this->ends(place.s - reach, place.s + reach, reading.length);
    return ends && !are_beyond(misses(*ends, start, reading.turn), tolerance_);
  });
}

// ---- poses ----
// Notation, of a pose X, phi that has the part's point c at X + R(phi) c in the world:
//   q_i, delta_i    a touch's measured centre and how far it may be off; tau_i, eps_i: the tangent, likewise
//   q_0             the middle of the touches; v_i = q_i - q_0
//   y, phi          what a box is of: the part's point at q_0, and the heading. Then the part's point at q_i is
//                   y + R(-phi) v_i, and X = q_0 - R(phi) y
//   (c, rho)        the disc of a node of centres, theta +- w its tangents
//   y +- b, phi +- h: the box. A touch may have its contact on a node if
//                     |y + R(-phi) v_i - c| <= |b| + 2 |v_i| sin(h / 2) + rho + delta_i
//                     |tau_i - theta - phi| <= w + eps_i + h, modulo turns
//                   and, of a roll, if it can have started somewhere on the node: RollStarts
// Follows docs/certificates.md, "Touches": where a touch has no node left, no pose of the box fits.
// Idea: poses are halved, not places. In one pose touches have nothing to do with each other, so that boxes decide what
// pairs of places leave open; and a box inside a listed set needs no more looking at, however large the set is.
// Doubles: all coordinates are at most S, and what is compared is off by less than 40 roundings of S: `rounding_`.

namespace {

// Boxes are no smaller than this share of the tolerances.
constexpr double kLeast = 2e-3;
// Headings that contacts without a place leave are known to this share of their tolerances.
constexpr double kHeadingShare = 0.01;
// Nodes are halved while they are larger than this share of the box.
constexpr double kNodeShare = 0.7;
constexpr double kRoundings = 1e-13;
constexpr double kAngleRounding = 1e-14;
// Parts of a node that are looked at for one where a roll can have started.
constexpr int kMostLooks = 200;
// One node beside one box, in expansions; a box.
constexpr double kComparison = 1e-3;
constexpr double kBox = 4e-3;
/// The values of length cos(x), x within `half` of the middle.
Interval cosines(double middle, double half, double length) {
  if (half >= 0.5 * kTurn) return {-length, length};
  const double one = std::cos(middle - half);
  const double other = std::cos(middle + half);
  const bool has_most = std::abs(nearest(middle)) <= half;
  const bool has_least = std::abs(nearest(middle + 0.5 * kTurn)) <= half;
  return {length * (has_least ? -1 : std::min(one, other)), length * (has_most ? 1 : std::max(one, other))};
}

}  // namespace

/// A box, with all that tests need of it.
struct PoseSearch::View {
  double x, y, heading;  // its middle
  double bx, by, half;   // half its widths
  double cosine, sine;   // of the heading
  double place, swing;   // |b| and 2 sin(h / 2)
};

/// Moves the touches so that their middle is the origin: the part's turn about it moves none of them further than its
/// distance from there.
PoseSearch::PoseSearch(CentreTree& tree, std::vector<SoughtTouch> touches, std::vector<PoseBox> listed,
                       std::optional<LeftOpen> open)
    : tree_(tree), touches_(std::move(touches)), listed_(std::move(listed)), open_(std::move(open)) {
  double largest = 0;
  double count = 0;
  for (const SoughtTouch& touch : touches_) count += touch.has_place ? 1 : 0;
  for (const SoughtTouch& touch : touches_) {
    if (!touch.has_place) continue;
    x_ += touch.x / count;
    y_ += touch.y / count;
    largest = std::max({largest, std::abs(touch.x), std::abs(touch.y), touch.length});
  }
  // v_i from here on.
  for (SoughtTouch& touch : touches_) {
    touch.x = touch.has_place ? touch.x - x_ : 0;
    touch.y = touch.has_place ? touch.y - y_ : 0;
  }
  const CentreTree::Node& root = tree_.node(tree_.root());
  const double part = std::hypot(root.x, root.y) + root.radius;
  rounding_ = kRoundings * (4 * largest + part);
}

/// The first box: all headings, and all places of the part's point at q_0 that some touch leaves.
Covered PoseSearch::run() {
  covered_ = {};
  stack_.assign(touches_.size(), tree_.root());
  std::vector<List> lists;
  for (std::size_t k = 0; k < touches_.size(); ++k) lists.emplace_back(k, k + 1);
  const CentreTree::Node root = tree_.node(tree_.root());  // references do not outlive halving
  double reach = std::numeric_limits<double>::infinity();
  bool any_place = false;
  bool all_have = true;
  for (const SoughtTouch& touch : touches_) {
    all_have = all_have && touch.has_place;
    if (!touch.has_place) continue;
    any_place = true;
    // The part's point at q_i is within the part's disc and the tolerance, and q_0 is |v_i| from it.
    reach = std::min(reach, root.radius + touch.length + std::hypot(touch.x, touch.y));
  }
  const double half = 0.5 * kTurn * (1 + kAngleRounding);
  if (!any_place) {  // only headings
    visit({Interval{0, 0}, {0, 0}, {-half, half}}, lists);
    return covered_;
  }
  reach += 2 * rounding_;
  if (!(reach < std::numeric_limits<double>::infinity())) refuse("an outline without a size");
  std::vector<Interval> headings;
  // Contacts without a place confine the heading alone; so that is done first, once for all places.
  if (all_have) headings.push_back({-half, half});
  if (!all_have) add_headings({-half, half}, lists, headings);
  for (const Interval& heading : headings) {
    visit({Interval{root.x - reach, root.x + reach}, {root.y - reach, root.y + reach}, heading}, lists);
  }
  return covered_;
}

/// Adds the headings that contacts without a place leave: what these say is the same wherever the part is, which may be
/// free to slide.
void PoseSearch::add_headings(const Interval& headings, const std::vector<List>& lists, std::vector<Interval>& left) {
  Budget::spend(kBox);
  // A box of headings, at any place.
  const View at = view({Interval{0, 0}, {0, 0}, headings});
  const std::size_t top = stack_.size();
  std::vector<List> own = lists;
  bool may_fit = true;
  double turn = 0;
  for (std::size_t k = 0; k < touches_.size() && may_fit; ++k) {
    if (touches_[k].has_place) continue;
    turn = std::max(turn, at.half / touches_[k].angle);
    may_fit = narrow(at, k, own[k]);
  }
  const auto is_listed = [&](const View& one) {
    return std::any_of(listed_.begin(), listed_.end(), [&](const PoseBox& box) { return holds_heading(box, one); });
  };
  // Small enough, or listed as a whole: it is kept, joined with its neighbour if both are in one set.
  if (may_fit && (turn <= kHeadingShare || is_listed(at))) {
    left.push_back(headings);
    if (left.size() > 1 && left[left.size() - 2].hi == headings.lo) {
      const Interval both{left[left.size() - 2].lo, headings.hi};
      if (is_listed(view({Interval{0, 0}, {0, 0}, both}))) {
        left.pop_back();
        left.back() = both;
      }
    }
  } else if (may_fit) {
    const double middle = 0.5 * (headings.lo + headings.hi);
    add_headings({headings.lo, middle}, own, left);
    add_headings({middle, headings.hi}, own, left);
  }
  stack_.resize(top);
}

/// Middle and half widths, rounded outwards; the heading's sine and cosine.
PoseSearch::View PoseSearch::view(const PoseBox& box) const {
  View view{};
  const auto middle = [](const Interval& one) { return 0.5 * (one.lo + one.hi); };
  const auto half = [&](const Interval& one) { return std::max(one.hi - middle(one), middle(one) - one.lo); };
  view.x = middle(box[0]);
  view.y = middle(box[1]);
  view.heading = middle(box[2]);
  view.bx = half(box[0]);
  view.by = half(box[1]);
  view.half = half(box[2]) + kAngleRounding;
  view.cosine = std::cos(view.heading);
  view.sine = std::sin(view.heading);
  view.place = std::hypot(view.bx, view.by);
  view.swing = view.half < 0.5 * kTurn ? 2 * std::sin(0.5 * view.half) : 2;
  return view;
}

/// In tolerances of the touch: of its place and of its tangent.
double PoseSearch::node_size(std::size_t touch, const CentreTree::Node& node) const {
  const SoughtTouch& one = touches_[touch];
  const double place = one.has_place ? node.radius / one.length : 0;
  return one.tangent ? std::max(place, node.half_turn / one.angle) : place;
}

/// The inequalities of the notation. False is certain.
bool PoseSearch::may_hold(const View& view, std::size_t touch, const CentreTree::Node& node) const {
  const SoughtTouch& one = touches_[touch];
  // y + R(-phi) v_i - c, in the middle of the box.
  const double dx = view.x + view.cosine * one.x + view.sine * one.y - node.x;
  const double dy = view.y + view.cosine * one.y - view.sine * one.x - node.y;
  const double reach = view.place + view.swing * std::hypot(one.x, one.y) + node.radius + one.length + rounding_;
  if (one.has_place && dx * dx + dy * dy > reach * reach) return false;
  if (!one.tangent) return true;
  const double most = node.half_turn + one.angle + view.half + kAngleRounding * (2 + std::abs(node.angle));
  return !(std::abs(nearest(*one.tangent - node.angle - view.heading)) > most);
}

/// A new list of the nodes that may hold the touch's contact, no larger than about the box. False: there is none, and
/// no pose of the box fits. Smaller boxes start from the list of the larger one: what that has excluded stays excluded.
bool PoseSearch::narrow(const View& view, std::size_t touch, List& list) {
  const SoughtTouch& one = touches_[touch];
  const double place = one.has_place ? (view.place + view.swing * std::hypot(one.x, one.y)) / one.length : 0;
  const double size = kNodeShare * (one.tangent ? std::max(place, view.half / one.angle) : place);
  // The new list is put on top of the stack; the caller drops it by the stack's size.
  const std::size_t top = stack_.size();
  waiting_.assign(stack_.begin() + static_cast<std::ptrdiff_t>(list.first),
                  stack_.begin() + static_cast<std::ptrdiff_t>(list.second));
  while (!waiting_.empty()) {
    Budget::spend(kComparison);
    const int index = waiting_.back();
    waiting_.pop_back();
    if (!may_hold(view, touch, tree_.node(index))) continue;
    const double spread = one.starts != nullptr ? one.starts->on(index).spread : 0;
    if (one.starts != nullptr && !one.starts->on(index).may_start) continue;
    // Larger than the box, or not decided for a roll: its halves are looked at.
    if (!(std::max(node_size(touch, tree_.node(index)), spread) <= size)) {
      // A smallest node stays as it is.
      const auto [left, right] = tree_.halves(index);
      if (left != right) {
        waiting_.push_back(left);
        waiting_.push_back(right);
        continue;
      }
    }
    stack_.push_back(index);
  }
  list = {top, stack_.size()};
  return list.first != list.second;
}

/// All headings of the view, modulo turns, in the box's.
bool PoseSearch::holds_heading(const PoseBox& box, const View& view) {
  if (box[2].width() >= kTurn) return true;
  const double off = nearest(view.heading - 0.5 * (box[2].lo + box[2].hi));
  return std::abs(off) + view.half <= 0.5 * box[2].width() + kTurnSlack;
}

/// Whether all poses of the box, X = q_0 - R(phi) y, are in one listed extent. R(phi) turns the middle of y on an arc
/// (`cosines`); the rest of y adds what it is along each axis.
bool PoseSearch::is_listed(const View& view) const {
  Budget::spend(kComparison * static_cast<double>(listed_.size()));
  const double length = std::hypot(view.x, view.y);
  const double direction = std::atan2(view.y, view.x) + view.heading;
  const Interval x = cosines(direction, view.half, length);
  const Interval y = cosines(direction - 0.25 * kTurn, view.half, length);
  // Bounds on |cos phi| and |sin phi| over all headings of the box.
  const double c = std::min(1.0, std::abs(view.cosine) + view.swing);
  const double s = std::min(1.0, std::abs(view.sine) + view.swing);
  const double bx = std::min(view.place, c * view.bx + s * view.by) + rounding_;
  const double by = std::min(view.place, s * view.bx + c * view.by) + rounding_;
  const Interval at_x{x_ - x.hi - bx, x_ - x.lo + bx};
  const Interval at_y{y_ - y.hi - by, y_ - y.lo + by};
  return std::any_of(listed_.begin(), listed_.end(), [&](const PoseBox& box) {
    if (!box[0].holds(at_x, 2 * rounding_) || !box[1].holds(at_y, 2 * rounding_)) return false;
    return holds_heading(box, view);
  });
}

/// Every node on which the contact can be lies on an arc that is left open.
bool PoseSearch::is_open(const List& list) const {
  return std::all_of(stack_.begin() + static_cast<std::ptrdiff_t>(list.first),
                     stack_.begin() + static_cast<std::ptrdiff_t>(list.second), [&](int index) {
                       return std::any_of(open_->arcs.begin(), open_->arcs.end(), [&](const Interval& arc) {
                         return arc.holds(tree_.node(index).s, rounding_);
                       });
                     });
}

/// Whether every contact of a node fits a pose for certain.
bool PoseSearch::fits_all_on(const View& view, std::size_t touch, int index) {
  const SoughtTouch& one = touches_[touch];
  const CentreTree::Node& node = tree_.node(index);
  if (one.starts != nullptr && !one.starts->on(index).all_start) return false;
  const double x = view.x + view.cosine * one.x + view.sine * one.y;
  const double y = view.y + view.cosine * one.y - view.sine * one.x;
  // The farthest centre of the node.
  const double far = std::hypot(x - node.x, y - node.y) + node.radius + rounding_;
  if (one.has_place && !(far <= one.length)) return false;
  if (!one.tangent) return true;
  const double off = std::abs(nearest(*one.tangent - node.angle - view.heading));
  return off + node.half_turn + kAngleRounding * (2 + std::abs(node.angle)) <= one.angle;
}

/// Whether some contact of a node fits a pose for certain. A roll may start on much less than the node.
bool PoseSearch::fits_on(const View& view, std::size_t touch, int index) {
  RollStarts* starts = touches_[touch].starts;
  waiting_.assign(1, index);
  for (int looks = 0; looks < kMostLooks && !waiting_.empty(); ++looks) {
    Budget::spend(kComparison);
    const int node = waiting_.back();
    waiting_.pop_back();
    if (fits_all_on(view, touch, node)) return true;
    if (starts == nullptr || !starts->on(node).may_start || !may_hold(view, touch, tree_.node(node))) continue;
    const auto [left, right] = tree_.halves(node);
    if (left == right) continue;
    waiting_.push_back(left);
    waiting_.push_back(right);
  }
  return false;
}

/// Whether the pose in the middle of a box fits for certain.
bool PoseSearch::fits_in_the_middle(const View& view, const std::vector<List>& lists) {
  for (std::size_t touch = 0; touch < touches_.size(); ++touch) {
    const auto [from, to] = lists[touch];
    bool fits = false;
    // One node that fits for certain is enough for the touch.
    for (std::size_t k = from; k < to && !fits; ++k) fits = fits_on(view, touch, stack_[k]);
    if (!fits) return false;
  }
  return true;
}

/// How large a box is beside the tolerances: its places, and its headings.
std::array<double, 2> PoseSearch::sizes(const View& view) const {
  double place = 0;
  double turn = 0;
  for (const SoughtTouch& touch : touches_) {
    if (touch.has_place) place = std::max(place, view.place / touch.length);
    // A heading moves a touch by its distance from the middle.
    if (touch.has_place) turn = std::max(turn, view.half * std::hypot(touch.x, touch.y) / touch.length);
    if (touch.tangent) turn = std::max(turn, view.half / touch.angle);
  }
  return {place, turn};
}

/// One box: no pose of it fits, or it is listed, or left open, or too small to be halved, or both halves are visited.
void PoseSearch::visit(const PoseBox& box, const std::vector<List>& lists) {
  if (covered_.unlisted || covered_.is_cut_short()) return;
  Budget::spend(kBox);
  ++covered_.boxes;
  const View at = view(box);
  // Lists of this box stand above those of the larger one, and are dropped when it is done.
  const std::size_t top = stack_.size();
  std::vector<List> own = lists;
  bool may_fit = true;
  for (std::size_t k = 0; k < touches_.size() && may_fit; ++k) may_fit = narrow(at, k, own[k]);
  // P1 holds of this box.
  if (!may_fit || is_listed(at)) {
    stack_.resize(top);
    return;
  }
  // Counted, not refused: the certificate itself leaves it open.
  if (open_ && is_open(own[open_->touch])) {
    ++covered_.open;
    stack_.resize(top);
    return;
  }
  const auto [place, turn] = sizes(at);
  // As small as boxes get. If the pose in its middle certainly fits and is in no set, the certificate is refuted.
  if (std::max(place, turn) <= kLeast) {
    const View middle = view({Interval{at.x, at.x}, {at.y, at.y}, {at.heading, at.heading}});
    if (!is_listed(middle) && fits_in_the_middle(middle, own)) {
      covered_.unlisted = {x_ - (at.cosine * at.x - at.sine * at.y), y_ - (at.sine * at.x + at.cosine * at.y),
                           at.heading};
    } else {
      ++covered_.undecided;
    }
    stack_.resize(top);
    return;
  }
  // The axis that is largest in tolerances.
  const std::size_t axis = turn > place ? 2 : at.bx >= at.by ? 0 : 1;
  const double middle = 0.5 * (box[axis].lo + box[axis].hi);
  for (const bool is_upper : {false, true}) {
    PoseBox half = box;
    (is_upper ? half[axis].lo : half[axis].hi) = middle;
    visit(half, own);
  }
  stack_.resize(top);
}

}  // namespace rollfix_verify
