// Rolls that are whole laps but for the last digits: a perimeter that somebody else computed.

#include <gtest/gtest.h>

#include <cmath>

#include "pair_cases.hpp"
#include "random.hpp"
#include "rollfix/error.hpp"
#include "shapes.hpp"

namespace pair_laps_test {
namespace {

using namespace rollfix;
using pair_cases::Case;

constexpr double kAgreement = 1e-7;  // of the perimeter

class PairLaps : public testing::TestWithParam<std::string> {
 protected:
  Part part_{gallery(GetParam())};

  /// The same case whose second roll of finger a is `laps` laps and `off` of its size more.
  Search search(Case drawn, double laps, double off) const {
    const double length = laps * part_.perimeter() * (1 + off);
    drawn.readings[1] = pair_cases::reading_from(part_, drawn.start, length, drawn.readings[1].length[1]);
    const Search search = locate(part_, drawn.readings);
    EXPECT_TRUE(pair_cases::holds(part_, search, drawn.start, kAgreement * part_.perimeter()));
    return search;
  }
};

INSTANTIATE_TEST_SUITE_P(Gallery, PairLaps, testing::Values("ellipse", "spline", "rounded-rectangle", "naca"),
                         shapes::as_identifier);

TEST_P(PairLaps, a_last_digit_more_or_less_changes_nothing) {
  auto generator = test_generator(71);
  for (int k = 0; k < test_count(4); ++k) {
    const Case drawn = pair_cases::random_case(part_, 2, generator);
    for (const double laps : {-2.0, -1.0, 1.0, 2.0}) {
      const Search exact = search(drawn, laps, 0);
      for (const double off : {-1e-13, -2.3e-16, 2.3e-16, 1e-13}) {
        SCOPED_TRACE(testing::Message() << "case " << k << ", laps " << laps << " off by " << off);
        const Search near = search(drawn, laps, off);
        EXPECT_EQ(near.status, Status::complete);
        EXPECT_EQ(near.placements.size(), exact.placements.size());
      }
    }
  }
}

TEST_P(PairLaps, a_facing_of_many_turns_more_is_the_same_facing) {
  auto generator = test_generator(73);
  const Case drawn = pair_cases::random_case(part_, 1, generator);
  const auto count = [&](double facing) {
    LocateOptions options;
    options.facing = facing;
    return locate(part_, drawn.readings, options).placements.size();
  };
  EXPECT_EQ(count(drawn.facing + 200 * shapes::kPi), count(drawn.facing));
  EXPECT_EQ(count(drawn.facing + 200'000 * shapes::kPi), count(drawn.facing));
  EXPECT_THROW(count(1e300), rollfix::InputError);  // no digit of it is left
}

}  // namespace
}  // namespace pair_laps_test
