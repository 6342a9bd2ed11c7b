// A saved part answers as before, to the bit, or is refused.
#include "rollfix/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

#include "files/part_record.hpp"
#include "paths.hpp"
#include "random.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "shapes.hpp"

namespace saved_part_test {
namespace {

using rollfix::InputError;
using rollfix::Part;
using rollfix::Vec2;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kPi = shapes::kPi;

Part again(const Part& part) { return rollfix::parse_part(rollfix::format_part(part), part.name()); }

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Every number that a search or a figure asks of a part, at random places.
void expect_same_bits(const Part& one, const Part& other) {
  EXPECT_TRUE(same_bits(one.perimeter(), other.perimeter()));
  EXPECT_EQ(one.inflections(), other.inflections());
  EXPECT_EQ(one.vertices(), other.vertices());
  ASSERT_EQ(one.corners().size(), other.corners().size());
  EXPECT_EQ(one.turning().spirals().size(), other.turning().spirals().size());
  EXPECT_EQ(one.reversed(), other.reversed());
  EXPECT_EQ(one.turns(), other.turns());
  std::mt19937_64 generator = test_generator();
  std::uniform_real_distribution<double> place(0, one.perimeter());
  for (int k = 0; k < test_count(200); ++k) {
    const double s = place(generator);
    EXPECT_TRUE(same_bits(one.turning().angle(s), other.turning().angle(s)));
    EXPECT_TRUE(same_bits(one.turning().curvature(s), other.turning().curvature(s)));
    EXPECT_EQ(one.point(s), other.point(s));
  }
  const rollfix::Reading reading = shapes::reading_from(one, place(generator), 0.2 * one.perimeter());
  const rollfix::Search before = rollfix::locate(one, reading);
  const rollfix::Search after = rollfix::locate(other, reading);
  EXPECT_EQ(shapes::starts(before), shapes::starts(after));
  EXPECT_EQ(before.counts.evaluations, after.counts.evaluations);
}

std::string message_of(const std::string& text) {
  try {
    rollfix::parse_part(text, "part.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::vector<std::string> gallery_names() {
  std::vector<std::string> names;
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) names.push_back(shape.name);
  return names;
}

class SavedPart : public testing::TestWithParam<std::string> {};

TEST_P(SavedPart, of_the_gallery_answers_with_the_same_bits) {
  const Part part(rollfix::gallery(GetParam()));
  expect_same_bits(part, again(part));
}

INSTANTIATE_TEST_SUITE_P(Gallery, SavedPart, testing::ValuesIn(gallery_names()), shapes::as_identifier);

TEST(SavedParts, of_every_kind_of_curve_answer_with_the_same_bits) {
  rollfix::Outline outline{"all.dxf", {}, true};
  outline.curves = {rollfix::Line({0, 0}, {4, 0}), rollfix::Arc({4, 1}, 1, -kPi / 2, kPi),
                    rollfix::EllipticArc({4, 3}, {2, 0}, {0, 1}, -kPi / 2, -kPi),
                    rollfix::Bezier({{4, 4}, {2, 5}, {1, 3}, {0, 4}}),
                    rollfix::Bezier({{0, 4}, {-1, 2}, {0, 0}}, {1, 2, 1})};
  expect_same_bits(Part(outline), again(Part(outline)));
}

TEST(SavedParts, of_clockwise_points_answer_with_the_same_bits) {
  const Part part(rollfix::outline_through({{0, 0}, {0, 1}, {1.3, 1.2}, {2, 0.1}}, "points.csv"));
  ASSERT_TRUE(part.reversed());
  expect_same_bits(part, again(part));
}

TEST(SavedParts, of_open_curves_answer_with_the_same_bits) {
  rollfix::OutlineOptions options;
  options.open = true;
  const Part part(rollfix::outline_through({{0, 0}, {1, 1}, {2, 0.3}, {3, 1}}, "points.csv", options));
  expect_same_bits(part, again(part));
}

TEST(SavedParts, keep_how_accurate_they_are) {
  rollfix::Outline outline = rollfix::gallery("cam");
  outline.accuracy = {0.002, 0.1 / 3, 0.7, 1e-5};
  const rollfix::Accuracy read = again(Part(outline)).outline().accuracy;
  EXPECT_TRUE(same_bits(read.length, outline.accuracy.length) && same_bits(read.turn, outline.accuracy.turn) &&
              same_bits(read.alike, outline.accuracy.alike) && same_bits(read.walk, outline.accuracy.walk));
}

/// Inches to millimetres: a length grows by the factor, radians per root of a length become less.
TEST(SavedParts, are_as_accurate_in_another_unit) {
  rollfix::Outline outline = rollfix::gallery("cam");
  outline.accuracy = {0.002, 0.03, 0.7, 1e-5};
  const rollfix::Accuracy metric = scaled(outline, 25.4, "mm").accuracy;
  EXPECT_EQ(metric.length, 0.002);
  EXPECT_EQ(metric.turn, 0.03);
  EXPECT_DOUBLE_EQ(metric.alike, 0.7 * 25.4);
  EXPECT_DOUBLE_EQ(std::pow(metric.walk, 2) * 25.4, 1e-10);
}

TEST(SavedParts, of_drawings_are_exact) {
  const Part part(rollfix::gallery("cam"));
  EXPECT_EQ(rollfix::format_part(part).find("accuracy"), std::string::npos);  // as files were before parts had one
  EXPECT_TRUE(again(part).outline().accuracy.is_exact());
}

TEST(SavedParts, are_the_same_text_when_saved_again) {
  const Part part(rollfix::gallery("naca"));
  rollfix::Part loaded = rollfix::parse_part(rollfix::format_part(part), part.name());
  EXPECT_EQ(rollfix::format_part(loaded), rollfix::format_part(part));
}

TEST(SavedParts, of_a_curve_type_without_a_record_are_refused) {
  struct Parabola {
    rollfix::Interval domain() const { return {0, 1}; }
    rollfix::Jet jet(double u) const { return {{u, u * u}, {1, 2 * u}, {0, 2}, {0, 0}}; }
  };
  EXPECT_THROW(rollfix::format_part(Part(rollfix::Outline{"own", {Parabola{}}, false})), InputError);
}

TEST(SavedParts, changed_in_any_byte_are_refused) {
  const std::string text = rollfix::format_part(Part(rollfix::gallery("stadium")));
  std::mt19937_64 generator = test_generator();
  for (int k = 0; k < test_count(2000); ++k) {
    std::string damaged = text;
    damaged[generator() % damaged.size()] ^= static_cast<char>(1 + generator() % 255);
    EXPECT_NE(message_of(damaged), "no error");
  }
}

TEST(SavedParts, cut_short_anywhere_are_refused) {
  const std::string text = rollfix::format_part(Part(rollfix::gallery("ellipse")));
  for (std::size_t size = 0; size < text.size(); size += 7) EXPECT_NE(message_of(text.substr(0, size)), "no error");
}

TEST(SavedParts, of_another_version_are_refused_by_name) {
  std::string text = rollfix::format_part(Part(rollfix::gallery("ellipse")));
  text.replace(text.find("part/2"), 6, "part/9");
  EXPECT_THAT(message_of(text),
              AllOf(HasSubstr("part.json: is a saved part of version 'rollfix/part/9'"), HasSubstr("make it again")));
}

/// Of a triangle, as version 1 wrote it.
std::string of_version_1() {
  std::ifstream file(checked_out("tests/saved_part_version_1.json"));
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(SavedParts, of_version_1_are_read_and_computed_anew) {
  const Part triangle(shapes::polygon({{0, 0}, {3, 0}, {0, 2}}));
  expect_same_bits(triangle, rollfix::parse_part(of_version_1(), triangle.name()));
}

TEST(SavedParts, hold_nothing_behind_their_outline) {
  std::string text = of_version_1();
  text.replace(text.find("part/1"), 6, "part/2");
  const std::size_t end = text.find("\",\n\"checksum\"");
  text =
      text.substr(0, end) + fmt::format("\",\n\"checksum\": \"{:016x}\"}}\n", rollfix::checksum(text.substr(0, end)));
  EXPECT_THAT(message_of(text), HasSubstr("contents contradict each other"));
}

TEST(SavedParts, foreign_json_is_not_taken_for_one) {
  EXPECT_FALSE(rollfix::is_saved_part(R"({"gallery": "ellipse"})"));
  EXPECT_FALSE(rollfix::is_saved_part(R"({"note": "rollfix/part/1"})"));
}

}  // namespace
}  // namespace saved_part_test
