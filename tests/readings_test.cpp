// Several readings of one roll: what each of them allows is cut by the others.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace readings_test {
namespace {

using namespace rollfix;
using testing::ElementsAre;
using testing::SizeIs;

TEST(Readings, that_are_not_numbers_are_refused) {
  const Part part(gallery("ellipse"));
  EXPECT_THROW(locate(part, Reading{std::nan(""), 1}), InputError);
  EXPECT_THROW(locate(part, std::vector<Reading>{}), InputError);
}

TEST(Readings, more_of_one_roll_leave_fewer_placements_and_never_lose_the_true_one) {
  const Part part(gallery("spline,n=14,seed=4,wobble=0.2"));
  const double start = 2.2;
  std::vector<Reading> readings;
  std::size_t last = 1000;
  for (const double length : {0.35, 0.9, 1.6, -0.5}) {
    readings.push_back(shapes::reading_from(part, start, length));
    const Search search = locate(part, readings);
    EXPECT_LE(search.placements.size(), last);
    EXPECT_TRUE(shapes::holds(part, search, start, 1e-9));
    last = search.placements.size();
  }
  EXPECT_EQ(last, 1U);
}

TEST(Readings, a_stretch_of_one_that_another_only_comes_near_to_is_none) {
  const Part stadium(gallery("stadium,length=2,r=0.5"));
  LocateOptions options;
  options.tolerance = 1e-3;
  for (const std::vector<Reading>& readings :
       {std::vector<Reading>{{0.5, 5e-4}, {0.25, 0}}, {{0.25, 0}, {0.5, 5e-4}}}) {
    const Search search = locate(stadium, readings, options);
    ASSERT_EQ(search.placements.size(), 2U);
    for (const Placement& placement : search.placements) {
      EXPECT_NE(placement.kind, Kind::stretch);
      EXPECT_TRUE(placement.roots.empty() || placement.residual < kLeastTolerance);
    }
  }
}

TEST(Readings, that_share_no_root_have_none_and_start_where_they_miss_least) {
  const Part part(gallery("spline,n=14,seed=4,wobble=0.2"));
  std::vector<Reading> readings{shapes::reading_from(part, 2.2, 0.35), shapes::reading_from(part, 2.2, 0.9)};
  readings[1].turn += 5e-3;
  LocateOptions options;
  options.tolerance = 1e-2;
  const Search search = locate(part, readings, options);
  ASSERT_TRUE(shapes::holds(part, search, 2.2, 1e-9));
  for (const Placement& placement : search.placements) {
    const auto miss = [&](double s) {
      double most = 0;
      for (const Reading& reading : readings) {
        most = std::max(most, std::abs(shapes::reading_from(part, s, reading.length[0]).turn - reading.turn));
      }
      return most;
    };
    EXPECT_NEAR(placement.residual, miss(placement.start[0]), 1e-12);
    EXPECT_TRUE(placement.roots.empty() || placement.residual <= kLeastTolerance);
    const Interval& extent = placement.extent[0];
    for (int k = 0; k <= 100; ++k) EXPECT_GE(miss(extent.lo + extent.width() * k / 100), placement.residual - 1e-9);
  }
}

TEST(Readings, a_stretch_is_cut_by_a_further_reading) {
  const Part stadium(gallery("stadium,length=2,r=0.5"));
  // 0.5 along a side, and 1.8 from the same start, which bends by 0.6 = 0.3 / r at the end.
  const Search search = locate(stadium, std::vector<Reading>{{0.5, 0}, {1.8, 0.6}});
  ASSERT_THAT(shapes::kinds(search), ElementsAre(Kind::crossing, Kind::crossing));
}

TEST(Readings, that_contradict_each_other_leave_nothing) {
  const Part part(gallery("spline"));
  const std::vector<Reading> readings{shapes::reading_from(part, 1, 0.5), shapes::reading_from(part, 3, 1.5)};
  EXPECT_EQ(locate(part, readings).verdict().text(), "inconsistent");
}

TEST(Readings, pivot_by_one_angle_at_a_corner_where_they_start) {
  const Part part = shapes::unit_square();
  // Each alone fits a start at a corner with some pivot; no pivot suits both.
  EXPECT_TRUE(locate(part, {{0, 1.2}, {0, -1.2}}).placements.empty());
  for (const Placement& placement : locate(part, {{0.5, 0.2}, {0.7, 0.2}}).placements) {
    EXPECT_LE(placement.residual, 1e-9);
  }
}

TEST(Readings, that_no_pivot_fits_exactly_are_still_at_the_corner) {
  LocateOptions options;
  options.tolerance = 1e-3;
  const Search search = locate(shapes::unit_square(), {{0.5, 0.2}, {0.7, 0.201}}, options);
  EXPECT_THAT(search.placements, SizeIs(4));
  for (const Placement& placement : search.placements) {
    EXPECT_EQ(placement.kind, Kind::corner);
    EXPECT_NEAR(placement.residual, 0.5e-3, 1e-9);
  }
}

TEST(Readings, of_a_finger_at_rest_cost_no_more_the_more_they_are) {
  const Part part(gallery("spline,n=9,seed=3"));
  const Reading roll = shapes::reading_from(part, 1, 0.5);
  std::vector<Reading> readings{roll};
  const std::size_t alone = locate(part, readings).placements.size();
  std::size_t least_work = std::numeric_limits<std::size_t>::max();
  for (int k = 1; k <= 20; ++k) {
    readings.insert(readings.begin(), Reading(0, 2e-10 * (k % 5 - 2)));
    const Search search = locate(part, readings);
    EXPECT_EQ(search.placements.size(), alone) << k;
    least_work = std::min(least_work, search.counts.intervals);
    EXPECT_LE(search.counts.intervals, static_cast<std::size_t>(k) * 2 * least_work) << k;
  }
}

}  // namespace
}  // namespace readings_test
