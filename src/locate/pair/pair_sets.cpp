#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "components.hpp"
#include "locate/searches.hpp"
#include "outline/turn.hpp"

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

// ---- what kind it is
// Notation:
//   (s, t)          a pair of first contacts: PairPoint; in a set `extent` is the box around it
//   f_k(s, t)       the equations of all readings, then the facing: `f`, with their Jacobian: `linearize`
//   sign            of det J at a root: on which side the one curve passes the other
//   cluster         a connected set of pairs within the tolerance
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Two fingers", step 7, and the kinds of
// "MULTIPLE SOLUTIONS". Least squares by Levenberg (1944) and Marquardt (1963).
// Idea: a set is a stretch where f = 0 on a line, a crossing where the signs of its roots do not add up to 0, else it
// touches. Without a root its start is where the largest |f_k| is least.

namespace {

// Two finds of one root: closer than this share of the perimeter, f not leaving 0 in between.
constexpr double kSameRoot = 1e-6;
// The least residual of a set is looked for on so many grids of so many cells, each half as wide as the one before.
constexpr std::size_t kGrid = 8;
constexpr int kGridRounds = 24;
// A way that is less than this share of the perimeter leads nowhere: least squares have arrived.
constexpr double kStandstill = 1e-15;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// What kind of answer a connected set of pairs is.
class SetsOfTwo {
 public:
  explicit SetsOfTwo(const ContactEquations& question)
      : question_(question), part_(question.part), turning_(part_.turning()), period_(part_.perimeter()) {}

  /// Kind, start and roots of a cluster. Without a root the start is where the largest |f_k| is least.
  FoundSet set_of(const PairCluster& cluster) const {
    const std::vector<PairRoot> roots = distinct_roots(cluster);
    const PairRoot start = roots.empty() ? nearest_miss(cluster) : roots.front();
    FoundSet found{kind_of(cluster, roots, start), start.at, cluster.extent, cluster.whole_loop, {}};
    for (const PairRoot& root : roots) found.roots.push_back(root.at);
    // With pivots the best place can be a root of all equations although none of the finds was one.
    const bool may_be_root = roots.empty() && start.corner && question_.is_overdetermined();
    if (may_be_root && residual_at(question_, start.at) <= kRootTurn) found.roots.push_back(start.at);
    found.family.assign(cluster.family.begin(), cluster.family.end());
    found.family_error = cluster.family_error;
    return found;
  }

 private:
  /// The roots of a cluster, each once; one that was found from two sides with different signs of det J has none.
  std::vector<PairRoot> distinct_roots(const PairCluster& cluster) const {
    std::vector<PairRoot> found;
    if (cluster.exact) {  // the first of its continuum
      PairRoot first;
      first.at = cluster.first;
      for (const PairRoot& root : cluster.roots) first.corner = first.corner || root.corner;
      found.push_back(first);
      return found;
    }
    // Most clusters have one root and need no sorting.
    if (cluster.roots.size() == 1) return is_exact(cluster.roots.front()) ? cluster.roots : found;
    std::vector<PairRoot> roots = cluster.roots;
    std::sort(roots.begin(), roots.end(), [](const PairRoot& one, const PairRoot& two) { return one.at < two.at; });
    for (const PairRoot& root : roots) {
      // Each root is compared with all found before: few are in one cluster.
      if (!is_exact(root)) continue;
      const auto same =
          std::find_if(found.begin(), found.end(), [&](const PairRoot& other) { return is_same(other, root); });
      if (same == found.end()) {
        found.push_back(root);
      } else {
        // Found with both signs: the curves touch there, J is singular.
        if (differ_in_sign(*same, root)) same->sign = 0;
        same->corner = same->corner && root.corner;
      }
    }
    return found;
  }

  /// Where contacts pivot each equation may have been met by a pivot of its own: all of more than two need one.
  bool is_exact(const PairRoot& root) const {
    if (!root.exact || !root.corner || !question_.is_overdetermined()) return root.exact;
    return residual_at(question_, root.at) <= kRootTurn;
  }

  /// Was the one root found on either side of where J is singular? Of more than two equations each find has the sign of
  /// two of them: those decide whose determinants are largest at both.
  bool differ_in_sign(const PairRoot& one, const PairRoot& two) const {
    if (!question_.is_overdetermined()) return one.sign != two.sign;
    Eigen::VectorXd f;
    std::array<Matrix, 2> jacobian;
    linearize(one.at, f, jacobian[0]);
    linearize(two.at, f, jacobian[1]);
    double largest = 0;
    for (Eigen::Index p = 0; p + 1 < f.size(); ++p) {
      for (Eigen::Index q = p + 1; q < f.size(); ++q) {
        const auto determinant = [&](const Matrix& by) { return by(p, 0) * by(q, 1) - by(p, 1) * by(q, 0); };
        // Below 0: det J of these two rows changes sign from one find to the other.
        const double product = determinant(jacobian[0]) * determinant(jacobian[1]);
        if (std::abs(product) > std::abs(largest)) largest = product;
      }
    }
    return largest < 0;
  }

  /// Are two finds one root? Where they are within rounding, or near to each other and f is still 0 half way.
  bool is_same(const PairRoot& one, const PairRoot& two) const {
    const double far = std::max(periodic(one.at[0], two.at[0]), periodic(one.at[1], two.at[1]));
    if (far <= 2 * kLengthAccuracy * period_) return true;
    if (far > kSameRoot * period_) return false;
    const PairPoint middle{one.at[0] + 0.5 * signed_way(one.at[0], two.at[0]),
                           one.at[1] + 0.5 * signed_way(one.at[1], two.at[1])};
    return residual_at(question_, middle) <= kRootTurn;
  }

  /// The shorter way from one place to another, below 0 backwards; and its length.
  double signed_way(double from, double to) const { return part_.boundary().offset(from, to); }
  double periodic(double one, double two) const { return std::abs(signed_way(one, two)); }

  /// Where the largest |f_k| is least: looked for on ever finer grids and, since the set may be much thinner than any
  /// grid, by least squares from their best place and from the ends of the set.
  PairRoot nearest_miss(const PairCluster& cluster) const {
    PairPoint best = least_on_grids(cluster.extent);
    // With corners f is set-valued, and its Jacobian does not exist everywhere: the grids alone.
    if (!part_.corners().empty()) return {best, 0, cluster.corner};
    double least = residual_at(question_, best);
    const PairBox& whole = cluster.extent;
    for (const PairPoint& from : {best, PairPoint{whole[0].lo, whole[1].lo}, PairPoint{whole[0].lo, whole[1].hi},
                                  PairPoint{whole[0].hi, whole[1].lo}, PairPoint{whole[0].hi, whole[1].hi}}) {
      const PairPoint at = least_squares(from, whole);
      const double residual = residual_at(question_, at);
      if (residual < least) {
        least = residual;
        best = at;
      }
    }
    return {best, 0, cluster.corner};
  }

  /// The place of the least residual on ever finer grids: each about the best place so far. Of a set with
  /// several minima it may be any.
  PairPoint least_on_grids(const PairBox& whole) const {
    PairBox box = whole;
    PairPoint best{box[0].middle(), box[1].middle()};
    double least = residual_at(question_, best);
    std::array<std::array<double, kGrid + 1>, 2> places;
    std::array<std::array<Tangents, kGrid + 1>, 2> tangents;
    const bool smooth = part_.corners().empty();
    for (int round = 0; round < kGridRounds; ++round) {
      for (const std::size_t finger : {0U, 1U}) {
        for (std::size_t i = 0; i <= kGrid; ++i) {
          places[finger][i] = box[finger].lo + box[finger].width() * static_cast<double>(i) / kGrid;
          // Tangents once for each line of the grid, not for each of its points.
          if (smooth) tangents[finger][i] = tangents_of(question_, finger, places[finger][i]);
        }
      }
      for (std::size_t i = 0; i <= kGrid; ++i) {
        for (std::size_t j = 0; j <= kGrid; ++j) {
          const PairPoint at{places[0][i], places[1][j]};
          const double residual =
              smooth ? residual_of(question_, tangents[0][i], tangents[1][j]) : residual_at(question_, at);
          if (residual < least) {
            least = residual;
            best = at;
          }
        }
      }
      for (const std::size_t k : {0U, 1U}) {
        // Half as wide in each direction, but never beyond the set.
        const double reach = 0.25 * box[k].width();
        box[k] = {std::max(whole[k].lo, best[k] - reach), std::min(whole[k].hi, best[k] + reach)};
      }
    }
    return best;
  }

  /// f and its Jacobian J by (s, t), eqs. (8) and (9); the facing equation is the last row, to the nearest whole turn.
  void linearize(const PairPoint& at, Eigen::VectorXd& f, Matrix& jacobian) const {
    const auto count = static_cast<Eigen::Index>(question_.readings.size());
    f.resize(static_cast<Eigen::Index>(question_.rows()));
    jacobian.resize(f.size(), 2);
    const Turning s0 = turning_.at(at[0]);
    const Turning t0 = turning_.at(at[1]);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Reading& reading = question_.readings[static_cast<std::size_t>(k)];
      const Turning s = turning_.at(at[0] + reading.length[0]);
      const Turning t = turning_.at(at[1] + reading.length[1]);
      f[k] = (s.angle - s0.angle) - (t.angle - t0.angle) - reading.turn;  // eq. (8), (9)
      jacobian.row(k) << s.curvature - s0.curvature, t0.curvature - t.curvature;
    }
    if (!question_.facing) return;
    f[count] = std::remainder(s0.angle - t0.angle - *question_.facing, kFullTurn);
    jacobian.row(count) << s0.curvature, -t0.curvature;
  }

  /// Where the sum of all f_k^2 is least near `at`: Levenberg and Marquardt's method, kept within a box. Damping grows
  /// where a step is no better and falls where it is.
  PairPoint least_squares(PairPoint at, const PairBox& box) const {
    constexpr int kMostSteps = 60;
    const double no_way = kStandstill * period_;
    Eigen::VectorXd f;
    Matrix jacobian;
    linearize(at, f, jacobian);
    Eigen::VectorXd next_f;
    Matrix next_jacobian;
    double damping = 1e-6;
    for (int step = 0; step < kMostSteps && damping < 1e12; ++step) {
      // Marquardt's scaling: the diagonal times 1 + damping, so that units of s and t do not matter.
      Eigen::Matrix2d normal = jacobian.transpose() * jacobian;
      normal.diagonal() *= 1 + damping;
      const Eigen::Vector2d move = normal.ldlt().solve(-jacobian.transpose() * f);
      if (!move.allFinite()) break;
      PairPoint next;
      for (const std::size_t k : {0U, 1U}) {
        next[k] = std::clamp(at[k] + move[static_cast<Eigen::Index>(k)], box[k].lo, box[k].hi);
      }
      if (next == at) {  // no better
        damping *= 10;
        continue;
      }
      if (std::max(std::abs(next[0] - at[0]), std::abs(next[1] - at[1])) <= no_way) break;
      linearize(next, next_f, next_jacobian);
      const bool better = next_f.squaredNorm() < f.squaredNorm();
      damping *= better ? 0.1 : 10;
      if (!better) continue;
      at = next;
      f.swap(next_f);
      jacobian.swap(next_jacobian);
    }
    return at;
  }

  /// The kind of a cluster. With as many equations as unknowns the signs of det J add up to 0 where the curves touch:
  /// one curve crosses the other and comes back, or only touches it. A small change of a reading can then remove all
  /// roots.
  Kind kind_of(const PairCluster& cluster, const std::vector<PairRoot>& roots, const PairRoot& start) const {
    if (cluster.exact) return Kind::stretch;
    if (start.corner) return Kind::corner;
    int sum = 0;
    for (const PairRoot& root : roots) sum += root.sign;
    if (roots.empty()) {  // of more equations than two some may cross where the others miss
      const bool crossed = std::any_of(cluster.roots.begin(), cluster.roots.end(),
                                       [](const PairRoot& root) { return root.sign != 0 && !root.exact; });
      return crossed ? Kind::crossing : Kind::touching;
    }
    const bool many_rows = question_.is_overdetermined();
    // Each find of more than two equations has the sign of two of them, which need not be the same two: signs do not
    // add up.
    if (many_rows && roots.size() == 1) return roots.front().sign != 0 ? Kind::crossing : Kind::touching;
    return sum != 0 ? Kind::crossing : Kind::touching;
  }

  const ContactEquations& question_;
  const Part& part_;
  const TurningFunction& turning_;
  double period_;
};

}  // namespace

std::vector<Placement> make_placements(const ContactEquations& question, const std::vector<PairCluster>& clusters) {
  // Kinds and roots first, then the order, then the placements in that order.
  const SetsOfTwo sets(question);
  const PlacementMaker maker(question);
  struct Ranked {
    double
        rounded;  // starts that differ by less than their own accuracy count as one, so that the other finger's decide
    double other;
    FoundSet set;
  };
  const Boundary boundary = question.part.boundary();
  const double grain = kRootLength * question.part.perimeter();
  std::vector<Ranked> ranked;
  ranked.reserve(clusters.size());
  for (const PairCluster& cluster : clusters) {
    FoundSet set = sets.set_of(cluster);
    const double rounded = std::round(boundary.canonical(set.start[0]) / grain);
    ranked.push_back({rounded, boundary.canonical(set.start[1]), std::move(set)});
  }
  // Ordered by s to the accuracy of roots, then by t, then as found.
  std::vector<std::size_t> order(ranked.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t two) {
    return std::tie(ranked[one].rounded, ranked[one].other, one) <
           std::tie(ranked[two].rounded, ranked[two].other, two);
  });
  std::vector<Placement> placements(clusters.size());
  for (std::size_t k = 0; k < order.size(); ++k) maker.make(std::move(ranked[order[k]].set), placements[k]);
  return placements;
}

}  // namespace rollfix::locating
