// The figure of the parts that a roll fits: each has its panel, and what is in it is where and as strong as it should.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "draw/labels.hpp"
#include "draw_helpers.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"

namespace draw_identify_test {
namespace {

using draw_test::count_of;
using draw_test::Figure;
using draw_test::figure_with;
using draw_test::gallery_part;
using draw_test::nesting_error;
using draw_test::paths_in;
using rollfix::Answer;
using rollfix::draw_parts;
using rollfix::Part;
using rollfix::PartsFigure;
using rollfix::Vec2;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

/// A figure of these shapes with the answers that it shows.
struct Found {
  std::vector<Answer> answers;
  PartsFigure figure;

  std::string svg() const { return draw_parts(figure).str(); }
};

/// Each shape with so many placements.
Found found_on(const std::vector<std::string>& shapes, int places = 2, double fraction = 0.1) {
  Found found;
  for (const std::string& shape : shapes) {
    found.answers.push_back(figure_with(gallery_part(shape), places, fraction).answer);
    found.answers.back().verdict = {rollfix::Verdict::ambiguous, static_cast<std::size_t>(places)};
  }
  found.figure.verdict = "several parts";
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    found.figure.parts.push_back({shapes[k], std::nan(""), &found.answers[k]});
  }
  return found;
}

Found found_on(std::size_t circles) { return found_on(std::vector<std::string>(circles, "circle")); }

/// A roll felt with noise: of an ellipse, where there are two places for it, and of a limacon.
Found found_with_noise(double first) {
  Found found;
  for (const std::string name : {"ellipse", "limacon"}) {
    found.answers.push_back(
        solve(rollfix::Problem{gallery_part(name), {{0.9, 0.5}, {1.8, 1.93}}, {}, rollfix::Noise{0.02, 0.02}}));
  }
  found.figure.parts = {{"ellipse", first, &found.answers[0]}, {"limacon", 1 - first, &found.answers[1]}};
  return found;
}

/// Where a panel is on the page, and what it holds.
struct Panel {
  Vec2 corner;
  Vec2 size;
  std::string svg;

  Vec2 far_corner() const { return corner + size; }
};

std::vector<Panel> panels_in(const std::string& svg) {
  std::vector<Panel> panels;
  for (std::size_t at = 0; (at = svg.find("<svg x=", at)) != std::string::npos; ++at) {
    Panel panel;
    const char* format = "<svg x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\">";
    const int read =
        std::sscanf(svg.c_str() + at, format, &panel.corner.x(), &panel.corner.y(), &panel.size.x(), &panel.size.y());
    EXPECT_EQ(read, 4);
    panel.svg = svg.substr(at, svg.find("</svg>", at) - at);
    panels.push_back(panel);
  }
  return panels;
}

/// Centres of the filled dots, which are the starts; contacts are rings.
std::vector<Vec2> starts_in(const std::string& svg) {
  std::vector<Vec2> starts;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) {
    const std::string tag = svg.substr(at, svg.find('>', at) - at);
    if (tag.find("fill=\"#ffffff\"") != std::string::npos) continue;
    Vec2 centre;
    EXPECT_EQ(std::sscanf(tag.c_str(), "<circle cx=\"%lf\" cy=\"%lf\"", &centre.x(), &centre.y()), 2);
    starts.push_back(centre);
  }
  return starts;
}

std::vector<std::string> names_in(const std::string& svg) {
  std::vector<std::string> names;
  for (const Panel& panel : panels_in(svg)) {
    const std::size_t group = panel.svg.find("class=\"name\"");
    const std::size_t from = panel.svg.find("bold\">", group) + 6;
    names.push_back(panel.svg.substr(from, panel.svg.find('<', from) - from));
  }
  return names;
}

/// The box around a panel's drawn boundary.
std::pair<Vec2, Vec2> boundary_box(const Panel& panel) {
  const std::vector<Vec2> boundary = paths_in(panel.svg, "boundary").at(0);
  Vec2 lo = boundary[0], hi = boundary[0];
  for (const Vec2& point : boundary) {
    lo = lo.cwiseMin(point);
    hi = hi.cwiseMax(point);
  }
  return {lo, hi};
}

/// Pixels for each unit of the part's outline.
double scale_of(const Panel& panel, const Part& part) {
  const auto [lo, hi] = boundary_box(panel);
  double least = 1e300, most = -1e300;
  for (int k = 0; k <= 2000; ++k) {
    const double x = part.point(part.perimeter() * k / 2000).x();
    least = std::min(least, x);
    most = std::max(most, x);
  }
  return (hi - lo).x() / (most - least);
}

/// Widths of the bars of probability, of the second rectangle in each group.
std::vector<double> bars_in(const std::string& svg) {
  std::vector<double> widths;
  for (std::size_t at = 0; (at = svg.find("class=\"probability\"", at)) != std::string::npos; ++at) {
    const std::size_t second = svg.find("<rect", svg.find("<rect", at) + 1);
    double width = -1;
    EXPECT_EQ(std::sscanf(svg.c_str() + second, "<rect x=\"%*f\" y=\"%*f\" width=\"%lf\"", &width), 1);
    widths.push_back(width);
  }
  return widths;
}

bool apart(const Panel& a, const Panel& b) {
  return (a.far_corner().array() <= b.corner.array()).any() || (b.far_corner().array() <= a.corner.array()).any();
}

TEST(PartsFigure, names_each_part_in_its_own_panel) {
  const Found found = found_on({"cam", "gear", "ellipse", "naca"});
  EXPECT_THAT(names_in(found.svg()), ElementsAre("cam", "gear", "ellipse", "naca"));
}

TEST(PartsFigure, says_the_verdict_and_of_how_many) {
  Found found = found_on({"cam", "gear"});
  found.figure.of = 1802;
  EXPECT_THAT(found.svg(), testing::AllOf(HasSubstr("several parts"), HasSubstr("2 of 1802 parts fit")));
}

TEST(PartsFigure, marks_starts_where_they_are_on_the_outline) {
  const Found found = found_on({"circle", "circle"}, 5);
  for (const Panel& panel : panels_in(found.svg())) {
    const auto [lo, hi] = boundary_box(panel);
    const std::vector<Vec2> starts = starts_in(panel.svg);
    ASSERT_THAT(starts, SizeIs(5));
    for (std::size_t k = 0; k < 5; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / 5;
      const Vec2 expected = 0.5 * (lo + hi) + 0.5 * (hi - lo).x() * Vec2(std::cos(angle), -std::sin(angle));
      EXPECT_LT((starts[k] - expected).norm(), 0.1);
    }
  }
}

TEST(PartsFigure, draws_each_roll_beside_the_outline) {
  const Found found = found_on({"cam", "gear"}, 3);
  for (const Panel& panel : panels_in(found.svg())) EXPECT_THAT(paths_in(panel.svg, "arc"), SizeIs(3));
}

TEST(PartsFigure, draws_rolls_the_other_way_on_a_part_that_lies_face_down) {
  Found found = found_on({"circle"}, 1, 0.25);
  const auto rises = [&] {
    const std::vector<Vec2> arc = paths_in(found.svg(), "arc").at(0);
    return arc.back().y() < arc.front().y();  // the page's y points down
  };
  EXPECT_TRUE(rises());
  found.answers[0].mirrored = true;
  EXPECT_FALSE(rises());
}

TEST(PartsFigure, has_panels_that_keep_apart_and_on_the_page) {
  for (std::size_t count = 1; count <= 12; ++count) {
    const Found found = found_on(count);
    const rollfix::Svg page = draw_parts(found.figure);
    const std::vector<Panel> panels = panels_in(page.str());
    ASSERT_THAT(panels, SizeIs(count));
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_TRUE((panels[i].corner.array() >= 0).all());
      EXPECT_TRUE((panels[i].far_corner().array() <= Vec2(page.width(), page.height()).array()).all());
      for (std::size_t j = 0; j < i; ++j) EXPECT_TRUE(apart(panels[i], panels[j])) << i << " and " << j;
    }
  }
}

TEST(PartsFigure, keeps_each_drawing_within_its_panel) {
  for (const double width : {640.0, 960.0, 1500.0}) {
    Found found = found_on({"naca", "gear", "limacon", "reuleaux", "cam"}, 4, 0.7);
    found.figure.width = width;
    for (const Panel& panel : panels_in(found.svg())) {
      for (const std::vector<Vec2>& path : paths_in(panel.svg, "arc")) {
        for (const Vec2& point : path)
          EXPECT_TRUE((point.array() > 0).all() && (point.array() < panel.size.array()).all());
      }
    }
  }
}

TEST(PartsFigure, draws_parts_to_one_scale) {
  const Found found = found_on({"circle", "ellipse"});
  const std::string svg = found.svg();
  const std::vector<Panel> panels = panels_in(svg);
  EXPECT_NEAR(scale_of(panels[0], found.answers[0].part) / scale_of(panels[1], found.answers[1].part), 1, 0.002);
  EXPECT_EQ(count_of(svg, "class=\"scale-bar\""), 1);
  EXPECT_THAT(svg, HasSubstr("all parts to the same scale"));
}

TEST(PartsFigure, gives_each_part_its_own_scale_where_sizes_differ_much) {
  Found found = found_on({"naca", "log-spiral"});
  const std::string svg = found.svg();
  const std::vector<Panel> panels = panels_in(svg);
  EXPECT_GT(scale_of(panels[0], found.answers[0].part), 5 * scale_of(panels[1], found.answers[1].part));
  EXPECT_EQ(count_of(svg, "class=\"scale-bar\""), 2);
  EXPECT_THAT(svg, HasSubstr("each part to its own scale"));
}

TEST(PartsFigure, draws_twelve_and_counts_the_others) {
  const std::string svg = found_on(17).svg();
  EXPECT_THAT(panels_in(svg), SizeIs(12));
  EXPECT_THAT(svg, HasSubstr("... and 5 more"));
  EXPECT_THAT(found_on(12).svg(), Not(HasSubstr("more")));
}

TEST(PartsFigure, says_how_probable_those_are_that_are_not_drawn) {
  Found found = found_on(14);
  for (PartsFigure::Entry& entry : found.figure.parts) entry.probability = 0.06;
  found.figure.rest = 0.16;
  EXPECT_THAT(found.svg(), testing::AllOf(HasSubstr("... and 2 more, together 12 %"), HasSubstr("all others: 16 %")));
}

TEST(PartsFigure, shortens_long_names_in_the_middle) {
  Found found = found_on({"circle", "circle"});
  found.figure.parts[0].name = "begins" + std::string(300, 'x') + "ends";
  const std::string svg = found.svg(), name = names_in(svg)[0];
  EXPECT_THAT(name, testing::AllOf(testing::StartsWith("begins"), HasSubstr("x\u2026x"), testing::EndsWith("ends")));
  EXPECT_LT(rollfix::text_width({{name, false, true, false}}, 12), panels_in(svg)[0].size.x());
}

TEST(PartsFigure, keeps_a_long_name_clear_of_its_probability) {
  Found found = found_with_noise(0.75);
  found.figure.parts[0].name = std::string(300, 'x');
  const std::string svg = found.svg(), name = names_in(svg)[0];
  const double taken = rollfix::text_width({{name + "75 %", false, true, false}}, 12);
  EXPECT_LT(taken, panels_in(svg)[0].size.x() - 2 * rollfix::draw::kPageMargin);
}

TEST(PartsFigure, has_bars_as_long_as_parts_are_probable) {
  const std::string svg = found_with_noise(0.75).svg();
  const std::vector<double> bars = bars_in(svg);
  ASSERT_THAT(bars, SizeIs(2));
  EXPECT_NEAR(bars[0] / bars[1], 3, 0.001);
  EXPECT_THAT(svg, testing::AllOf(HasSubstr("75 %"), HasSubstr("25 %")));
}

TEST(PartsFigure, frames_the_likeliest) {
  const std::vector<Panel> panels = panels_in(found_with_noise(0.75).svg());
  EXPECT_THAT(panels[0].svg, HasSubstr("class=\"likeliest\""));
  EXPECT_THAT(panels[1].svg, Not(HasSubstr("class=\"likeliest\"")));
}

TEST(PartsFigure, frames_all_that_are_the_likeliest_alike) {
  EXPECT_EQ(count_of(found_with_noise(0.5).svg(), "class=\"likeliest\""), 2);
}

TEST(PartsFigure, frames_none_and_has_no_bars_without_noise) {
  const std::string svg = found_on({"cam", "gear"}).svg();
  EXPECT_THAT(svg, Not(HasSubstr("class=\"likeliest\"")));
  EXPECT_THAT(svg, Not(HasSubstr("class=\"probability\"")));
}

TEST(PartsFigure, draws_a_roll_as_strong_as_it_is_probable_beside_the_likeliest) {
  Found found = found_with_noise(0.75);
  ASSERT_THAT(found.answers[0].placements, SizeIs(2));
  const auto second_roll = [&](double first, double second) {
    found.answers[0].placements[0].probability = first;
    found.answers[0].placements[1].probability = second;
    const std::string svg = found.svg();
    const std::size_t arc = svg.find("class=\"arc\"", svg.find("class=\"arc\"") + 1);
    return std::stoi(svg.substr(svg.find("stroke=\"#", arc) + 13, 2), nullptr,
                     16);  // blue, of which its colour has none
  };
  EXPECT_EQ(second_roll(0.4, 0.4), 0);
  EXPECT_GT(second_roll(0.8, 0.4), 60);
  EXPECT_GT(second_roll(0.9, 0.01), second_roll(0.8, 0.4) + 60);
}

TEST(PartsFigure, says_which_parts_cannot_be_told_from_one) {
  Found found = found_on({"cam", "gear"});
  found.figure.parts[0].congruent = {"twin"};
  EXPECT_EQ(count_of(found.svg(), "can't be told from twin<"), 1);
}

TEST(PartsFigure, names_as_many_congruent_parts_as_fit) {
  Found found = found_on({"cam", "gear", "ellipse"});
  found.figure.parts[0].congruent.assign(40, "another-section");
  EXPECT_THAT(found.svg(), HasSubstr("another-section and 39 more<"));
}

TEST(PartsFigure, lists_a_few_places_and_counts_all) {
  EXPECT_THAT(found_on({"cam"}, 3).svg(), testing::AllOf(HasSubstr("3 places<"), HasSubstr("class=\"legend\"")));
  EXPECT_THAT(found_on({"cam"}, 6).svg(), HasSubstr("6 places, 4 listed<"));
  EXPECT_THAT(found_on({"cam"}, 20).svg(), testing::AllOf(HasSubstr("20 places<"), Not(HasSubstr("class=\"legend\""))));
}

TEST(PartsFigure, leaves_out_what_a_list_has_no_room_for) {
  Found found = found_with_noise(0.75);
  for (rollfix::Placement& placement : found.answers[0].placements) {
    placement.kind = rollfix::Kind::corner;
    placement.sd = placement.end_sd = 1e-9;
  }
  found.figure.width = 640;
  EXPECT_THAT(found.svg(), testing::AllOf(HasSubstr("class=\"legend\""), Not(HasSubstr(", corner"))));
  found.figure.width = 1500;
  EXPECT_THAT(found.svg(), HasSubstr(", corner"));
}

TEST(PartsFigure, has_ticks_where_there_are_too_many_rolls) {
  const std::string svg = found_on({"cam"}, 60).svg();
  EXPECT_THAT(paths_in(svg, "arc"), SizeIs(0));
  EXPECT_THAT(paths_in(svg, "starts").at(0), SizeIs(120));
  EXPECT_THAT(svg, HasSubstr("tick: a start"));
}

TEST(PartsFigure, can_be_of_no_part) {
  PartsFigure figure;
  figure.verdict = "none";
  figure.of = 9;
  const std::string svg = draw_parts(figure).str();
  EXPECT_EQ(nesting_error(svg), "");
  EXPECT_THAT(svg,
              testing::AllOf(HasSubstr("none"), HasSubstr("0 of 9 parts fit"), HasSubstr("The roll fits no part")));
}

TEST(PartsFigure, is_well_formed_whatever_a_part_is_called) {
  Found found = found_on({"gear", "log-spiral", "naca"});
  found.figure.parts[1].name = "<b> & \"c\"";
  found.figure.parts[1].congruent = {"<d>"};
  EXPECT_EQ(nesting_error(found.svg()), "");
}

TEST(PartsFigure, is_the_same_on_every_run) {
  const Found found = found_with_noise(0.75);
  EXPECT_EQ(found.svg(), found.svg());
}

TEST(PartsFigure, draws_the_rolls_of_two_fingers) {
  constexpr double kDegree = std::numbers::pi / 180;
  Found found;
  found.answers.push_back(solve(rollfix::Problem{
      gallery_part("cam"), {{0.7446832, -0.3983439, 57.48184 * kDegree}, {1.5, -0.8, 110.97 * kDegree}}, {}}));
  found.figure.parts = {{"cam", std::nan(""), &found.answers[0]}};
  ASSERT_THAT(found.answers[0].placements, Not(SizeIs(0)));
  EXPECT_THAT(paths_in(found.svg(), "arc"), SizeIs(2));
  EXPECT_THAT(found.svg(), HasSubstr("blue: finger a, orange: finger b"));
}

TEST(PartsFigure, refuses_a_part_without_an_answer) {
  PartsFigure figure;
  figure.parts.push_back({"cam"});
  EXPECT_THAT([&] { draw_parts(figure); },
              testing::ThrowsMessage<rollfix::InputError>(HasSubstr("`cam` has no answer")));
}

TEST(PartsFigure, refuses_a_page_that_is_too_narrow) {
  Found found = found_on({"cam"});
  found.figure.width = 100;
  EXPECT_THROW(found.svg(), rollfix::InputError);
}

}  // namespace
}  // namespace draw_identify_test
