// The two figures: what has to be in them, where, and how they behave as there is more to show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "draw_helpers.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"

namespace draw_figure_test {
namespace {

using draw_test::count_of;
using draw_test::Figure;
using draw_test::figure_with;
using draw_test::found_at;
using draw_test::gallery_part;
using draw_test::nesting_error;
using draw_test::paths_in;
using rollfix::draw_part;
using rollfix::Part;
using rollfix::Vec2;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// How many labels read like a_3 (drawn twice each: a white rim and the letter).
int labels(const std::string& svg, const std::string& letter, const std::string& number) {
  const std::string text =
      "italic\">" + letter + "</tspan><tspan font-size=\"9.36\" dy=\"2.86\">" + number + "</tspan>";
  return count_of(svg, text) / 2;
}

/// Centre and radius of the circle that a drawn boundary is.
std::pair<Vec2, double> drawn_circle(const std::string& svg) {
  const std::vector<Vec2> boundary = paths_in(svg, "boundary").at(0);
  Vec2 lo = boundary[0], hi = boundary[0];
  for (const Vec2& point : boundary) {
    lo = lo.cwiseMin(point);
    hi = hi.cwiseMax(point);
  }
  return {0.5 * (lo + hi), 0.5 * (hi - lo).x()};
}

TEST(AnswerFigure, has_one_arc_and_both_labels_for_each_placement) {
  const Part part = gallery_part("ellipse");
  const std::string svg = figure_with(part, 6, 0.2).str();
  EXPECT_EQ(paths_in(svg, "arc").size(), 6U);
  for (const std::string number : {"0", "1", "2", "3", "4", "5"}) {
    EXPECT_EQ(labels(svg, "a", number), 1);
    EXPECT_EQ(labels(svg, "b", number), 1);
  }
  EXPECT_EQ(labels(svg, "a", "6"), 0);
  EXPECT_THAT(svg, HasSubstr("class=\"legend\""));
  EXPECT_THAT(svg, HasSubstr("class=\"scale-bar\""));
}

TEST(AnswerFigure, is_well_formed_and_the_same_on_every_run) {
  for (const std::string name : {"ellipse", "gear", "naca", "reuleaux", "log-spiral"}) {
    const Part part = gallery_part(name);
    const std::string svg = figure_with(part, 5, 0.13).str();
    EXPECT_EQ(nesting_error(svg), "") << name;
    EXPECT_EQ(svg, figure_with(part, 5, 0.13).str()) << name;
  }
}

TEST(AnswerFigure, has_y_pointing_up) {
  const Part part = gallery_part("circle");
  Figure figure = figure_with(part, 1, 0.25);  // from (1, 0) over a quarter to (0, 1)
  const std::string svg = figure.str();
  const auto [centre, radius] = drawn_circle(svg);
  const std::vector<Vec2> arc = paths_in(svg, "arc").at(0);
  EXPECT_NEAR(arc.front().y(), centre.y(), 0.5);
  EXPECT_GT(arc.front().x(), centre.x() + radius);
  EXPECT_LT(arc.back().y(), centre.y() - radius);
}

TEST(AnswerFigure, stacks_overlapping_arcs_outward) {
  const Part part = gallery_part("circle");
  const std::string svg = figure_with(part, 3, 0.9).str();
  const auto [centre, radius] = drawn_circle(svg);
  double last = radius;
  for (const std::vector<Vec2>& arc : paths_in(svg, "arc")) {
    const double size = (arc.front() - centre).norm();
    EXPECT_GT(size, last + 4);
    for (const Vec2& point : arc) EXPECT_NEAR((point - centre).norm(), size, 0.2);
    last = size;
  }
}

TEST(AnswerFigure, winds_an_arc_that_goes_round_more_than_once) {
  const Part part = gallery_part("circle");
  const std::string svg = figure_with(part, 1, 2.5).str();
  const auto [centre, radius] = drawn_circle(svg);
  const std::vector<Vec2> arc = paths_in(svg, "arc").at(0);
  double turned = 0;
  for (std::size_t i = 0; i + 1 < arc.size(); ++i) {
    const Vec2 from = arc[i] - centre, to = arc[i + 1] - centre;
    turned -= std::atan2(rollfix::cross(from, to), from.dot(to));  // y points down here
    EXPECT_GE(to.norm(), from.norm() - 0.1);
  }
  EXPECT_NEAR(turned, 5 * std::numbers::pi, 0.05);
  EXPECT_GT((arc.back() - centre).norm(), (arc.front() - centre).norm() + 10);
}

TEST(AnswerFigure, names_the_contact_of_a_second_reading_c) {
  const Part part = gallery_part("ellipse");
  Figure figure = figure_with(part, 2, 0.1);
  figure.answer.readings.push_back({0.2 * part.perimeter(), 1.5});
  const std::string svg = figure.str();
  EXPECT_EQ(labels(svg, "a", "1") + labels(svg, "b", "1") + labels(svg, "c", "1"), 3);
}

TEST(AnswerFigure, shows_a_stretch_as_a_band_over_its_extent) {
  const Part part = gallery_part("circle");
  Figure figure = figure_with(part, 1, 0.1);
  figure.answer.placements[0].kind = rollfix::Kind::stretch;
  figure.answer.placements[0].extent = rollfix::Interval{0, part.perimeter() / 4};
  const std::string svg = figure.str();
  const std::vector<std::vector<Vec2>> bands = paths_in(svg, "extent");
  ASSERT_EQ(bands.size(), 1U);
  const auto [centre, radius] = drawn_circle(svg);
  EXPECT_LT((bands[0].front() - centre - Vec2(radius, 0)).norm(), 0.5);
  EXPECT_LT((bands[0].back() - centre - Vec2(0, -radius)).norm(), 0.5);
}

TEST(AnswerFigure, shows_where_the_search_is_unresolved) {
  const Part part = gallery_part("ellipse");
  Figure figure = figure_with(part, 1, 0.1);
  figure.answer.unresolved = {rollfix::Interval{1, 2}};
  EXPECT_EQ(paths_in(figure.str(), "unresolved").size(), 1U);
}

TEST(AnswerFigure, draws_the_finger_at_both_ends_of_the_highlighted_placement) {
  const Part part = gallery_part("circle");
  Figure figure = figure_with(part, 6, 0.1);
  figure.answer.fingers = {0.25};
  EXPECT_THAT(figure.str(), Not(HasSubstr("class=\"finger\"")));
  figure.highlight = 2;
  const std::string svg = figure.str();
  EXPECT_EQ(count_of(svg, "class=\"finger\""), 1);
  // The disk touches the circle from outside: the distance between their centres is the sum of their radii.
  const auto [centre, radius] = drawn_circle(svg);
  const std::size_t at = svg.find("<circle", svg.find("class=\"finger\""));
  double x = 0, y = 0, r = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + at, "<circle cx=\"%lf\" cy=\"%lf\" r=\"%lf\"", &x, &y, &r), 3);
  EXPECT_NEAR(r, 0.25 * radius, 0.1);
  EXPECT_NEAR((Vec2(x, y) - centre).norm(), 1.25 * radius, 0.2);
}

TEST(AnswerFigure, drops_labels_and_then_arcs_as_placements_grow_many) {
  const Part part = gallery_part("ellipse");
  const std::string twenty = figure_with(part, 20, 0.05).str();
  EXPECT_EQ(labels(twenty, "b", "19"), 1);
  EXPECT_THAT(twenty, Not(HasSubstr("class=\"legend\"")));
  const std::string more = figure_with(part, 24, 0.05).str();
  EXPECT_EQ(labels(more, "a", "0"), 0);
  EXPECT_EQ(paths_in(more, "arc").size(), 24U);
  EXPECT_THAT(more, HasSubstr("ambiguous (24)"));
  EXPECT_THAT(more, HasSubstr("24 placements: no labels, no list"));
  const std::string crowd = figure_with(part, 5000, 0.4).str();
  EXPECT_EQ(paths_in(crowd, "arc").size(), 0U);
  EXPECT_EQ(paths_in(crowd, "starts").at(0).size(), 10000U);
  EXPECT_LT(crowd.size(), 500000U);
  EXPECT_THAT(crowd, HasSubstr("5000 placements: no rolls, no labels, no list"));
}

TEST(AnswerFigure, draws_a_part_alone_when_nothing_fits) {
  const Part part = gallery_part("ellipse");
  const std::string svg = figure_with(part, 0, 0.1).str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_THAT(svg, HasSubstr("inconsistent"));
}

TEST(AnswerFigure, refuses_what_does_not_fit_together) {
  const Part part = gallery_part("ellipse");
  EXPECT_THROW(rollfix::draw_answer(rollfix::AnswerFigure{}), rollfix::InputError);
  Figure figure = figure_with(part, 3, 0.1);
  figure.highlight = 3;
  EXPECT_THAT([&] { figure.str(); }, ThrowsMessage<rollfix::InputError>(HasSubstr("one of its 3 placements, found 3")));
  figure.highlight.reset();
  figure.numbers = {1};
  EXPECT_THROW(figure.str(), rollfix::InputError);
}

TEST(SideBySide, shows_one_part_at_one_scale_and_keeps_a_placements_number) {
  const Part part = gallery_part("circle");
  Figure first = figure_with(part, 6, 0.4), second = figure_with(part, 1, 0.4);
  second.answer.placements = found_at(part, {first.answer.placements[4].start[0] + 1e-9}, 0.4 * part.perimeter());
  second.numbers = numbers_of(second.answer, first.answer);
  EXPECT_THAT(second.numbers, testing::ElementsAre(4));
  const rollfix::Svg row = rollfix::side_by_side({first.figure(), second.figure()});
  EXPECT_EQ(row.width(), 2 * 640);
  const std::string svg = row.str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_EQ(labels(svg, "a", "4"), 2);
  EXPECT_EQ(labels(svg, "a", "0"), 1);
  const std::size_t right = svg.find("<svg x=\"640\"");
  ASSERT_NE(right, std::string::npos);
  EXPECT_NEAR(drawn_circle(svg.substr(0, right)).second, drawn_circle(svg.substr(right)).second, 0.02);
}

TEST(NumbersOf, count_across_the_seam) {
  const Part part = gallery_part("circle");
  const double P = part.perimeter();
  rollfix::Answer later{part};
  later.placements = found_at(part, {P - 1e-9, 3}, 1);
  rollfix::Answer earlier{part};
  earlier.placements = found_at(part, {0, 1, 3}, 1);
  EXPECT_THAT(numbers_of(later, earlier), testing::ElementsAre(0, 2));
}

TEST(PartFigure, marks_every_event_once_in_the_shape_and_counts_them) {
  const Part part = gallery_part("limacon");
  ASSERT_GT(part.inflections().size() + part.vertices().size(), 0U);
  const std::string svg = draw_part({&part, "", 640}).str();
  EXPECT_EQ(nesting_error(svg), "");
  const std::size_t from = svg.find("class=\"events\""), to = svg.find("</g>", from);
  EXPECT_EQ(count_of(svg.substr(from, to - from), "<path"),
            static_cast<int>(part.inflections().size() + part.vertices().size()));
  EXPECT_THAT(svg, HasSubstr(std::to_string(part.vertices().size()) + " vert"));
  EXPECT_EQ(svg, draw_part({&part, "", 640}).str());
}

TEST(PartFigure, plots_the_turning_function_of_a_circle_as_a_straight_line) {
  const Part part = gallery_part("circle");
  const std::string svg = draw_part({&part, "", 640}).str();
  const std::size_t plot = svg.find("class=\"turning\"");
  const std::size_t graph = svg.find("stroke=\"#1f3b57\"", plot);
  const std::size_t path = svg.rfind("d=\"", graph);
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + path, "d=\"M%lf %lfL%lf %lf\"", &x0, &y0, &x1, &y1), 4);
  EXPECT_GT(x1 - x0, 500);  // the whole axis in one piece
  EXPECT_LT(y1, y0 - 80);   // growing upward
}

TEST(PartFigure, says_that_it_cut_a_peak_and_only_then) {
  const Part wing = gallery_part("naca"), ellipse = gallery_part("ellipse");
  EXPECT_THAT(draw_part({&wing, "", 640}).str(), HasSubstr("peaks cut"));
  EXPECT_THAT(draw_part({&ellipse, "", 640}).str(), Not(HasSubstr("peaks cut")));
}

TEST(PartFigure, can_be_drawn_of_every_shape_in_the_gallery) {
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    const Part part = gallery_part(shape.name);
    EXPECT_EQ(nesting_error(draw_part({&part, "", 640}).str()), "") << shape.name;
    EXPECT_EQ(nesting_error(figure_with(part, 3, 0.07).str()), "") << shape.name;
  }
}

TEST(PartFigure, needs_a_part) { EXPECT_THROW(draw_part({}), rollfix::InputError); }

}  // namespace
}  // namespace draw_figure_test
