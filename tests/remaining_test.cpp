// How many places, poses or parts remain, by their probabilities: what is improbable does not count, but a hundred and
// twenty that are all alike do.

#include "locate/remaining.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "cli.hpp"
#include "disk_rolls.hpp"
#include "random.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/part.hpp"
#include "rollfix/solve.hpp"

namespace remaining_test {
namespace {

using rollfix::how_many_remain;
using testing::StartsWith;
using Probabilities = std::vector<double>;

/// A log of a disk on a part, with this noise.
rollfix::Problem on_part(const rollfix::Part& part, const rollfix::Noise& noise) {
  const rollfix::Finger finger = rollfix::disk(0.1);
  rollfix::Log log = rollfix::roll(part, finger, rollfix::disk_rolls::by_distance(0.3, 1.0, 60)).log;
  auto generator = test_generator();
  std::normal_distribution<double> normal;
  for (double& u : log.fingers[0].u) u += noise.contact * normal(generator);
  for (double& psi : log.fingers[0].psi) psi += noise.angle * normal(generator);
  log.fingers[0].x.clear();
  log.fingers[0].y.clear();
  return {part, {log}, {finger}, noise};
}

}  // namespace

TEST(Remaining, is_one_where_it_is_sure) {
  EXPECT_EQ(how_many_remain(Probabilities{0.96, 0.03, 0.01}), 1U);
  EXPECT_EQ(how_many_remain(Probabilities{0.94, 0.05, 0.01}), 3U);
  EXPECT_EQ(how_many_remain(Probabilities{}), 0U);
}

TEST(Remaining, is_not_what_is_improbable) {
  EXPECT_EQ(how_many_remain(Probabilities{0.9, 0.0995, 0.0005}), 2U);
  EXPECT_EQ(how_many_remain(Probabilities{0.5, 0.491, 0.009}), 2U);
}

TEST(Remaining, is_all_that_is_alike_however_improbable) {
  EXPECT_EQ(how_many_remain(Probabilities(120, 1.0 / 120)), 120U);
  EXPECT_EQ(how_many_remain(Probabilities(1'000'000, 1e-6)), 1'000'000U);
  Probabilities one_and_many(51, 0.002);
  one_and_many.front() = 0.9;
  EXPECT_EQ(how_many_remain(one_and_many), 51U);
}

TEST(Remaining, is_all_where_there_is_no_noise) {
  EXPECT_EQ(how_many_remain(Probabilities(3, std::numeric_limits<double>::quiet_NaN())), 3U);
}

TEST(Remaining, of_a_part_with_equal_sides_are_as_many_as_sides) {
  rollfix::Noise noise;
  noise.contact = 0.001;
  noise.angle = 0.002;
  for (const int sides : {60, 101, 120, 250}) {
    const rollfix::Answer answer =
        solve(on_part(rollfix::load_part("gallery:polygon,n=" + std::to_string(sides)), noise));
    EXPECT_EQ(answer.verdict.text(), "ambiguous (" + std::to_string(sides) + ")");
    EXPECT_EQ(next_roll(answer, {}, false, {}).why.find("only one place"), std::string::npos);
  }
}

TEST(Remaining, of_many_congruent_parts_are_all) {
  const cli::Folder folder;
  std::vector<rollfix::CatalogSource> sources;
  const rollfix::Part part = rollfix::load_part("gallery:spline,n=9,seed=4");
  for (int k = 0; k < 130; ++k) {
    const std::string name = "copy " + std::to_string(k);
    sources.push_back({name, name, 1, part});
  }
  rollfix::build_catalog("copies.db", sources);
  const rollfix::Catalog catalog("copies.db");
  rollfix::Noise noise;
  noise.contact = 0.001;
  noise.angle = 0.002;
  rollfix::Problem question = on_part(catalog.part(0), noise);
  const rollfix::Identified found = identify(catalog, question);
  EXPECT_EQ(found.parts.size(), 130U);
  EXPECT_THAT(found.verdict, StartsWith("130 congruent parts"));
}

}  // namespace remaining_test
