#include "outline/joining.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "outline/turn.hpp"
#include "rollfix/outline.hpp"

// Notation:
//   node, edge      ends of curves that meet, and what is drawn from one to another: Edge
//   passage         an edge and the way that it is passed through
//   departure       heading and curvature with which an edge leaves a node
//   loose           an edge that ends nowhere, and what hangs on it alone
//   face            what is all around a piece: its passages on the outside, cut into loops that pass no node twice
// Follows docs/files.md, "Loops".
// Idea: from the leftmost point on, always the rightmost turn at a node: that is once around the outer face of a plane
// graph. Where edges leave alike, their curvatures say which is on the right.
namespace rollfix::outline {

namespace {

/// Tangents closer together than this are one, and the curvature says which edge is on which side: drawings hold some
/// seven digits.
constexpr double kSameHeading = 1e-6;

/// How a curve leaves its front (`forward`), or its back against its direction. At rest it has no tangent there: the
/// direction to its middle stands for it, with curvature 0.
Departure departure(const Curve& curve, bool forward, std::size_t node) {
  const Interval domain = curve.domain();
  const Jet jet = curve.jet(forward ? domain.lo : domain.hi);
  Vec2 along = forward ? jet.first : Vec2(-jet.first);
  // A velocity of 0 at the end itself has no direction.
  const bool at_rest = !(along.norm() > 0);
  if (at_rest) along = curve.position(domain.middle()) - jet.position;
  const double bend = at_rest ? 0 : curvature(jet);
  return {node, std::atan2(along.y(), along.x()), forward ? bend : -bend};
}

/// Builds the graph, drops loose edges, and walks around the outside of each connected piece. Linear in the number of
/// edges but for nodes at which many meet.
class OuterFace {
 public:
  OuterFace(const std::vector<Edge>& edges, std::size_t nodes) : edges_(edges), at_(nodes), loose_(edges.size()) {
    // Each edge leaves two nodes, or one node twice.
    for (std::size_t k = 0; k < edges.size(); ++k) {
      at_[edges[k].front.node].push_back({k, true});
      at_[edges[k].back.node].push_back({k, false});
    }
    leave_out_loose_ends();
  }

  /// One face for each connected piece, by its lowest edge's number.
  std::vector<Face> run() {
    std::vector<Face> faces;
    std::vector<bool> seen(edges_.size(), false);
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      if (!seen[k]) faces.push_back(face_of(piece_with(k, seen)));
    }
    return faces;
  }

 private:
  /// How a passage leaves its first node.
  const Departure& leaving(const Passage& one) const {
    return one.forward ? edges_[one.edge].front : edges_[one.edge].back;
  }
  /// The node that a passage comes to.
  std::size_t end_of(const Passage& one) const {
    return one.forward ? edges_[one.edge].back.node : edges_[one.edge].front.node;
  }

  /// What is left at a node once loose edges are gone.
  std::vector<Passage> kept(std::size_t node) const {
    std::vector<Passage> result;
    for (const Passage& one : at_[node]) {
      if (!loose_[one.edge]) result.push_back(one);
    }
    return result;
  }

  /// An edge alone at one of its ends is loose, and what it leaves alone is loose as well. What remains has at least
  /// two ends at each node, so every piece of it encloses something.
  void leave_out_loose_ends() {
    std::vector<std::size_t> count(at_.size());
    std::vector<std::size_t> waiting;
    for (std::size_t node = 0; node < at_.size(); ++node) {
      count[node] = at_[node].size();
      if (count[node] == 1) waiting.push_back(node);
    }
    // Each node in `waiting` had one edge left when it came there.
    while (!waiting.empty()) {
      const std::size_t node = waiting.back();
      waiting.pop_back();
      if (count[node] != 1) continue;  // the other end of one that was taken
      const Passage last = kept(node).front();
      loose_[last.edge] = true;
      --count[node];
      if (--count[end_of(last)] == 1) waiting.push_back(end_of(last));
    }
  }

  /// All edges connected with this one, loose ones included, by rising number; they are marked as seen.
  std::vector<std::size_t> piece_with(std::size_t edge, std::vector<bool>& seen) const {
    std::vector<std::size_t> piece = {edge};
    seen[edge] = true;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      for (const std::size_t node : {edges_[piece[k]].front.node, edges_[piece[k]].back.node}) {
        for (const Passage& other : at_[node]) {
          if (!seen[other.edge]) piece.push_back(other.edge);
          seen[other.edge] = true;
        }
      }
    }
    std::sort(piece.begin(), piece.end());
    return piece;
  }

  /// The outer face of a connected piece: from an edge at the very left on, at each node the rightmost turn, until the
  /// first passage comes again.
  Face face_of(std::vector<std::size_t> piece) const {
    Face face{std::move(piece), {}, false};
    const std::optional<Passage> first = leftmost(face.edges);
    face.encloses = first.has_value();
    // All of it is loose: it encloses nothing.
    if (!first) return face;
    std::vector<Passage> around;
    Passage now = *first;
    // As the next passage of each is unique, and so is the one before, the walk returns to its first.
    do {
      around.push_back(now);
      now = rightmost(end_of(now), {now.edge, !now.forward});
    } while (now.edge != first->edge || now.forward != first->forward);
    // The drawing may cross without a node. Then the walk is not around the outside, and no loops are given.
    std::vector<std::vector<Passage>> loops = loops_of(around);
    if (surround(loops, around, face.edges)) face.loops = std::move(loops);
    return face;
  }

  /// The way around in pieces that pass no node twice; there and back along a bridge is none.
  std::vector<std::vector<Passage>> loops_of(const std::vector<Passage>& around) const {
    std::vector<std::vector<Passage>> loops;
    std::vector<Passage> open;
    std::map<std::size_t, std::size_t> reached;  // of each node on the way, how much of `open` led there
    reached[leaving(around.front()).node] = 0;
    // `open` is a path that passes no node twice. A node that comes again closes a loop, which is taken out of it.
    for (const Passage& one : around) {
      open.push_back(one);
      const auto [known, is_new] = reached.try_emplace(end_of(one), open.size());
      if (is_new) continue;
      const auto begin = open.begin() + static_cast<std::ptrdiff_t>(known->second);
      std::vector<Passage> loop(begin, open.end());
      // The nodes inside the loop are on the path no more; the one where it closed still is.
      for (auto passed = loop.begin(); passed + 1 != loop.end(); ++passed) reached.erase(end_of(*passed));
      open.erase(begin, open.end());
      // There and back on one edge.
      const bool is_bridge = loop.size() == 2 && loop[0].edge == loop[1].edge;
      if (!is_bridge) loops.push_back(std::move(loop));
    }
    return loops;
  }

  /// An edge at the very left, passed through downwards: as the outside is counter-clockwise.
  std::optional<Passage> leftmost(const std::vector<std::size_t>& piece) const {
    std::optional<Passage> best;
    double least = 0;
    for (const std::size_t k : piece) {
      if (loose_[k]) continue;
      const std::vector<Vec2>& points = edges_[k].points;
      // At the leftmost point of a counter-clockwise boundary the way leads downwards. If that point is a node, the
      // lowest edge that leaves it is the one.
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (best && !(points[i].x() < least)) continue;
        least = points[i].x();
        if (i == 0) {
          best = lowest_at(edges_[k].front.node);
        } else if (i + 1 == points.size()) {
          best = lowest_at(edges_[k].back.node);
        } else {
          best = Passage{k, turns_left(points[i - 1], points[i], points[i + 1])};
        }
      }
    }
    return best;
  }

  /// On the way through a leftmost point: then it is counter-clockwise.
  static bool turns_left(const Vec2& before, const Vec2& point, const Vec2& after) {
    const double turn = cross(point - before, after - point);
    // Straight there, the edge is vertical: forward must be downwards.
    return turn != 0 ? turn > 0 : after.y() < before.y();
  }

  /// All edges of a leftmost node lead to the right: the rightmost turn of who comes from the left is the lowest.
  Passage lowest_at(std::size_t node) const { return next_after(std::numbers::pi, 0, kept(node), std::nullopt); }

  /// The passage that follows at a node after coming in by `back`, as seen leaving: the next one counter-clockwise.
  Passage rightmost(std::size_t node, const Passage& back) const {
    return next_after(leaving(back).heading, leaving(back).curvature, kept(node), back);
  }

  /// The first edge counter-clockwise from a heading; `back` itself only where there is no other.
  Passage next_after(double heading, double curvature, const std::vector<Passage>& here,
                     const std::optional<Passage>& back) const {
    struct Way {
      bool is_back = false;
      double turn = 0;  // counter-clockwise, in [0, 2 pi]
      double bend = 0;  // how much more it turns left
    };
    // An edge with the heading of the way back: if it bends more to the left it is the first one counter-clockwise,
    // else the last.
    const auto way = [&](const Passage& one) {
      Way result{back && one.edge == back->edge && one.forward == back->forward, 0, leaving(one).curvature - curvature};
      result.turn = nearest_angle(leaving(one).heading - heading);
      if (std::abs(result.turn) < kSameHeading) {
        result.turn = result.bend > 0 ? 0 : kFullTurn;
      } else if (result.turn < 0) {
        result.turn += kFullTurn;
      }
      return result;
    };
    // The least turn; among equal headings the one that bends less to the left; the way back last of all.
    return *std::min_element(here.begin(), here.end(), [&](const Passage& a, const Passage& b) {
      const Way one = way(a);
      const Way other = way(b);
      if (one.is_back != other.is_back) return other.is_back;
      return std::abs(one.turn - other.turn) < kSameHeading ? one.bend < other.bend : one.turn < other.turn;
    });
  }

  /// The points along a loop, the end of each passage left out, as it is the start of the next.
  Polygon polygon_of(const std::vector<Passage>& loop) const {
    Polygon polygon;
    for (const Passage& one : loop) {
      std::vector<Vec2> points = edges_[one.edge].points;
      if (!one.forward) std::reverse(points.begin(), points.end());
      polygon.points.insert(polygon.points.end(), points.begin(), points.end() - 1);
    }
    polygon.box = box_around(polygon.points);
    return polygon;
  }

  /// Whether all edges that are not around the outside lie within one of the loops.
  bool surround(const std::vector<std::vector<Passage>>& loops, const std::vector<Passage>& around,
                const std::vector<std::size_t>& piece) const {
    std::vector<Polygon> polygons;
    for (const std::vector<Passage>& loop : loops) polygons.push_back(polygon_of(loop));
    std::vector<bool> is_around(edges_.size(), false);
    for (const Passage& one : around) is_around[one.edge] = true;
    const auto is_inside = [&](const Vec2& point) {
      return std::any_of(polygons.begin(), polygons.end(),
                         [&](const Polygon& polygon) { return polygon.contains(point); });
    };
    // Edges that are around the outside are its boundary; loose ones may stick out.
    return std::all_of(piece.begin(), piece.end(), [&](std::size_t k) {
      const std::vector<Vec2>& points = edges_[k].points;
      if (is_around[k] || loose_[k]) return true;
      // Its ends may be nodes of the face itself: points of the polygon.
      return points.size() == 2 ? is_inside(0.5 * (points.front() + points.back()))
                                : std::all_of(points.begin() + 1, points.end() - 1, is_inside);
    });
  }

  const std::vector<Edge>& edges_;        // all that branch
  std::vector<std::vector<Passage>> at_;  // those that leave each node
  std::vector<bool> loose_;               // of each edge
};

}  // namespace

Edge edge_along(const std::vector<Curve>& curves, std::size_t front, std::size_t back) {
  Outline outline;
  outline.curves = curves;
  std::vector<Vec2> points = polygon_of(outline).points;
  points.push_back(curves.back().back());
  return {departure(curves.front(), true, front), departure(curves.back(), false, back), std::move(points)};
}

std::vector<Face> outer_faces(const std::vector<Edge>& edges, std::size_t nodes) {
  return OuterFace(edges, nodes).run();
}

}  // namespace rollfix::outline
