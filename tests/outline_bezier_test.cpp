// Bezier and NURBS curves, and elliptic arcs.
#include "rollfix/curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "beziers.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace outline_bezier_test {
namespace {

using beziers::bernstein;
using beziers::bow;
using beziers::open_outline;
using rollfix::Bezier;
using rollfix::check;
using rollfix::Curve;
using rollfix::EllipticArc;
using rollfix::InputError;
using rollfix::nurbs;
using rollfix::Outline;
using rollfix::Part;
using rollfix::Vec2;
using shapes::random_point;
using std::numbers::pi;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

int whole(std::mt19937_64& generator, int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(generator); }

std::vector<Vec2> random_points(std::mt19937_64& generator, int count) {
  std::vector<Vec2> points;
  for (int k = 0; k < count; ++k) points.push_back(random_point(generator));
  return points;
}

std::vector<double> random_weights(std::mt19937_64& generator, int count) {
  std::vector<double> weights;
  for (int k = 0; k < count; ++k) weights.push_back(std::exp(uniform(generator, -2, 2)));
  return weights;
}

template <class Make>
std::string message_of(Make make) {
  try {
    make();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// ---- elliptic arcs

TEST(EllipticArc, derivatives_are_right) {
  EXPECT_THAT(check(open_outline({EllipticArc({1, 2}, {3, 1}, {-0.5, 2}, 0.3, 2.5)})), IsEmpty());
  EXPECT_THAT(check(open_outline({EllipticArc({1, 2}, {3, 1}, {-0.5, 2}, 0.3, -6)})), IsEmpty());
}

TEST(EllipticArc, full_ellipse_closes_to_the_last_bit) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(200); ++i) {
    const Curve ellipse = EllipticArc(random_point(generator), random_point(generator), random_point(generator),
                                      uniform(generator, -7, 7), i % 2 == 0 ? 2 * pi : -2 * pi);
    EXPECT_EQ(ellipse.front(), ellipse.back());
  }
}

TEST(EllipticArc, runs_from_the_angle_given_by_the_sweep) {
  const Vec2 centre(1, 2), major(3, 1), minor(-0.5, 2);
  for (const double sweep : {1.2, -1.2, 5.0, -5.0}) {
    const Curve arc = EllipticArc(centre, major, minor, 0.7, sweep);
    for (const double share : {0.0, 0.3, 1.0}) {
      const double angle = 0.7 + share * sweep;
      const Vec2 expected = centre + std::cos(angle) * major + std::sin(angle) * minor;
      EXPECT_NEAR((arc.position(share * std::abs(sweep)) - expected).norm(), 0, 2e-15);
    }
  }
}

TEST(EllipticArc, with_equal_perpendicular_axes_is_an_arc) {
  const Curve ellipse = EllipticArc({1, 2}, {0, 3}, {-3, 0}, 0.5, -2);
  const Curve circle = rollfix::Arc({1, 2}, 3, 0.5 + pi / 2, -2);
  for (const double u : {0.0, 1.0, 2.0}) EXPECT_NEAR((ellipse.position(u) - circle.position(u)).norm(), 0, 2e-15);
}

TEST(EllipticArc, impossible_one_is_refused) {
  EXPECT_THROW(EllipticArc({0, 0}, {1, 2}, {2, 4}, 0, 1), InputError);
  EXPECT_THROW(EllipticArc({0, 0}, {0, 0}, {2, 4}, 0, 1), InputError);
  EXPECT_THROW(EllipticArc({0, 0}, {1, 0}, {0, 1}, 0, 0), InputError);
  EXPECT_THROW(EllipticArc({0, 0}, {1, 0}, {0, 1}, 0, 7), InputError);
  EXPECT_THROW(EllipticArc({0, 0}, {1, 0}, {0, 1}, kNan, 1), InputError);
  EXPECT_THROW(EllipticArc({kNan, 0}, {1, 0}, {0, 1}, 0, 1), InputError);
  EXPECT_THROW(EllipticArc({0, 0}, {kNan, 0}, {0, 1}, 0, 1), InputError);
}

// ---- Bezier curves

TEST(Bezier, is_the_sum_of_bernstein_polynomials) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(300); ++i) {
    const int count = whole(generator, 2, 9);
    const auto points = random_points(generator, count);
    const auto weights = i % 2 == 0 ? std::vector<double>() : random_weights(generator, count);
    const Curve curve = Bezier(points, weights);
    const double u = uniform(generator, 0, 1);
    EXPECT_NEAR((curve.position(u) - bernstein(points, weights, u)).norm(), 0, 1e-12);
  }
}

TEST(Bezier, ends_are_exact_to_the_last_bit) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(300); ++i) {
    const int count = whole(generator, 2, 9);
    const auto points = random_points(generator, count);
    const Curve curve = Bezier(points, i % 2 == 0 ? std::vector<double>() : random_weights(generator, count));
    EXPECT_EQ(curve.front(), points.front());
    EXPECT_EQ(curve.back(), points.back());
  }
}

TEST(Bezier, derivatives_are_right_for_every_degree) {
  auto generator = test_generator();
  for (int count = 2; count <= 9; ++count) {
    EXPECT_THAT(check(open_outline({Bezier(bow(count))})), IsEmpty()) << count;
    EXPECT_THAT(check(open_outline({Bezier(bow(count), random_weights(generator, count))})), IsEmpty()) << count;
  }
}

TEST(Bezier, of_the_highest_degree_is_taken_and_of_one_more_refused) {
  EXPECT_THAT(check(open_outline({Bezier(bow(rollfix::kMostDegree + 1))}), 8), IsEmpty());
  EXPECT_THROW(Bezier(bow(rollfix::kMostDegree + 2)), InputError);
}

TEST(Bezier, rational_quarter_is_a_circle) {
  const Curve quarter = Bezier({{1, 0}, {1, 1}, {0, 1}}, {1, std::sqrt(0.5), 1});
  for (double u = 0; u <= 1; u += 0.0625) {
    EXPECT_NEAR(quarter.position(u).norm(), 1, 1e-15);
    EXPECT_NEAR(curvature(quarter.jet(u)), 1, 1e-13);
    EXPECT_NEAR(curvature_rate(quarter.jet(u)), 0, 1e-12);
  }
}

TEST(Bezier, equal_weights_are_as_good_as_none) {
  EXPECT_EQ(Bezier(bow(4), {2, 2, 2, 2}).record().kind, "bezier");
  EXPECT_EQ(Bezier(bow(4), {2, 1, 2, 2}).record().kind, "rational-bezier");
}

TEST(Bezier, record_makes_the_same_curve_again) {
  const Bezier plain(bow(4));
  const std::vector<double>& n = plain.record().numbers;
  ASSERT_THAT(n, SizeIs(8));
  EXPECT_EQ(Bezier({{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}}).jet(0.3).position,
            plain.jet(0.3).position);
  EXPECT_THAT(Bezier(bow(3), {1, 2, 3}).record().numbers,
              testing::ElementsAre(3, 0, 1, bow(3)[1].x(), bow(3)[1].y(), 2, bow(3)[2].x(), bow(3)[2].y(), 3));
}

TEST(Bezier, bad_input_is_refused) {
  EXPECT_THAT(message_of([] { Bezier({{1, 2}}); }), HasSubstr("expected 2 to 26 control points, found 1"));
  EXPECT_THAT(message_of([] { Bezier({{1, 2}, {1, 2}, {1, 2}}); }), HasSubstr("are the same"));
  EXPECT_THAT(message_of([] { Bezier({{1, 2}, {kNan, 2}}); }), HasSubstr("finite control points"));
  EXPECT_THAT(message_of([] { Bezier({{1, 2}, {3, 2}}, {1}); }), HasSubstr("one weight for each of 2 control points"));
  EXPECT_THAT(message_of([] { Bezier({{1, 2}, {3, 2}}, {1, 0}); }), HasSubstr("weights above 0, found 0"));
  EXPECT_THAT(message_of([] { Bezier({{1, 2}, {3, 2}}, {1, -2}); }), HasSubstr("weights above 0, found -2"));
  EXPECT_THAT(message_of([] { Bezier({{1, 2}, {3, 2}}, {1, kNan}); }), HasSubstr("weights above 0, found nan"));
}

// ---- NURBS

/// A basis function of the spline for t in this span of its knots, by the Cox-de Boor recursion: 0/0 counts as 0.
double basis(int degree, const std::vector<double>& knots, std::size_t i, std::size_t span, double t) {
  if (degree == 0) return i == span ? 1 : 0;
  const auto p = static_cast<std::size_t>(degree);
  const double rise = knots[i + p] - knots[i];
  const double fall = knots[i + p + 1] - knots[i + 1];
  double sum = 0;
  if (rise > 0) sum += (t - knots[i]) / rise * basis(degree - 1, knots, i, span, t);
  if (fall > 0) sum += (knots[i + p + 1] - t) / fall * basis(degree - 1, knots, i + 1, span, t);
  return sum;
}

struct Spline {
  int degree;
  std::vector<double> knots;
  std::vector<Vec2> points;
  std::vector<double> weights;

  Vec2 at(double t, std::size_t span) const {
    Vec2 sum = Vec2::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double factor = (weights.empty() ? 1 : weights[i]) * basis(degree, knots, i, span, t);
      sum += factor * points[i];
      total += factor;
    }
    return sum / total;
  }
  std::vector<Curve> curves() const { return nurbs(degree, knots, points, weights); }
};

Spline random_spline(std::mt19937_64& generator) {
  Spline spline;
  spline.degree = whole(generator, 1, 7);
  const int count = spline.degree + 1 + whole(generator, 0, 8);
  const bool clamped = whole(generator, 0, 1) == 0;
  const auto p = static_cast<std::size_t>(spline.degree);
  double knot = uniform(generator, -3, 3);
  int times = 1;
  for (int k = 0; k < count + spline.degree + 1; ++k) {
    spline.knots.push_back(knot);
    const bool at_start = clamped && k < spline.degree;
    const bool at_end = clamped && k >= count;
    const bool repeat =
        !clamped ? times < spline.degree && whole(generator, 0, 3) == 0
                 : k > spline.degree && k + 1 < count && times < spline.degree && whole(generator, 0, 3) == 0;
    if (at_start || at_end || repeat) {
      ++times;
    } else {
      knot += uniform(generator, 0.3, 2);
      times = 1;
    }
  }
  if (spline.knots[p] == spline.knots[static_cast<std::size_t>(count)]) return random_spline(generator);
  spline.points = random_points(generator, count);
  // Weights on a line move only its parameter.
  if (spline.degree > 1 && whole(generator, 0, 1) == 0) spline.weights = random_weights(generator, count);
  return spline;
}

TEST(Nurbs, agrees_with_the_basis_functions) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(500); ++i) {
    const Spline spline = random_spline(generator);
    const auto curves = spline.curves();
    std::size_t number = 0;
    for (auto span = static_cast<std::size_t>(spline.degree); span < spline.points.size(); ++span) {
      const double lo = spline.knots[span], hi = spline.knots[span + 1];
      if (lo == hi) continue;
      ASSERT_LT(number, curves.size());
      for (const double u : {0.0, 0.3, 0.8, 1.0}) {
        const Vec2 expected = spline.at(u == 1 ? hi : lo + u * (hi - lo), span);
        EXPECT_NEAR((curves[number].position(u) - expected).norm(), 0, 1e-9) << "degree " << spline.degree;
      }
      ++number;
    }
    EXPECT_EQ(number, curves.size());
  }
}

TEST(Nurbs, clamped_ends_are_exact_and_joints_meet_to_the_last_bit) {
  auto generator = test_generator();
  for (int i = 0; i < test_count(200); ++i) {
    const auto points = random_points(generator, 6);
    const auto curves = nurbs(3, {0, 0, 0, 0, 1, 2.5, 3, 3, 3, 3}, points,
                              i % 2 == 0 ? std::vector<double>() : random_weights(generator, 6));
    ASSERT_THAT(curves, SizeIs(3));
    EXPECT_EQ(curves.front().front(), points.front());
    EXPECT_NEAR((curves.back().back() - points.back()).norm(), 0, 4e-15);
    EXPECT_EQ(curves[0].back(), curves[1].front());
    EXPECT_EQ(curves[1].back(), curves[2].front());
  }
}

TEST(Nurbs, nine_points_with_weights_are_a_circle) {
  const double w = std::sqrt(0.5);
  const std::vector<Vec2> points = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  Outline circle{"circle", nurbs(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, points, {1, w, 1, w, 1, w, 1, w, 1})};
  ASSERT_THAT(circle.curves, SizeIs(4));
  EXPECT_THAT(check(circle), IsEmpty());
  EXPECT_NEAR(Part(circle).perimeter(), 2 * pi, 1e-12);
  EXPECT_THAT(Part(circle).corners(), IsEmpty());
}

TEST(Nurbs, derivatives_are_right) {
  EXPECT_THAT(check(open_outline(nurbs(3, {0, 1, 2, 3, 4, 6, 7, 7, 9, 10}, bow(6), {1, 2, 1, 0.5, 1, 1}))), IsEmpty());
}

TEST(Nurbs, stretch_that_is_a_point_is_left_out) {
  std::vector<Vec2> points = bow(7);
  points[1] = points[2] = points[3] = points[0];
  EXPECT_THAT(nurbs(3, {0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4}, points), SizeIs(3));
}

TEST(Nurbs, of_doubled_control_points_makes_a_part) {
  std::vector<Vec2> points = bow(6);
  points[1] = points[0];
  const Part part(open_outline(nurbs(3, {0, 0, 0, 0, 1, 2, 3, 3, 3, 3}, points)));
  EXPECT_THAT(part.corners(), IsEmpty());
}

TEST(Nurbs, weights_too_far_apart_are_refused_and_not_worked_on_for_hours) {
  const auto with_weights = [](double second, double third) {
    Outline outline{"leaf", {}, true};
    outline.curves.emplace_back(Bezier({{0, 0}, {1, 0}, {1, 1}}, {1, second, third}));
    outline.curves.emplace_back(rollfix::Line({1, 1}, {0, 0}));
    return outline;
  };
  EXPECT_THAT(refusal_of([&] { Part{with_weights(1, 500)}; }), HasSubstr("as with weights far apart"));
  EXPECT_THAT(refusal_of([&] { Part{with_weights(2, 1000)}; }), HasSubstr("as with weights far apart"));
  EXPECT_GT(Part(with_weights(1, 200)).perimeter(), 2.8);
}

TEST(Nurbs, bad_input_is_refused) {
  const std::vector<Vec2> four = bow(4);
  const std::vector<double> knots = {0, 0, 0, 0, 1, 1, 1, 1};
  const auto message = [](int degree, const std::vector<double>& k, const std::vector<Vec2>& p,
                          const std::vector<double>& w = {}) { return message_of([&] { nurbs(degree, k, p, w); }); };
  EXPECT_EQ(message(3, knots, four), "no error");
  EXPECT_THAT(message(0, knots, four), HasSubstr("degree 1 to 25, found 0"));
  EXPECT_THAT(message(26, knots, four), HasSubstr("degree 1 to 25, found 26"));
  EXPECT_THAT(message(-1, knots, four), HasSubstr("degree 1 to 25, found -1"));
  EXPECT_THAT(message(4, knots, four), HasSubstr("at least 5 control points"));
  EXPECT_THAT(message(3, {0, 0, 0, 1, 1, 1, 1}, four), HasSubstr("expected 8 knots"));
  EXPECT_THAT(message(3, {0, 0, 0, 0, 1, 1, 1, kNan}, four), HasSubstr("finite knots"));
  EXPECT_THAT(message(3, {0, 0, 0, 0, 1, 1, 0.5, 1}, four), HasSubstr("found 0.5 after 1"));
  EXPECT_THAT(message(3, {1, 1, 1, 1, 1, 1, 1, 1}, four), HasSubstr("span an interval"));
  EXPECT_THAT(message(2, {0, 0, 0, 1, 1, 1, 2, 2, 2}, bow(6)), HasSubstr("the inner knot 1"));
  EXPECT_THAT(message(3, knots, {{0, 0}, {1, 0}, {kNan, 1}, {0, 1}}), HasSubstr("finite control points"));
  EXPECT_THAT(message(3, knots, four, {1, 1, 1}), HasSubstr("one weight for each of 4"));
  EXPECT_THAT(message(3, knots, four, {1, 1, 1, 0}), HasSubstr("weights above 0"));
  EXPECT_THAT(message(3, {}, {}), HasSubstr("control points"));
}

TEST(Nurbs, inner_knot_as_often_as_the_degree_is_a_corner) {
  const std::vector<Vec2> points = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}};
  const auto curves = nurbs(2, {0, 0, 0, 1, 1, 2, 2, 2}, points);
  ASSERT_THAT(curves, SizeIs(2));
  EXPECT_EQ(curves[0].back(), Vec2(2, 0));
  EXPECT_THAT(Part(open_outline(curves)).corners(), SizeIs(1));
}

}  // namespace
}  // namespace outline_bezier_test
