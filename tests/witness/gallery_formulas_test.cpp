// The gallery's curves against their formulas in 60 digits: position, three derivatives and the curvature, to a few
// units of a double's last place. The derivatives here are differences, which share nothing with the library's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "rollfix/outline.hpp"

namespace gallery_formulas_test {
namespace {

using boost::multiprecision::atan;
using boost::multiprecision::cos;
using boost::multiprecision::exp;
using boost::multiprecision::pow;
using boost::multiprecision::sin;
using boost::multiprecision::sqrt;
using rollfix::Curve;
using rollfix::Interval;
using rollfix::Jet;
using rollfix::Vec2;

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>, boost::multiprecision::et_off>;
using Point = std::array<Real, 2>;
using Formula = std::function<Point(Real)>;

constexpr double kUnit = 0x1p-53;  // half a unit in the last place of 1

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1]}; }
Point operator*(const Real& f, const Point& a) { return {f * a[0], f * a[1]}; }
double norm(const Point& a) { return static_cast<double>(sqrt(a[0] * a[0] + a[1] * a[1])); }
Point exact(const Vec2& v) { return {Real(v.x()), Real(v.y())}; }

/// Position and derivatives 1 to 3. With this step the differences are good to some 20 digits.
std::array<Point, 4> differentiated(const Formula& f, const Real& u) {
  const Real h("1e-11");
  const Point before2 = f(u - 2 * h), before = f(u - h), here = f(u), after = f(u + h), after2 = f(u + 2 * h);
  return {here, (1 / (2 * h)) * (after - before), (1 / (h * h)) * (after + before - Real(2) * here),
          (1 / (2 * h * h * h)) * (after2 - before2 - Real(2) * (after - before))};
}

Real cross(const Point& a, const Point& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The largest errors found along a curve, in units of rounding of what is compared.
struct Errors {
  std::array<double, 4> derivative = {0, 0, 0, 0};
  double curvature = 0;
};

/// The library measures the second half of a full turn back from the end: its parameter is exact from there.
Real turned(double u, const Interval& domain) {
  const bool is_full_turn = domain.lo == 0 && domain.hi == 2 * std::numbers::pi;
  return is_full_turn && u > std::numbers::pi ? Real(u) - Real(domain.hi) : Real(u);
}

/// A derivative may be small by chance: errors are in units of what it is within a few samples.
double size_near(const std::vector<std::array<Point, 4>>& truth, std::size_t sample, std::size_t order) {
  constexpr std::size_t kNear = 4;
  double size = 0;
  for (std::size_t k = sample < kNear ? 0 : sample - kNear; k <= sample + kNear && k < truth.size(); ++k) {
    size = std::max(size, norm(truth[k][order]));
  }
  return size;
}

Errors errors_of(const Curve& curve, const Formula& formula) {
  constexpr std::size_t kSamples = 100;
  const Interval domain = curve.domain();
  std::vector<double> parameters;
  std::vector<std::array<Point, 4>> truth;
  for (std::size_t k = 0; k <= kSamples; ++k) {
    parameters.push_back(k == kSamples ? domain.hi : domain.lo + domain.width() * static_cast<double>(k) / kSamples);
    truth.push_back(differentiated(formula, turned(parameters.back(), domain)));
  }
  Errors worst;
  double most_curvature = 0;
  for (std::size_t k = 0; k <= kSamples; ++k) {
    const Jet jet = curve.jet(parameters[k]);
    const std::array<Vec2, 4> found = {jet.position, jet.first, jet.second, jet.third};
    for (std::size_t order = 0; order < 4; ++order) {
      const double error = norm(exact(found[order]) - truth[k][order]) / (size_near(truth, k, order) * kUnit);
      worst.derivative[order] = std::max(worst.derivative[order], error);
    }
    const double speed = norm(truth[k][1]);
    const double kappa = static_cast<double>(cross(truth[k][1], truth[k][2])) / (speed * speed * speed);
    most_curvature = std::max(most_curvature, std::abs(kappa));
    worst.curvature = std::max(worst.curvature, std::abs(rollfix::curvature(jet) - kappa) / kUnit);
  }
  worst.curvature /= most_curvature;
  return worst;
}

Formula polar(const std::function<Real(Real)>& radius) {
  return [radius](const Real& u) { return radius(u) * Point{cos(u), sin(u)}; };
}

void expect_accurate(const std::string& specification, std::size_t index, const Formula& formula) {
  const Errors errors = errors_of(rollfix::gallery(specification).curves.at(index), formula);
  EXPECT_LE(errors.derivative[0], 8) << specification;
  EXPECT_LE(errors.derivative[1], 16) << specification;
  EXPECT_LE(errors.derivative[2], 16) << specification;
  EXPECT_LE(errors.derivative[3], 256) << specification;  // it has near-double zeros on wing sections
  EXPECT_LE(errors.curvature, 32) << specification;
}

TEST(GalleryFormulas, circle) {
  expect_accurate("circle,r=0.7", 0, polar([](const Real&) { return Real(0.7); }));
}

TEST(GalleryFormulas, ellipse) {
  for (const double b : {1.0, 0.999, 0.01}) {
    expect_accurate(fmt::format("ellipse,a=1,b={}", b), 0, [b](const Real& u) -> Point {
      return {cos(u), Real(b) * sin(u)};
    });
  }
}

TEST(GalleryFormulas, superellipse) {
  for (const int n : {3, 4, 5, 6, 20}) {  // of odd n the first quarter
    expect_accurate(fmt::format("superellipse,n={}", n), 0, [n](const Real& u) {
      const Real g = pow(cos(u), n) + pow(sin(u), n);
      return pow(g, Real(-1) / n) * Point{Real(1.5) * cos(u), sin(u)};
    });
  }
}

TEST(GalleryFormulas, limacon) {
  for (const double b : {1.0, -1.25, 1.499, 2.0, -1.49999}) {
    expect_accurate(fmt::format("limacon,a=1.5,b={}", b), 0,
                    polar([b](const Real& u) -> Real { return Real(1.5) + Real(b) * cos(u); }));
  }
}

TEST(GalleryFormulas, cam) {
  expect_accurate("cam,base=1,lift=2", 0, polar([](const Real& u) -> Real {
                    const Real q = (1 + cos(u)) / 2;
                    return 1 + 2 * q * q;
                  }));
}

TEST(GalleryFormulas, gear) {
  for (const int teeth : {1, 12, 100}) {
    expect_accurate(fmt::format("gear,depth=0.25,teeth={}", teeth), 0,
                    polar([teeth](const Real& u) -> Real { return 1 + cos(teeth * u) / 4; }));
  }
}

TEST(GalleryFormulas, log_spiral) {
  for (const double b : {0.125, -0.5}) {
    expect_accurate(fmt::format("log-spiral,a=3,turns=3,b={}", b), 0,
                    polar([b](const Real& u) -> Real { return 3 * exp(Real(b) * u); }));
  }
}

TEST(GalleryFormulas, exponential) {
  expect_accurate("exponential,from=-10,to=3,scale=2", 0, [](const Real& u) -> Point { return {2 * u, 2 * exp(u)}; });
}

/// A 4-digit section: camber in percent, its place in tenths, thickness in percent.
struct Section {
  int camber;
  int place;
  int thickness;
};

/// The textbook's formula: x = w^2 from the nose, thickness laid off square to the camber line; u = -w above, w below.
Formula wing(const Section& section, bool upper, bool fore) {
  return [=](const Real& u) -> Point {
    const Real m = Real(section.camber) / 100, p = Real(section.place) / 10, t = Real(section.thickness) / 100;
    const Real w = upper ? -u : u;
    const Real x = w * w;
    const Real half = 5 * t *
                      (Real("0.2969") * w - Real("0.126") * x - Real("0.3516") * x * x + Real("0.2843") * x * x * x -
                       Real("0.1036") * x * x * x * x);
    const Real reach = fore ? p : 1 - p;
    const bool has_camber = section.camber > 0;
    const Real line = has_camber ? Real(m * (1 - (x - p) * (x - p) / (reach * reach))) : Real(0);
    const Real angle = has_camber ? Real(atan(2 * m * (p - x) / (reach * reach))) : Real(0);
    const Point offset = half * Point{-sin(angle), cos(angle)};
    return upper ? Point{x, line} + offset : Point{x, line} - offset;
  };
}

TEST(GalleryFormulas, symmetric_wing_section) {
  expect_accurate("naca,digits=0012", 0, wing({0, 0, 12}, true, true));
  expect_accurate("naca,digits=0012", 1, wing({0, 0, 12}, false, true));
}

TEST(GalleryFormulas, cambered_wing_section) {
  for (std::size_t i = 0; i < 4; ++i) {
    expect_accurate("naca,digits=4415", i, wing({4, 4, 15}, i < 2, i == 1 || i == 2));
    expect_accurate("naca,digits=9130", i, wing({9, 1, 30}, i < 2, i == 1 || i == 2));
  }
}

}  // namespace
}  // namespace gallery_formulas_test
