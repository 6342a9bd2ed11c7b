#include "searches.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

// Notation:
//   f(s)            Theta(s + L) - Theta(s) - theta, eqs. (4), (5): ResidualSample; of several readings the largest |f|
//   piece, root     what the search left, and zeros of f in it: StartPiece, Root
//   cluster         pieces that touch, across s = 0 as well: one placement
//   P               the perimeter: `period_`
// Follows docs/search.md, "Once per reading", 7, and "MULTIPLE SOLUTIONS".
// Idea: a cluster is one connected set, and f at its two ends says of which kind. Readings share a root where the steps
// of Gauss and Newton from one of theirs bring the largest |f| down to rounding. Where there is none, golden sections
// find what misses least.
namespace rollfix::locating {
namespace {

// A place known to this share of the perimeter is known as well as it can be.
constexpr double kPolished = 1e-14;
// A value so many times further off than rounding leaves it is no root.
constexpr double kManyRoundings = 1000;

using Roots = boost::container::small_vector<Root, 4>;

/// Pieces that touch, and the roots in them. lo <= hi, hi beyond P where it reaches across s = 0.
struct Cluster {
  double lo = 0;
  double hi = 0;
  bool exact = false;
  bool corner = false;  // all of its pieces are
  bool whole_loop = false;
  bool is_joined = false;      // of several pieces
  std::size_t first_root = 0;  // of those handed out
  std::size_t root_count = 0;
};
using Clusters = boost::container::small_vector<Cluster, kFewAnswers>;

/// Joins pieces that touch, in rising order. Sorts the pieces. On a closed part the last cluster goes on across s = 0
/// where both ends of the boundary are covered; one that covers all of it is a whole loop.
Clusters clusters_of(const Part& part, Pieces& pieces) {
  Clusters clusters;
  const double same_place = kLengthAccuracy * part.perimeter();
  const auto earlier = [](const StartPiece& one, const StartPiece& two) { return one.lo < two.lo; };
  if (!std::is_sorted(pieces.begin(), pieces.end(), earlier)) std::sort(pieces.begin(), pieces.end(), earlier);
  for (const StartPiece& piece : pieces) {
    // Pieces within rounding of each other are one connected set.
    if (clusters.empty() || piece.lo > clusters.back().hi + same_place) {
      clusters.push_back({piece.lo, piece.hi, piece.exact, piece.corner});
    } else {
      clusters.back().hi = std::max(clusters.back().hi, piece.hi);
      clusters.back().exact |= piece.exact;
      clusters.back().corner &= piece.corner;
      clusters.back().is_joined = true;
    }
  }
  if (clusters.empty() || !part.closed()) return clusters;
  const double period = part.perimeter();
  // s = 0 and s = P are one place.
  const bool joined = clusters.front().lo <= same_place && clusters.back().hi >= period - same_place;
  if (joined && clusters.size() == 1) {
    Cluster& only = clusters.front();
    only.whole_loop = only.hi - only.lo >= period - 2 * same_place;
    if (only.whole_loop) only = {0, period, only.exact, false, true, true};
  } else if (joined) {
    clusters.back().hi = period + clusters.front().hi;
    clusters.back().exact |= clusters.front().exact;
    clusters.back().corner &= clusters.front().corner;
    clusters.back().is_joined = true;
    clusters.erase(clusters.begin());
  }
  return clusters;
}

/// Each root to the first cluster that holds it, if there is one: those of one cluster next to each other, in rising
/// order. Clusters are in rising order and apart.
FoundRoots handed_out(const Part& part, FoundRoots& roots, Clusters& clusters) {
  FoundRoots handed;
  if (clusters.empty()) return handed;
  const auto earlier = [](const Root& one, const Root& two) { return one.s < two.s; };
  if (!std::is_sorted(roots.begin(), roots.end(), earlier)) std::sort(roots.begin(), roots.end(), earlier);
  const double same_place = kLengthAccuracy * part.perimeter();
  const auto take = [&](Cluster& cluster, const Root& root) {
    if (root.s < cluster.lo - same_place || root.s > cluster.hi + same_place) return false;
    if (cluster.root_count++ == 0) cluster.first_root = handed.size();
    handed.push_back(root);
    return true;
  };
  // Roots and clusters are both in rising order: one pass.
  FoundRoots left;  // that no cluster holds before s = 0 is crossed
  auto next = clusters.begin();
  for (const Root& root : roots) {
    while (next != clusters.end() && next->hi + same_place < root.s) ++next;
    if (next == clusters.end() || !take(*next, root)) left.push_back(root);
  }
  if (!part.closed()) return handed;
  for (Root& root : left) {  // into the last one, across s = 0
    root.s += part.perimeter();
    take(clusters.back(), root);
  }
  return handed;
}

/// Makes one placement of each cluster: its roots, its kind and, where there is no root, the best place.
class SetsOfOne {
 public:
  SetsOfOne(const ContactEquations& question, const FoundRoots& roots)
      : question_(question),
        handed_out_(roots),
        turning_(question.part.turning()),
        readings_(question.readings),
        maker_(question),
        period_(question.part.perimeter()) {}

  /// The placement of a cluster: its kind, its roots, and as start the first root or the best place.
  void make(const Cluster& cluster, Placement& placement) const {
    const Interval extent{cluster.lo, cluster.hi};
    // The most frequent answer: one reading, one simple root. The search has its sample already.
    if (readings_.size() == 1 && readings_[0].is_exact() && cluster.root_count == 1 && roots_of(cluster)->crossing &&
        !cluster.is_joined) {
      const Root& root = *roots_of(cluster);
      const SlopeSample sample{root.sample.value, root.sample.start_curvature, root.sample.end_curvature};
      maker_.make_crossing(root.s, root.panel, extent, sample, placement);
      return;
    }
    const Roots roots = exact_roots(cluster);
    const Root start = roots.empty() ? nearest_miss(cluster) : roots.front();
    FoundSet found{kind_of(cluster, roots, start), start.s, extent, cluster.whole_loop, {}};
    for (const Root& root : roots) found.roots.push_back(root.s);
    maker_.make(std::move(found), placement);
  }

 private:
  // ---- roots ----

  /// The first of the cluster's `root_count` roots.
  const Root* roots_of(const Cluster& cluster) const { return handed_out_.data() + cluster.first_root; }

  /// f and its slope at any s, eqs. (4) and (5), Theta taken as the limit from above.
  ResidualSample sample(const Reading& reading, double s) const {
    const Turning at_start = turning_.at(s);
    const Turning at_end = turning_.at(s + reading.length[0]);
    return {s, at_end.angle - at_start.angle - reading.turn, at_start.curvature, at_end.curvature};
  }

  /// The places in a cluster where every reading's f is 0, each once.
  Roots exact_roots(const Cluster& cluster) const {
    Roots found;
    double looked_at = -std::numeric_limits<double>::infinity();  // the last crossing that all may share
    for (std::size_t k = 0; k < cluster.root_count; ++k) {
      const Root& root = roots_of(cluster)[k];
      Root candidate = root;
      // One reading: the search said whether f = 0 there. Several: f of all of them must be.
      if (readings_.size() == 1) {
        if (!root.exact) continue;
      } else {
        if (root.crossing && !question_.is_open()) {
          // Readings find a root that they share again: once is enough.
          if (root.s - looked_at <= kLengthAccuracy * period_ || !may_be_shared(root)) continue;
          looked_at = root.s;
          candidate.s = polished_together(root.s, cluster);
        }
        if (residual_at(question_, candidate.s) > kRootTurn) continue;
      }
      // One root that two readings, or two neighbouring intervals, found: a crossing only if each find says so.
      if (!found.empty() && same_root(found.back(), candidate)) {
        found.back().crossing &= candidate.crossing;
        found.back().corner |= candidate.corner;
        continue;
      }
      found.push_back(candidate);
      if (cluster.exact || question_.is_open()) break;  // the rest is its continuum
    }
    return found;
  }

  /// Can one place be a root of every reading's f? A root is known to kRootTurn over its own slope, so another f may be
  /// off there by its slope times that. Compared without a division, so that slopes of 0 are allowed.
  bool may_be_shared(const Root& root) const {
    const double own = std::abs(root.sample.slope());
    return std::all_of(readings_.begin(), readings_.end(), [&](const Reading& reading) {
      if (!reading.is_exact()) return true;
      const ResidualSample at = sample(reading, root.s);
      return !(own * std::abs(at.value) > kManyRoundings * kRootTurn * (own + std::abs(at.slope())));
    });
  }

  /// Where the sum of all f_k^2 is least, by Gauss-Newton steps from s that stay in the cluster: steep readings weigh
  /// most.
  double polished_together(double s, const Cluster& cluster) const {
    for (int round = 0; round < 3; ++round) {
      double normal = 0;
      double right = 0;
      for (const Reading& reading : readings_) {
        if (!reading.is_exact()) continue;
        const ResidualSample at = sample(reading, s);
        normal += at.slope() * at.slope();
        right -= at.slope() * at.value;
      }
      // Where all slopes are 0 the step is no number and ends the loop.
      const double next = s + right / normal;
      if (!(next >= cluster.lo && next <= cluster.hi)) break;
      s = next;
    }
    return s;
  }

  /// Between two finds of one root f does not leave 0.
  bool same_root(const Root& one, const Root& two) const {
    if (two.s - one.s <= kLengthAccuracy * period_) return true;
    return two.s - one.s <= 1e-6 * period_ && residual_at(question_, 0.5 * (one.s + two.s)) <= kTurnAccuracy;
  }

  /// Where the largest |f| is least: at an extremum, at a joint, or at an end of the cluster; for several readings
  /// also where two of them are equally far off.
  Root nearest_miss(const Cluster& cluster) const {
    Root best;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](double s, bool corner) {
      const double residual = residual_at(question_, s);
      if (residual < least) {
        least = residual;
        best = {s, false, corner || cluster.corner};
      }
    };
    consider(cluster.lo, false);
    consider(cluster.hi, false);
    for (std::size_t k = 0; k < cluster.root_count; ++k) {
      const Root& root = roots_of(cluster)[k];
      consider(root.s, root.corner);
    }
    if (readings_.size() > 1) consider(golden_section(cluster), false);
    return best;
  }

  /// A minimum of the largest |f_k| in the cluster, by golden sections; the least of all where there is only one.
  double golden_section(const Cluster& cluster) const {
    constexpr double kRatio = 0.6180339887498949;
    double lo = cluster.lo;
    double hi = cluster.hi;
    double inner_lo = hi - kRatio * (hi - lo);
    double inner_hi = lo + kRatio * (hi - lo);
    double value_lo = residual_at(question_, inner_lo);
    double value_hi = residual_at(question_, inner_hi);
    // lo < inner_lo < inner_hi < hi, and the residual is known at both inner places; each round evaluates one more.
    while (hi - lo > kPolished * period_) {
      if (value_lo <= value_hi) {
        hi = inner_hi;
        inner_hi = inner_lo;
        value_hi = value_lo;
        inner_lo = hi - kRatio * (hi - lo);
        value_lo = residual_at(question_, inner_lo);
      } else {
        lo = inner_lo;
        inner_lo = inner_hi;
        value_lo = value_hi;
        inner_hi = lo + kRatio * (hi - lo);
        value_hi = residual_at(question_, inner_hi);
      }
      if (!(inner_lo > lo && inner_hi < hi)) break;
    }
    return 0.5 * (lo + hi);
  }

  // ---- what kind ----

  /// The kind of the connected set (search.md, "MULTIPLE SOLUTIONS"); `start` is its first root or its best place.
  Kind kind_of(const Cluster& cluster, const Roots& roots, const Root& start) const {
    const bool is_wide = cluster.hi - cluster.lo > kLengthAccuracy * period_;
    // An interval on which f = 0, or on which readings that are intervals fit.
    if (cluster.exact || (is_wide && question_.is_open())) return Kind::stretch;
    if (start.corner) return Kind::corner;
    if (roots.size() == 1 && roots.front().crossing && !cluster.is_joined) return Kind::crossing;
    // A whole loop has no ends at which to compare signs.
    if (cluster.whole_loop) return roots.empty() ? Kind::touching : Kind::crossing;
    for (const Reading& reading : readings_) {
      if (reading.is_exact() && changes_sign(reading, cluster)) return Kind::crossing;
    }
    return Kind::touching;
  }

  /// Does f have opposite signs at the two ends of the cluster? An end where it is 0 is an end of the boundary: there a
  /// root with a slope counts.
  bool changes_sign(const Reading& reading, const Cluster& cluster) const {
    const double lo = one_sided(reading, cluster.lo, Side::after);
    const double hi = one_sided(reading, cluster.hi, Side::before);
    if (std::abs(lo) > kTurnAccuracy && std::abs(hi) > kTurnAccuracy) return (lo < 0) != (hi < 0);
    const ResidualSample end = sample(reading, std::abs(lo) < std::abs(hi) ? cluster.lo : cluster.hi);
    return std::abs(hi - lo) > kTurnAccuracy && std::abs(end.slope()) > slope_noise(end);
  }

  /// A slope of f below this is rounding: kNoSlope times the sum of 1 / P and of both curvatures' sizes.
  double slope_noise(const ResidualSample& at) const {
    return kNoSlope * (std::abs(at.start_curvature) + std::abs(at.end_curvature) + 1 / period_);
  }

  /// f at s as the limit from one side, at both the start and the end of the roll.
  double one_sided(const Reading& reading, double s, Side side) const {
    return turning_.angle(s + reading.length[0], side) - turning_.angle(s, side) - reading.turn;
  }

  const ContactEquations& question_;
  const FoundRoots& handed_out_;
  const TurningFunction& turning_;
  std::span<const Reading> readings_;
  PlacementMaker maker_;
  double period_;
};

}  // namespace

/// One placement for each cluster, ordered by start in [0, P). The last cluster may reach across s = 0, and its start
/// may then be the least: the placements are sorted again.
std::vector<Placement> make_placements(const ContactEquations& question, Findings found) {
  Clusters clusters = clusters_of(question.part, found.pieces);
  const FoundRoots roots = handed_out(question.part, found.roots, clusters);
  const SetsOfOne sets(question, roots);
  std::vector<Placement> placements(clusters.size());
  for (std::size_t k = 0; k < clusters.size(); ++k) sets.make(clusters[k], placements[k]);
  const auto earlier = [](const Placement& one, const Placement& two) { return one.start[0] < two.start[0]; };
  if (!std::is_sorted(placements.begin(), placements.end(), earlier)) {
    std::sort(placements.begin(), placements.end(), earlier);
  }
  return placements;
}

}  // namespace rollfix::locating
