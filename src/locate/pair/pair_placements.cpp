#include "pair_placements.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../accuracy.hpp"
#include "pair_residual.hpp"

namespace rollfix {
namespace {

// Two finds of one root: closer than this share of the perimeter, f not leaving 0 in between.
constexpr double kSameRoot = 1e-6;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 2>;

class PairPlacementMaker {
 public:
  PairPlacementMaker(const Part& part, const std::vector<PairReading>& readings, const std::optional<double>& facing)
      : part_(part), turning_(part.turning()), readings_(readings), facing_(facing), period_(part.perimeter()) {}

  PairPlacement make(const PairCluster& cluster) const {
    PairPlacement placement;
    const std::vector<PairRoot> roots = distinct_roots(cluster);
    const PairRoot start = roots.empty() ? nearest_miss(cluster) : roots.front();
    const PairReading& last = readings_.back();
    placement.start = {canonical(start.at[0]), canonical(start.at[1])};
    placement.end = {canonical(start.at[0] + last.length_a), canonical(start.at[1] + last.length_b)};
    placement.extent = {extent_of(cluster, 0), extent_of(cluster, 1)};
    placement.whole_loop = cluster.whole_loop;
    placement.kind = kind_of(cluster, roots, start);
    for (const PairRoot& root : roots) placement.roots.push_back({canonical(root.at[0]), canonical(root.at[1])});
    placement.residual = pair_residual(part_, readings_, facing_, start.at);
    for (const std::size_t k : {0U, 1U}) {
      placement.point[k] = part_.point(placement.start[k]);
      placement.tangent[k] = part_.tangent(placement.start[k]);
    }
    placement.family = cluster.family;
    placement.family_error = cluster.family_error;
    describe_slopes(start.at, placement);
    if (placement.kind == Kind::corner) placement.pivot = pair_pivots(part_, readings_, start.at);
    return placement;
  }

 private:
  double canonical(double s) const {
    if (!part_.closed()) return std::clamp(s, 0.0, period_);
    const double base = wrap(s, period_).base;
    return period_ - base <= kLengthAccuracy * period_ ? 0 : base;
  }

  Interval extent_of(const PairCluster& cluster, std::size_t finger) const {
    if (cluster.whole_loop[finger]) return {0, period_};
    const Interval& extent = cluster.extent[finger];
    if (!part_.closed()) return {std::max(extent.lo, 0.0), std::min(extent.hi, period_)};
    const double width = extent.width();
    double lo = wrap(extent.lo, period_).base;
    if (period_ - lo <= kLengthAccuracy * period_ && width <= kLengthAccuracy * period_) lo = 0;
    return {lo, lo + width};
  }

  /// The roots of a cluster, each once; one that was found from two sides with different signs of det J has none.
  std::vector<PairRoot> distinct_roots(const PairCluster& cluster) const {
    std::vector<PairRoot> found;
    if (cluster.exact) {  // the first of its continuum
      PairRoot first;
      first.at =
          cluster.family.empty() ? PairPoint{cluster.extent[0].lo, cluster.extent[1].lo} : cluster.family.front();
      for (const PairRoot& root : cluster.roots) first.corner = first.corner || root.corner;
      found.push_back(first);
      return found;
    }
    std::vector<PairRoot> roots = cluster.roots;
    std::sort(roots.begin(), roots.end(), [](const PairRoot& one, const PairRoot& two) { return one.at < two.at; });
    for (const PairRoot& root : roots) {
      if (!root.exact) continue;
      const auto same =
          std::find_if(found.begin(), found.end(), [&](const PairRoot& other) { return is_same(other, root); });
      if (same == found.end()) {
        found.push_back(root);
      } else {
        const bool many_rows = readings_.size() + (facing_ ? 1 : 0) > 2;  // then signs are of different pairs of rows
        if (same->sign != root.sign && !many_rows) same->sign = 0;
        same->corner = same->corner && root.corner;
      }
    }
    return found;
  }

  bool is_same(const PairRoot& one, const PairRoot& two) const {
    const double far = std::max(periodic(one.at[0], two.at[0]), periodic(one.at[1], two.at[1]));
    if (far <= 2 * kLengthAccuracy * period_) return true;
    if (far > kSameRoot * period_) return false;
    const PairPoint middle{one.at[0] + 0.5 * signed_way(one.at[0], two.at[0]),
                           one.at[1] + 0.5 * signed_way(one.at[1], two.at[1])};
    return pair_residual(part_, readings_, facing_, middle) <= kRootTurn;
  }

  double signed_way(double from, double to) const {
    return part_.closed() ? std::remainder(to - from, period_) : to - from;
  }
  double periodic(double one, double two) const { return std::abs(signed_way(one, two)); }

  /// Where the largest |f_k| is least: looked for on ever finer grids and, since the set may be much thinner than any
  /// grid, by least squares from their best place and from the ends of the set.
  PairRoot nearest_miss(const PairCluster& cluster) const {
    PairBox box = cluster.extent;
    PairPoint best{box[0].middle(), box[1].middle()};
    double least = pair_residual(part_, readings_, facing_, best);
    constexpr int kGrid = 8;
    constexpr int kRounds = 24;
    for (int round = 0; round < kRounds; ++round) {
      for (int i = 0; i <= kGrid; ++i) {
        for (int j = 0; j <= kGrid; ++j) {
          const PairPoint at{box[0].lo + box[0].width() * i / kGrid, box[1].lo + box[1].width() * j / kGrid};
          const double residual = pair_residual(part_, readings_, facing_, at);
          if (residual < least) {
            least = residual;
            best = at;
          }
        }
      }
      for (const std::size_t k : {0U, 1U}) {
        const double reach = 0.25 * box[k].width();
        box[k] = {std::max(cluster.extent[k].lo, best[k] - reach), std::min(cluster.extent[k].hi, best[k] + reach)};
      }
    }
    if (!part_.corners().empty()) return {best, 0, cluster.corner};
    const PairBox& whole = cluster.extent;
    for (const PairPoint& from : {best, PairPoint{whole[0].lo, whole[1].lo}, PairPoint{whole[0].lo, whole[1].hi},
                                  PairPoint{whole[0].hi, whole[1].lo}, PairPoint{whole[0].hi, whole[1].hi}}) {
      const PairPoint at = least_squares(from, whole);
      const double residual = pair_residual(part_, readings_, facing_, at);
      if (residual < least) {
        least = residual;
        best = at;
      }
    }
    return {best, 0, cluster.corner};
  }

  /// f and its Jacobian; the facing equation is the last row.
  void linearize(const PairPoint& at, Eigen::VectorXd& f, Matrix& jacobian) const {
    const auto count = static_cast<Eigen::Index>(readings_.size());
    f.resize(count + (facing_ ? 1 : 0));
    jacobian.resize(f.size(), 2);
    const Turning s0 = turning_.at(at[0]);
    const Turning t0 = turning_.at(at[1]);
    for (Eigen::Index k = 0; k < count; ++k) {
      const PairReading& reading = readings_[static_cast<std::size_t>(k)];
      const Turning s = turning_.at(at[0] + reading.length_a);
      const Turning t = turning_.at(at[1] + reading.length_b);
      f[k] = (s.angle - s0.angle) - (t.angle - t0.angle) - reading.turn;
      jacobian.row(k) << s.curvature - s0.curvature, t0.curvature - t.curvature;
    }
    if (!facing_) return;
    f[count] = std::remainder(s0.angle - t0.angle - *facing_, 2 * std::numbers::pi);
    jacobian.row(count) << s0.curvature, -t0.curvature;
  }

  /// Levenberg and Marquardt's method, kept within a box.
  PairPoint least_squares(PairPoint at, const PairBox& box) const {
    constexpr int kMostSteps = 60;
    Eigen::VectorXd f;
    Matrix jacobian;
    linearize(at, f, jacobian);
    double damping = 1e-6;
    for (int step = 0; step < kMostSteps && damping < 1e12; ++step) {
      Eigen::Matrix2d normal = jacobian.transpose() * jacobian;
      normal.diagonal() *= 1 + damping;
      const Eigen::Vector2d move = normal.ldlt().solve(-jacobian.transpose() * f);
      if (!move.allFinite()) break;
      PairPoint next;
      for (const std::size_t k : {0U, 1U}) {
        next[k] = std::clamp(at[k] + move[static_cast<Eigen::Index>(k)], box[k].lo, box[k].hi);
      }
      Eigen::VectorXd next_f;
      Matrix next_jacobian;
      linearize(next, next_f, next_jacobian);
      const bool better = next_f.squaredNorm() < f.squaredNorm();
      damping *= better ? 0.1 : 10;
      if (!better) continue;
      at = next;
      f = next_f;
      jacobian = next_jacobian;
    }
    return at;
  }

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
    const bool many_rows = readings_.size() + (facing_ ? 1 : 0) > 2;
    if (many_rows && roots.size() == 1) return roots.front().sign != 0 ? Kind::crossing : Kind::touching;
    return sum != 0 ? Kind::crossing : Kind::touching;
  }

  /// J by rows [kappa(s_k) - kappa(s0), -(kappa(t_k) - kappa(t0))], the facing row [kappa(s0), -kappa(t0)] last.
  void describe_slopes(const PairPoint& at, PairPlacement& placement) const {
    placement.error = std::numeric_limits<double>::infinity();
    if (placement.kind == Kind::corner) placement.error = kRootLength * period_;
    if (placement.kind != Kind::crossing) return;
    const std::size_t count = readings_.size();
    const auto rows = static_cast<Eigen::Index>(count + (facing_ ? 1 : 0));
    Matrix jacobian(rows, 2);
    std::vector<std::array<double, 2>> ends;
    const double start_a = turning_.curvature(at[0]);
    const double start_b = turning_.curvature(at[1]);
    double noise = (std::abs(start_a) + std::abs(start_b) + 1 / period_);
    for (std::size_t k = 0; k < count; ++k) {
      const double end_a = turning_.curvature(at[0] + readings_[k].length_a);
      const double end_b = turning_.curvature(at[1] + readings_[k].length_b);
      noise = std::max(noise, std::abs(end_a) + std::abs(end_b));
      ends.push_back({end_a, end_b});
      jacobian.row(static_cast<Eigen::Index>(k)) << end_a - start_a, -(end_b - start_b);
    }
    if (facing_) jacobian.row(rows - 1) << start_a, -start_b;
    const Eigen::Matrix2d normal = jacobian.transpose() * jacobian;
    // The least singular value from trace and determinant: no more than two columns.
    const double trace = normal.trace();
    const double determinant = normal.determinant();
    const double largest = 0.5 * trace + std::sqrt(std::max(0.0, 0.25 * trace * trace - determinant));
    const double smallest = largest > 0 ? std::sqrt(std::max(0.0, determinant / largest)) : 0;
    if (!(smallest > kNoSlope * noise)) return;
    const Eigen::Matrix<double, 2, Eigen::Dynamic> inverse = normal.inverse() * jacobian.transpose();
    placement.error = std::max(kRootLength * period_, kRootTurn / smallest);
    for (const std::size_t finger : {0U, 1U}) {
      const auto row = static_cast<Eigen::Index>(finger);
      for (std::size_t k = 0; k < count; ++k) {
        const double by_turn = inverse(row, static_cast<Eigen::Index>(k));
        placement.sensitivity.per_turn[finger].push_back(by_turn);
        placement.sensitivity.per_length[finger].push_back({-ends[k][0] * by_turn, ends[k][1] * by_turn});
      }
      if (facing_) placement.sensitivity.per_facing[finger] = inverse(row, rows - 1);
    }
  }

  const Part& part_;
  const TurningFunction& turning_;
  const std::vector<PairReading>& readings_;
  const std::optional<double>& facing_;
  double period_;
};

}  // namespace

std::vector<PairPlacement> make_pair_placements(const Part& part, const std::vector<PairReading>& readings,
                                                const std::optional<double>& facing,
                                                const std::vector<PairCluster>& clusters) {
  const PairPlacementMaker maker(part, readings, facing);
  std::vector<PairPlacement> placements;
  placements.reserve(clusters.size());
  for (const PairCluster& cluster : clusters) placements.push_back(maker.make(cluster));
  // Starts that differ by less than their own accuracy count as one, so that the other finger's decide.
  const auto rank = [&](const PairPlacement& placement) {
    const double grain = kRootLength * part.perimeter();
    return std::pair(std::round(placement.start[0] / grain), placement.start[1]);
  };
  std::sort(placements.begin(), placements.end(),
            [&](const PairPlacement& one, const PairPlacement& two) { return rank(one) < rank(two); });
  return placements;
}

}  // namespace rollfix
