// Two fingers three ways: the production search, the paper's march and an exhaustive check answer the same questions.
// They share nothing but the curves (the check and the march not even the readings' turns). What the march refuses,
// lines and arcs and corners, pair_agreement_test.cpp compares two ways.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "march_families.hpp"
#include "march_pairs.hpp"
#include "pair_cases.hpp"
#include "pair_oracle.hpp"
#include "random.hpp"
#include "shapes.hpp"

namespace pair_three_ways_test {
namespace {

using namespace rollfix;
using march::PairResult;
using march::StartPair;
using pair_cases::Case;

constexpr double kAgreement = 1e-7;   // of the perimeter
constexpr double kMarchReset = 1e-8;  // of the perimeter: pairs that are closer are one to the march

/// What was compared, and where the march fell short of the others.
struct Tally {
  int cases = 0;
  int pairs = 0;
  int near_double = 0;  // cases that the check can't count, compared two ways
  int refused = 0;      // by the march, likewise
  int doubtful = 0;     // cases in which the march doubts
  int lost = 0;         // pairs that the march doesn't list

  void print(const std::string& name) const {
    std::printf(
        "three ways: %s: cases %d, pairs %d, near a double pair %d, refused %d, doubtful %d, lost by march %d\n",
        name.c_str(), cases, pairs, near_double, refused, doubtful, lost);
  }
};

class PairThreeWays : public testing::TestWithParam<std::string> {
 protected:
  Part part_{gallery(GetParam())};
  march::PairMarch march_{part_.outline()};
  pair_oracle::Exhaustive oracle_{part_.outline()};
  Tally tally_;

  void TearDown() override {
    if (tally_.cases > 0) tally_.print(GetParam());
  }

  double slack() const { return kAgreement * part_.perimeter(); }

  std::optional<PairResult> marched(const Case& drawn) const {
    try {
      return march_.pairs(drawn.readings[0], drawn.readings[1]);
    } catch (const march::Refusal& refusal) {
      EXPECT_EQ(refusal.reason(), march::Reason::continuum) << refusal.what();
      return {};
    }
  }

  void compare(const Case& drawn) {
    SCOPED_TRACE(march_pairs::trace_of(GetParam(), {drawn.readings[0], drawn.readings[1]}));
    const Search search = locate(part_, drawn.readings);
    EXPECT_EQ(search.status, Status::complete);
    EXPECT_TRUE(pair_cases::holds(part_, search, drawn.start, slack()));
    ++tally_.cases;
    tally_.pairs += static_cast<int>(search.placements.size());
    compare_with_check(search, drawn);
    if (const std::optional<PairResult> result = marched(drawn)) {
      compare_with_march(search, *result);
    } else {
      ++tally_.refused;
    }
  }

 private:
  void compare_with_check(const Search& search, const Case& drawn) {
    const pair_oracle::Scan scan = oracle_.scan(drawn.readings);
    if (scan.nearest_miss < pair_oracle::kHorizon) {
      ++tally_.near_double;
      return;
    }
    const auto near = [&](const pair_oracle::Root& root, const Placement& placement) {
      return pair_cases::distance(part_, placement.start, {root.s, root.t}) <= std::max(slack(), 10 * root.error);
    };
    for (const pair_oracle::Root& root : scan.roots) {
      EXPECT_TRUE(std::any_of(search.placements.begin(), search.placements.end(),
                              [&](const Placement& placement) { return near(root, placement); }))
          << "production lost what the check has: " << root.s << " " << root.t;
    }
    EXPECT_EQ(search.placements.size(), scan.roots.size());
  }

  void compare_with_march(const Search& search, const PairResult& result) {
    tally_.doubtful += result.complete() ? 0 : 1;
    for (const StartPair& pair : result.pairs) {
      EXPECT_TRUE(pair_cases::holds(part_, search, {pair.s, pair.t}, slack() + 4 * pair.error))
          << "production lost what the march has: " << pair.s << " " << pair.t;
    }
    for (const Placement& placement : search.placements) {
      for (const PerFinger<double>& root : placement.roots) {
        if (!listed(result, root)) expect_excused(search, result, root);
      }
    }
  }

  bool listed(const PairResult& result, const PerFinger<double>& root) const {
    return std::any_of(result.pairs.begin(), result.pairs.end(), [&](const StartPair& pair) {
      return pair_cases::distance(part_, {pair.s, pair.t}, root) <= std::max(slack(), 4 * pair.error);
    });
  }

  /// What the march may lose: pairs closer together than its reset, and what it says it doubts.
  void expect_excused(const Search& search, const PairResult& result, const PerFinger<double>& root) {
    ++tally_.lost;
    const double next = gap(search, root);
    const bool doubted = march_pairs::doubts(result, {root[0], root[1]}, part_.perimeter());
    std::printf("three ways: %s: the march lost %.12g %.12g, gap to the next pair %.3g P, %s\n", GetParam().c_str(),
                root[0], root[1], next, doubted ? "in doubt" : "no doubt");
    EXPECT_TRUE(doubted || next <= kMarchReset) << "the march lost " << root[0] << " " << root[1];
  }

  /// How far the next pair is, in parts of the perimeter.
  double gap(const Search& search, const PerFinger<double>& root) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Placement& placement : search.placements) {
      for (const PerFinger<double>& other : placement.roots) {
        if (other != root) nearest = std::min(nearest, pair_cases::distance(part_, other, root));
      }
    }
    return nearest / part_.perimeter();
  }
};

INSTANTIATE_TEST_SUITE_P(Gallery, PairThreeWays,
                         testing::ValuesIn(march_families::with_others(march_families::kOfTwoFingers)),
                         shapes::as_identifier);

TEST_P(PairThreeWays, agree_on_random_readings) {
  auto generator = test_generator(61);
  for (int k = 0; k < test_count(30); ++k) compare(pair_cases::random_case(part_, 2, generator));
}

TEST_P(PairThreeWays, agree_where_the_fingers_roll_opposite_ways_by_equal_lengths) {
  auto generator = test_generator(62);
  for (int k = 0; k < test_count(3); ++k) {
    Case drawn = pair_cases::random_case(part_, 2, generator);
    for (Reading& reading : drawn.readings) {
      reading = pair_cases::reading_from(part_, drawn.start, reading.length[0], -reading.length[0]);
    }
    compare(drawn);
  }
}

TEST_P(PairThreeWays, where_a_finger_rests_the_march_refuses_and_the_others_agree) {
  auto generator = test_generator(66);
  for (int k = 0; k < test_count(3); ++k) {
    Case drawn = pair_cases::random_case(part_, 2, generator);
    drawn.readings[1] = pair_cases::reading_from(part_, drawn.start, drawn.readings[1].length[0], 0);
    compare(drawn);
  }
  EXPECT_EQ(tally_.refused, tally_.cases);
}

/// Readings that fit along a curve through `start`.
class PairContinua : public PairThreeWays {
 protected:
  void expect_continuum(const Case& drawn) {
    SCOPED_TRACE(march_pairs::trace_of(GetParam(), {drawn.readings[0], drawn.readings[1]}));
    const std::optional<PairResult> result = marched(drawn);
    EXPECT_TRUE(!result || !result->complete()) << "the march takes it for " << result->pairs.size() << " pairs";
    const Search search = locate(part_, drawn.readings);
    EXPECT_TRUE(std::any_of(search.placements.begin(), search.placements.end(), [&](const Placement& placement) {
      return placement.kind == Kind::stretch && pair_cases::holds(part_, placement, drawn.start, slack());
    })) << search.verdict().text();
  }
};

INSTANTIATE_TEST_SUITE_P(Gallery, PairContinua,
                         testing::ValuesIn(march_families::with_others(march_families::kOfTwoFingers)),
                         shapes::as_identifier);

TEST_P(PairContinua, where_equal_rolls_turn_equally_the_march_refuses_and_production_has_a_stretch) {
  auto generator = test_generator(63);
  for (int k = 0; k < test_count(1); ++k) {
    Case drawn = pair_cases::random_case(part_, 2, generator);
    drawn.start[1] = drawn.start[0];
    for (Reading& reading : drawn.readings) reading = {reading.length[0], reading.length[0], 0};
    expect_continuum(drawn);
  }
}

TEST_P(PairContinua, likewise_one_reading_twice) {
  auto generator = test_generator(64);
  for (int k = 0; k < test_count(1); ++k) {
    Case drawn = pair_cases::random_case(part_, 2, generator);
    drawn.readings[1] = drawn.readings[0];
    expect_continuum(drawn);
  }
}

TEST_P(PairContinua, likewise_where_a_roll_is_whole_laps) {
  auto generator = test_generator(65);
  for (int k = 0; k < test_count(1); ++k) {
    Case drawn = pair_cases::random_case(part_, 2, generator);
    const Reading first = drawn.readings[0];
    const double lap = part_.perimeter();
    drawn.readings[1] = pair_cases::reading_from(part_, drawn.start, first.length[0] + lap, first.length[1] - lap);
    expect_continuum(drawn);
  }
}

}  // namespace
}  // namespace pair_three_ways_test
