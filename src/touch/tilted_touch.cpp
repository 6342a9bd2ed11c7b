#include "posterior.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <optional>

// Notation:
//   u, ds           place of the contact on the path, and length of boundary: `length_per_u`, 1 or at a corner r
//   r(u)            the touch's residuals in the given pose; r^T r is `distance_at(...).square`, least at the nearest
//                   place
//   l(pose)         the integral of exp(-r^T r / 2) ds: `sum_`, with exp(-least / 2) taken out
//                   of a normal alone, at every place that has it
//   g(u), M(u)      a place's share of the normal equations, J^T r with its sign and J^T J: `Normals`
//   E g, E M        means over u with these weights: d log l = E g, -d^2 log l = E M - Cov g: `result`
// Follows docs/touch.md, "How it works": the last paragraph. Gauss and Legendre's rule of 5 points on panels of
// `kPanel` standard deviations.
// Idea: where a contact is on the boundary is summed over, not maximised, so that a side ends where it ends and a
// corner counts with its own length.
namespace rollfix::touch {
namespace {

using Rule = boost::math::quadrature::gauss<double, 5>;

// A panel of the rule is no longer than this many standard deviations of a contact.
constexpr double kPanel = 3;
// Squares that exceed the least by more add next to nothing: of a normal distribution 6e-7.
constexpr double kNothing = 25;
constexpr int kMostPanels = 60;  // in either direction
// Where a side goes on for so many standard deviations to both sides of the nearest place, ...
constexpr double kAllOfIt = 5.5;
// ... and the squares at this many are those of a straight side but for such shares of them, even and odd, the integral
// is that of a normal distribution: the odd part counts by its square, and the even one is taken along.
constexpr double kTried = 3;
constexpr double kEvenPart = 0.1;
constexpr double kOddPart = 0.1;

/// The integral by quadrature: from the nearest place outwards both ways, or of a normal alone over all of the
/// boundary.
class Integral {
 public:
  /// `nearest`: its square is taken out, so that no weight underflows.
  Integral(const PoseFit& fit, const Pose& pose, std::size_t touch, const PathPlace& nearest)
      : path_(fit.path(touch)), frame_(fit.frame(pose)), touch_(fit.in_part(pose, touch)) {
    least_ = distance_at(path_.at(nearest), touch_).square;
    if (!touch_.has_place || is_reference(fit.touches()[touch])) {
      go_everywhere(fit.tree(touch));
      return;
    }
    go(nearest, true);
    go(nearest, false);
  }

  /// Slope E g; matrix E M - Cov g, with Cov g = E g g^T - E g E g^T.
  TiltedTouch result() const {
    TiltedTouch result;
    if (!(sum_ > 0)) {  // a corner that has no length, and nothing near it has
      result.log_likelihood = -kNothing - 0.5 * least_;
      return result;
    }
    result.log_likelihood = std::log(sum_) - 0.5 * least_;
    result.normals.slope = slope_ / sum_;
    result.normals.matrix = matrix_ / sum_ - (spread_ / sum_ - result.normals.slope * result.normals.slope.transpose());
    return result;
  }

 private:
  /// Panel by panel along the boundary until the squares are kNothing above the least and rising, the boundary ends,
  /// half a lap is gone (the other half is the other direction's), or there are too many panels.
  void go(PathPlace from, bool forwards) {
    const double half_lap = 0.5 * path_.part().perimeter();
    double gone = 0;
    for (int panels = 0; panels < kMostPanels && gone <= half_lap; ++panels) {
      const CentreStretch& stretch = path_.stretches()[from.stretch];
      const double end = forwards ? stretch.u.hi : stretch.u.lo;
      // On to the next stretch; at a corner without length at once.
      if (from.u == end || (stretch.corner && path_.radius() == 0)) {
        const std::optional<std::size_t> next = forwards ? stretch.after : stretch.before;
        if (!next) return;
        const Interval& u = path_.stretches()[*next].u;
        from = {*next, forwards ? u.lo : u.hi};
        continue;
      }
      const Distance here = distance_at(path_.at(from), touch_);
      const double rising = forwards ? -here.slope : here.slope;
      if (here.square > least_ + kNothing && rising >= 0) return;
      // Weight v^T v is the information of u: 1 / sqrt of it is the standard deviation.
      const double most = here.weight > 0 ? kPanel / std::sqrt(here.weight) : stretch.u.width();
      const double to = forwards ? std::min(end, from.u + most) : std::max(end, from.u - most);
      const double length = length_per_u(path_, from.stretch);
      add_panel(from.stretch, std::min(from.u, to), std::max(from.u, to), length);
      gone += std::abs(to - from.u) * length;
      from.u = to;
    }
  }

  /// Of a normal alone: every stretch of the boundary that has it, wherever it is.
  void go_everywhere(PathTree& tree) {
    std::vector<std::int32_t> waiting{tree.root()};
    while (!waiting.empty()) {
      const std::int32_t index = waiting.back();
      waiting.pop_back();
      const PathTree::Node node = tree.node(index);
      // Each place of the node counts less than exp(-kNothing / 2) of the nearest.
      if (least_square(node, touch_) > least_ + kNothing) continue;
      const auto stretch = static_cast<std::size_t>(node.stretch);
      const double length = node.is_single() ? length_per_u(path_, stretch) : 1;
      if (length == 0) continue;  // a corner that a point touches
      if (node.is_single() && node.half_turn <= 0.5 * kPanel * touch_.angle_unit) {
        add_panel(stretch, node.u.lo, node.u.hi, length);
        continue;
      }
      const auto [left, right] = tree.halves(index);
      if (left == right) continue;
      waiting.push_back(left);
      waiting.push_back(right);
    }
  }

  /// Gauss and Legendre's rule; its table has the half of the points that are not below 0.
  void add_panel(std::size_t stretch, double lo, double hi, double length_per_u) {
    const double middle = 0.5 * (lo + hi);
    const double half = 0.5 * (hi - lo);
    for (std::size_t k = 0; k < Rule::abscissa().size(); ++k) {
      const double offset = half * Rule::abscissa()[k];
      const double weight = half * Rule::weights()[k] * length_per_u;
      add({stretch, middle + offset}, weight);
      if (offset != 0) add({stretch, middle - offset}, weight);
    }
  }

  /// One point of the rule, that stands for `length` of boundary.
  void add(const PathPlace& place, double length) {
    const CentrePoint point = path_.at(place);
    const double weight = length * std::exp(-0.5 * (distance_at(point, touch_).square - least_));
    const Normals normals = normals_at(frame_, touch_, point);
    sum_ += weight;
    slope_ += weight * normals.slope;
    matrix_ += weight * normals.matrix;
    spread_ += weight * normals.slope * normals.slope.transpose();
  }

  const CentrePath& path_;
  PartFrame frame_;
  InPart touch_;
  // Sums over the points, with weight exp(-(square - least) / 2) times length.
  double least_ = 0;
  double sum_ = 0;
  Eigen::Vector3d slope_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d spread_ = Eigen::Matrix3d::Zero();
};

/// E g and E M - Cov g for a place with this variance on a straight side: there g is linear, and M quadratic, in u.
/// `variance`: of u. With Var u = v: Cov g = v (dg/du)(dg/du)^T, and E M gains v |dc/du|^2 in the heading's entry, as
/// the arm's square grows so.
Normals mean_and_spread(const PartFrame& frame, const InPart& touch, const CentrePoint& point, double variance) {
  Normals normals = normals_at(frame, touch, point);
  Eigen::Vector3d by_place = -mixed_at(frame, touch, point).by_pose;  // d g / du
  if (touch.has_place) {
    const double share = 1 / (touch.place_unit * touch.place_unit);
    by_place(2) += share * turned_left(point.along).dot(touch.at - point.centre);
    normals.matrix(2, 2) += share * variance * point.along.squaredNorm();
  }
  normals.matrix -= variance * by_place * by_place.transpose();
  return normals;
}

/// In the middle of a side that is straight next to the noise, in closed form; nothing elsewhere.
std::optional<TiltedTouch> on_a_side(const PoseFit& fit, const Pose& pose, std::size_t touch,
                                     const PathPlace& nearest) {
  const CentrePath& path = fit.path(touch);
  const Interval& side = path.stretches()[nearest.stretch].u;
  const InPart at = fit.in_part(pose, touch);
  const CentrePoint point = path.at(nearest);
  const Distance here = distance_at(point, at);
  const double sd = here.weight > 0 ? 1 / std::sqrt(here.weight) : side.width();
  if (nearest.u - kAllOfIt * sd < side.lo || nearest.u + kAllOfIt * sd > side.hi) return std::nullopt;
  // By how much the square is larger there than at the nearest place.
  const auto rise = [&](double by) {
    return distance_at(path.at({nearest.stretch, nearest.u + by}), at).square - here.square;
  };
  const double before = rise(-kTried * sd) / (kTried * kTried);  // of a straight side 1
  const double behind = rise(kTried * sd) / (kTried * kTried);
  const double even = 0.5 * (before + behind);
  // A bend or a fold that is too strong: quadrature.
  if (std::abs(even - 1) > kEvenPart || 0.5 * std::abs(behind - before) > kOddPart) return std::nullopt;
  TiltedTouch result;
  // exp(-least / 2) times the integral of exp(-even (u / sd)^2 / 2) ds.
  result.log_likelihood = -0.5 * here.square + std::log(sd * length_per_u(path, nearest.stretch)) +
                          0.5 * std::log(2 * std::numbers::pi / even);
  result.normals = mean_and_spread(fit.frame(pose), at, point, sd * sd / even);
  return result;
}

}  // namespace

/// Closed form where the side allows it, else quadrature. A normal alone, or a reference, may be at any place.
TiltedTouch tilted_touch(const PoseFit& fit, const Pose& pose, std::size_t touch, const PathPlace& nearest) {
  const Measured& measured = fit.touches()[touch];
  const bool may_be_anywhere = !measured.has_place || is_reference(measured);
  const std::optional<TiltedTouch> plain = may_be_anywhere ? std::nullopt : on_a_side(fit, pose, touch, nearest);
  if (plain) return *plain;
  return Integral(fit, pose, touch, nearest).result();
}

}  // namespace rollfix::touch
