#include "fitted_curves.hpp"

#ifdef ROLLFIX_BENCH_OCCT

#include <Geom2dAPI_InterCurveCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt2d.hxx>

namespace bench {
namespace {

constexpr double kPrecision = 1e-9;  // rad: of places where the curves meet
constexpr int kDegree = 3;

/// The pieces as one B-spline, whose parameter counts them. Slopes go on from piece to piece, so that knots are double
/// and no piece's ends are control points.
Handle(Geom2d_BSplineCurve) spline_of(const FittedCurve& curve) {
  const int pieces = static_cast<int>(curve.pieces());
  TColgp_Array1OfPnt2d poles(1, 2 * pieces + 2);
  int next = 1;
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    if (k % kDegree == 0 && k > 0 && k + 1 < curve.points.size()) continue;
    poles(next++) = gp_Pnt2d(curve.points[k].x(), curve.points[k].y());
  }
  TColStd_Array1OfReal knots(0, pieces);
  TColStd_Array1OfInteger multiplicities(0, pieces);
  for (int k = 0; k <= pieces; ++k) {
    knots(k) = k;
    multiplicities(k) = k == 0 || k == pieces ? kDegree + 1 : kDegree - 1;
  }
  return new Geom2d_BSplineCurve(poles, knots, multiplicities, kDegree);
}

}  // namespace

std::optional<Pairs> locate_by_occt(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                                    std::size_t pieces) {
  const auto [a, b] = fitted_curves(part, readings, pieces);
  const Geom2dAPI_InterCurveCurve meetings(spline_of(a), spline_of(b), kPrecision);
  Pairs rough;
  for (int k = 1; k <= meetings.NbPoints(); ++k) {
    const IntRes2d_IntersectionPoint& meeting = meetings.Intersector().Point(k);
    rough.push_back({a.at(meeting.ParamOnFirst()), b.at(meeting.ParamOnSecond())});
  }
  return polished(part, readings, rough);
}

}  // namespace bench

#else

namespace bench {

std::optional<Pairs> locate_by_occt(const rollfix::Part& /*part*/, const std::vector<rollfix::Reading>& /*readings*/,
                                    std::size_t /*pieces*/) {
  return std::nullopt;
}

}  // namespace bench

#endif
