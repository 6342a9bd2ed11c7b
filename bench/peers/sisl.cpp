#include "fitted_curves.hpp"

#ifdef ROLLFIX_BENCH_SISL

#include <sisl.h>

#include <cstdlib>
#include <memory>

namespace bench {
namespace {

constexpr double kPrecision = 1e-9;  // rad: of places where the curves meet
constexpr int kOrder = 4;            // of a cubic

using Spline = std::unique_ptr<SISLCurve, decltype(&freeCurve)>;

/// The pieces as one B-spline, a knot of each joint for every degree; its parameter counts pieces.
Spline spline_of(const FittedCurve& curve) {
  std::vector<double> knots(1, 0.0);
  for (std::size_t k = 0; k <= curve.pieces(); ++k) knots.insert(knots.end(), 3, static_cast<double>(k));
  knots.push_back(static_cast<double>(curve.pieces()));
  std::vector<double> coordinates;
  for (const rollfix::Vec2& point : curve.points) coordinates.insert(coordinates.end(), {point.x(), point.y()});
  constexpr int kPolynomial = 1;
  constexpr int kCopied = 1;
  return {newCurve(static_cast<int>(curve.points.size()), kOrder, knots.data(), coordinates.data(), kPolynomial, 2,
                   kCopied),
          &freeCurve};
}

}  // namespace

std::optional<Pairs> locate_by_sisl(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                                    std::size_t pieces) {
  const auto [a, b] = fitted_curves(part, readings, pieces);
  const Spline one = spline_of(a);
  const Spline two = spline_of(b);
  int points = 0;
  double* on_one = nullptr;
  double* on_two = nullptr;
  int stretches = 0;
  SISLIntcurve** curves = nullptr;
  int status = 0;
  s1857(one.get(), two.get(), 0, kPrecision, &points, &on_one, &on_two, &stretches, &curves, &status);
  Pairs rough;
  for (int k = 0; status >= 0 && k < points; ++k) rough.push_back({a.at(on_one[k]), b.at(on_two[k])});
  if (curves != nullptr) freeIntcrvlist(curves, stretches);
  std::free(on_one);
  std::free(on_two);
  return polished(part, readings, rough);
}

}  // namespace bench

#else

namespace bench {

std::optional<Pairs> locate_by_sisl(const rollfix::Part& /*part*/, const std::vector<rollfix::Reading>& /*readings*/,
                                    std::size_t /*pieces*/) {
  return std::nullopt;
}

}  // namespace bench

#endif
