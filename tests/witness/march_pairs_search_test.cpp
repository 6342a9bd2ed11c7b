// Section 3.2: bisection where phi_2 and phi_4 go opposite ways, the iteration of Figure 6 where they go the same way.

#include "march_pairs_pieces.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_pairs_search_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using march_pairs::Pieces;
using march_pairs::Planted;
using march_pairs::PlantedWithin;
using march_pairs::Point;
using march_pairs::Readings;
using rollfix::Outline;

std::vector<Outline> shapes_of(std::mt19937_64& generator) {
  return {egg(), ellipse(2, 1), limacon(1.5, 1), amoeba(), random_spline(generator, 10)};
}

TEST(MarchPairsSearch, finds_all_pairs_that_an_exhaustive_scan_finds) {
  auto generator = test_generator(61);
  for (const Outline& outline : shapes_of(generator)) {
    const Exhaustive oracle(outline);
    const PairMarch march(outline);
    for (int i = 0; i < test_count(2); ++i) {
      const Planted planted(oracle, generator);
      SCOPED_TRACE(march_pairs::trace_of(outline.name, planted.readings));
      const PairResult result = march_pairs::march(march, planted.readings);
      EXPECT_TRUE(march_pairs::lists(result, planted.at, oracle.perimeter()) || !result.complete());
      march_pairs::expect_agreement(oracle, result, planted.readings);
    }
  }
}

/// +1 where phi_2 and phi_4 go the same way as phi_1 and phi_3 grow, -1 where they go opposite ways.
double ways(const Exhaustive& oracle, const Readings& readings, double s, double t) {
  const double along_s = oracle.slope(s, readings[0].length[0]) * oracle.slope(s, readings[1].length[0]);
  const double along_t = oracle.slope(t, readings[0].length[1]) * oracle.slope(t, readings[1].length[1]);
  return along_s * along_t;
}

TEST(MarchPairsSearch, bisection_finds_those_with_opposite_ways_and_the_iteration_the_others) {
  auto generator = test_generator(62);
  std::array<int, 2> seen{};
  for (const Outline& outline : shapes_of(generator)) {
    const Exhaustive oracle(outline);
    const PairMarch march(outline);
    const Planted planted(oracle, generator);
    for (const StartPair& pair : march_pairs::march(march, planted.readings).pairs) {
      const bool same = ways(oracle, planted.readings, pair.s, pair.t) > 0;
      EXPECT_EQ(pair.found, same ? PairFound::iteration : PairFound::bisection);
      ++seen[same ? 1 : 0];
    }
  }
  EXPECT_GT(seen[0], 5);
  EXPECT_GT(seen[1], 5);
}

TEST(MarchPairsSearch, bisection_happens_once_at_most_in_a_pair_of_intervals) {
  auto generator = test_generator(63);
  const Exhaustive oracle(amoeba());
  const PairResult result = march_pairs::march(PairMarch(amoeba()), Planted(oracle, generator).readings);
  const auto bisected = std::count_if(result.pairs.begin(), result.pairs.end(),
                                      [](const StartPair& pair) { return pair.found == PairFound::bisection; });
  EXPECT_GT(bisected, 0);
  EXPECT_LE(static_cast<std::size_t>(bisected), result.bisections);
}

/// One iteration of Figure 6, round by round.
struct Rounds {
  std::vector<Point> places;
  std::vector<double> rates;
  bool reached = false;

  Rounds(const Correspondence& way, double perimeter, Tally& tally) {
    StartsOfBoth at = way.begin.counted_by(tally);
    const LimitRule one_round{1e-12 * perimeter, 4e-15 * perimeter, 1e-9 * perimeter, 1};
    places.push_back({at.a.s(), at.b.s()});
    while (!reached && places.size() < 5000) {
      const Approach round = iterate(at, way, one_round);
      if (round.end == Approach::End::exit) return;
      places.push_back({at.a.s(), at.b.s()});
      rates.push_back(round.rate);
      reached = round.end == Approach::End::limit;
    }
  }
};

/// Calls `look` with every iteration of some random questions that reaches a pair.
template <class Look>
int each_iteration(std::uint64_t stream, const Look& look) {
  auto generator = test_generator(stream);
  int seen = 0;
  for (const Outline& outline : shapes_of(generator)) {
    const Exhaustive oracle(outline);
    const PlantedWithin planted(oracle, generator);
    Pieces pieces(outline, oracle.perimeter(), planted.readings);
    pieces.each([&](const auto&, const auto&, const auto& way) {
      if (!way || way->trend_2 != way->trend_4) return;
      const Rounds rounds(*way, oracle.perimeter(), pieces.tally);
      if (!rounds.reached) return;
      ++seen;
      look(*way, rounds);
    });
  }
  return seen;
}

TEST(MarchPairsSearch, both_iterates_go_forward_only_and_never_pass_the_pair_to_which_they_converge) {
  const int seen = each_iteration(64, [](const Correspondence& way, const Rounds& rounds) {
    const double s_way = way.y() > way.x() ? 1 : -1;
    const double t_way = way.z() > way.w() ? 1 : -1;
    const Point limit = rounds.places.back();
    for (std::size_t i = 1; i < rounds.places.size(); ++i) {
      EXPECT_GE(s_way * (rounds.places[i].s - rounds.places[i - 1].s), 0);
      EXPECT_GE(t_way * (rounds.places[i].t - rounds.places[i - 1].t), 0);
      EXPECT_LE(s_way * (rounds.places[i].s - limit.s), 0);
      EXPECT_LE(t_way * (rounds.places[i].t - limit.t), 0);
    }
  });
  EXPECT_GT(seen, 10);
}

TEST(MarchPairsSearch, the_pair_that_the_iteration_converges_to_is_the_first_one) {
  // (9) keeps the sign that it has at (x, w) up to there.
  each_iteration(65, [](const Correspondence& way, const Rounds& rounds) {
    Tally tally;
    StartsOfBoth at = way.begin.counted_by(tally);
    const bool negative = at.excess(1) < 0;
    const Point limit = rounds.places.back();
    for (int k = 1; k < 10; ++k) {
      at = way.begin.counted_by(tally);
      way.move_s_to(at, way.x() + (limit.s - way.x()) * k / 10);
      EXPECT_EQ(at.excess(1) < 0, negative);
    }
  });
}

TEST(MarchPairsSearch, the_distance_to_the_pair_shrinks_by_the_rate_that_is_claimed) {
  int measured = 0;
  each_iteration(66, [&](const Correspondence&, const Rounds& rounds) {
    const std::size_t count = rounds.places.size();
    if (count < 15 || rounds.rates.back() > 0.9 || rounds.rates.back() < 0.2) return;
    const auto left = [&](std::size_t i) {
      return std::hypot(rounds.places[i].s - rounds.places.back().s, rounds.places[i].t - rounds.places.back().t);
    };
    // From where the distance is 1e-4 of the first to where it is 1e-8: linear, and above rounding.
    std::size_t from = 0;
    while (left(from) > 1e-5) ++from;
    std::size_t to = from;
    while (left(to) > 1e-8) ++to;
    if (to < from + 4) return;
    ++measured;
    EXPECT_NEAR(std::pow(left(to) / left(from), 1.0 / static_cast<double>(to - from)), rounds.rates.back(), 2e-3);
  });
  EXPECT_GT(measured, 2);
}

}  // namespace
}  // namespace march_pairs_search_test
