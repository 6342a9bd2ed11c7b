// A tolerance of 0 asks for what rounding can't give: the least is used, and no placement hangs on the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace locate_least_tolerance_test {
namespace {

using rollfix::LocateOptions;
using rollfix::Part;
using rollfix::Reading;
using rollfix::Search;

class ToleranceOfZero : public testing::TestWithParam<std::string> {
 protected:
  double place() { return std::uniform_real_distribution<double>(0, part_.perimeter())(random_); }

  Reading roll_of_one(double s, double length) const { return shapes::reading_from(part_, s, length); }
  Reading roll_of_two(double s, double t, double a, double b) const {
    return {a, b, roll_of_one(s, a).turn - roll_of_one(t, b).turn};
  }

  /// How many placements there are, in whatever order the readings come.
  std::vector<std::size_t> counts_in_every_order(std::vector<Reading> readings) const {
    std::vector<std::size_t> order(readings.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::vector<std::size_t> counts;
    do {
      std::vector<Reading> ordered;
      for (const std::size_t k : order) ordered.push_back(readings[k]);
      counts.push_back(locate(part_, ordered, kExact).placements.size());
    } while (std::next_permutation(order.begin(), order.end()));
    return counts;
  }

  static constexpr LocateOptions kExact{0};
  Part part_{rollfix::gallery(GetParam())};
  std::mt19937_64 random_ = test_generator();
};

TEST_P(ToleranceOfZero, keeps_the_truth_of_one_finger_whatever_the_order_of_its_readings) {
  for (int k = 0; k < test_count(40); ++k) {
    const double s = place();
    const std::vector<std::size_t> counts =
        counts_in_every_order({roll_of_one(s, place()), roll_of_one(s, -place()), roll_of_one(s, place())});
    EXPECT_THAT(counts, testing::Each(testing::AllOf(counts.front(), testing::Ge(1U)))) << "s = " << s;
  }
}

TEST_P(ToleranceOfZero, keeps_the_truth_of_two_fingers_whatever_the_order_of_their_readings) {
  for (int k = 0; k < test_count(10); ++k) {
    const double s = place();
    const double t = place();
    const std::vector<std::size_t> counts =
        counts_in_every_order({roll_of_two(s, t, place(), -place()), roll_of_two(s, t, -place(), -place()),
                               roll_of_two(s, t, place(), place())});
    EXPECT_THAT(counts, testing::Each(testing::AllOf(counts.front(), testing::Ge(1U)))) << "s = " << s << ", t = " << t;
  }
}

TEST_P(ToleranceOfZero, is_told_to_be_the_least_there_is) {
  const double s = place();
  rollfix::Problem problem{part_, {roll_of_one(s, 1), roll_of_one(s, 2)}};
  problem.tolerance = 0;
  const rollfix::Answer answer = solve(problem);
  EXPECT_EQ(answer.tolerance.value, rollfix::kLeastTolerance);
  EXPECT_EQ(answer.tolerance.source, rollfix::Tolerance::Source::least);
}

INSTANTIATE_TEST_SUITE_P(Gallery, ToleranceOfZero, testing::Values("cam", "limacon", "gear", "spline", "ellipse"),
                         shapes::as_identifier);

TEST(Tolerance, that_is_no_number_or_below_0_is_refused) {
  const Part part(rollfix::gallery("cam"));
  for (const double tolerance :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e-9}) {
    EXPECT_THAT(refusal_of([&] {
                  locate(part, Reading{0.5, 0.3}, {tolerance});
                }),
                testing::StartsWith("expected a finite tolerance of at least 0, found"));
  }
}

}  // namespace
}  // namespace locate_least_tolerance_test
