// Which roll tells apart the parts of a catalog that remain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "catalogs.hpp"
#include "rollfix/identify.hpp"

namespace advise_catalog_test {
namespace {

using namespace catalogs;
using cli::Json;
using cli::run;
using testing::HasSubstr;

class AdviseCatalog : public testing::Test {
 protected:
  AdviseCatalog() : catalog_(of(splines(30))) {}

  static std::vector<std::string> splines(int count) {
    std::vector<std::string> shapes;
    for (int k = 1; k <= count; ++k) shapes.push_back("spline,n=9,wobble=0.2,seed=" + std::to_string(k));
    return shapes;
  }

  /// From s on part 15 by one length: several parts remain.
  Problem short_roll() const { return {catalog_.part(15), roll_on(catalog_.part(15), 1, {0.5})}; }

  cli::Folder folder_;
  Catalog catalog_;
};

TEST_F(AdviseCatalog, leaves_one_part_whichever_it_is) {
  const Identified found = identify(catalog_, short_roll());
  const NextRollOfParts next = next_roll(found);
  ASSERT_GT(found.parts.size(), 3U);
  ASSERT_TRUE(next.helps());
  EXPECT_LT(next.advice->advised().placements, 1.5);
  EXPECT_LT(next.advice->advised().travel, 1.5 * std::abs(next.advice->advised().length));
  for (const NextRollOfParts::Place& place : next.places) {
    const Part part = catalog_.part(found.parts[place.part].weight.part);
    const double start = place.hypothesis.place[0] - 0.5;
    std::vector<double> lengths = {0.5};
    for (int k = 1; k <= 10; ++k) lengths.push_back(0.5 + 0.1 * k * next.advice->advised().length);
    const Identified then = identify(catalog_, {part, roll_on(part, start, lengths)});
    EXPECT_EQ(then.parts.size(), 1U);
    EXPECT_EQ(then.parts.at(0).weight.part, found.parts[place.part].weight.part);
  }
}

TEST_F(AdviseCatalog, says_what_turn_each_part_would_show) {
  const Identified found = identify(catalog_, short_roll());
  const NextRollOfParts next = next_roll(found);
  for (const NextRollOfParts::Place& place : next.places) {
    const TurningFunction& turning = found.parts[place.part].answer.part.turning();
    const double from = place.hypothesis.place[0];
    const double to = from + next.advice->advised().length;
    EXPECT_EQ(place.turn_ahead, turning.angle(to) - turning.angle(from));
  }
}

TEST_F(AdviseCatalog, shares_the_probability_among_parts_as_the_noise_says) {
  Problem problem{catalog_.part(15), roll_on(catalog_.part(15), 1, {0.2, 0.4, 0.6, 0.8})};
  problem.noise = Noise{0.01, 0.05};
  const Identified found = identify(catalog_, problem);
  const NextRollOfParts next = next_roll(found);
  double of_first = 0;
  for (const NextRollOfParts::Place& place : next.places)
    of_first += place.part == 0 ? place.hypothesis.probability : 0;
  EXPECT_NEAR(of_first, found.parts[0].probability, 1e-3);
}

TEST_F(AdviseCatalog, stays_within_the_travel) {
  const NextRollOfParts next = next_roll(identify(catalog_, short_roll()), Interval{-0.1, 0.3});
  for (const ExpectedGain& gain : next.advice->gains) {
    EXPECT_GE(gain.length, -0.1);
    EXPECT_LE(gain.length, 0.3);
  }
}

TEST_F(AdviseCatalog, says_that_congruent_parts_stay_together) {
  build_catalog("twins.db",
                {{"gallery:spline,n=9,wobble=0.2,seed=3", "one"}, {"gallery:spline,seed=3,n=9,wobble=0.2", "other"}});
  const Catalog twins("twins.db");
  const NextRollOfParts next = next_roll(identify(twins, {twins.part(0), roll_on(twins.part(0), 1, {0.4, 0.9, 1.5})}));
  EXPECT_FALSE(next.helps());
  EXPECT_EQ(next.why, "the parts that remain are congruent");
}

TEST_F(AdviseCatalog, has_nothing_to_say_of_one_part_or_none) {
  const Part part = catalog_.part(15);
  const NextRollOfParts one = next_roll(identify(catalog_, {part, roll_on(part, 1, {0.3, 0.7, 1.1, 1.5})}));
  EXPECT_EQ(one.why, "there is only one part and one place left");
  EXPECT_FALSE(one.advice);
  const NextRollOfParts none = next_roll(identify(catalog_, {part, {{0.1, 5.0}}}));
  EXPECT_THAT(none.why, HasSubstr("nothing fits"));
}

TEST_F(AdviseCatalog, is_a_command) {
  const Reading reading = short_roll().measured.readings.front();
  const std::string roll = " --reading 0.5," + std::to_string(reading.turn) + " --tolerance 1e-4";
  const cli::Ran text = run("advise --catalog parts.db" + roll);
  EXPECT_THAT(text.out, HasSubstr("parts: roll on"));
  EXPECT_THAT(text.out, HasSubstr("turn to expect"));
  const Json json = run("advise --catalog parts.db --json" + roll).json();
  EXPECT_EQ(json["schema"], "rollfix/advise/1");
  EXPECT_EQ(json["catalog"]["parts"], 30);
  EXPECT_TRUE(json["contenders"][0].contains("part"));
  EXPECT_THAT(run("advise gallery:cam --catalog parts.db" + roll).err, HasSubstr("found both"));
  EXPECT_THAT(run("advise --catalog parts.db --reading 0.5,0.1,0.2").err, HasSubstr("two fingers"));
}

}  // namespace
}  // namespace advise_catalog_test
