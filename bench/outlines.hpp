#pragma once

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rollfix/outline/gallery.hpp"
#include "rollfix/outline/points.hpp"
#include "rollfix/part/part.hpp"

namespace bench {

/// What is measured: the gallery at its defaults, and an outline as a user has it.
struct Family {
  std::string name;
  rollfix::Outline outline;
};

/// A wing section through points, with a corner at the trailing edge.
inline rollfix::Outline wing_through_points(int count) {
  const rollfix::Part wing(rollfix::gallery("naca,digits=2412"));
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < count; ++k) points.push_back(wing.point(wing.perimeter() * k / count));
  return {"points", rollfix::spline_through(points, true), true};
}

inline std::vector<Family> families() {
  std::vector<Family> all;
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    all.push_back({shape.name, rollfix::gallery(shape.name)});
  }
  all.push_back({"200 points", wing_through_points(200)});
  return all;
}

/// W is the time that this takes: Boost's adaptive quadrature at 1e-10, one call per smooth piece.
inline double perimeter_by_quadrature(const rollfix::Outline& outline) {
  double sum = 0;
  for (const rollfix::Curve& curve : outline.curves) {
    const rollfix::Interval domain = curve.domain();
    sum += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
        [&](double u) { return curve.velocity(u).norm(); }, domain.lo, domain.hi, 15, 1e-10);
  }
  return sum;
}

/// Lines and arcs alone: next to nothing to integrate.
inline bool is_trivial(const rollfix::Part& part) {
  const std::vector<rollfix::Spiral>& spirals = part.turning().spirals();
  return std::all_of(spirals.begin(), spirals.end(), [](const rollfix::Spiral& spiral) { return spiral.trend == 0; });
}

/// A geometric mean.
class Mean {
 public:
  void add(double value) {
    if (!(value > 0)) return;
    sum_ += std::log(value);
    ++count_;
  }
  /// Not a number where nothing was measured.
  double value() const { return count_ > 0 ? std::exp(sum_ / count_) : std::nan(""); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

}  // namespace bench
