#pragma once

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

/// Lengths and areas of drawings by quadrature on their jets, independent of what the library makes of them.
namespace drawings {

using rollfix::Curve;
using rollfix::Drawing;
using rollfix::Jet;
using rollfix::Vec2;

/// Integral of f(jet) over a curve's parameter, to 1e-12 or so.
template <class F>
double integral(const Curve& curve, const F& f) {
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  const auto at = [&](double u) { return f(curve.jet(u)); };
  return Rule::integrate(at, curve.domain().lo, curve.domain().hi, 10, 1e-12);
}

inline double length_of(const std::vector<Curve>& curves) {
  double sum = 0;
  for (const Curve& curve : curves) {
    sum += integral(curve, [](const Jet& jet) { return jet.first.norm(); });
  }
  return sum;
}

/// Half the integral of x dy - y dx (Green): the area of closed curves, above 0 where they run counter-clockwise.
inline double area_of(const std::vector<Curve>& curves) {
  double sum = 0;
  for (const Curve& curve : curves) {
    sum += 0.5 * integral(curve, [](const Jet& jet) { return rollfix::cross(jet.position, jet.first); });
  }
  return sum;
}

inline std::vector<Curve> curves_of(const Drawing& drawing) {
  std::vector<Curve> curves;
  for (const rollfix::DrawnCurve& drawn : drawing.curves) curves.push_back(drawn.curve);
  return curves;
}

inline double length_of(const Drawing& drawing) { return length_of(curves_of(drawing)); }
inline double area_of(const Drawing& drawing) { return area_of(curves_of(drawing)); }

/// The drawing as one closed outline, its curves in the file's order.
inline rollfix::Outline outline_of(const Drawing& drawing) {
  rollfix::Outline outline{drawing.name, curves_of(drawing), true};
  return area_of(drawing) > 0 ? outline : rollfix::reversed(outline);
}

/// As the library measures it.
inline double perimeter_of(const Drawing& drawing) { return rollfix::Part(outline_of(drawing)).perimeter(); }

/// "arc", "line", ... of each curve.
inline std::vector<std::string> kinds_of(const Drawing& drawing) {
  std::vector<std::string> kinds;
  for (const rollfix::DrawnCurve& drawn : drawing.curves) {
    const auto record = drawn.curve.record();
    kinds.push_back(record ? record->kind : "");
  }
  return kinds;
}

/// What each curve was made of, kinds and numbers: equal records are equal curves, to the bit.
inline std::vector<std::vector<double>> numbers_of(const Drawing& drawing) {
  std::vector<std::vector<double>> numbers;
  for (const rollfix::DrawnCurve& drawn : drawing.curves) numbers.push_back(drawn.curve.record().value().numbers);
  return numbers;
}

}  // namespace drawings
