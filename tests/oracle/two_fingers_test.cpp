// Two fingers against the oracle: all pairs, and no other. --count and --seed say how many random cases, and which.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "oracle/doubt.hpp"
#include "oracle/two_finger_agreement.hpp"
#include "oracle/two_finger_cases.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"

namespace oracle_two_fingers_test {
namespace {

using namespace oracle;
using rollfix::Search;

TwoFingerAgreement agreement(const Boundary& boundary, const PairCase& asked, const Search& search) {
  return {boundary, asked.question(doubt(boundary), rollfix::kLeastTolerance), search};
}

/// Calls `examine(known, asked, search)` for so many random cases, two on each outline.
template <class Examine>
void for_random_cases(int count, std::uint64_t stream, const Examine& examine) {
  constexpr int kCases = 2;
  for (int k = 0; kCases * k < count; ++k) {
    std::mt19937_64 generator = test_generator(stream + static_cast<std::uint64_t>(k));
    RandomShapes random(generator);
    const auto kind = static_cast<std::size_t>(k);
    const Shape shape = random.curved_shape(kind);
    const rollfix::Part part = shape.part();
    const Boundary known = shape.boundary();
    RandomPairCases cases(known, RandomShapes::is_drafted(kind), random);
    for (int i = 0; i < std::min(kCases, count - kCases * k); ++i) {
      const PairCase asked = cases.pair_case();
      rollfix::LocateOptions options;
      options.tolerance = asked.tolerance;
      options.facing = asked.facing;
      SCOPED_TRACE(fmt::format("outline {} ({}), case {}", k, shape.name, i));
      examine(known, asked, rollfix::locate(part, asked.readings, options));
    }
  }
}

TEST(OracleTwoFingers, find_what_the_library_finds_and_nothing_else) {
  const int count = test_count(100);
  int told = 0, incomplete = 0;
  for_random_cases(count, 4000, [&](const Boundary& known, const PairCase& asked, const Search& search) {
    const TwoFingerAgreement compared = agreement(known, asked, search);
    EXPECT_THAT(compared.complaints(), testing::IsEmpty());
    if (compared.truth().is_told()) ++told;
    if (search.status == rollfix::Status::incomplete) ++incomplete;
  });
  EXPECT_GE(10 * told, 7 * count);  // the others leave continua
  EXPECT_LE(50 * incomplete, count);
}

TEST(OracleTwoFingers, complain_of_a_pair_that_is_missing_twice_there_or_elsewhere) {
  int seen = 0;
  for_random_cases(16, 5000, [&](const Boundary& known, const PairCase& asked, const Search& search) {
    const bool is_told = agreement(known, asked, search).truth().is_told();
    if (!is_told || search.placements.empty() || asked.tolerance < 1e-9 ||
        search.placements.front().kind != rollfix::Kind::crossing) {
      return;
    }
    ++seen;
    const auto expect_complaint = [&](const auto& spoil) {
      Search spoiled = search;
      spoil(spoiled.placements);
      EXPECT_FALSE(agreement(known, asked, spoiled).complaints().empty());
    };
    expect_complaint([](auto& placements) { placements.erase(placements.begin()); });
    expect_complaint([](auto& placements) { placements.push_back(placements.front()); });
    expect_complaint(
        [&](auto& placements) { placements.front().start[1] += 1e-3 * static_cast<double>(known.perimeter()); });
  });
  EXPECT_GT(seen, 4);
}

}  // namespace
}  // namespace oracle_two_fingers_test
