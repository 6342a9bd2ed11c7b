// Readings as people type them: signs, degrees, digits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cli.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace cli_reading_test {
namespace {

using cli::Json;
using cli::run;

Json located(const std::string& arguments) { return run("locate " + arguments + " --json").json(); }

double tolerance_of(const std::string& arguments) { return located(arguments)["tolerance"].get<double>(); }

/// As a person would write it: rounded, and often without its last zeros.
std::string written(double value, int decimals, bool trim) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  while (trim && text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

bool covers(const Json& placements, double s, double period) {
  for (const Json& placement : placements) {
    const double lo = placement["extent"][0][0];
    const double hi = placement["extent"][0][1];
    const double slack = 1e-9 * period;
    for (const double shift : {-period, 0.0, period}) {
      if (s + shift >= lo - slack && s + shift <= hi + slack) return true;
    }
  }
  return false;
}

}  // namespace

TEST(CliReading, a_negative_length_needs_no_equals_sign) {
  const Json found = located("gallery:ellipse --reading -0.5,-1.25");
  EXPECT_EQ(found["readings"][0]["length"][0], -0.5);
  EXPECT_EQ(found["readings"][0]["turn"], -1.25);
  EXPECT_EQ(located("gallery:ellipse --reading -.5,-1.25")["readings"], found["readings"]);
  EXPECT_EQ(located("gallery:ellipse --reading=-0.5,-1.25")["readings"], found["readings"]);
}

TEST(CliReading, may_stand_in_front_of_the_part_and_be_repeated) {
  const Json found = located("--reading 0.5,0.25 --reading -0.5,-0.25 gallery:ellipse");
  EXPECT_EQ(found["readings"].size(), 2U);
}

TEST(CliReading, takes_degrees_wherever_an_angle_is) {
  EXPECT_DOUBLE_EQ(located("gallery:ellipse --reading 1,90deg")["readings"][0]["turn"], std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(tolerance_of("gallery:ellipse --reading 1,1 --tolerance 2deg"), std::numbers::pi / 90);
}

TEST(CliTolerance, is_what_the_rounding_of_the_digits_can_do) {
  // The ellipse's largest curvature is a / b^2 = 2: a length that is off by h turns the tangent by up to 2 h.
  EXPECT_DOUBLE_EQ(tolerance_of("gallery:ellipse,a=2,b=1 --reading 1.50,1.27"), 0.005 * (1 + 2));
  EXPECT_DOUBLE_EQ(tolerance_of("gallery:ellipse,a=2,b=1 --reading 1.5,1.27"), 0.005 * (1 + 2));
  EXPECT_DOUBLE_EQ(tolerance_of("gallery:ellipse,a=2,b=1 --reading 1,1.3"), 0.05 * (1 + 2));
  EXPECT_NEAR(tolerance_of("gallery:ellipse,a=2,b=1 --reading 1.5,73deg"), 0.05 * (std::numbers::pi / 180 + 2), 1e-15);
}

TEST(CliTolerance, is_that_of_the_roughest_of_several_readings) {
  EXPECT_DOUBLE_EQ(tolerance_of("gallery:ellipse --reading 1.50,1.27 --reading 2.0,1.5"), 0.05 * (1 + 2));
}

TEST(CliTolerance, is_1e_9_for_whole_numbers_and_for_numbers_in_full) {
  EXPECT_EQ(tolerance_of("gallery:ellipse --reading 2,1"), 1e-9);
  EXPECT_EQ(tolerance_of("gallery:ellipse --reading 1.4142135623730951,0.5"), 1e-9);
}

TEST(CliTolerance, is_whatever_is_asked_for) {
  EXPECT_EQ(tolerance_of("gallery:ellipse --reading 1.5,1.27 --tolerance 0.125"), 0.125);
  EXPECT_EQ(tolerance_of("gallery:ellipse --reading 1.5,1.27 --tolerance 0"), rollfix::kLeastTolerance);
}

TEST(CliTolerance, keeps_the_true_place_however_roughly_a_reading_is_written_down) {
  std::mt19937_64 generator = test_generator();
  std::uniform_real_distribution<double> fraction(0, 1);
  for (int i = test_count(60); i > 0; --i) {
    const std::string name = fmt::format("gallery:spline,seed={}", generator() % 100);
    const rollfix::Part part(rollfix::load_outline(name));
    const double P = part.perimeter();
    const double s = P * fraction(generator);
    const double length = P * (0.05 + 0.9 * fraction(generator));
    const double turn = part.turning().angle(s + length) - part.turning().angle(s);
    const int decimals = 1 + static_cast<int>(generator() % 6);
    const bool trim = generator() % 2 == 0;
    std::string reading = written(length, decimals, trim) + "," + written(turn, decimals, trim);
    if (reading.find('.') == std::string::npos) continue;  // whole numbers mean what they say
    const Json found = located(name + " --reading " + reading);
    EXPECT_TRUE(covers(found["placements"], s, P)) << name << " --reading " << reading << " from " << cli::exact(s);
  }
}

TEST(CliReading, degrees_may_have_their_sign_or_stand_apart) {
  const std::vector<std::string> part{"locate", "gallery:ellipse,a=2,b=1", "--json", "--reading"};
  const auto answer = [&](const std::string& reading) {
    std::vector<std::string> words = part;
    words.push_back(reading);
    Json json = cli::run_words(words).json();
    json.erase("counts");
    return json;
  };
  EXPECT_EQ(answer("1.50,35.0\xC2\xB0"), answer("1.50,35.0deg"));
  EXPECT_EQ(answer("1.50,35.0 deg"), answer("1.50,35.0deg"));
  EXPECT_EQ(answer("1.50, 35.0 \xC2\xB0"), answer("1.50,35.0deg"));
}

TEST(CliReading, a_turn_that_was_likely_meant_in_degrees_is_asked_about) {
  const std::string told = run("locate gallery:ellipse,a=2,b=1 --reading 1,73").err;
  EXPECT_NE(told.find("--reading 1,73: a turn of 73 rad is 11.6 turns; did you mean 73deg?"), std::string::npos)
      << told;
  EXPECT_EQ(run("locate gallery:ellipse,a=2,b=1 --reading 1,73deg").err.find("did you mean"), std::string::npos);
  EXPECT_EQ(run("locate gallery:ellipse,a=2,b=1 --reading 50,34").err.find("did you mean"), std::string::npos);
}

}  // namespace cli_reading_test
