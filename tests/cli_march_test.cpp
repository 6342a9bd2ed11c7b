// rollfix locate --march: the paper's algorithms answer.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli.hpp"
#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace cli_march_test {
namespace {

using cli::Json;

Json locate(const std::string& arguments, int code = 0) {
  const cli::Ran ran = cli::run("locate " + arguments + " --json");
  EXPECT_EQ(ran.code, code) << arguments << '\n' << ran.err;
  return ran.out.empty() ? Json() : ran.json();
}

/// The placements' starts, finger by finger.
std::vector<std::vector<double>> starts(const Json& answer) {
  std::vector<std::vector<double>> list;
  for (const Json& placement : answer.at("placements")) list.push_back(placement.at("start"));
  return list;
}

/// That each of `some` is one of `all` to 1e-7 P, and that they are as many.
void expect_same(const Json& some, const Json& all, const std::string& what) {
  const double perimeter = all.at("part").at("perimeter");
  const auto apart = [&](double one, double other) { return std::fabs(std::remainder(one - other, perimeter)); };
  const auto marched = starts(some);
  const auto found = starts(all);
  EXPECT_EQ(marched.size(), found.size()) << what;
  for (const auto& start : marched) {
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const auto& other) {
      return std::equal(start.begin(), start.end(), other.begin(),
                        [&](double one, double two) { return apart(one, two) <= 1e-7 * perimeter; });
    })) << what;
  }
}

double turn(const rollfix::Part& part, double s, double length) {
  return part.turning().angle(s + length) - part.turning().angle(s);
}

TEST(CliMarch, agrees_with_the_production_search_on_smooth_families_of_one_finger) {
  std::mt19937_64 generator = test_generator(1);
  std::uniform_real_distribution<double> share(0.05, 0.95);
  for (const char* name : {"gallery:ellipse", "gallery:limacon", "gallery:cam", "gallery:spline", "gallery:gear"}) {
    const rollfix::Part part(rollfix::load_outline(name));
    for (int i = 0; i < test_count(2); ++i) {
      const double length = share(generator) * part.perimeter();
      const std::string asked = fmt::format("{} --tolerance 1e-12 --reading {:.17g},{:.17g}", name, length,
                                            turn(part, share(generator) * part.perimeter(), length));
      expect_same(locate(asked + " --march"), locate(asked), asked);
    }
  }
}

TEST(CliMarch, agrees_with_the_production_search_on_smooth_families_of_two_fingers) {
  std::mt19937_64 generator = test_generator(2);
  std::uniform_real_distribution<double> share(0.05, 0.95);
  for (const char* name : {"gallery:cam", "gallery:spline"}) {
    const rollfix::Part part(rollfix::load_outline(name));
    const double s = share(generator) * part.perimeter();
    const double t = share(generator) * part.perimeter();
    std::string asked = fmt::format("{} --tolerance 1e-12", name);
    for (int k = 0; k < 2; ++k) {
      const double a = share(generator) * part.perimeter();
      const double b = share(generator) * part.perimeter();
      asked += fmt::format(" --reading {:.17g},{:.17g},{:.17g}", a, b, turn(part, s, a) - turn(part, t, b));
    }
    expect_same(locate(asked + " --march"), locate(asked), asked);
  }
}

TEST(CliMarch, counts_are_below_the_bounds_of_theorems_4_and_5) {
  const Json convex = locate("gallery:ellipse,a=2,b=1 --reading 1.5,73.2deg --march --step 0.01").at("counts");
  EXPECT_EQ(convex.at("steps_per_loop"), 629);  // 2 pi / 0.01, rounded up
  EXPECT_LE(convex.at("marching"), 2 * 629);
  EXPECT_LE(convex.at("start"), 629);
  EXPECT_EQ(convex.at("bisection"), 0);
  const Json wavy = locate("gallery:limacon --reading 1.5,40deg --march --step 0.01").at("counts");
  EXPECT_LE(wavy.at("steps"), 5 * 629);
}

TEST(CliMarch, the_document_says_by_which_method) {
  const Json answer = locate("gallery:ellipse,a=2,b=1 --reading 1.5,73.2deg --march");
  EXPECT_EQ(answer.at("schema"), "rollfix/locate/1");
  EXPECT_EQ(answer.at("method"), "march");
  EXPECT_EQ(answer.at("verdict"), "ambiguous (4)");
  for (const Json& placement : answer.at("placements")) {
    EXPECT_TRUE(placement.at("found") == "case 1" || placement.at("found") == "case 2");
    EXPECT_GT(placement.at("rate"), 0);
    EXPECT_LT(placement.at("rate"), 1);
  }
}

TEST(CliMarch, a_further_reading_leaves_what_fits_it_too) {
  const std::string two =
      "gallery:spline,n=9,seed=7,wobble=0.2 --reading 0.58,0.94,-0.725248 --reading 1.01,1.92,-1.99849 --march";
  EXPECT_EQ(locate(two).at("placements").size(), 16U);
  const Json third = locate(two + " --reading 1.25,2.37,-1.966238");
  EXPECT_EQ(third.at("placements").size(), 1U);
  EXPECT_EQ(third.at("dropped").at("further_reading"), 15);
}

TEST(CliMarch, what_the_paper_excludes_is_refused_with_the_reason) {
  const auto refused = [](const std::string& arguments, const std::string& reason) {
    const cli::Ran ran = cli::run("locate " + arguments + " --march");
    EXPECT_EQ(ran.code, 2) << arguments;
    EXPECT_EQ(ran.out, "");
    EXPECT_NE(ran.err.find(reason), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("leave --march out"), std::string::npos) << ran.err;
  };
  refused("gallery:naca --reading 0.5,1", "corner");
  refused("gallery:stadium --reading 1,1", "line");
  refused("gallery:circle --reading 1,1", "arc");
  refused("gallery:ellipse --reading 0,0", "every start fits");
  refused("gallery:cam --reading 1,2,0.5", "two readings");
}

TEST(CliMarch, nothing_that_fits_is_exit_code_1) {
  EXPECT_EQ(cli::run("locate gallery:ellipse --reading 1,3 --march").code, 1);
}

TEST(CliMarch, an_option_that_the_march_has_no_use_for_is_an_error) {
  for (const char* option : {"--noise angle=1deg", "--budget 5", "-o x.svg", "--explain --finger jaw"}) {
    EXPECT_EQ(cli::run(fmt::format("locate gallery:ellipse --reading 1.5,1 --march {}", option)).code, 2) << option;
  }
  EXPECT_EQ(cli::run("locate gallery:cam --reading 1.5,-0.8,1.9 --facing 1 --march").code, 2);
  EXPECT_EQ(cli::run("locate gallery:ellipse --reading 1.5,1 --step 0.1").code, 2);
  EXPECT_EQ(cli::run("locate gallery:ellipse --reading 1.5,1 --march --step 0").code, 2);
}

}  // namespace
}  // namespace cli_march_test
