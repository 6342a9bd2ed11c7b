// How many nodes a roll's rows are joined to: as many as there are, but where what gathers on the way shows in them.
#include <gtest/gtest.h>

#include <algorithm>

#include "belief/nodes.hpp"
#include "random.hpp"

namespace nodes_test {
namespace {

using rollfix::belief::Nodes;

/// Nodes of a roll over this share of a perimeter of 1.
std::size_t nodes_of(std::size_t rows, double laps, double slip) {
  rollfix::BeliefOptions options;
  options.noise = rollfix::Noise{1e-3, 5e-3, slip, 0};
  Nodes nodes(rollfix::belief::ErrorModel(options, rollfix::LogKind::contact, 30, 1), 30, false);
  std::mt19937_64 random = test_generator(rows);
  std::normal_distribution<double> normal;
  for (std::size_t k = 1; k <= rows; ++k) {
    const double length = laps * static_cast<double>(k) / static_cast<double>(rows);
    nodes.add({{length + 1e-3 * normal(random), 5e-3 * normal(random)}, 30});
  }
  return nodes.complete().size();
}

}  // namespace

TEST(Nodes, rows_stay_what_they_are_where_slip_does_not_show_in_them) {
  EXPECT_EQ(nodes_of(200, 0.4, 0), 200U);
  EXPECT_EQ(nodes_of(200, 0.4, 0.005), 200U);
  EXPECT_GE(nodes_of(100000, 0.4, 0), rollfix::belief::kMostNodes / 2);
}

TEST(Nodes, there_are_forty_for_a_lap_where_slip_shows_and_two_dozen_for_less) {
  EXPECT_NEAR(static_cast<double>(nodes_of(20000, 2, 0.05)), 80, 12);
  EXPECT_NEAR(static_cast<double>(nodes_of(100000, 2, 0.05)), 80, 12);
  EXPECT_NEAR(static_cast<double>(nodes_of(20000, 0.4, 0.05)), 24, 4);
}

TEST(Nodes, a_mean_of_rows_that_a_walk_goes_through_is_weighed_as_what_it_is) {
  // Of a walk of n steps of variance 1 the mean of its places has, with the last place, this covariance and this
  // variance: sums of min(j, k) and of k over all rows.
  for (const double n : {1.0, 2.0, 7.0, 100.0}) {
    double variance = 0;
    double with_last = 0;
    for (double j = 1; j <= n; ++j) {
      with_last += j / n;
      for (double k = 1; k <= n; ++k) variance += std::min(j, k) / (n * n);
    }
    rollfix::belief::Node node;
    node.rows = n;
    EXPECT_NEAR(node.share_in_mean() * n, with_last, 1e-9 * n);
    EXPECT_NEAR((node.share_in_mean() - node.share_averaged()) * n, variance, 1e-9 * n);
  }
}

}  // namespace nodes_test
