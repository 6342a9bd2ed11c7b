// Robust rows: far from a place they all count as outliers, and nothing there tells how narrow it is.
#include <gtest/gtest.h>

#include <array>

#include "single_rolls.hpp"

namespace robust_search_test {
namespace {

using namespace single_rolls;

constexpr std::array kShapes = {"polygon,n=5", "reuleaux", "spline,n=9,seed=4,wobble=0.2", "rounded-rectangle"};

void expect_listed(const Rolling& rolling) {
  for (int k = 0; k < test_count(40); ++k) {
    const Part part(gallery(kShapes[static_cast<std::size_t>(k) % kShapes.size()]));
    Drawn one = drawn(part, rolling, static_cast<std::uint64_t>(k) + 1);
    one.problem.robust = true;
    EXPECT_TRUE(lists(solve(one.problem), one.start)) << "case " << k;
  }
}

TEST(RobustSearch, finds_places_as_narrow_as_good_sensors_make_them) {
  expect_listed({.noise = {.contact = 1e-4, .angle = 0.001}});
}

TEST(RobustSearch, finds_them_by_few_rows) { expect_listed({.noise = {.contact = 1e-4, .angle = 0.001}, .rows = 20}); }

TEST(RobustSearch, finds_them_by_centres_as_well) {
  expect_listed({.noise = {.contact = 1e-4, .angle = 0.001, .position = 1e-4}, .places = true});
}

}  // namespace
}  // namespace robust_search_test
