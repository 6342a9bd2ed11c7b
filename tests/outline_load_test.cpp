// load_outline: what a user may write where a part is asked for.
#include "rollfix/outline.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "rollfix/error.hpp"
#include "rollfix/part.hpp"
#include "text/text.hpp"

namespace outline_load_test {
namespace {

using rollfix::InputError;
using rollfix::load_outline;
using rollfix::nearest_name;
using rollfix::Outline;
using rollfix::OutlineOptions;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

std::string message_of(const std::string& argument) {
  try {
    load_outline(argument);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A folder of its own for every test.
class Load : public testing::Test {
 protected:
  Load() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("rollfix_load_") + test->name());
    std::filesystem::create_directories(folder_);
  }
  ~Load() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  const std::string kSquare = "0 0\n1 0\n1 1\n0 1\n";

 private:
  std::filesystem::path folder_;
};

TEST_F(Load, points_file_is_known_by_its_ending) {
  for (const char* name : {"part.csv", "part.dat", "part.txt", "PART.CSV", "two.parts.dat"}) {
    const Outline outline = load_outline(written(name, kSquare));
    EXPECT_EQ(outline.curves.size(), 4U) << name;
    EXPECT_EQ(outline.name, path(name));
    EXPECT_TRUE(outline.closed);
  }
}

TEST_F(Load, options_reach_the_spline) {
  OutlineOptions options;
  options.open = true;
  const Outline open = load_outline(written("part.csv", kSquare), options);
  EXPECT_FALSE(open.closed);
  EXPECT_EQ(open.curves.size(), 3U);

  options = {};
  options.corner_angle = 2;  // more than a right angle
  EXPECT_NE(load_outline(path("part.csv"), options).curves[0].jet(0.5).second, rollfix::Vec2(0, 0));
}

TEST_F(Load, gallery_shape_is_named_as_the_user_wrote_it) {
  const Outline outline = load_outline("gallery:ellipse, a=3");
  EXPECT_EQ(outline.name, "gallery:ellipse, a=3");
  EXPECT_EQ(outline.curves[0].front(), rollfix::Vec2(3, 0));
}

TEST_F(Load, dash_is_standard_input) {
  written("part.csv", kSquare);
  const int terminal = dup(STDIN_FILENO);
  const int file = open(path("part.csv").c_str(), O_RDONLY);
  dup2(file, STDIN_FILENO);
  std::clearerr(stdin);
  const Outline outline = load_outline("-");
  dup2(terminal, STDIN_FILENO);
  close(terminal);
  close(file);
  EXPECT_EQ(outline.curves.size(), 4U);
  EXPECT_EQ(outline.name, "-");
}

TEST_F(Load, missing_file_is_named) {
  EXPECT_EQ(message_of(path("gone.csv")), path("gone.csv") + ": there is no such file");
}

TEST_F(Load, directory_is_named) {
  std::filesystem::create_directories(path("folder.csv"));
  EXPECT_EQ(message_of(path("folder.csv")), path("folder.csv") + ": is a directory, expected a file");
}

TEST_F(Load, errors_in_a_file_carry_its_path) {
  EXPECT_THAT(message_of(written("part.csv", "0 0\n1 x\n")), testing::StartsWith(path("part.csv") + ":2: '1 x'"));
}

TEST_F(Load, unknown_ending_lists_the_known) {
  EXPECT_THAT(message_of("part.step"), AllOf(HasSubstr("part.step: has the unknown ending '.step'"),
                                             HasSubstr(".csv, .dat or .txt, or gallery:NAME")));
  EXPECT_THAT(message_of("folder.d/part"), HasSubstr("folder.d/part: has no ending"));
}

TEST_F(Load, gallery_name_without_gallery_is_recognised) {
  EXPECT_THAT(message_of("ellipse,a=2"), EndsWith("did you mean gallery:ellipse?"));
  EXPECT_THAT(message_of("limason"), EndsWith("did you mean gallery:limacon?"));
}

TEST_F(Load, drawings_are_of_another_library_and_it_says_how_to_call_that) {
  for (const std::string name : {"part.dxf", "part.SVG", "part.json"}) {
    EXPECT_THAT(message_of(name), AllOf(HasSubstr("rollfix::files"), HasSubstr("load_part(\"" + name + "\", {}).part"),
                                        HasSubstr("here expected points in .csv")));
  }
}

TEST_F(Load, part_is_its_outline) {
  const rollfix::Part part = rollfix::load_part(written("part.csv", kSquare));
  EXPECT_EQ(part.perimeter(), rollfix::Part(load_outline(path("part.csv"))).perimeter());
  EXPECT_EQ(part.name(), path("part.csv"));
  EXPECT_THROW(rollfix::load_part("part.dxf"), InputError);
}

TEST(NearestName, is_the_one_with_the_fewest_edits) {
  EXPECT_EQ(nearest_name("elipse", {"circle", "ellipse", "superellipse"}), "ellipse");
  EXPECT_EQ(nearest_name("cricle", {"circle", "ellipse"}), "circle");  // neighbours swapped: one edit
  EXPECT_EQ(nearest_name("gaer", {"gear", "cam"}), "gear");
  EXPECT_EQ(nearest_name("A", {"a", "b"}), "a");
}

TEST(NearestName, is_nothing_when_none_is_near) {
  EXPECT_EQ(nearest_name("hexagon", {"circle", "ellipse"}), "");
  EXPECT_EQ(nearest_name("", {"circle"}), "");
  EXPECT_EQ(nearest_name("circle", {}), "");
}

}  // namespace
}  // namespace outline_load_test
