#include "outline/curve_measure.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace rollfix {

namespace {

using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;

constexpr double kQuadratureTolerance = 1e-12;  // relative
constexpr unsigned kMostHalvings = 12;
constexpr int kPointsPerCurve = 16;

template <class F>
double integral(const F& f, const Interval& domain) {
  return Quadrature::integrate(f, domain.lo, domain.hi, kMostHalvings, kQuadratureTolerance);
}

bool is_line(const Curve& curve) {
  const auto record = curve.record();
  return record && record->kind == "line";
}

}  // namespace

CurveMeasure measure(const Curve& curve) {
  const Interval domain = curve.domain();
  CurveMeasure result;
  result.front = result.origin = curve.front();
  result.box.extend(result.front);
  result.back = curve.back();
  result.middle = curve.position(domain.middle());
  const bool straight = is_line(curve);
  for (int k = 1; k <= kPointsPerCurve; ++k) {
    const Vec2 point = k == kPointsPerCurve || straight
                           ? result.back
                           : curve.position(domain.lo + domain.width() * k / kPointsPerCurve);
    result.box.extend(point);
    if (straight) break;
  }
  if (straight) {
    result.length = (result.back - result.front).norm();
    return result;
  }
  result.length = integral([&](double u) { return curve.velocity(u).norm(); }, domain);
  // The area of a nearly straight curve is next to nothing, and no quadrature gets it to a share of itself: with the
  // length added, the tolerance is a share of length^2.
  const double with_length = integral(
      [&](double u) {
        const Jet jet = curve.jet(u);
        return cross(jet.position - result.origin, jet.first) + result.length * jet.first.norm();
      },
      domain);
  result.twice_area = with_length - result.length * result.length;
  return result;
}

bool Polygon::contains(const Vec2& point) const {
  if (!box.contains(point)) return false;
  bool inside = false;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec2& a = points[k];
    const Vec2& b = points[(k + 1) % points.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > point.x()) inside = !inside;
  }
  return inside;
}

Polygon polygon_of(const Outline& outline) {
  Polygon result;
  for (const Curve& curve : outline.curves) {
    const Interval domain = curve.domain();
    const int count = is_line(curve) ? 1 : kPointsPerCurve;
    for (int k = 0; k < count; ++k) result.points.push_back(curve.position(domain.lo + domain.width() * k / count));
  }
  result.box = box_around(result.points);
  return result;
}

}  // namespace rollfix
