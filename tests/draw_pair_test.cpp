// The figure of two fingers: both rolls on the part, and the square of all pairs beside it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw/answer/densities.hpp"
#include "draw_helpers.hpp"
#include "pair_cases.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"

namespace draw_pair_test {
namespace {

using draw_test::count_of;
using draw_test::Figure;
using draw_test::gallery_part;
using draw_test::nesting_error;
using draw_test::paths_in;
using rollfix::Part;
using rollfix::PerFinger;
using rollfix::Vec2;
using rollfix::draw::level_lines;
using rollfix::draw::Samples;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

Samples samples(double lo, double hi, int count, double (*value)(double)) {
  Samples samples;
  for (int i = 0; i <= count; ++i) {
    samples.at.push_back(lo + (hi - lo) * i / count);
    samples.value.push_back(value(samples.at.back()));
  }
  return samples;
}

TEST(LevelLines, of_a_circle_are_one_closed_line_round_it) {
  const auto lines = level_lines(samples(-1.5, 1.5, 100, [](double x) { return x * x; }),
                                 samples(-1.5, 1.5, 90, [](double y) { return -y * y; }), 1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].front(), lines[0].back());
  double turned = 0;
  for (std::size_t i = 0; i + 1 < lines[0].size(); ++i) {
    EXPECT_NEAR(lines[0][i].norm(), 1, 1e-3);
    turned += std::atan2(rollfix::cross(lines[0][i], lines[0][i + 1]), lines[0][i].dot(lines[0][i + 1]));
  }
  EXPECT_NEAR(std::abs(turned), 2 * std::numbers::pi, 1e-9);
}

TEST(LevelLines, end_at_the_edge) {
  const auto lines =
      level_lines(samples(0, 1, 40, [](double x) { return x; }), samples(0, 1, 50, [](double y) { return y; }), 0.25);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(std::abs(lines[0].front().x() - lines[0].back().x()), 0.75, 1e-12);
  for (const Vec2& point : lines[0]) EXPECT_NEAR(point.x() - point.y(), 0.25, 1e-12);
}

TEST(LevelLines, cross_where_the_function_has_a_saddle) {
  const auto square = [](double x) { return x * x; };
  for (const double level : {-1e-3, 0.0, 1e-3}) {
    const auto lines = level_lines(samples(-1, 1, 64, square), samples(-1, 1, 64, square), level);
    double length = 0;
    for (const auto& line : lines) {
      for (const Vec2& point : line) EXPECT_NEAR(std::abs(point.x()), std::abs(point.y()), 0.04);
      for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
    }
    EXPECT_NEAR(length, 4 * std::numbers::sqrt2, 0.1);
  }
}

/// A figure with crossings at these pairs; the readings are those of the first.
Figure figure_of(const Part& part, const std::vector<PerFinger<double>>& starts,
                 const std::vector<std::array<double, 2>>& shares = {{0.21, -0.12}, {0.31, 0.15}}) {
  Figure figure{{part}};
  const double P = part.perimeter();
  for (const auto& [a, b] : shares) {
    const PerFinger<double> from = starts.empty() ? PerFinger<double>(0.0, 0.0) : starts[0];
    figure.answer.readings.push_back(pair_cases::reading_from(part, from, a * P, b * P));
  }
  for (const PerFinger<double>& start : starts) {
    rollfix::Placement placement;
    placement.start = placement.end = placement.tangent = start;
    placement.extent = {rollfix::Interval{}, rollfix::Interval{}};
    placement.whole_loop = {false, false};
    placement.point = {Vec2(), Vec2()};
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const double share = shares.back()[finger];
      placement.end[finger] = part.boundary().on_first_lap(start[finger] + share * P);
      placement.extent[finger] = {start[finger], start[finger]};
      placement.point[finger] = part.point(start[finger]);
      placement.tangent[finger] = part.tangent(start[finger]);
    }
    placement.roots.push_back(start);
    figure.answer.placements.push_back(placement);
  }
  return figure;
}

/// The placements in the square of pairs, on the page: centre and radius.
std::vector<std::pair<Vec2, double>> dots_of(const std::string& svg) {
  const std::size_t from = svg.find("class=\"dots\"", svg.find("class=\"plane\"")), to = svg.find("</g>", from);
  std::vector<std::pair<Vec2, double>> dots;
  for (std::size_t at = from; (at = svg.find("<circle", at)) < to; ++at) {
    double x = 0, y = 0, r = 0;
    EXPECT_EQ(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\" r=\"%lf\"", &x, &y, &r), 3);
    dots.push_back({{x, y}, r});
  }
  return dots;
}

/// All lines of the k-th equation in the square.
std::vector<Vec2> equation(const std::string& svg, int k) {
  std::size_t at = svg.find("class=\"plane\"");
  for (int i = 0; i <= k; ++i) at = svg.find("class=\"equation\"", at + 1);
  const std::string group = "<g class=\"line\">";
  std::string lines = svg.substr(at, svg.find("</g>", at) - at);
  for (std::size_t path = 0; (path = lines.find("<path", path)) != std::string::npos; path += group.size() + 1) {
    lines.insert(path, group);
  }
  std::vector<Vec2> points;
  for (const auto& path : paths_in(lines, "line")) points.insert(points.end(), path.begin(), path.end());
  return points;
}

double distance(const std::vector<Vec2>& points, const Vec2& from) {
  double least = 1e300;
  for (const Vec2& point : points) least = std::min(least, (point - from).norm());
  return least;
}

int labels(const std::string& svg, const std::string& letter, int k) {
  const std::string text = "italic\">" + letter + "</tspan><tspan font-size=\"9.72\" dy=\"2.97\">" + std::to_string(k);
  return count_of(svg, text) / 2;  // a white rim and the letter
}

TEST(AnswerFigureOfTwo, shows_both_rolls_with_their_contacts_named) {
  const Part part = gallery_part("ellipse");
  const std::string svg = figure_of(part, {{1, 4}}).str();
  EXPECT_EQ(paths_in(svg, "arc").size(), 3U);  // b turns back: its roll has two runs
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(labels(svg, "s", k), 1) << k;
    EXPECT_EQ(labels(svg, "t", k), 1) << k;
  }
  EXPECT_EQ(labels(svg, "s", 3), 0);
}

TEST(AnswerFigureOfTwo, draws_each_equation_through_the_pairs_that_satisfy_it) {
  const Part part = gallery_part("limacon");
  const std::string svg = figure_of(part, {{2, 5}}).str();
  const Vec2 dot = dots_of(svg).at(0).first;
  EXPECT_LT(distance(equation(svg, 0), dot), 2);  // the lines' own vertices are about a pixel apart
  EXPECT_LT(distance(equation(svg, 1), dot), 2);
  Figure wrong = figure_of(part, {{2, 5}});
  wrong.answer.readings[1].turn += 0.5;
  EXPECT_GT(distance(equation(wrong.str(), 1), dot), 4);
}

TEST(AnswerFigureOfTwo, dashes_a_line_in_the_legend_as_in_the_square) {
  const Part part = gallery_part("limacon");
  const std::string svg = figure_of(part, {{2, 5}}).str();
  const std::size_t legend = svg.find("class=\"legend\"");
  EXPECT_EQ(count_of(svg.substr(legend, svg.find("</g>", legend) - legend), "stroke-dasharray"), 1);
}

TEST(AnswerFigureOfTwo, draws_the_facing_as_an_equation_of_its_own) {
  const Part part = gallery_part("limacon");
  Figure figure = figure_of(part, {{2, 5}}, {{0.2, 0.1}});
  figure.answer.facing = part.turning().angle(2) - part.turning().angle(5) + 6 * std::numbers::pi;
  const std::string svg = figure.str();
  EXPECT_LT(distance(equation(svg, 0), dots_of(svg).at(0).first), 2);
  EXPECT_THAT(svg, HasSubstr("facing"));
}

TEST(AnswerFigureOfTwo, has_s_to_the_right_and_t_upward) {
  const Part part = gallery_part("ellipse");
  const double P = part.perimeter();
  const auto dots = dots_of(figure_of(part, {{0, 0}, {P / 2, 0}, {0, P / 2}}).str());
  ASSERT_EQ(dots.size(), 3U);
  const auto origin = std::max_element(dots.begin(), dots.end(), [](auto& a, auto& b) { return a.second < b.second; });
  const double half = 0.5 * 0.4 * 960;
  EXPECT_NEAR(dots[0].first.x() - origin->first.x(), half, 0.1);
  EXPECT_NEAR(dots[1].first.y() - origin->first.y(), -half, 0.1);
}

TEST(AnswerFigureOfTwo, draws_a_stretch_as_a_line_that_goes_on_at_the_opposite_edge) {
  const Part part = gallery_part("ellipse");
  const double P = part.perimeter();
  Figure figure = figure_of(part, {{0.75 * P, 0.5 * P}});
  figure.answer.placements[0].kind = rollfix::Kind::stretch;
  figure.answer.placements[0].family = {{0.75 * P, 0.5 * P}, {1.25 * P, P}};
  const std::string svg = figure.str();
  const std::size_t from = svg.find("class=\"stretch\""), to = svg.find("</g>", from);
  EXPECT_GE(count_of(svg.substr(from, to - from), "<path"), 2);
  EXPECT_EQ(count_of(svg.substr(from, to - from), "<rect"), 0);
  figure.answer.placements[0].family_error = 0.1 * P;  // not a line at all: a patch of pairs
  figure.answer.placements[0].extent = {rollfix::Interval{0.2 * P, 0.4 * P}, rollfix::Interval{0.2 * P, 0.4 * P}};
  const std::string patch = figure.str();
  const std::size_t start = patch.find("class=\"stretch\"");
  EXPECT_EQ(count_of(patch.substr(start, patch.find("</g>", start) - start), "<rect"), 1);
}

TEST(AnswerFigureOfTwo, gives_other_placements_a_dot_for_each_finger_and_one_number_where_dots_meet) {
  const Part part = gallery_part("ellipse");
  const std::string svg = figure_of(part, {{1, 4}, {2, 5}, {2, 6}}).str();
  const std::size_t from = svg.find("class=\"starts\""), to = svg.find("</g>", from);
  EXPECT_EQ(count_of(svg.substr(from, to - from), "<circle"), 3);  // 1 and 2 share finger a's
  EXPECT_THAT(svg, HasSubstr(">1,2<"));
}

TEST(AnswerFigureOfTwo, draws_the_fingers_of_the_highlighted_placement) {
  const Part part = gallery_part("ellipse");
  Figure figure = figure_of(part, {{1, 4}, {2, 5}});
  EXPECT_THAT(figure.str(), Not(HasSubstr("class=\"finger\"")));
  figure.highlight = 1;
  figure.answer.fingers = {0.3, 0.2};
  EXPECT_EQ(count_of(figure.str(), "class=\"finger\""), 2);
  figure.answer.fingers[1] = rollfix::jaw();
  EXPECT_EQ(count_of(figure.str(), "class=\"finger\""), 1);
}

TEST(AnswerFigureOfTwo, drops_numbers_as_placements_grow_many) {
  const Part part = gallery_part("ellipse");
  std::vector<PerFinger<double>> starts;
  for (int i = 0; i < 3000; ++i) starts.push_back({0.003 * i, 0.002 * i});
  const std::string svg = figure_of(part, starts).str();
  EXPECT_EQ(dots_of(svg).size(), 3000U);
  EXPECT_THAT(svg, Not(HasSubstr(">2999<")));
  EXPECT_LT(svg.size(), 1000000U);
}

TEST(AnswerFigureOfTwo, can_be_drawn_of_every_shape_the_same_on_every_run) {
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    const Part part = gallery_part(shape.name);
    const double P = part.perimeter();
    const Figure figure = figure_of(part, {{0.3 * P, 0.4 * P}, {0.2 * P, 0.5 * P}});
    const std::string svg = figure.str();
    EXPECT_EQ(nesting_error(svg), "") << shape.name;
    EXPECT_EQ(svg, figure.str()) << shape.name;
  }
}

TEST(AnswerFigureOfTwo, of_nothing_that_fits_is_the_part_and_the_equations) {
  const Part part = gallery_part("ellipse");
  const std::string svg = figure_of(part, {}).str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_THAT(svg, HasSubstr("inconsistent"));
  EXPECT_EQ(count_of(svg, "class=\"equation\""), 2);
  EXPECT_TRUE(dots_of(svg).empty());
  EXPECT_EQ(count_of(svg, "finger a"), 1);  // beside the axis: none is drawn
}

TEST(AnswerFigureOfTwo, shows_where_the_search_is_unresolved) {
  const Part part = gallery_part("ellipse");
  Figure figure = figure_of(part, {{1, 4}});
  figure.answer.unresolved = {{rollfix::Interval{1, 2}, rollfix::Interval{3, 4}}};
  EXPECT_EQ(count_of(figure.str(), "class=\"unresolved\""), 1);
}

TEST(AnswerFigureOfTwo, refuses_what_does_not_fit_together) {
  const Part part = gallery_part("ellipse");
  EXPECT_THROW(rollfix::draw_answer(rollfix::AnswerFigure{}), rollfix::InputError);
  Figure figure = figure_of(part, {{1, 4}});
  figure.highlight = 1;
  EXPECT_THAT([&] { figure.str(); }, ThrowsMessage<rollfix::InputError>(HasSubstr("one of its 1 placements, found 1")));
}

}  // namespace
}  // namespace draw_pair_test
