// What only the centres of a log contradict: two answers with all that may be wrong looked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "rollfix/log.hpp"
#include "rollfix/solve.hpp"
#include "shapes.hpp"

namespace centres_contradicted_test {
namespace {

using rollfix::Answer;
using rollfix::Problem;

/// Eight corners to pivot at; a jaw pivots at the four at the outside.
rollfix::Part comb() {
  return rollfix::Part(shapes::polygon(
      {{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 1}, {3, 1}, {3, 1.5}, {2, 1.5}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}));
}

/// A jaw that turns about the place where its frame begins, which is said to move away meanwhile.
rollfix::Log of_a_jaw_that_is_not_where_it_is_said_to_be() {
  std::string rows = "u,psi,x,y\n";
  for (int k = 0; k < 12; ++k) {
    const double share = k / 11.0;
    rows += fmt::format("0,{},{},{}\n", 0.2 + 0.5 * share, 5 + 0.4 * share, 0.3 * share);
  }
  return rollfix::parse_log(rows, "pivot.csv");
}

TEST(CentresContradicted, fit_badly_whether_or_not_there_are_places_that_a_jaw_does_not_get_to) {
  const rollfix::Part box(shapes::polygon({{0, 0}, {5, 0}, {5, 2}, {0, 2}}));  // the comb's corners at the outside
  for (const rollfix::Part& part : {box, comb()}) {
    const Problem problem{
        part, of_a_jaw_that_is_not_where_it_is_said_to_be(), {rollfix::jaw()}, rollfix::Noise{0.01, 0.02}};
    const Answer answer = rollfix::solve(problem);
    EXPECT_FALSE(answer.diagnoses.empty());
    EXPECT_EQ(answer.verdict.text(), "ambiguous (4), but the rows fit badly");
  }
}

}  // namespace
}  // namespace centres_contradicted_test
