#include "pair_sets.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "../accuracy.hpp"
#include "../placements.hpp"
#include "outline/turn.hpp"

namespace rollfix {
namespace {

// Two finds of one root: closer than this share of the perimeter, f not leaving 0 in between.
constexpr double kSameRoot = 1e-6;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// What kind of answer a connected set of pairs is.
class SetsOfTwo {
 public:
  explicit SetsOfTwo(const Question& question)
      : question_(question), part_(question.part), turning_(part_.turning()), period_(part_.perimeter()) {}

  FoundSet set_of(const PairCluster& cluster) const {
    const std::vector<PairRoot> roots = distinct_roots(cluster);
    const PairRoot start = roots.empty() ? nearest_miss(cluster) : roots.front();
    FoundSet found{kind_of(cluster, roots, start), start.at, cluster.extent, cluster.whole_loop, {}};
    for (const PairRoot& root : roots) found.roots.push_back(root.at);
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
        const bool many_rows = question_.is_overdetermined();  // then signs are of different pairs of rows
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
    return residual_at(question_, middle) <= kRootTurn;
  }

  double signed_way(double from, double to) const { return part_.boundary().offset(from, to); }
  double periodic(double one, double two) const { return std::abs(signed_way(one, two)); }

  /// Where the largest |f_k| is least: looked for on ever finer grids and, since the set may be much thinner than any
  /// grid, by least squares from their best place and from the ends of the set.
  PairRoot nearest_miss(const PairCluster& cluster) const {
    PairBox box = cluster.extent;
    PairPoint best{box[0].middle(), box[1].middle()};
    double least = residual_at(question_, best);
    constexpr int kGrid = 8;
    constexpr int kRounds = 24;
    for (int round = 0; round < kRounds; ++round) {
      for (int i = 0; i <= kGrid; ++i) {
        for (int j = 0; j <= kGrid; ++j) {
          const PairPoint at{box[0].lo + box[0].width() * i / kGrid, box[1].lo + box[1].width() * j / kGrid};
          const double residual = residual_at(question_, at);
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
      const double residual = residual_at(question_, at);
      if (residual < least) {
        least = residual;
        best = at;
      }
    }
    return {best, 0, cluster.corner};
  }

  /// f and its Jacobian; the facing equation is the last row.
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
    const bool many_rows = question_.is_overdetermined();
    if (many_rows && roots.size() == 1) return roots.front().sign != 0 ? Kind::crossing : Kind::touching;
    return sum != 0 ? Kind::crossing : Kind::touching;
  }

  const Question& question_;
  const Part& part_;
  const TurningFunction& turning_;
  double period_;
};

}  // namespace

std::vector<Placement> make_placements(const Question& question, const std::vector<PairCluster>& clusters) {
  const SetsOfTwo sets(question);
  const PlacementMaker maker(question);
  std::vector<Placement> placements(clusters.size());
  for (std::size_t k = 0; k < clusters.size(); ++k) maker.make(sets.set_of(clusters[k]), placements[k]);
  // Starts that differ by less than their own accuracy count as one, so that the other finger's decide.
  const auto rank = [&](const Placement& placement) {
    const double grain = kRootLength * question.part.perimeter();
    return std::pair(std::round(placement.start[0] / grain), placement.start[1]);
  };
  std::sort(placements.begin(), placements.end(),
            [&](const Placement& one, const Placement& two) { return rank(one) < rank(two); });
  return placements;
}

}  // namespace rollfix
