#include "resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace {

using chebyshev::Grid;
using chebyshev::Series;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A series is resolved when its last terms are rounding errors: relative to its size, ...
constexpr double kSeriesNoise = 20 * kEpsilon;
// ... or too small to matter: as a length (share of the outline's size) or as an angle (radians).
constexpr double kLengthNoise = 1e-17;
constexpr double kTurnNoise = 1e-15;
// A parameter is rounded, and so are the angles and powers that a curve makes of it.
constexpr double kParameterNoise = 4 * kEpsilon;
// Independent checks of a panel: speed between the nodes, and total turn against the tangents at the ends.
constexpr double kSpeedAgreement = 1e-13;
constexpr double kTurnAgreement = 5e-13;
// A panel whose turning differs from that of an arc (a line) by less is an arc (a line).
constexpr double kStructureTurn = 1e-13;
// A panel shorter than this share of its curve's domain that still isn't resolved holds a cusp.
constexpr double kShortestPanel = 1e-11;

// Newton's method converges quadratically: after a step like this the next one would be a rounding error.
constexpr double kNewtonStep = 1e-8;
constexpr int kNewtonRounds = 10;
// After a step below this the slope is known well enough for the next one: what it is off by, times that, is rounding.
constexpr double kSameSlope = 1e-6;

constexpr int kCoarseDegree = 8;  // enough for a span between dense points
constexpr int kFineDegree = 16;

class Resolver {
 public:
  Resolver(const Curve& curve, double size, const std::function<void(const ResolvedPanel&)>& sink)
      : curve_(curve), size_(size), sink_(sink) {}

  void run() { cut(curve_.domain(), true); }

 private:
  void cut(Interval range, bool coarse_first) {
    static const Grid coarse(kCoarseDegree);
    static const Grid fine(kFineDegree);
    if ((coarse_first && fits(range, coarse)) || fits(range, fine)) {
      sink_(panel_);
      return;
    }
    if (range.width() <= kShortestPanel * curve_.domain().width()) throw_cusp(range.middle());
    cut({range.lo, range.middle()}, false);
    cut({range.middle(), range.hi}, false);
  }

  /// Fills panel_ and says whether its polynomials are as good as the curve's own rounding errors allow.
  bool fits(Interval range, const Grid& grid) {
    return measure_length(range, grid) && invert_length(range, grid) && measure_turn(grid);
  }

  bool measure_length(Interval range, const Grid& grid) {
    const Eigen::Index count = grid.points().size();
    Series speeds(count);
    for (Eigen::Index j = 0; j < count; ++j) {
      speeds[j] = curve_.velocity(range.middle() + 0.5 * range.width() * grid.points()[j]).norm();
      if (!(speeds[j] > 0) || !std::isfinite(speeds[j])) throw_cusp(range.middle());
    }
    speed_ = grid.coefficients(speeds);
    const double tail = chebyshev::tail(speed_);
    // The parameter's own rounding moves each node: what the speed changes by on the way is noise as well.
    parameter_noise_ = kParameterNoise * curve_.parameter_size(range);
    const double slope = 2 * (speeds.maxCoeff() - speeds.minCoeff()) / range.width();
    const double noise = kSeriesNoise * speeds.maxCoeff() + parameter_noise_ * slope;
    if (tail > noise && tail * range.width() > kLengthNoise * size_) return false;
    length_ = chebyshev::antiderivative(speed_) * (0.5 * range.width());
    panel_.length = length_.sum();
    return true;
  }

  /// u where the arc length is resolved: Newton's method on the length series, from its first two terms.
  bool invert_length(Interval range, const Grid& grid) {
    const Eigen::Index count = grid.points().size();
    const double half = 0.5 * range.width();
    const Series points = grid.points().segment(1, count - 2);  // the ends are known
    const Series targets = (points.array() + 1).matrix() * (0.5 * panel_.length);
    inner_.resize(count - 2);
    for (Eigen::Index j = 0; j < inner_.size(); ++j) {  // c0 (x + 1) + c1 (x^2 - 1) / 2 = target
      const double right = targets[j] / half - speed_[0] + 0.5 * speed_[1];
      const double root = speed_[0] * speed_[0] + 2 * speed_[1] * right;
      inner_[j] = root > 0 ? std::clamp(2 * right / (speed_[0] + std::sqrt(root)), -1.0, 1.0) : points[j];
    }
    Series slopes;
    double last_step = 1;
    for (int round = 0; round < kNewtonRounds && last_step > kNewtonStep; ++round) {
      if (last_step > kSameSlope) slopes = chebyshev::values(speed_, inner_) * half;
      const Series steps = (targets - chebyshev::values(length_, inner_)).cwiseQuotient(slopes);
      inner_ += steps;
      last_step = steps.cwiseAbs().maxCoeff();
    }
    Series parameters(count);
    parameters.segment(1, count - 2) = (inner_ * half).array() + range.middle();
    parameters[0] = range.lo;
    parameters[count - 1] = range.hi;
    panel_.parameter = grid.coefficients(parameters);
    nodes_ = parameters;
    return inner_.cwiseAbs().maxCoeff() <= 1;
  }

  bool measure_turn(const Grid& grid) {
    const Eigen::Index count = grid.points().size();
    Series curvatures(count);
    double noise = 0;
    const Series speeds = chebyshev::values(speed_, inner_);
    for (Eigen::Index j = 0; j < count; ++j) {
      const Jet jet = curve_.jet(nodes_[j]);
      const double speed = jet.first.norm();
      const double speed_noise = kSpeedAgreement * speed + parameter_noise_ * jet.second.norm();
      const bool is_end = j == 0 || j + 1 == count;  // where the series is the speed
      if (!is_end && std::abs(speed - speeds[j - 1]) > speed_noise) return false;
      curvatures[j] = curvature(jet);
      noise = std::max(noise, kSeriesNoise * (std::abs(curvatures[j]) + jet.second.norm() / (speed * speed)) +
                                  parameter_noise_ * std::abs(curvature_rate(jet)));
      if (j == 0) panel_.tangent_at_start = jet.first;
      if (j + 1 == count) panel_.tangent_at_end = jet.first;
    }
    panel_.curvature = grid.coefficients(curvatures);
    const double tail = chebyshev::tail(panel_.curvature);
    if (tail > noise && tail * panel_.length > kTurnNoise) return false;
    recognize_arc();
    panel_.turn = chebyshev::antiderivative(panel_.curvature) * (0.5 * panel_.length);
    const double between = angle_between(panel_.tangent_at_start, panel_.tangent_at_end);
    return std::abs(nearest_angle(between - panel_.turn.sum())) <= kTurnAgreement + noise * panel_.length;
  }

  void recognize_arc() {
    Series& series = panel_.curvature;
    const double most = series.cwiseAbs().maxCoeff();
    Eigen::Index count = series.size();
    while (count > 1 && std::abs(series[count - 1]) <= kEpsilon * most) --count;
    const double bending = series.segment(1, count - 1).cwiseAbs().sum();
    if (bending * panel_.length <= kStructureTurn) count = 1;
    if (count == 1 && std::abs(series[0]) * panel_.length <= kStructureTurn) series[0] = 0;
    series.conservativeResize(count);
  }

  [[noreturn]] void throw_cusp(double u) const {
    const Vec2 place = curve_.position(u);
    throw InputError(
        fmt::format("expected a tangent at every point, found none (a cusp) at ({:.6g}, {:.6g}), parameter {:.6g}: "
                    "remove the cusp or end the curve there, so that it becomes a corner",
                    place.x(), place.y(), u));
  }

  const Curve& curve_;
  double size_;
  const std::function<void(const ResolvedPanel&)>& sink_;
  double parameter_noise_ = 0;
  Series speed_;   // |alpha'| over x in [-1, 1] of the parameter
  Series length_;  // arc length from the panel's start, likewise
  Series inner_;   // where in that x the nodes of equal arc length lie, but for the ends
  Series nodes_;   // the same as parameters u
  ResolvedPanel panel_;
};

}  // namespace

void resolve(const Curve& curve, double size, const std::function<void(const ResolvedPanel&)>& sink) {
  Resolver(curve, size, sink).run();
}

}  // namespace rollfix
