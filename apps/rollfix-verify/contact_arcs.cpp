#include "contact_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "centre_tree.hpp"
#include "check.hpp"
#include "document.hpp"

// Notation:
//   [A, B]          an arc of the boundary; (c, rho): the disc that holds its points
//   z in [lo, hi]   first contacts; [lo + L - a, hi + L + a]: where the contact is at an instant
// Idea: the boundary's stretches, small ones beside the arc, together hold it; so rho is about half its length.
namespace rollfix_verify {
namespace {

// Stretches are no longer than this share of the arc, and go beyond its ends by no more than that.
constexpr double kArcGrain = 0.125;
constexpr double kBeyond = 1.0 / 256;
// Shares of the perimeter.
constexpr double kShort = 1.0 / 64;
constexpr double kTiny = 1e-4;
// Arcs are widened for rounding by this share of the perimeter.
constexpr double kArcSlack = 1e-13;
constexpr double kPlaceRounding = 1e-14;
constexpr double kArcAngleRounding = 1e-14;
constexpr double kArcWork = 2e-3;
// Arcs of first contacts are no shorter than this share of the tolerances.
constexpr double kLeastArc = 2e-3;
// What is passed over counts from so far in, a share of the perimeter.
constexpr double kPassedSlack = 1e-12;

}  // namespace

/// Refuses an outline of which no size is known.
BoundaryArcs::BoundaryArcs(const Boundary& boundary)
    : boundary_(boundary),
      tree_(boundary, 0, std::nullopt),
      closed_(boundary.closed()),
      period_(boundary.perimeter().middle()),
      turn_(boundary.closed() ? boundary.total_turn().middle() : 0) {
  const CentreTree::Node& root = tree_.node(tree_.root());
  size_ = std::hypot(root.x, root.y) + root.radius;
  if (!(size_ < std::numeric_limits<double>::infinity())) refuse("an outline without a size");
}

/// A short arc on one curve is bounded as it stands, in a few parts if it is not tiny.
bool BoundaryArcs::add_curve(const Interval& arc, double slack) {
  // Long arcs, and arcs over joints, take the tree.
  if (arc.width() > kShort * period_) return false;
  const std::optional<Place> from = boundary_.after(arc.lo - slack);
  const std::optional<Place> to = boundary_.after(arc.hi + slack);
  if (!from || !to || from->curve != to->curve) return false;
  // Curves are counted on from lap to lap; angles grow by the whole turn with each.
  const double lap = std::floor(static_cast<double>(from->curve) / static_cast<double>(boundary_.curves()));
  const long curve = from->curve - static_cast<long>(lap) * boundary_.curves();
  const Interval u{from->u.lower(), to->u.upper()};
  const int parts = arc.width() > kTiny * period_ ? 4 : 1;
  for (int k = 0; k < parts; ++k) {
    const auto end = [&](int part) { return part == parts ? u.hi : u.lo + u.width() * part / parts; };
    const CentreTree::Node node = tree_.stretch(curve, {end(k), end(k + 1)});
    found_.push_back({node.x, node.y, node.radius, node.angle + lap * turn_, node.half_turn});
  }
  return true;
}

/// Collects nodes that are small beside the arc, and together hold it. Descends where a node meets the arc.
void BoundaryArcs::add(int index, const Lap& lap, double grain) {
  const CentreTree::Node node = tree_.node(index);
  // The node is beside the arc.
  if (node.s.hi < lap.arc.lo || node.s.lo > lap.arc.hi) return;
  Budget::spend(0.1 * kArcWork);
  // Beyond the arc's ends by a small share of it at most.
  const bool is_within = lap.arc.holds(node.s, kBeyond / kArcGrain * grain);
  const bool is_small = node.curve >= 0 && (node.is_corner || (is_within && node.s.width() <= grain));
  const auto [left, right] = is_small ? std::make_pair(index, index) : tree_.halves(index);
  if (left == right) {
    found_.push_back({node.x, node.y, node.radius, node.angle + lap.turn,
                      node.half_turn + kArcAngleRounding * (2 + std::abs(node.angle + lap.turn))});
    return;
  }
  add(left, lap, grain);
  add(right, lap, grain);
}

/// The disc and the tangents of all places on an arc. Short arcs on one curve are expanded directly; all others take
/// nodes of the tree, on each lap.
OnArc BoundaryArcs::over(Interval arc) {
  Budget::spend(kArcWork);
  found_.clear();
  // Contacts beyond an end of an open outline are excluded elsewhere.
  if (!closed_) arc = {std::clamp(arc.lo, 0.0, period_), std::clamp(arc.hi, 0.0, period_)};
  const double laps = std::max(std::abs(arc.lo), std::abs(arc.hi)) / period_;
  // Rounding of s grows with the number of laps.
  const double slack = kArcSlack * (1 + laps) * period_;
  const double grain = std::max(kArcGrain * arc.width(), slack);
  if (add_curve(arc, slack)) return hull_of_found();
  const double first = closed_ ? std::floor((arc.lo - slack) / period_) : 0;
  const double last = closed_ ? std::floor((arc.hi + slack) / period_) : 0;
  for (double lap = first; lap <= last; lap += 1) {
    const double on = lap * period_;
    add(tree_.root(), {{arc.lo - slack - on, arc.hi + slack - on}, lap * turn_}, grain);
  }
  // A boundary without a gap has a stretch for each arc.
  if (found_.empty()) refuse("a boundary with a gap");
  return hull_of_found();
}

/// A disc about the middle of all discs' middles, and the hull of the tangents.
OnArc BoundaryArcs::hull_of_found() const {
  const double most = std::numeric_limits<double>::infinity();
  Interval x{most, -most}, y{most, -most}, angle{most, -most};
  for (const OnArc& one : found_) {
    x = {std::min(x.lo, one.x), std::max(x.hi, one.x)};
    y = {std::min(y.lo, one.y), std::max(y.hi, one.y)};
    angle = {std::min(angle.lo, one.angle - one.half_turn), std::max(angle.hi, one.angle + one.half_turn)};
  }
  OnArc all{0.5 * (x.lo + x.hi), 0.5 * (y.lo + y.hi), 0, 0.5 * (angle.lo + angle.hi), 0.5 * angle.width()};
  for (const OnArc& one : found_) {
    all.radius = std::max(all.radius, std::hypot(one.x - all.x, one.y - all.y) + one.radius);
  }
  all.radius += kPlaceRounding * size_;
  all.half_turn += kArcAngleRounding * (2 + std::abs(all.angle));
  return all;
}

/// The root is the whole boundary.
FirstContacts::FirstContacts(BoundaryArcs& boundary, const HeldFinger& finger) : boundary_(boundary), finger_(finger) {
  add({0, boundary.period()});
}

/// Where the contact can be at an instant: z + L, within the tolerance of travel.
Interval FirstContacts::moved(const Interval& arc, std::size_t instant) const {
  const double travelled = finger_.at[instant].travelled;
  return {arc.lo + travelled - finger_.travel, arc.hi + travelled + finger_.travel};
}

/// On some lap.
bool FirstContacts::meets(const Interval& one, const Interval& other) const {
  // Some shift by whole laps makes them meet.
  if (!boundary_.closed()) return one.meets(other);
  const double period = boundary_.period();
  return std::floor((other.hi - one.lo) / period) >= std::ceil((other.lo - one.hi) / period);
}

/// Each contact has a place within reach, and so has all that was rolled over from every first contact of the arc.
bool FirstContacts::can_be(const Interval& arc) const {
  const double slack = kPassedSlack * boundary_.period();
  // The intersection of z + `passed` over all z of the arc.
  const Interval passed{arc.hi + finger_.passed.lo + slack, arc.lo + finger_.passed.hi - slack};
  // A contact beyond an end does not exist.
  const bool is_open = !boundary_.closed();
  if (is_open && passed.lo < passed.hi && (passed.lo < -slack || passed.hi > boundary_.period() + slack)) return false;
  for (std::size_t instant = 0; instant < finger_.at.size(); ++instant) {
    const Interval there = moved(arc, instant);
    if (is_open && (there.hi < 0 || there.lo > boundary_.period())) return false;
    const bool is_within = std::any_of(finger_.within.begin(), finger_.within.end(), [&](const Interval& one) {
      return meets({one.lo - slack, one.hi + slack}, there);
    });
    // The contact is out of reach at that instant.
    if (finger_.reach && !is_within) return false;
  }
  if (!finger_.reach || !(passed.lo < passed.hi)) return true;
  // What was passed over may meet no gap between the places within reach.
  return std::none_of(finger_.gaps.begin(), finger_.gaps.end(), [&](const Interval& gap) {
    const Interval inner{gap.lo + slack, gap.hi - slack};
    return inner.lo < inner.hi && meets(inner, passed);
  });
}

/// Its index; halves are added one behind the other.
int FirstContacts::add(const Interval& arc) {
  nodes_.push_back({arc, can_be(arc), -1, {}});
  return static_cast<int>(nodes_.size()) - 1;
}

/// Computed when it is first asked for, and kept.
const OnArc& FirstContacts::at(int index, std::size_t instant) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.at.empty()) node.at.resize(finger_.at.size());
  if (!node.at[instant]) node.at[instant] = boundary_.over(moved(node.arc, instant));
  return *node.at[instant];
}

/// What the arc length itself may be off by does not get smaller, nor does a corner's turn.
/// Arcs of size 1 and below are not halved any further.
double FirstContacts::size(int index) {
  const double width = arc(index).width();
  double size = 0;
  for (std::size_t instant = 0; instant < finger_.at.size(); ++instant) {
    const double turn = std::min(at(index, instant).half_turn / finger_.turn, width / finger_.travel);
    const double place = finger_.has_place ? 0.5 * width / finger_.place : 0;
    size = std::max({size, turn, place});
  }
  return size / kLeastArc;
}

std::pair<int, int> FirstContacts::halves(int index) {
  const Interval whole = arc(index);
  if (nodes_[static_cast<std::size_t>(index)].left < 0) {
    const double middle = 0.5 * (whole.lo + whole.hi);
    if (!(middle > whole.lo && middle < whole.hi)) return {index, index};
    const int left = add({whole.lo, middle});
    add({middle, whole.hi});
    nodes_[static_cast<std::size_t>(index)].left = left;
  }
  const int left = nodes_[static_cast<std::size_t>(index)].left;
  return {left, left + 1};
}

// ---- out of reach ----
// Notation:
//   (c, rho)        the disc of a node of centres that are left out; of a jaw, of contacts
//   (b, sigma)      the disc of a node of the boundary
//   n, w            of a jaw: the normal in the middle of the tangents of the node, and half of their interval
// Follows docs/certificates.md, "Touches": P1 is about the places within reach.
// Idea: what is left out is halved until some stretch of the boundary is inside of the finger at all of the part.
// Inside of a disk of radius r is |c - b| + rho + sigma < r. A flat jaw is the half plane beyond the tangent: inside of
// it is n . (b - c) - rho - sigma - 2 |b - c| sin(w / 2) > 0. A finger counts as touching that enters the part by less
// than a slack, so that where a place is left out the point is as deep as that, and halving ends.

namespace {

constexpr double kReachComparison = 1e-3;
constexpr double kReachRounding = 1e-13;
// A node of the boundary that is smaller than this share of a disc of centres tells no more.
constexpr double kSmallNode = 0.125;
// Discs of centres are no smaller than these shares of the outline's size and of the radius: a hundredth of how deep a
// finger is that counts as entering the part.
constexpr double kLeastOfSize = 1e-8;
constexpr double kLeastOfRadius = 1e-5;
constexpr double kHalfCircle = 3.14159265358979;

/// What is left of an interval.
std::vector<Interval> without(const Interval& whole, std::vector<Interval> parts) {
  std::sort(parts.begin(), parts.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> rest;
  double from = whole.lo;
  for (const Interval& part : parts) {
    if (part.lo > from) rest.push_back({from, std::min(part.lo, whole.hi)});
    from = std::max(from, part.hi);
    if (from >= whole.hi) return rest;
  }
  rest.push_back({from, whole.hi});
  return rest;
}

/// Shows that a finger would enter the part wherever it is not said to reach; one use.
class LeftOut {
 public:
  LeftOut(const Boundary& boundary, double radius, const Considered& considered)
      : all_(boundary, 0, std::nullopt),
        radius_(radius),
        is_jaw_(std::isinf(radius)),
        period_(boundary.perimeter().middle()),
        centres_(boundary, is_jaw_ ? 0 : radius, rest(boundary, considered)) {
    const CentreTree::Node& root = all_.node(all_.root());
    // The size of the part, by which a jaw's turn moves its points.
    size_ = root.radius;
    least_ = std::min(kLeastOfSize * root.radius, kLeastOfRadius * radius);
    rounding_ = kReachRounding * (std::hypot(root.x, root.y) + root.radius + (is_jaw_ ? 0 : radius));
  }

  /// Depth first over all centres that are left out: each node is shown to be entered, or halved. The first place that
  /// can't be shown.
  std::optional<double> find() {
    if (centres_.root() < 0) return std::nullopt;
    std::vector<int> waiting{centres_.root()};
    while (!waiting.empty()) {
      const int index = waiting.back();
      waiting.pop_back();
      const CentreTree::Node node = centres_.node(index);
      if (is_jaw_ ? is_beyond(node) : is_entered(node)) continue;
      const auto [left, right] = centres_.halves(index);
      const double size = is_jaw_ ? std::max(node.radius, node.half_turn * size_) : node.radius;
      // As small as it gets: the finger is not shown to enter the part there.
      if (left == right || size <= least_) return node.s.lo;
      waiting.push_back(right);
      waiting.push_back(left);
    }
    return std::nullopt;
  }

 private:
  /// The arcs between those that are considered, and at every corner the other angles.
  Considered rest(const Boundary& boundary, const Considered& considered) const {
    std::vector<Interval> arcs;
    for (const Interval& arc : considered.arcs) {
      // Arcs may go on beyond the perimeter.
      for (const double lap : boundary.laps()) arcs.push_back({arc.lo + lap, arc.hi + lap});
    }
    Considered result;
    const double slack = kLengthSlack * period_;
    for (const Interval& gap : without({0, period_}, arcs)) {
      // Gaps no wider than the slack of both their ends are rounding.
      if (gap.width() > 2 * slack) result.arcs.push_back(gap);
    }
    for (long curve = 0; curve < boundary.curves(); ++curve) {
      const std::optional<Ball> pivots = all_.pivots(curve);
      if (!pivots) continue;
      const double s = boundary.back(curve).s.middle();
      const Interval whole{pivots->lower(), pivots->upper()};
      CornerAngles corner{s, {}};
      for (const Interval& piece : without(whole, all_.angles_at(curve, *pivots, considered))) {
        if (piece.width() > 2 * kTurnSlack) corner.angles.push_back(piece);
      }
      result.corners.push_back(corner);
    }
    return result;
  }

  /// Whether one stretch of the boundary is inside the finger at all these centres: the nearest ones are asked first.
  bool is_entered(const CentreTree::Node& centres) {
    std::vector<int> waiting{all_.root()};
    while (!waiting.empty()) {
      Budget::spend(kReachComparison);
      const int index = waiting.back();
      waiting.pop_back();
      const CentreTree::Node node = all_.node(index);
      const double away = std::hypot(centres.x - node.x, centres.y - node.y) + centres.radius + rounding_;
      // The whole stretch is inside the finger at every centre of the node.
      if (away + node.radius < radius_) return true;
      // None of it is inside at all centres, or it is too small beside their disc for its halves to tell more.
      if (away - node.radius >= radius_ || node.radius <= kSmallNode * centres.radius) continue;
      const auto [left, right] = all_.halves(index);
      if (left == right) continue;
      const auto distance = [&](int half) {
        return std::hypot(centres.x - all_.node(half).x, centres.y - all_.node(half).y);
      };
      const bool is_left_nearer = distance(left) < distance(right);
      waiting.push_back(is_left_nearer ? right : left);
      waiting.push_back(is_left_nearer ? left : right);
    }
    return false;
  }

  /// The same of a flat jaw along all these tangents: what is furthest beyond it is asked first.
  bool is_beyond(const CentreTree::Node& contacts) {
    // The tangents +- w turn a point at distance d by 2 d sin(w / 2) at most.
    const double swing = 2 * std::sin(0.5 * std::min(contacts.half_turn, kHalfCircle));
    // n . (b - c): how far a point is beyond the line of the jaw, which touches at c along the tangent.
    const auto height = [&](const CentreTree::Node& node) {
      return std::sin(contacts.angle) * (node.x - contacts.x) - std::cos(contacts.angle) * (node.y - contacts.y);
    };
    std::vector<int> waiting{all_.root()};
    while (!waiting.empty()) {
      Budget::spend(kReachComparison);
      const int index = waiting.back();
      waiting.pop_back();
      const CentreTree::Node node = all_.node(index);
      const double off = contacts.radius + rounding_ + swing * std::hypot(node.x - contacts.x, node.y - contacts.y);
      if (height(node) - node.radius > off) return true;
      if (height(node) + node.radius <= off || node.radius <= kSmallNode * contacts.radius) continue;
      const auto [left, right] = all_.halves(index);
      if (left == right) continue;
      const bool is_left_higher = height(all_.node(left)) > height(all_.node(right));
      waiting.push_back(is_left_higher ? right : left);
      waiting.push_back(is_left_higher ? left : right);
    }
    return false;
  }

  CentreTree all_;  // the boundary itself
  double radius_;
  bool is_jaw_;
  double period_;
  CentreTree centres_;  // that are left out
  double size_ = 0;
  double rounding_ = 0;
  double least_ = 0;
};

}  // namespace

std::optional<double> not_out_of_reach(const Boundary& boundary, double radius, const Considered& considered) {
  return LeftOut(boundary, radius, considered).find();
}

}  // namespace rollfix_verify
