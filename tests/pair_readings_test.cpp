// What two fingers must say for an answer: two readings, or one and how they face each other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pair_cases.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace pair_readings_test {
namespace {

using namespace rollfix;
using pair_cases::reading_from;

const PerFinger<double> kStart{1.3, 4.1};

Part spline() { return Part(gallery("spline,n=10,seed=3")); }

std::vector<Reading> readings(const Part& part, std::size_t count) {
  std::vector<Reading> all;
  for (const PerFinger<double> lengths : {PerFinger<double>{0.9, -0.7}, {1.9, 0.6}, {2.6, 1.5}, {3.3, 2.9}}) {
    if (all.size() < count) all.push_back(reading_from(part, kStart, lengths[0], lengths[1]));
  }
  return all;
}

double facing(const Part& part) { return part.turning().angle(kStart[0]) - part.turning().angle(kStart[1]); }

bool holds(const Search& search, const PerFinger<double>& at) {
  return std::any_of(search.placements.begin(), search.placements.end(), [&](const Placement& placement) {
    return std::abs(placement.start[0] - at[0]) + std::abs(placement.start[1] - at[1]) < 1e-7;
  });
}

std::string message_of(const Part& part, const std::vector<Reading>& all, const LocateOptions& options = {}) {
  try {
    locate(part, all, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PairReadings, one_alone_leaves_a_curve_of_answers_and_is_refused) {
  EXPECT_THAT(message_of(spline(), readings(spline(), 1)), testing::HasSubstr("a curve of answers"));
  EXPECT_THAT(message_of(spline(), {}), testing::HasSubstr("found none"));
}

TEST(PairReadings, one_suffices_with_the_facing_equation) {
  LocateOptions options;
  options.facing = facing(spline());
  const Search search = locate(spline(), readings(spline(), 1), options);
  EXPECT_TRUE(holds(search, kStart));
  EXPECT_EQ(search.placements.size() % 2, 0U);
}

TEST(PairReadings, the_facing_angle_counts_modulo_whole_turns) {
  LocateOptions options;
  options.facing = facing(spline());
  LocateOptions turned = options;
  *turned.facing += 6 * shapes::kPi;
  const Search one = locate(spline(), readings(spline(), 1), options);
  const Search other = locate(spline(), readings(spline(), 1), turned);
  ASSERT_EQ(one.placements.size(), other.placements.size());
  for (std::size_t k = 0; k < one.placements.size(); ++k) {
    EXPECT_NEAR(one.placements[k].start[0], other.placements[k].start[0], 1e-9);
  }
}

TEST(PairReadings, two_suffice_and_each_further_one_narrows_the_set) {
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const std::size_t count : {2U, 3U, 4U}) {
    const Search search = locate(spline(), readings(spline(), count));
    EXPECT_TRUE(holds(search, kStart)) << count;
    EXPECT_LE(search.placements.size(), before);
    before = search.placements.size();
  }
  EXPECT_EQ(locate(spline(), readings(spline(), 4)).verdict().text(), "unique");
}

TEST(PairReadings, three_that_were_rounded_still_cross_and_tell_how_sure_they_are) {
  std::vector<Reading> rounded = readings(spline(), 3);
  for (Reading& reading : rounded) reading.turn = std::round(1e4 * reading.turn) / 1e4;
  LocateOptions options;
  options.tolerance = 1e-4;
  const Search search = locate(spline(), rounded, options);
  ASSERT_EQ(search.verdict().text(), "unique");
  EXPECT_EQ(search.placements.front().kind, Kind::crossing);
  EXPECT_EQ(search.placements.front().sensitivity.per_turn[1].size(), 3U);
}

TEST(PairReadings, a_facing_equation_that_holds_keeps_the_true_pair_among_fewer) {
  LocateOptions options;
  options.facing = facing(spline());
  const Search without = locate(spline(), readings(spline(), 2));
  const Search with = locate(spline(), readings(spline(), 2), options);
  EXPECT_TRUE(holds(with, kStart));
  EXPECT_LT(with.placements.size(), without.placements.size());
}

TEST(PairReadings, a_whole_lap_more_is_the_same_place) {
  const Part part = spline();
  std::vector<Reading> longer = readings(part, 2);
  longer[0].length[0] += part.perimeter();
  longer[0].turn += 2 * shapes::kPi;
  longer[1].length[1] -= 2 * part.perimeter();
  longer[1].turn += 4 * shapes::kPi;
  const Search one = locate(part, readings(part, 2));
  const Search other = locate(part, longer);
  ASSERT_EQ(one.placements.size(), other.placements.size());
  for (std::size_t k = 0; k < one.placements.size(); ++k) {
    EXPECT_NEAR(one.placements[k].start[1], other.placements[k].start[1], 1e-9);
  }
}

TEST(PairReadings, that_are_no_numbers_are_refused) {
  std::vector<Reading> bad = readings(spline(), 2);
  bad[1].turn = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of(spline(), bad), testing::HasSubstr("three finite numbers"));
  LocateOptions options;
  options.facing = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message_of(spline(), readings(spline(), 1), options), testing::HasSubstr("facing"));
}

TEST(PairReadings, with_a_facing_that_may_be_half_a_turn_off_are_refused) {
  LocateOptions options;
  options.facing = 0.2;
  options.tolerance = 4;
  EXPECT_THAT(message_of(spline(), readings(spline(), 1), options), testing::HasSubstr("229.183 deg"));
}

TEST(PairReadings, with_a_facing_that_may_be_nearly_half_a_turn_off_end_within_the_budget) {
  LocateOptions options{shapes::kPi - 1e-10, 2000};
  options.facing = 0.2;
  EXPECT_LT(locate(spline(), readings(spline(), 1), options).counts.intervals, 10000U);
}

TEST(PairReadings, longer_than_an_open_curve_are_refused) {
  const Part part(gallery("log-spiral"));
  const double period = part.perimeter();
  EXPECT_THAT(message_of(part, {{0.1, 2 * period, 0}, {0.1, 0.2, 0}}), testing::HasSubstr("open curve"));
}

TEST(PairReadings, on_an_open_curve_find_only_rolls_that_lie_on_it) {
  const Part part(gallery("exponential"));
  const double period = part.perimeter();
  const PerFinger<double> start{0.3 * period, 0.6 * period};
  const Search search = locate(part, {reading_from(part, start, 0.5 * period, -0.4 * period),
                                      reading_from(part, start, -0.2 * period, 0.3 * period)});
  EXPECT_TRUE(holds(search, start));
  for (const Placement& placement : search.placements) {
    EXPECT_LE(placement.start[0] + 0.5 * period, period * (1 + 1e-12));
    EXPECT_GE(placement.start[1] - 0.4 * period, -period * 1e-12);
  }
}

TEST(PairReadings, a_budget_that_runs_out_leaves_boxes_that_hold_what_is_not_listed) {
  const Part part = spline();
  const Search whole = locate(part, readings(part, 2));
  for (std::size_t budget = 0; budget < 30; ++budget) {
    LocateOptions options;
    options.budget = budget;
    const Search search = locate(part, readings(part, 2), options);
    EXPECT_EQ(search.verdict().text() == "undecided", !search.unresolved.empty());
    // The whole boundary for both is said where an odd number of crossings shows that something went wrong.
    for (const PerFinger<Interval>& box : search.unresolved) EXPECT_LT(box[0].width(), part.perimeter());
    for (const Placement& placement : whole.placements) {
      const bool open =
          std::any_of(search.unresolved.begin(), search.unresolved.end(), [&](const PerFinger<Interval>& box) {
            return box[0].contains(placement.start[0]) && box[1].contains(placement.start[1]);
          });
      EXPECT_TRUE(open || holds(search, placement.start)) << "budget " << budget;
    }
  }
}

TEST(PairReadings, give_the_same_bits_every_time) {
  const Part part = spline();
  const Search one = locate(part, readings(part, 2));
  const Search two = locate(part, readings(part, 2));
  ASSERT_EQ(one.placements.size(), two.placements.size());
  for (std::size_t k = 0; k < one.placements.size(); ++k) EXPECT_EQ(one.placements[k].start, two.placements[k].start);
}

}  // namespace
}  // namespace pair_readings_test
