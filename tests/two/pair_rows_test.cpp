// However many rows two fingers' roll has, they come to no more than so many nodes, each the mean of its own.
#include "belief/two/pair_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pair_rows_test {
namespace {

using rollfix::Reading;
using rollfix::belief::kMostNodes;
using rollfix::belief::PairErrors;
using rollfix::belief::PairNode;
using rollfix::belief::PairRows;

Reading row(std::size_t k) {
  const auto x = static_cast<double>(k);
  return {1e-3 * x + std::sin(7 * x), -2e-3 * x, std::cos(3 * x)};
}

std::vector<PairNode> nodes_of(std::size_t rows, bool robust = false) {
  rollfix::BeliefOptions options;
  options.noise = {0.01, 0.01, 0, 0};
  PairRows all(robust);
  for (std::size_t k = 0; k < rows; ++k) all.add(row(k), std::nullopt);
  return all.nodes({}, {}, PairErrors(options, rollfix::LogKind::travelled, {0, 0}, false, 10));
}

class Rows : public testing::TestWithParam<std::size_t> {};

}  // namespace

TEST_P(Rows, each_node_is_the_mean_of_as_many_neighbours_as_the_others) {
  const std::vector<PairNode> nodes = nodes_of(GetParam());
  EXPECT_LE(nodes.size(), kMostNodes);
  EXPECT_GE(2 * nodes.size(), std::min(GetParam(), kMostNodes));
  std::size_t next = 0;
  for (const PairNode& node : nodes) {
    const auto count = static_cast<std::size_t>(node.gathered);
    EXPECT_TRUE(count == static_cast<std::size_t>(nodes.front().gathered) || &node == &nodes.back());
    Reading sum(0, 0, 0);
    for (std::size_t k = 0; k < count; ++k, ++next) {
      const Reading one = row(next);
      for (const std::size_t finger : {0U, 1U}) sum.length[finger] += one.length[finger] / node.gathered;
      sum.turn += one.turn / node.gathered;
    }
    EXPECT_NEAR(node.length[0], sum.length[0], 1e-9);
    EXPECT_NEAR(node.length[1], sum.length[1], 1e-9);
    EXPECT_NEAR(node.turn, sum.turn, 1e-9);
  }
  EXPECT_EQ(next, GetParam());
}

INSTANTIATE_TEST_SUITE_P(PairRows, Rows, testing::Values(1, 511, 512, 513, 1025, 8192, 8193, 8209, 20000, 70001));

TEST(PairRows, of_robust_ones_an_outlier_moves_nothing) {
  rollfix::BeliefOptions options;
  options.noise = {0.01, 0.01, 0, 0};
  PairRows all(true);
  for (std::size_t k = 0; k < 40000; ++k) all.add({0.1, 0.1, k % 50 == 0 ? 100.0 : 0.5}, std::nullopt);
  for (const PairNode& node : all.nodes({}, {}, PairErrors(options, rollfix::LogKind::travelled, {0, 0}, false, 10))) {
    EXPECT_DOUBLE_EQ(node.turn, 0.5);
  }
}

}  // namespace pair_rows_test
