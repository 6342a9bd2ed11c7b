#include "outline/outer_face.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "outline/joining.hpp"
#include "outline/turn.hpp"

namespace rollfix {

namespace {

/// Tangents closer together than this are one, and the curvature says which edge is on which side: drawings hold some
/// seven digits.
constexpr double kSameHeading = 1e-6;

class OuterFace {
 public:
  OuterFace(const std::vector<Edge>& edges, std::size_t nodes) : edges_(edges), at_(nodes), loose_(edges.size()) {
    for (std::size_t k = 0; k < edges.size(); ++k) {
      at_[edges[k].front.node].push_back({k, true});
      at_[edges[k].back.node].push_back({k, false});
    }
    leave_out_loose_ends();
  }

  std::vector<Face> run() {
    std::vector<Face> faces;
    std::vector<bool> seen(edges_.size(), false);
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      if (!seen[k]) faces.push_back(face_of(piece_with(k, seen)));
    }
    return faces;
  }

 private:
  const Departure& leaving(const Passage& one) const {
    return one.forward ? edges_[one.edge].front : edges_[one.edge].back;
  }
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

  /// An edge alone at one of its ends is loose, and what it leaves alone is loose as well.
  void leave_out_loose_ends() {
    std::vector<std::size_t> waiting(at_.size());
    for (std::size_t node = 0; node < at_.size(); ++node) waiting[node] = node;
    while (!waiting.empty()) {
      const std::vector<Passage> here = kept(waiting.back());
      waiting.pop_back();
      if (here.size() != 1) continue;
      loose_[here.front().edge] = true;
      waiting.push_back(end_of(here.front()));
    }
  }

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

  Face face_of(std::vector<std::size_t> piece) const {
    Face face{std::move(piece), {}, false};
    const std::optional<Passage> first = leftmost(face.edges);
    face.encloses = first.has_value();
    if (!first) return face;
    std::vector<bool> passed(edges_.size(), false);
    std::vector<Passage> around;
    Passage now = *first;
    do {
      if (passed[now.edge]) return face;  // the outside passes one edge twice: a bridge between two loops
      passed[now.edge] = true;
      around.push_back(now);
      now = rightmost(end_of(now), {now.edge, !now.forward});
    } while (now.edge != first->edge || now.forward != first->forward);
    if (surrounds(around, passed, face.edges)) face.around = std::move(around);
    return face;
  }

  /// An edge at the very left, passed through downwards: as the outside is counter-clockwise.
  std::optional<Passage> leftmost(const std::vector<std::size_t>& piece) const {
    std::optional<Passage> best;
    double least = 0;
    for (const std::size_t k : piece) {
      if (loose_[k]) continue;
      const std::vector<Vec2>& points = edges_[k].points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (best && !(points[i].x() < least)) continue;
        least = points[i].x();
        const bool at_node = i == 0 || i + 1 == points.size();
        best = at_node ? lowest_at(i == 0 ? edges_[k].front.node : edges_[k].back.node)
                       : Passage{k, points[i + 1].y() < points[i - 1].y()};
      }
    }
    return best;
  }

  /// All edges of a leftmost node lead to the right: the rightmost turn of who comes from the left is the lowest.
  Passage lowest_at(std::size_t node) const { return next_after(std::numbers::pi, 0, kept(node), std::nullopt); }

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
    return *std::min_element(here.begin(), here.end(), [&](const Passage& a, const Passage& b) {
      const Way one = way(a);
      const Way other = way(b);
      if (one.is_back != other.is_back) return other.is_back;
      return std::abs(one.turn - other.turn) < kSameHeading ? one.bend < other.bend : one.turn < other.turn;
    });
  }

  bool surrounds(const std::vector<Passage>& around, const std::vector<bool>& passed,
                 const std::vector<std::size_t>& piece) const {
    Polygon polygon;
    for (const Passage& one : around) {
      std::vector<Vec2> points = edges_[one.edge].points;
      if (!one.forward) std::reverse(points.begin(), points.end());
      polygon.points.insert(polygon.points.end(), points.begin(), points.end() - 1);
    }
    polygon.box = box_around(polygon.points);
    return std::all_of(piece.begin(), piece.end(), [&](std::size_t k) {
      const std::vector<Vec2>& points = edges_[k].points;
      if (passed[k] || loose_[k]) return true;
      // Its ends may be nodes of the face itself: points of the polygon.
      return points.size() == 2 ? polygon.contains(0.5 * (points.front() + points.back()))
                                : std::all_of(points.begin() + 1, points.end() - 1,
                                              [&](const Vec2& point) { return polygon.contains(point); });
    });
  }

  const std::vector<Edge>& edges_;
  std::vector<std::vector<Passage>> at_;  // those that leave each node
  std::vector<bool> loose_;
};

}  // namespace

std::vector<Face> outer_faces(const std::vector<Edge>& edges, std::size_t nodes) {
  return OuterFace(edges, nodes).run();
}

}  // namespace rollfix
