#include "components.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

// Notation, as in piece_links.cpp:
//   piece, shift    a connected set of pairs (s, t) within the tolerance, and whole laps that it is moved by
//   link            two pieces that touch
//   extent          what all pieces of a component reach over, unwrapped
//   slant           the direction that roots are sorted along
// Follows docs/search.md, "Two fingers", step 7.
// Idea: connected components of what touches: each is one placement.
namespace rollfix::locating {
namespace {

bool holds(const PairBox& box, const PairPoint& at) {
  return at[0] >= box[0].lo && at[0] <= box[0].hi && at[1] >= box[1].lo && at[1] <= box[1].hi;
}

/// Walks the graph of pieces that touch: each connected component is a cluster. Then hands out the roots.
class Joiner {
 public:
  Joiner(const Part& part, const PairFindings& findings, double same_place)
      : pieces_(findings.pieces),
        roots_(findings.roots),
        boundary_(part.boundary()),
        same_place_(same_place),
        links_(links_of(pieces_, boundary_, same_place)) {}

  /// One cluster for each connected component, in the order of its first piece.
  std::vector<PairCluster> run() {
    std::vector<PairCluster> clusters;
    std::vector<bool> seen(pieces_.size(), false);
    shift_of_.assign(pieces_.size(), {0, 0});
    sort_roots();
    std::vector<std::vector<std::size_t>> members;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (!seen[k]) clusters.push_back(cluster_of(k, seen, members.emplace_back()));
    }
    // The box about a line may hold what is not near it, and what is another set's.
    for (const bool near_lines : {true, false}) {
      if (not_taken(0) == roots_.size()) break;
      for (std::size_t k = 0; k < clusters.size(); ++k) hand_out_roots(members[k], near_lines, clusters[k]);
    }
    return clusters;
  }

 private:
  /// The connected component of piece `first`, with its pieces in `members`. shift_of_ says for each of them by how
  /// many laps it is moved to hang together with the first one; the extent is of the moved pieces.
  PairCluster cluster_of(std::size_t first, std::vector<bool>& seen, std::vector<std::size_t>& members) {
    PairCluster cluster;
    std::vector<std::size_t> waiting{first};
    seen[first] = true;
    cluster.extent = pieces_[first].box;
    cluster.corner = true;
    // All that waits is marked as seen, with its shift.
    while (!waiting.empty()) {
      const std::size_t here = waiting.back();
      waiting.pop_back();
      members.push_back(here);
      const PairBox box = moved(pieces_[here].box, shift_of_[here]);
      for (const std::size_t k : {0U, 1U}) {
        cluster.extent[k].lo = std::min(cluster.extent[k].lo, box[k].lo);
        cluster.extent[k].hi = std::max(cluster.extent[k].hi, box[k].hi);
      }
      cluster.exact = cluster.exact || pieces_[here].exact;
      cluster.corner = cluster.corner && pieces_[here].corner;
      for (const PieceLink& link : links_[here]) {
        if (seen[link.to]) continue;
        seen[link.to] = true;
        shift_of_[link.to] = {shift_of_[here][0] + link.shift[0], shift_of_[here][1] + link.shift[1]};
        waiting.push_back(link.to);
      }
    }
    // A set that goes all the way round covers the whole loop, wherever it was cut.
    for (const std::size_t k : {0U, 1U}) {
      if (boundary_.closed && covers_loop(members, k)) {
        cluster.whole_loop[k] = true;
        cluster.extent[k] = {0, boundary_.perimeter};
      }
    }
    // Of a continuum: where it begins, and a line through all of it.
    if (cluster.exact) {
      cluster.first = first_exact(members, cluster);
      FamilyLine line = line_through_family(pieces_, links_, members, boundary_.perimeter);
      cluster.family = std::move(line.points);
      cluster.family_error = line.error;
    }
    return cluster;
  }

  /// Where an exact set begins, however its pieces were cut and in whatever order they were found.
  PairPoint first_exact(const std::vector<std::size_t>& members, const PairCluster& cluster) const {
    PairPoint first{std::numeric_limits<double>::infinity(), 0};
    // The least s so far; of those that are least but for rounding, the least t.
    const auto try_point = [&](PairPoint at) {
      for (const std::size_t k : {0U, 1U}) {
        if (cluster.whole_loop[k]) at[k] = boundary_.canonical(at[k]);
      }
      const double ahead = first[0] - at[0];
      if (ahead > same_place_ || (ahead >= -same_place_ && at[1] < first[1])) first = at;
    };
    for (const std::size_t k : members) {
      const PairPiece& piece = pieces_[k];
      if (!piece.exact) continue;
      if (piece.line.empty()) try_point(moved(PairPoint{piece.box[0].lo, piece.box[1].lo}, shift_of_[k]));
      for (const PairPoint& at : piece.line) try_point(moved(at, shift_of_[k]));
    }
    return first;
  }

  /// Do the members' intervals, together, cover all of one finger's boundary?
  bool covers_loop(const std::vector<std::size_t>& members, std::size_t finger) const {
    double widths = 0;
    for (const std::size_t k : members)
      widths += pieces_[k].box[finger].width() + 2 * kJointWidth * boundary_.perimeter;
    if (widths < 0.5 * boundary_.perimeter) return false;  // too short together: no sort needed
    std::vector<Interval> intervals;
    for (const std::size_t k : members) {
      const Interval& interval = pieces_[k].box[finger];
      if (interval.width() > 0) intervals.push_back(interval);
    }
    std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
    const double slack = kJointWidth * boundary_.perimeter;
    // [0, reached] is covered by the intervals so far, but for joints.
    double reached = slack;
    for (const Interval& interval : intervals) {
      if (interval.lo > reached + slack) return false;
      reached = std::max(reached, interval.hi);
    }
    return reached >= boundary_.perimeter - slack;
  }

  /// Orders the roots along the slant, all of them still to be handed out.
  void sort_roots() {
    not_taken_.resize(roots_.size() + 1);
    std::iota(not_taken_.begin(), not_taken_.end(), std::size_t{0});
    roots_at_.reserve(roots_.size());
    for (const PairRoot& root : roots_) roots_at_.push_back({along_slant(root.at), along_slant(root.at)});
    root_order_ = by_place(roots_at_);
  }

  /// The first root, in their order from this one on, that no piece has taken; the number of roots if there is none.
  /// Ways are shortened as they are gone (path compression), so that taken roots are not passed again and again.
  std::size_t not_taken(std::size_t from) {
    std::size_t found = from;
    while (not_taken_[found] != found) found = not_taken_[found];
    while (from != found) from = std::exchange(not_taken_[from], found);
    return found;
  }

  /// A root is the first piece's that holds it; with `near_lines`, of one with a line, that is near that.
  void hand_out_roots(const std::vector<std::size_t>& members, bool near_lines, PairCluster& cluster) {
    std::vector<std::pair<std::size_t, PairPoint>> found;
    for (const std::size_t k : members) {
      const PairBox box = widened(pieces_[k].box, same_place_);
      // Roots in the box have a place along the slant within the box's own: a stretch of their order.
      const Interval reach = along_slant(box);
      const auto from = std::lower_bound(root_order_.begin(), root_order_.end(), reach.lo,
                                         [&](std::size_t root, double value) { return roots_at_[root].lo < value; });
      auto next = not_taken(static_cast<std::size_t>(from - root_order_.begin()));
      for (; next < root_order_.size() && roots_at_[root_order_[next]].lo <= reach.hi; next = not_taken(next + 1)) {
        const std::size_t root = root_order_[next];
        if (!holds(box, roots_[root].at)) continue;
        if (near_lines && !is_near_line(pieces_[k], roots_[root].at)) continue;
        not_taken_[next] = next + 1;
        found.emplace_back(root, moved(roots_[root].at, shift_of_[k]));
      }
    }
    // In the order in which the search found them, whichever piece holds them.
    std::sort(found.begin(), found.end());
    for (const auto& [root, at] : found) {
      cluster.roots.push_back(roots_[root]);
      cluster.roots.back().at = at;
    }
  }

  /// Is the root as near to the piece's line as the line may be off? True for a piece without a line.
  bool is_near_line(const PairPiece& piece, const PairPoint& at) const {
    if (piece.line.empty()) return true;
    const double reach = piece.error + same_place_ + kJointWidth * boundary_.perimeter;
    return line_meets(piece.line, {0, 0}, {Interval{at[0], at[0]}, Interval{at[1], at[1]}}, reach);
  }

  const std::vector<PairPiece>& pieces_;
  const std::vector<PairRoot>& roots_;
  Boundary boundary_;
  double same_place_;
  std::vector<std::vector<PieceLink>> links_;
  std::vector<Shift> shift_of_;          // of each piece, from where it is to its place in its cluster
  std::vector<Interval> roots_at_;       // along the slant, and ...
  std::vector<std::size_t> root_order_;  // ... in that order, in which ...
  std::vector<std::size_t> not_taken_;   // ... from each one there leads a way to the next that is not taken
};

}  // namespace

std::vector<PairCluster> join_pieces(const Part& part, const PairFindings& findings, double same_place) {
  return Joiner(part, findings, same_place).run();
}

}  // namespace rollfix::locating
