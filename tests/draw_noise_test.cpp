// Figures of answers with noise: what is probable is drawn where it is, and as probable as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <numbers>
#include <random>

#include "draw/answer/densities.hpp"
#include "draw/plot.hpp"
#include "draw_helpers.hpp"
#include "noisy_pairs.hpp"
#include "random.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace draw_noise_test {
namespace {

using draw_test::count_of;
using draw_test::gallery_part;
using draw_test::nesting_error;
using draw_test::paths_in;
using rollfix::Answer;
using rollfix::AnswerFigure;
using rollfix::Boundary;
using rollfix::Density;
using rollfix::Interval;
using rollfix::Log;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Vec2;
using testing::HasSubstr;
using testing::Not;

/// A noisy roll of one finger, solved.
struct Solved {
  Log log;
  Answer answer;

  std::string str(bool in_world = true) const {
    AnswerFigure figure{&answer};
    if (in_world) figure.log = &log;
    return draw_answer(figure).str();
  }
};

Solved solved(const std::string& shape, double start, double length, const Noise& noise) {
  const Part part = gallery_part(shape);
  rollfix::RollPlan plan;
  plan.start = start;
  plan.distance = length;
  plan.rows = 60;
  const Log log = noisy_roll(part, rollfix::DiskFinger{0.2}, plan, noise, 5).log;
  rollfix::Problem problem{part, log, {rollfix::disk(0.2)}, noise};
  return {log, solve(problem)};
}

const Solved& ellipse() {
  static const Solved of_ellipse = solved("ellipse", 1, 1.5, {0.005, 0.01});
  return of_ellipse;
}

TEST(Binned, keeps_the_mass_across_the_seam_and_in_points) {
  const Boundary loop{10, true};
  const Density density = {{{9, 11}, 0.5}, {{4, 4}, 0.25}, {{2, 3}, 0.25}};
  const std::vector<double> bins = rollfix::draw::binned(density, loop, loop.full_arc(), 20);
  double sum = 0;
  for (const double height : bins) sum += 0.5 * height;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NEAR(bins[0], 0.25, 1e-12);
  EXPECT_NEAR(bins[19], 0.25, 1e-12);
  EXPECT_NEAR(bins[8], 0.5, 1e-12);
  const std::vector<double> seam = rollfix::draw::binned(density, loop, {9, 11}, 2);
  EXPECT_NEAR(seam[0], 0.25, 1e-12);
  EXPECT_NEAR(seam[1], 0.25, 1e-12);
}

TEST(Smoothed, keeps_the_mass_around_a_loop) {
  std::vector<double> bins(50, 0.0);
  bins[0] = 3;
  const std::vector<double> smooth = rollfix::draw::smoothed(bins, 2, true);
  double sum = 0;
  for (const double height : smooth) sum += height;
  EXPECT_NEAR(sum, 3, 1e-12);
  EXPECT_NEAR(smooth[1], smooth[49], 1e-12);
  EXPECT_NEAR(smooth[2] / smooth[0], std::exp(-0.5), 1e-12);
}

TEST(Ellipse, lies_where_the_squared_distance_is_what_was_asked_for) {
  Eigen::Matrix2d covariance;
  covariance << 4, 1.5, 1.5, 1;
  const Vec2 mean(3, -2);
  for (const Vec2& at : rollfix::draw::ellipse(mean, covariance, 2)) {
    EXPECT_NEAR((at - mean).dot(covariance.inverse() * (at - mean)), 4, 1e-9);
  }
  EXPECT_NEAR(
      std::pow(rollfix::draw::half_axes(covariance).x(), 2) + std::pow(rollfix::draw::half_axes(covariance).y(), 2),
      covariance.trace(), 1e-12);
  // Of a normal distribution in the plane exp(-r^2 / 2) lies beyond r.
  EXPECT_NEAR(std::exp(-0.5 * std::pow(rollfix::draw::kEllipse95, 2)), 0.05, 1e-5);
  EXPECT_NEAR(std::exp(-0.5 * std::pow(rollfix::draw::kEllipseHalf, 2)), 0.5, 1e-5);
}

TEST(Numbers, are_as_long_as_they_are_sure_and_no_probability_is_a_certainty) {
  using rollfix::draw::percent;
  using rollfix::draw::with_sd;
  EXPECT_EQ(with_sd(1.409895, 0.0528), "1.410 \u00b1 0.053");
  EXPECT_EQ(with_sd(-120.4, 14), "\u2212120 \u00b1 14");
  EXPECT_EQ(percent(0.49512), "49.5 %");
  EXPECT_EQ(percent(1), "> 99.9 %");
  EXPECT_EQ(percent(0), "< 0.1 %");
}

TEST(NoiseFigure, has_an_area_and_a_probability_for_each_place) {
  const std::string svg = ellipse().str(false);
  EXPECT_EQ(nesting_error(svg), "");
  ASSERT_EQ(ellipse().answer.placements.size(), 2U);
  EXPECT_EQ(paths_in(svg, "density").size(), 2U + 1U + 2U);  // on the outline, over s, and enlarged
  EXPECT_EQ(count_of(svg, "class=\"zoom\""), 2);
  EXPECT_THAT(svg, HasSubstr("50 %"));
  EXPECT_THAT(svg, Not(HasSubstr("touching")));
  EXPECT_THAT(svg, Not(HasSubstr("class=\"extent\"")));
  EXPECT_THAT(svg, Not(HasSubstr("class=\"world\"")));
  EXPECT_EQ(svg, ellipse().str(false));
}

TEST(NoiseFigure, has_bands_that_hold_95_percent) {
  const std::string svg = ellipse().str(false);
  const std::vector<Vec2> boundary = paths_in(svg, "boundary").at(0);
  double length = (boundary.front() - boundary.back()).norm();
  for (std::size_t k = 1; k < boundary.size(); ++k) length += (boundary[k] - boundary[k - 1]).norm();
  const double scale = length / ellipse().answer.part.perimeter();
  const std::vector<std::vector<Vec2>> bands = paths_in(svg, "interval");
  ASSERT_EQ(bands.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    double band = 0;
    for (std::size_t i = 1; i < bands[k].size(); ++i) band += (bands[k][i] - bands[k][i - 1]).norm();
    EXPECT_NEAR(band, scale * ellipse().answer.placements[k].interval[0].width(), 0.5);
  }
}

TEST(NoiseFigure, says_anywhere_of_a_circle) {
  const Solved circle = solved("circle", 1, 1.5, {0.01, 0.01});
  const std::string svg = circle.str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_NE(svg.find("anywhere"), std::string::npos);
  EXPECT_NE(svg.find("not known"), std::string::npos);
  EXPECT_EQ(svg.find("likeliest"), std::string::npos);
}

TEST(NoiseFigure, shows_the_world_where_the_log_tells_of_it) {
  const std::string svg = ellipse().str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_EQ(count_of(svg, "class=\"world\""), 1);
  EXPECT_EQ(count_of(svg, "class=\"other-pose\""), 1);
  EXPECT_EQ(count_of(svg, "class=\"pose-ellipse\""), 1);
  EXPECT_EQ(count_of(svg, "class=\"heading-fan\""), 1);
  Solved blind = ellipse();
  blind.log.fingers[0].x.clear();
  EXPECT_THAT(blind.str(), Not(HasSubstr("class=\"world\"")));
}

TEST(NoiseFigure, has_the_fingers_path_as_it_was) {
  const std::string svg = ellipse().str();
  const std::vector<Vec2> path = paths_in(svg, "finger-path").at(0);
  const rollfix::FingerRows& rows = ellipse().log.fingers[0];
  const Vec2 drawn = path.back() - path.front();
  const Vec2 was(rows.x.back() - rows.x.front(), rows.y.back() - rows.y.front());
  EXPECT_NEAR(std::atan2(-drawn.y(), drawn.x()), std::atan2(was.y(), was.x()), 0.01);
}

TEST(NoiseFigure, can_be_drawn_of_every_shape_in_the_gallery) {
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    const Part part = gallery_part(shape.name);
    const double P = part.perimeter();
    rollfix::Reading reading(0.2 * P, part.turning().angle(0.5 * P) - part.turning().angle(0.3 * P));
    const Answer answer = rollfix::solve({part, reading, {}, Noise{1e-3 * P, 0.02}});
    EXPECT_EQ(nesting_error(draw_answer(answer).str()), "") << shape.name;
  }
}

TEST(NoiseFigureOfTwo, has_an_ellipse_for_each_pair_and_enlarges_the_likeliest) {
  std::mt19937_64 generator = test_generator(6);
  const Part part = gallery_part("ellipse");
  const Noise noise{0.02, 0.03};
  const noisy_pairs::Case drawn = noisy_pairs::noisy_case(part, {1, 4}, 0.5, -0.8, 60, 0.2, 0.2, noise, generator);
  const Solved two{drawn.log, rollfix::solve({part, drawn.log, {rollfix::disk(0.2)}, noise})};
  const std::string svg = two.str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_GE(count_of(svg, "class=\"ellipse\""), 2) << "seed " << test_seed();
  EXPECT_EQ(count_of(svg, "class=\"pair-zoom\""), 2) << "seed " << test_seed();
  EXPECT_EQ(count_of(svg, "class=\"world\""), 1);
  EXPECT_EQ(count_of(svg, "class=\"last-pose\""), 1);
  EXPECT_EQ(svg, two.str());
}

TEST(OtherLoops, are_drawn_thin_in_the_parts_scale) {
  const Part part = gallery_part("circle");
  rollfix::PartFigure figure{&part, ""};
  figure.others = {rollfix::gallery("circle,r=0.5")};
  const std::string svg = draw_part(figure).str();
  const auto width = [](const std::vector<Vec2>& path) {
    double lo = 1e300, hi = -1e300;
    for (const Vec2& at : path) {
      lo = std::min(lo, at.x());
      hi = std::max(hi, at.x());
    }
    return hi - lo;
  };
  EXPECT_NEAR(width(paths_in(svg, "others").at(0)), 0.5 * width(paths_in(svg, "boundary").at(0)), 0.2);
}

TEST(DeadReckoned, comes_back_to_the_start_of_an_exact_roll_around) {
  const Part part = gallery_part("circle");
  rollfix::RollPlan plan;
  plan.distance = part.perimeter();
  plan.rows = 50;
  const Log log = noisy_roll(part, rollfix::DiskFinger{0.2}, plan, {}, 1).log;
  const auto rows = dead_reckoned(log, rollfix::disk(0.2));
  ASSERT_EQ(rows.size(), 50U);
  EXPECT_LT((rows.back().point - rows.front().point).norm(), 1e-9);
  for (const rollfix::ReckonedRow& row : rows) EXPECT_LT((row.point - part.point(row.s)).norm(), 1e-9);
  EXPECT_THROW(dead_reckoned(log, {}), rollfix::InputError);
}

TEST(TaughtFigure, shows_the_rows_the_gap_and_what_is_left_of_their_turns) {
  const Part part = gallery_part("circle");
  rollfix::PartFigure figure{&part, ""};
  for (int k = 0; k <= 40; ++k) {
    const double angle = 2 * std::numbers::pi * k / 40;
    figure.taught.rows.push_back(
        {angle, angle + std::numbers::pi / 2 + 0.01, Vec2(1.1 * std::cos(0.95 * angle), 1.1 * std::sin(0.95 * angle))});
  }
  figure.taught.lap = part.perimeter();
  figure.taught.gap = 0.34;
  figure.taught.closing = "kept open";
  const std::string svg = draw_part(figure).str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_EQ(paths_in(svg, "rows").size(), 1U);
  const std::vector<Vec2> gap = paths_in(svg, "gap").at(0), boundary = paths_in(svg, "boundary").at(0);
  Vec2 lo = boundary[0], hi = boundary[0];
  for (const Vec2& at : boundary) {
    lo = lo.cwiseMin(at);
    hi = hi.cwiseMax(at);
  }
  const double chord = 2 * 1.1 * std::sin(0.5 * 0.05 * 2 * std::numbers::pi);
  EXPECT_NEAR((gap.at(1) - gap.at(0)).norm(), chord * 0.5 * (hi - lo).x(), 0.5);
  EXPECT_THAT(svg, HasSubstr("gap 0.34: kept open"));
  EXPECT_EQ(count_of(svg, "class=\"row-turns\""), 1);
  figure.taught = {};
  EXPECT_THAT(draw_part(figure).str(), Not(HasSubstr("class=\"gap\"")));
}

}  // namespace
}  // namespace draw_noise_test
