#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "belief/posterior.hpp"
#include "belief/two/pair_density.hpp"
#include "locate/remaining.hpp"
#include "rollfix/turning_function.hpp"

// Notation:
//   leaf            a square of a region's grid with its density and its share of the mass: PairLeaf
//   grain           a point within a leaf, with a share of its mass: PairGrain
//   hill            the leaves that lead up to one maximum: `hills` gives each leaf the leaf at its top
//   valley          log density falls by `kValley` below the lower of two peaks: then they are two modes
// Follows docs/two_fingers.md, "The search", step 4.
// Idea: leaves are taken from the highest down, as if a tide fell. Each joins the hill that it touches, and two hills
// that meet are one unless both stand out by `kValley` where they meet (a union-find over leaves).
namespace rollfix::belief {

namespace {

/// For each leaf of a region those beside it: four points just across each side find them, and a smaller one finds the
/// larger one on whose side it is. One may be there several times.
std::vector<std::vector<std::size_t>> neighbours_in(const PairRegion& region) {
  const std::size_t count = region.leaves.size();
  std::vector<std::vector<std::size_t>> neighbours(count);
  for (std::size_t k = 0; k < count; ++k) {
    const PairLeaf& leaf = region.leaves[k];
    for (const double along : {-0.375, -0.125, 0.125, 0.375}) {
      for (const double side : {-0.501, 0.501}) {
        for (const Eigen::Vector2d& off : {Eigen::Vector2d(side, along), Eigen::Vector2d(along, side)}) {
          const std::size_t other = region.leaf_at(leaf.centre + leaf.size.cwiseProduct(off));
          if (other == count) continue;
          neighbours[k].push_back(other);
          neighbours[other].push_back(k);
        }
      }
    }
  }
  return neighbours;
}

/// For each leaf of a region the leaf at the top of its hill.
std::vector<std::size_t> tops_of(const PairRegion& region) {
  const std::size_t count = region.leaves.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Heights are log densities by (w_a, w_b), with the prior on the boundary.
  const auto height = [&](std::size_t k) { return region.leaves[k].log_density; };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return height(a) > height(b); });
  // Union-find: `up` leads to the top; `count` means that the leaf is still under water.
  const std::vector<std::vector<std::size_t>> neighbours = neighbours_in(region);
  std::vector<std::size_t> up(count, count);
  const auto top = [&](std::size_t k) {
    while (up[k] != k) {
      // Path halving: later walks are shorter.
      up[k] = up[up[k]];
      k = up[k];
    }
    return k;
  };
  // The tide falls: hills that emerge join where they meet, unless both stand out far enough.
  for (const std::size_t k : order) {
    up[k] = k;
    std::size_t highest = k;
    // The highest hill that this leaf touches, if there is one: the leaf joins it.
    for (const std::size_t other : neighbours[k]) {
      if (up[other] == count) continue;
      if (highest == k || height(top(other)) > height(highest)) highest = top(other);
    }
    // A new peak.
    if (highest == k) continue;
    up[k] = highest;
    for (const std::size_t other : neighbours[k]) {
      if (up[other] == count || other == k) continue;
      const std::size_t peak = top(other);
      // Here two hills meet, at this height: the lower one joins where its peak is less than kValley above.
      if (peak != highest && height(peak) - height(k) < kValley) up[peak] = highest;
    }
  }
  std::vector<std::size_t> result(count);
  for (std::size_t k = 0; k < count; ++k) result[k] = top(k);
  return result;
}

// Of exact lengths nothing is to be shared out.
constexpr double kNoVariance = 1e-300;

/// A share of the mass, at one finger's place, give or take `half`.
struct Grain {
  double s;
  double half;
  double share;
};

/// The place up to which there is this much mass. `grains`: in order of s. Each one's mass is spread to half way to its
/// neighbours, the outermost ones' as far as they go.
double quantile(const std::vector<Grain>& grains, double mass) {
  const double most = grains.back().s + grains.back().half;
  double begin = grains.front().s - grains.front().half;
  double before = 0;
  double share = 0;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    // Grains at one place count as one: their shares wait for the next that lies further on.
    share += grains[k].share;
    const double end = k + 1 < grains.size() ? 0.5 * (grains[k].s + grains[k + 1].s) : most;
    if (end <= begin) continue;  // several at one place
    if (before + share >= mass) return begin + (end - begin) * std::clamp((mass - before) / share, 0.0, 1.0);
    before += std::exchange(share, 0);
    begin = end;
  }
  return most;
}

/// One mode, made from the leaves of its hill.
class PairHill {
 public:
  PairHill(const PairRegion& region, std::vector<std::size_t> leaves, const PairModel& model, const Reading& last)
      : region_(&region), leaves_(std::move(leaves)), model_(&model), last_(last.length) {}

  /// Of both first contacts being in here.
  double probability() const {
    double sum = 0;
    for (const std::size_t k : leaves_) sum += region_->leaves[k].share;
    return sum;
  }

  /// See Mode. `start` is the peak of the best leaf's quadratic; if an interval leaves it out, what is nearest to the
  /// mean.
  Mode mode() const {
    Mode mode = empty_mode();
    mode.probability = probability();
    const PairLeaf& best = peak();
    const PairStart start = moved(best.start, step_to_peak(best));
    for (const std::size_t finger : {0U, 1U}) {
      const double s = start.arc[finger]->at(start.w[finger]).s;
      mode.start[finger] = model_->places.on_first_lap(s);
      mode.tangent[finger] = start.w[finger] - model_->boundary[finger]->tilt() * s;
      mode.end[finger] = model_->places.on_first_lap(s + rolled(best, finger));
    }
    add_spread(mode);
    for (const std::size_t finger : {0U, 1U}) {
      if (!model_->places.contains(mode.interval[finger], mode.start[finger])) return in_the_middle(mode);
    }
    return mode;
  }

  /// The grains that hold anything, with what their leaf knows of the first contacts' slide.
  std::vector<MassPiece> pieces() const {
    const auto counts = [](const PairGrain& grain) { return grain.share > kLeastShare; };
    std::ptrdiff_t count = 0;  // of a continuum hundreds of thousands, so that no room is made for more
    for (const std::size_t k : leaves_) {
      const std::vector<PairGrain>& grains = region_->leaves[k].grains;
      count += std::count_if(grains.begin(), grains.end(), counts);
    }
    std::vector<MassPiece> pieces;
    pieces.reserve(static_cast<std::size_t>(count));
    const Eigen::Vector2d share = share_of_first();
    const Eigen::Vector2d walked = model_->gathered.head<2>().cwiseProduct(share);
    for (const std::size_t k : leaves_) {
      const PairLeaf& leaf = region_->leaves[k];
      const Eigen::Matrix2d open = leaf.score.covariance.topLeftCorner<2, 2>();
      Eigen::Matrix2d covariance = share.asDiagonal() * open * share.asDiagonal();
      covariance += walked.asDiagonal();
      for (const PairGrain& grain : leaf.grains) {
        if (!counts(grain)) continue;
        const Eigen::Vector2d slid = share.cwiseProduct(offsets_at(leaf, grain));
        pieces.push_back(
            {grain.s, grain.angle, grain.share, std::nullopt, PerFinger<double>(slid[0], slid[1]), covariance});
      }
    }
    return pieces;
  }

 private:
  /// How much of an offset of lengths at the end of the roll is the error of the first contact, of each finger. The
  /// offset is that error and all that has slipped since, which are independent: what is known of their sum is shared
  /// out as their variances are.
  Eigen::Vector2d share_of_first() const {
    const Eigen::Vector2d first = model_->errors->start().diagonal().head<2>();
    return first.cwiseQuotient((first + model_->gathered.head<2>()).cwiseMax(kNoVariance));
  }

  /// The offsets of lengths as the rows tell them for these first contacts, linear in w about the leaf's centre.
  Eigen::Vector2d offsets_at(const PairLeaf& leaf, const PairGrain& grain) const {
    const Eigen::Vector2d centre = region_->frame * leaf.centre;
    Eigen::Vector2d from_centre;
    for (const std::size_t finger : {0U, 1U}) {
      const auto i = static_cast<Eigen::Index>(finger);
      const double w = grain.angle[finger] + model_->boundary[finger]->tilt() * grain.s[finger];
      from_centre[i] = w - region_->origin.w[finger] - centre[i];
    }
    return leaf.score.errors.head<2>() + leaf.score.errors_by_start.topRows<2>() * from_centre;
  }

  /// Where a density is flat its peak is a ripple somewhere, at an edge as well, and says nothing: what is nearest to
  /// the mean does.
  Mode in_the_middle(Mode mode) const {
    const PairLeaf* nearest = nullptr;
    const PairGrain* middle = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t k : leaves_) {
      for (const PairGrain& grain : region_->leaves[k].grains) {
        double off = 0;
        bool is_inside = true;
        for (const std::size_t finger : {0U, 1U}) {
          // How far the grain is from the mean, both fingers, squared; it must lie in both intervals.
          const double at = model_->places.on_first_lap(grain.s[finger]);
          off += square(model_->places.offset(mode.mean[finger], at));
          is_inside = is_inside && model_->places.contains(mode.interval[finger], at);
        }
        if (!is_inside || off >= least) continue;
        least = off;
        nearest = &region_->leaves[k];
        middle = &grain;
      }
    }
    // No grain lies in both intervals: the peak stays.
    if (middle == nullptr) return mode;
    for (const std::size_t finger : {0U, 1U}) {
      mode.start[finger] = model_->places.on_first_lap(middle->s[finger]);
      mode.tangent[finger] = middle->angle[finger];
      mode.end[finger] = model_->places.on_first_lap(middle->s[finger] + rolled(*nearest, finger));
    }
    return mode;
  }

  /// One with room for both fingers.
  static Mode empty_mode() {
    const PerFinger<double> zeros(0, 0);
    const PerFinger<Interval> nothing{Interval{}, Interval{}};
    Mode mode;
    mode.start = mode.end = mode.tangent = mode.mean = mode.sd = mode.end_mean = mode.end_sd = zeros;
    mode.interval = mode.region = nothing;
    return mode;
  }

  /// The likeliest leaf, the prior on the boundary left out.
  const PairLeaf& peak() const {
    std::size_t best = leaves_.front();
    for (const std::size_t k : leaves_) {
      if (region_->leaves[k].score.log_likelihood() > region_->leaves[best].score.log_likelihood()) best = k;
    }
    return region_->leaves[best];
  }

  /// One step of Newton's method, no further than the leaf goes.
  Eigen::Vector2d step_to_peak(const PairLeaf& leaf) const {
    const Eigen::Matrix2d information = region_->frame.transpose() * leaf.score.information * region_->frame;
    // In the region's coordinates, in which the leaf is a rectangle.
    const Eigen::Vector2d slope = region_->frame.transpose() * leaf.score.slope;
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    // Where a direction is not known at all, the matrix stays regular.
    const Eigen::Matrix2d ridged = information + 1e-9 * (information.trace() + 1e-300) * Eigen::Matrix2d::Identity();
    step = ridged.inverse() * slope;
    // In half sides.
    const double most = (2 * step.cwiseAbs()).cwiseQuotient(leaf.size).maxCoeff();
    if (!std::isfinite(most)) return Eigen::Vector2d::Zero();
    if (most > 1) step /= most;
    return region_->frame * step;
  }

  /// True length of the last row, by the shared errors that the leaf estimates.
  double rolled(const PairLeaf& leaf, std::size_t finger) const {
    const auto i = static_cast<Eigen::Index>(finger);
    return (last_[finger] + leaf.score.errors[i]) / (1 + leaf.score.errors[2 + i]);
  }

  /// How far a leaf's grains go to either side, along each finger's boundary.
  std::array<double, 2> half_of_grains(const PairLeaf& leaf) const {
    std::array<double, 2> half{};
    for (const std::size_t finger : {0U, 1U}) {
      // A grain's half width in w, then along the boundary.
      const double along = region_->frame.row(static_cast<Eigen::Index>(finger)).cwiseAbs().dot(leaf.size);
      half[finger] = 0.5 / kGrainsAcross * along * leaf.start.arc[finger]->at(leaf.start.w[finger]).slope;
    }
    return half;
  }

  /// The variance of `rolled`, from offset and scale, and the row's own contact. To first order; length^2.
  double variance_rolled(const PairLeaf& leaf, std::size_t finger) const {
    const auto i = static_cast<Eigen::Index>(finger);
    const double length = rolled(leaf, finger);
    const PairSharedCovariance& P = leaf.score.covariance;
    return std::max(0.0, P(i, i) - 2 * length * P(i, 2 + i) + length * length * P(2 + i, 2 + i)) +
           model_->errors->contact_variance();
  }

  /// Means, covariance and intervals of both first contacts, and of the contacts now, as sums over grains.
  void add_spread(Mode& mode) const {
    double total = 0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    Eigen::Vector2d end_sum = Eigen::Vector2d::Zero();
    Eigen::Vector2d end_squares = Eigen::Vector2d::Zero();
    std::array<std::vector<Grain>, 2> grains;
    for (const std::size_t k : leaves_) {
      const PairLeaf& leaf = region_->leaves[k];
      const std::array<double, 2> half = half_of_grains(leaf);
      for (const PairGrain& grain : leaf.grains) {
        // Places are counted from the region's origin, unwrapped.
        Eigen::Vector2d off;
        for (const std::size_t finger : {0U, 1U}) {
          const auto i = static_cast<Eigen::Index>(finger);
          off[i] = grain.s[finger] - region_->origin_s[finger];
          const double end = off[i] + rolled(leaf, finger);
          end_sum[i] += grain.share * end;
          // An end is as uncertain as its start, and by the variance of the roll.
          end_squares[i] += grain.share * (end * end + variance_rolled(leaf, finger));
          grains[finger].push_back({off[i], half[finger], grain.share});
        }
        total += grain.share;
        sum += grain.share * off;
        squares += grain.share * off * off.transpose();
      }
    }
    const Eigen::Vector2d mean = sum / total;
    mode.covariance = squares / total - mean * mean.transpose();
    for (const std::size_t finger : {0U, 1U}) {
      const auto i = static_cast<Eigen::Index>(finger);
      const double origin = region_->origin_s[finger];
      mode.mean[finger] = model_->places.on_first_lap(origin + mean[i]);
      mode.sd[finger] = std::sqrt(std::max(0.0, mode.covariance(i, i)));
      const double end = end_sum[i] / total;
      mode.end_mean[finger] = model_->places.on_first_lap(origin + end);
      mode.end_sd[finger] = std::sqrt(std::max(0.0, end_squares[i] / total - end * end));
      std::vector<Grain>& of_finger = grains[finger];
      std::sort(of_finger.begin(), of_finger.end(), [](const Grain& a, const Grain& b) { return a.s < b.s; });
      const auto as_interval = [&](double lo, double hi) {
        const double at = model_->places.on_first_lap(origin + lo);
        // No interval is longer than once around.
        return Interval{at, at + std::min(hi - lo, model_->perimeter())};
      };
      mode.interval[finger] = as_interval(quantile(of_finger, 0.5 * (1 - kCredible) * total),
                                          quantile(of_finger, 0.5 * (1 + kCredible) * total));
      mode.region[finger] = as_interval(of_finger.front().s, of_finger.back().s);
    }
  }

  const PairRegion* region_;
  std::vector<std::size_t> leaves_;
  const PairModel* model_;
  PerFinger<double> last_;  // lengths of the last row
};

/// In the order of their tops.
std::vector<PairHill> hills_of(const PairRegion& region, const PairModel& model, const Reading& last) {
  const std::vector<std::size_t> tops = tops_of(region);
  // The order of a map does not depend on addresses: the same samples give the same bits.
  std::map<std::size_t, std::vector<std::size_t>> by_top;
  for (std::size_t k = 0; k < tops.size(); ++k) by_top[tops[k]].push_back(k);
  std::vector<PairHill> hills;
  for (auto& [top, leaves] : by_top) hills.emplace_back(region, std::move(leaves), model, last);
  return hills;
}

}  // namespace

PairModes modes_of(const PairDensity& density, const PairModel& model, const Reading& last) {
  std::vector<PairHill> hills;
  double likeliest = 0;
  for (const PairRegion& region : density.regions) {
    for (PairHill& hill : hills_of(region, model, last)) {
      likeliest = std::max(likeliest, hill.probability());
      hills.push_back(std::move(hill));
    }
  }
  struct Found {
    Mode mode;
    std::vector<MassPiece> pieces;
  };
  std::vector<Found> all;
  for (const PairHill& hill : hills) {
    if (is_listed(hill.probability(), likeliest)) all.push_back({hill.mode(), hill.pieces()});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Found& a, const Found& b) { return a.mode.probability > b.mode.probability; });
  PairModes result;
  for (Found& found : all) {
    result.modes.push_back(std::move(found.mode));
    result.pieces.push_back(std::move(found.pieces));
  }
  return result;
}

}  // namespace rollfix::belief
