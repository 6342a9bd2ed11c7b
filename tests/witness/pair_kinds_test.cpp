// The kinds of answers that two fingers can have, each on a part where it is known why.

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "pair_cases.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace pair_kinds_test {
namespace {

using namespace rollfix;
using pair_cases::reading_from;

std::vector<Reading> equal_rolls(const Part& part) {
  const double period = part.perimeter();
  return {{0.2 * period, 0.2 * period, 0}, {0.37 * period, 0.37 * period, 0}};
}

std::size_t count(const Search& search, Kind kind) {
  return static_cast<std::size_t>(std::count_if(search.placements.begin(), search.placements.end(),
                                                [&](const Placement& placement) { return placement.kind == kind; }));
}

/// Is t - s the same all along the family, modulo P?
bool has_offset(const Part& part, const Placement& placement, double offset) {
  return std::all_of(placement.family.begin(), placement.family.end(), [&](const PerFinger<double>& at) {
    return part.boundary().distance(at[1] - at[0], offset) <= 1e-9 * part.perimeter();
  });
}

double largest_residual(const Part& part, const std::vector<Reading>& readings, const PerFinger<double>& at) {
  double largest = 0;
  for (const Reading& reading : readings) {
    const Reading there = reading_from(part, at, reading.length[0], reading.length[1]);
    largest = std::max(largest, std::abs(there.turn - reading.turn));
  }
  return largest;
}

// ---- stretches ----

TEST(PairStretch, equal_rolls_without_a_turn_fit_wherever_both_fingers_are_at_one_place) {
  const Part part(gallery("spline,n=9,seed=5"));
  const Search search = locate(part, equal_rolls(part));
  ASSERT_EQ(count(search, Kind::stretch), 1U);
  EXPECT_EQ(search.verdict().text(), "unobservable");
  EXPECT_EQ(search.placements.front().whole_loop, (std::array<bool, 2>{true, true}));
  EXPECT_TRUE(has_offset(part, search.placements.front(), 0));
}

TEST(PairStretch, an_ellipse_has_one_more_half_way_round) {
  const Part part(gallery("ellipse"));
  const Search search = locate(part, equal_rolls(part));
  ASSERT_EQ(search.placements.size(), 2U);
  EXPECT_EQ(search.status, Status::complete);
  EXPECT_TRUE(has_offset(part, search.placements[0], 0));
  EXPECT_TRUE(has_offset(part, search.placements[1], 0.5 * part.perimeter()));
  EXPECT_LE(search.counts.intervals, 20000U);
}

TEST(PairStretch, a_part_with_twelve_teeth_has_twelve) {
  const Part part(gallery("gear"));
  const Search search = locate(part, equal_rolls(part));
  EXPECT_EQ(count(search, Kind::stretch), 12U);
  EXPECT_EQ(search.status, Status::complete);
}

TEST(PairStretch, a_circle_can_tell_nothing) {
  const Part part(gallery("circle"));
  const Search search = locate(part, equal_rolls(part));
  ASSERT_EQ(search.placements.size(), 1U);
  EXPECT_EQ(search.placements.front().kind, Kind::stretch);
  EXPECT_EQ(search.verdict().text(), "unobservable");
}

TEST(PairStretch, rolls_of_no_length_fit_everywhere) {
  const Part part(gallery("cam"));
  const Search search = locate(part, {{0, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(search.verdict().text(), "unobservable");
  EXPECT_EQ(search.placements.size(), 1U);
}

TEST(PairStretch, whole_laps_fit_everywhere) {
  const Part part(gallery("limacon"));
  const double period = part.perimeter();
  const Search search = locate(part, {{period, 2 * period, -2 * shapes::kPi}, {-period, 0, -2 * shapes::kPi}});
  EXPECT_EQ(search.verdict().text(), "unobservable");
}

TEST(PairStretch, a_second_reading_that_says_nothing_leaves_closed_curves_of_pairs) {
  const Part part(gallery("spline"));
  const double period = part.perimeter();
  const std::vector<Reading> readings{{0.2 * period, 0.3 * period, 0.05}, {0, 0, 0}};
  const Search search = locate(part, readings);
  // As many as a contour plot of the one equation has, drawn on a grid of 4,000 by 4,000 cells.
  EXPECT_EQ(count(search, Kind::stretch), 14U);
  EXPECT_EQ(search.placements.size(), 14U);
  for (const Placement& placement : search.placements) {
    for (const PerFinger<double>& at : placement.family) EXPECT_LE(largest_residual(part, readings, at), 1e-6);
  }
}

TEST(PairStretch, families_that_cross_are_one_connected_set) {
  const Part part(gallery("ellipse"));
  const double period = part.perimeter();
  // Half a lap turns by pi from everywhere; the other reading alone leaves t = s and its mirror images.
  const Search search = locate(part, {{0.5 * period, 0.5 * period, 0}, {0.3 * period, 0.3 * period, 0}});
  ASSERT_EQ(search.placements.size(), 1U);
  EXPECT_EQ(search.verdict().text(), "unobservable");
}

TEST(PairStretch, straight_sides_and_equal_arcs_leave_patches_of_pairs) {
  const Part part(gallery("stadium"));
  const double side = 0.01 * part.perimeter();
  const Search search = locate(part, {{side, side, 0}, {2 * side, side, 0}});
  ASSERT_GE(count(search, Kind::stretch), 1U);
  EXPECT_EQ(search.status, Status::complete);
}

// ---- crossings and touchings ----

/// Two readings for which the two curves touch at a planted pair: finger b's second length is moved until det J
/// vanishes there.
struct Tangency {
  Part part{gallery("spline,n=8,seed=2")};
  PerFinger<double> start{1.1, 3.9};
  double length_b = 0;

  std::vector<Reading> readings() const {
    return {reading_from(part, start, 0.8, 1.3), reading_from(part, start, kSecond, length_b)};
  }
  Tangency() {
    const auto f = [&](double length) { return determinant(length); };
    double lo = 0.2;
    while (f(lo) * f(lo + 0.05) > 0) {
      lo += 0.05;
      if (lo > part.perimeter()) throw std::logic_error("no length makes the curves touch here");
    }
    std::uintmax_t rounds = 100;
    const boost::math::tools::eps_tolerance<double> fine(50);
    const auto found = boost::math::tools::toms748_solve(f, lo, lo + 0.05, fine, rounds);
    length_b = 0.5 * (found.first + found.second);
  }

 private:
  static constexpr double kSecond = 0.81;  // hardly longer than the first, so that both slopes of a are alike

  double slope(double s, double by) const { return part.turning().curvature(s + by) - part.turning().curvature(s); }
  double determinant(double length) const {
    return slope(start[0], 0.8) * slope(start[1], length) - slope(start[0], kSecond) * slope(start[1], 1.3);
  }
};

const Placement* nearest(Search&& search, const PerFinger<double>& at) = delete;  // would outlive it
const Placement* nearest(const Search& search, const PerFinger<double>& at) {
  const Placement* best = nullptr;
  double least = 1e9;
  for (const Placement& placement : search.placements) {
    const double far = std::hypot(placement.start[0] - at[0], placement.start[1] - at[1]);
    if (far < least) {
      least = far;
      best = &placement;
    }
  }
  return best;
}

TEST(PairTouching, where_the_curves_touch_is_found_and_called_so) {
  const Tangency tangency;
  const Search search = locate(tangency.part, tangency.readings());
  const Placement* placement = nearest(search, tangency.start);
  ASSERT_NE(placement, nullptr);
  EXPECT_EQ(placement->kind, Kind::touching);
  EXPECT_EQ(search.status, Status::complete);
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_LE(placement->extent[k].lo, tangency.start[k] + 1e-9);
    EXPECT_GE(placement->extent[k].hi, tangency.start[k] - 1e-9);
  }
}

TEST(PairTouching, crossings_are_even_in_number_beside_it) {
  const Tangency tangency;
  const Search search = locate(tangency.part, tangency.readings());
  EXPECT_EQ(count(search, Kind::crossing) % 2, 0U);
  EXPECT_EQ(count(search, Kind::touching), 1U);
}

TEST(PairTouching, apart_it_becomes_two_crossings_or_none) {
  const Tangency tangency;
  std::vector<Reading> readings = tangency.readings();
  const std::size_t touching = locate(tangency.part, readings).placements.size();
  readings[1].turn += 1e-5;
  const std::size_t one_way = locate(tangency.part, readings).placements.size();
  readings[1].turn -= 2e-5;
  const std::size_t other_way = locate(tangency.part, readings).placements.size();
  EXPECT_EQ(std::max(one_way, other_way), touching + 1);
  EXPECT_EQ(std::min(one_way, other_way), touching - 1);
}

TEST(PairTouching, two_crossings_that_the_tolerance_can_not_tell_apart_are_one_placement) {
  const Tangency tangency;
  std::vector<Reading> readings = tangency.readings();
  readings[1].turn += 1e-5;
  if (locate(tangency.part, readings).placements.size() % 2 != 0) readings[1].turn -= 2e-5;
  LocateOptions wide;
  wide.tolerance = 1e-4;
  const Search search = locate(tangency.part, readings, wide);
  const Placement* placement = nearest(search, tangency.start);
  ASSERT_NE(placement, nullptr);
  EXPECT_EQ(placement->kind, Kind::touching);
}

TEST(PairTouching, a_set_of_several_roots_crosses_where_their_signs_do_not_cancel) {
  const Part part(gallery("spline,n=8,seed=2"));
  const TurningFunction& turning = part.turning();
  auto generator = test_generator();
  LocateOptions wide;
  wide.tolerance = 0.05;
  std::size_t seen = 0;
  for (int k = 0; k < test_count(20); ++k) {
    const std::vector<Reading> readings = pair_cases::random_case(part, 2, generator).readings;
    for (const Placement& placement : locate(part, readings, wide).placements) {
      if (placement.roots.size() < 2) continue;
      int sum = 0;
      for (const PerFinger<double>& root : placement.roots) {
        const auto slope = [&](std::size_t finger, std::size_t reading) {
          const double s = root[finger];
          return turning.curvature(s + readings[reading].length[finger]) - turning.curvature(s);
        };
        sum += slope(0, 0) * slope(1, 1) < slope(0, 1) * slope(1, 0) ? 1 : -1;
      }
      EXPECT_EQ(placement.kind, sum != 0 ? Kind::crossing : Kind::touching) << "seed " << test_seed() << ", case " << k;
      ++seen;
    }
  }
  EXPECT_GT(seen, 5U);
}

TEST(PairTouching, a_near_miss_is_kept_within_the_tolerance_and_dropped_beyond) {
  const Tangency tangency;
  const std::size_t touching = locate(tangency.part, tangency.readings()).placements.size();
  for (const double sign : {1.0, -1.0}) {
    std::vector<Reading> readings = tangency.readings();
    readings[1].turn += sign * 1e-5;
    if (locate(tangency.part, readings).placements.size() > touching) continue;  // this way they cross
    LocateOptions wide;
    wide.tolerance = 1e-4;
    EXPECT_TRUE(pair_cases::holds(tangency.part, locate(tangency.part, readings, wide), tangency.start, 0));
    wide.tolerance = 1e-6;
    EXPECT_FALSE(pair_cases::holds(tangency.part, locate(tangency.part, readings, wide), tangency.start, 1e-3));
  }
}

TEST(PairTouching, one_connected_set_is_one_placement_however_the_boundary_is_cut) {
  // Two of the pairs have just met and parted; around that place the curves run together within the tolerance.
  const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  LocateOptions options;
  for (const double tolerance : {1e-5, 6.4e-5, 1e-4}) {
    options.tolerance = tolerance;
    EXPECT_EQ(locate(part, {{0.58, 0.94, -0.725248}, {1.01, 1.92, -2.03570}}, options).placements.size(), 15U);
  }
}

TEST(PairTouching, stays_so_where_a_reading_is_given_twice) {
  const std::vector<Reading> on_ellipse{{-1.1816296950915781, -11.60132990470353, 7.3808089299271593},
                                        {-3.6114147605004381, 11.721519798861356, -9.6433508548107678}};
  const std::vector<Reading> on_cam{{1.3198055678546547, 2.5552784644003621, -0.82092005410798707},
                                    {-7.7575387250770778, 2.5914658570296552, -8.5217764095897017}};
  for (const auto& [name, readings] : {std::pair("ellipse", on_ellipse), std::pair("cam", on_cam)}) {
    const Part part(gallery(name));
    std::vector<Reading> more = readings;
    more.push_back(readings.front());
    EXPECT_EQ(shapes::kinds(locate(part, more)), shapes::kinds(locate(part, readings))) << name;
    EXPECT_GE(count(locate(part, more), Kind::touching), 1U) << name;
  }
}

TEST(PairCrossing, where_the_curves_run_alongside_each_other_has_the_extent_that_one_equation_gives) {
  // Finger b rests in the second reading, so that one alone decides about s: |f_2| <= tolerance there and no further.
  const Part part(gallery("spline,n=11,seed=737928123,wobble=0.254"));
  const std::vector<Reading> readings{{6.4171912980861183, -3.2139574702642695, 10.284716124315144},
                                      {4.3975253438083923, 0, 4.199361411990453}};
  const Search search = locate(part, readings);
  const Placement* placement = nearest(search, {4.03926, 5.22432});
  ASSERT_NE(placement, nullptr);
  const double s = placement->start[0];
  const double slope = part.turning().curvature(s + readings[1].length[0]) - part.turning().curvature(s);
  const double width = 2 * LocateOptions().tolerance / std::abs(slope);
  EXPECT_NEAR(placement->extent[0].width(), width, 0.05 * width);
}

}  // namespace
}  // namespace pair_kinds_test
