#include "centre_tree.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "budget.hpp"
#include "document.hpp"

// Notation:
//   (c, rho)        the disc of a node of centres that are left out; of a jaw, of contacts
//   (b, sigma)      the disc of a node of the boundary
//   n, w            of a jaw: the normal in the middle of the tangents of the node, and half of their interval
// Follows docs/certificates.md, "Touches": P1 is about the places within reach.
// Idea: what is left out is halved until some stretch of the boundary is inside of the finger at all of the part.
// Inside of a disk of radius r is |c - b| + rho + sigma < r. A flat jaw is the half plane beyond the tangent: inside of
// it is n . (b - c) - rho - sigma - 2 |b - c| sin(w / 2) > 0. A finger counts as touching that enters the part by less
// than a slack, so that where a place is left out the point is as deep as that, and halving ends.
namespace rollfix_verify {
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
