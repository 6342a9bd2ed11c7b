// load_part: whatever a user may name as a part, and what is said of how it was taken.
#include "rollfix/files.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "cli.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace load_part_test {
namespace {

using cli::Folder;
using rollfix::InputError;
using rollfix::load_part;
using rollfix::LoadedPart;
using rollfix::LoadOptions;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

std::string message_of(const std::string& argument, const LoadOptions& options = {}) {
  try {
    load_part(argument, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string dxf(const std::string& entities) { return "0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n"; }

std::string line(double x0, double y0, double x1, double y1) {
  return fmt::format("0\nLINE\n8\n0\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", x0, y0, x1, y1);
}

std::string circle(double x, double y, double radius) {
  return fmt::format("0\nCIRCLE\n8\n0\n10\n{}\n20\n{}\n40\n{}\n", x, y, radius);
}

/// A 4 x 2 plate of four lines, the third of which ends `gap` early.
std::string plate(double gap = 0) {
  return line(0, 0, 4, 0) + line(4, 0, 4, 2) + line(4, 2, gap, 2) + line(0, 2, 0, 0);
}

constexpr const char* kSquareSvg = R"(<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0 H1 V1 H0 Z"/></svg>)";

TEST(LoadPart, takes_each_kind_of_file_by_its_ending) {
  const Folder folder;
  folder.write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
  folder.write("plate.dxf", dxf(plate()));
  folder.write("square.svg", kSquareSvg);
  folder.write("circle.json", R"({"gallery": "circle", "parameters": {"r": 2}})");
  folder.write("disk.json",
               R"({"curves": [{"type": "arc", "centre": [0, 0], "radius": 1, "from": 0, "sweep": "360deg"}]})");
  EXPECT_NEAR(load_part("square.csv", {}).part.perimeter(), 4, 1e-12);
  EXPECT_NEAR(load_part("plate.dxf", {}).part.perimeter(), 12, 1e-12);
  EXPECT_NEAR(load_part("square.svg", {}).part.perimeter(), 4, 1e-12);
  EXPECT_NEAR(load_part("circle.json", {}).part.perimeter(), 4 * kPi, 1e-11);
  EXPECT_NEAR(load_part("disk.json", {}).part.perimeter(), 2 * kPi, 1e-11);
  EXPECT_NEAR(load_part("gallery:circle,r=3", {}).part.perimeter(), 6 * kPi, 1e-11);
}

TEST(LoadPart, takes_a_saved_part) {
  const Folder folder;
  rollfix::save_part(load_part("gallery:naca", {}).part, "wing.json");
  const LoadedPart loaded = load_part("wing.json", {});
  EXPECT_EQ(loaded.part.perimeter(), load_part("gallery:naca", {}).part.perimeter());
  EXPECT_EQ(loaded.part.name(), "wing.json");
}

TEST(LoadPart, the_outer_loop_is_taken_and_the_choice_is_said) {
  const Folder folder;
  folder.write("plate.dxf", dxf(circle(1, 1, 0.5) + plate() + circle(3, 1, 0.25)));
  const LoadedPart loaded = load_part("plate.dxf", {});
  EXPECT_NEAR(loaded.part.perimeter(), 12, 1e-12);
  EXPECT_EQ(loaded.loop, 1U);
  ASSERT_EQ(loaded.loops.size(), 3U);
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("3 closed loops: took number 1, the largest loop")));
}

TEST(LoadPart, loop_takes_a_hole_as_a_hole) {
  const Folder folder;
  folder.write("plate.dxf", dxf(circle(1, 1, 0.5) + plate()));
  LoadOptions options;
  options.loop = 2;
  const LoadedPart loaded = load_part("plate.dxf", options);
  EXPECT_NEAR(loaded.part.perimeter(), kPi, 1e-11);
  EXPECT_EQ(loaded.part.turns(), -1);
  options.loop = 3;
  EXPECT_THAT(message_of("plate.dxf", options),
              HasSubstr("`loop` 3: plate.dxf has 2 loops: expected a number from 1 to 2"));
}

TEST(LoadPart, an_open_drawing_is_refused_with_the_gap_and_its_place) {
  const Folder folder;
  folder.write("plate.dxf", dxf(plate(0.01)));
  EXPECT_THAT(message_of("plate.dxf"),
              AllOf(HasSubstr("plate.dxf: expected a closed loop, found none"), HasSubstr("is open by 0.01 between"),
                    HasSubstr("(0.01, 2)"), HasSubstr("(0, 2)"), HasSubstr("`gap`")));
}

TEST(LoadPart, gap_closes_it_and_that_is_reported) {
  const Folder folder;
  folder.write("plate.dxf", dxf(plate(0.01)));
  LoadOptions options;
  options.gap = 0.02;
  const LoadedPart loaded = load_part("plate.dxf", options);
  EXPECT_NEAR(loaded.part.perimeter(), 11.99, 1e-12);
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("ends of curves up to 0.01 apart were taken to meet")));
}

TEST(LoadPart, open_takes_the_longest_chain) {
  const Folder folder;
  folder.write("plate.dxf", dxf(plate(0.01)));
  LoadOptions options;
  options.points.open = true;
  const LoadedPart loaded = load_part("plate.dxf", options);
  EXPECT_FALSE(loaded.part.closed());
  EXPECT_NEAR(loaded.part.perimeter(), 11.99, 1e-12);
}

TEST(LoadPart, smooth_takes_the_ends_of_lines_as_points) {
  const Folder folder;
  std::string polygon;
  const auto x = [](int k) { return std::cos(2 * kPi * k / 100); };
  const auto y = [](int k) { return std::sin(2 * kPi * k / 100); };
  for (int k = 0; k < 100; ++k) polygon += line(x(k), y(k), x(k + 1), y(k + 1));
  folder.write("round.dxf", dxf(polygon));
  LoadOptions options;
  options.points.smooth = 1e-3;
  const LoadedPart loaded = load_part("round.dxf", options);
  EXPECT_NEAR(loaded.part.perimeter(), 2 * kPi, 1e-3);
  EXPECT_THAT(loaded.part.corners(), IsEmpty());
  EXPECT_THAT(loaded.notes, Contains(HasSubstr("smoothed: within 0.001 of all 100 points")));
}

TEST(LoadPart, smooth_leaves_arcs_alone) {
  const Folder folder;
  folder.write("round.dxf", dxf(circle(0, 0, 1)));
  LoadOptions options;
  options.points.smooth = 1e-3;
  EXPECT_THAT(message_of("round.dxf", options), HasSubstr("this one has curves"));
}

TEST(LoadPart, options_that_do_not_apply_are_refused) {
  const Folder folder;
  folder.write("square.csv", "0,0\n1,0\n1,1\n0,1\n");
  folder.write("square.svg", kSquareSvg);
  LoadOptions loop;
  loop.loop = 1;
  LoadOptions layer;
  layer.layer = "cut";
  LoadOptions angle;
  angle.points.corner_angle = rollfix::kCornerAngle;  // given is given, the default as well
  EXPECT_THAT(message_of("square.csv", loop), HasSubstr("`loop` is for drawings, and square.csv is points"));
  EXPECT_THAT(message_of("gallery:cam", loop), HasSubstr("`loop` is for drawings, and gallery:cam is a gallery shape"));
  EXPECT_THAT(message_of("square.svg", layer), HasSubstr("`layer` is for DXF files"));
  EXPECT_THAT(message_of("square.svg", angle), HasSubstr("`corner_angle` is for points"));
  EXPECT_THAT(message_of("gallery:cam", angle), HasSubstr("`corner_angle` is for points"));
}

TEST(LoadPart, rounded_digits_of_a_drawing_are_no_gap) {
  const Folder folder;
  folder.write("plate.dxf", dxf(line(0, 0, 4, 0) + line(4.000001, 0, 4, 2) + line(4, 2, 0, 2) + line(0, 2, 0, 0)));
  const LoadedPart loaded = load_part("plate.dxf", {});
  EXPECT_NEAR(loaded.part.perimeter(), 12, 1e-5);
  EXPECT_THAT(loaded.notes, ElementsAre(HasSubstr("ends of curves up to 1e-06 apart")));
}

TEST(LoadPart, an_unknown_ending_lists_the_known) {
  EXPECT_THAT(message_of("part.step"),
              AllOf(HasSubstr("part.step: has the unknown ending '.step'"), HasSubstr("a drawing in .dxf or .svg")));
  EXPECT_THAT(message_of("ellipse,a=2"), HasSubstr("did you mean gallery:ellipse?"));
}

TEST(LoadPart, standard_input_is_known_by_how_it_begins) {
  const Folder folder;
  folder.write("plate.dxf", dxf(plate()));
  folder.write("square.svg", kSquareSvg);
  folder.write("shape.json", R"({"gallery": "circle"})");
  rollfix::save_part(load_part("gallery:cam", {}).part, "cam.json");
  EXPECT_THAT(cli::shell("rollfix inspect - < plate.dxf").out, HasSubstr("perimeter    12.0"));
  EXPECT_THAT(cli::shell("rollfix inspect - < square.svg").out, HasSubstr("perimeter    4.0"));
  EXPECT_THAT(cli::shell("rollfix inspect - < shape.json").out, HasSubstr("perimeter    6.28"));
  EXPECT_EQ(cli::shell("rollfix inspect - < cam.json").code, 0);
}

}  // namespace
}  // namespace load_part_test
