#include "outlines.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

#include "rollfix/outline.hpp"

namespace bench {

rollfix::Outline wing_through_points(int count) {
  const rollfix::Part wing(rollfix::gallery("naca,digits=2412"));
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < count; ++k) points.push_back(wing.point(wing.perimeter() * k / count));
  return {"points", rollfix::spline_through(points, true), true};
}

rollfix::Outline egg_through_points(int count) {
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < count; ++k) {
    const double t = 2 * std::numbers::pi * k / count;
    const double bulge = 1 + 0.15 * std::cos(t);
    points.push_back({3 * bulge * std::cos(t), 2 * bulge * std::sin(t)});
  }
  return {"egg", rollfix::spline_through(points, true), true};
}

std::vector<Family> families() {
  std::vector<Family> all;
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    all.push_back({shape.name, rollfix::gallery(shape.name)});
  }
  all.push_back({"wing, 160 points", wing_through_points(160), false});
  return all;
}

double perimeter_by_quadrature(const rollfix::Outline& outline) {
  double sum = 0;
  for (const rollfix::Curve& curve : outline.curves) {
    const rollfix::Interval domain = curve.domain();
    sum += boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
        [&](double u) { return curve.velocity(u).norm(); }, domain.lo, domain.hi, 15, 1e-10);
  }
  return sum;
}

bool is_trivial(const rollfix::Part& part) {
  const std::vector<rollfix::Spiral>& spirals = part.turning().spirals();
  return std::all_of(spirals.begin(), spirals.end(), [](const rollfix::Spiral& spiral) { return spiral.trend == 0; });
}

}  // namespace bench
