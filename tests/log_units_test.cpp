// A log in one unit on a part in another.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::log_units_test {
namespace {

Part ellipse_in(const std::string& unit, double size) {
  return with_unit(Part(gallery("ellipse,a=" + std::to_string(2 * size) + ",b=" + std::to_string(size))), unit);
}

LogOptions in(const std::string& unit) {
  LogOptions options;
  options.unit = unit;
  return options;
}

/// The starts, in the part's unit.
std::vector<double> starts(const Answer& answer) {
  std::vector<double> result;
  for (const Placement& one : answer.placements) result.push_back(one.start[0]);
  return result;
}

void expect_ten_times(const std::vector<double>& large, const std::vector<double>& small) {
  ASSERT_EQ(large.size(), small.size());
  ASSERT_FALSE(large.empty());
  for (std::size_t k = 0; k < large.size(); ++k) EXPECT_NEAR(large[k], 10 * small[k], 1e-7);
}

TEST(LogUnits, lengths_and_turns_are_converted_to_the_parts_unit) {
  const Log log = parse_log("length,turn\n10.0,0.625\n", "log", in("mm"));
  expect_ten_times(starts(solve({ellipse_in("mm", 10), log})), starts(solve({ellipse_in("cm", 1), log})));
}

TEST(LogUnits, increments_are_converted_with_their_sums) {
  const Log log = parse_log("distance,dturn\n4.0,0.3\n6.0,0.325\n", "log", in("mm"));
  const Log converted = in_unit(log, "cm", {});
  EXPECT_EQ(converted.unit, "cm");
  EXPECT_NEAR(converted.fingers[0].length.back(), 1, 1e-15);
  EXPECT_NEAR(converted.fingers[0].distance.front(), 0.4, 1e-15);
  EXPECT_NEAR(converted.fingers[0].place_rounding, 0.005, 1e-15);
}

TEST(LogUnits, of_a_disk_the_centres_and_of_a_jaw_u_as_well_are_lengths) {
  const Log log = parse_log("u,psi,x,y\n0,0,10,20\n1,1,11,21\n", "log", in("mm"));
  const FingerRows of_disk = in_unit(log, "m", {disk(0.01)}).fingers[0];
  EXPECT_EQ(of_disk.u, log.fingers[0].u);
  EXPECT_NEAR(of_disk.y[1], 0.021, 1e-17);
  EXPECT_NEAR(in_unit(log, "m", {jaw()}).fingers[0].u[1], 1e-3, 1e-18);
}

TEST(LogUnits, where_a_unit_is_not_known_nothing_is_converted) {
  const Log log = parse_log("length,turn\n10.0,0.625\n", "log");
  EXPECT_EQ(in_unit(log, "cm", {}).fingers[0].length, log.fingers[0].length);
  const Log known = parse_log("length,turn\n10.0,0.625\n", "log", in("mm"));
  EXPECT_EQ(in_unit(known, "", {}).fingers[0].length, log.fingers[0].length);
}

TEST(LogUnits, a_simulated_log_has_its_parts_unit) {
  const Log log = noisy_increments(ellipse_in("mm", 10), 1, 5, 4, {}, 1).log;
  EXPECT_EQ(log.unit, "mm");
}

TEST(LogUnits, two_files_are_read_with_all_options) {
  const std::string a = testing::TempDir() + "rollfix_units_a.csv";
  const std::string b = testing::TempDir() + "rollfix_units_b.csv";
  for (const std::string& path : {a, b}) write_log(path, parse_log("u,psi\n0,0\n10,-10\n20,-15\n", "degrees"));
  LogOptions options;
  options.angles = "deg";
  options.wrapped = false;
  const Log log = read_log(a, b, options);
  EXPECT_NEAR(log.fingers[1].u[1], 10 * 3.14159265358979323846 / 180, 1e-15);
  EXPECT_EQ(log.fingers[0].u_wrapped, std::optional<bool>(false));
}

}  // namespace
}  // namespace rollfix::log_units_test
