#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "hold/held_rows.hpp"
#include "hold/steps.hpp"
#include "hold_cases.hpp"
#include "rollfix/files.hpp"

// With noise: each set of boxes that the search leaves has a placement that is listed, or is counted.
namespace hold_sets_test {

using namespace hold_cases;

struct Counted {
  std::size_t sets = 0;
  std::size_t listed = 0;  // of these, with a placement at least
  HoldAnswer answer;
};

Counted counted(const HoldProblem& problem) {
  namespace hold = rollfix::hold;
  const std::vector<Log> logs = hold::logs_of(problem);
  const hold::WheelPaths wheels;
  hold::HeldQuestion question(problem, hold::held_rows(problem, logs), hold::rows_to_search(problem, logs.front()),
                              wheels);
  const std::vector<hold::FoundSet> found = question.sets(question.search().search().fit);
  Counted result{found.size(), 0, {problem.part, std::vector<rollfix::HoldRoll>(logs.size())}};
  hold::weigh(problem, question.rows(), question.searched(), found, question.search(), wheels, hold::Care::full,
              result.answer);
  std::set<std::vector<double>> sets;  // by where they begin
  for (const HoldPlacement& one : result.answer.placements) {
    std::vector<double> begin;
    for (const rollfix::HoldContact& contact : one.contacts) begin.push_back(contact.extent.lo);
    sets.insert(begin);
  }
  result.listed = sets.size();
  return result;
}

TEST(HoldSets, that_are_not_listed_are_counted_once) {
  const Part part = rollfix::load_part("gallery:spline,n=9,seed=4,wobble=0.25");
  Holding holding;
  holding.centres = false;
  holding.contact_sd = 0.004;
  holding.angle_sd = 0.02;
  const double size = diagonal(part);
  std::mt19937_64 generator(7);
  std::size_t several = 0;  // that have several modes in one set
  for (int k = 0; k < 3; ++k) {
    HoldCase one = random_hold(part, holding, generator);
    one.problem.noise = rollfix::Noise{.contact = holding.contact_sd * size, .angle = holding.angle_sd};
    one.problem.may_overlap = true;
    const Counted found = counted(one.problem);
    EXPECT_EQ(found.answer.improbable, found.sets - found.listed) << k;
    several += found.answer.placements.size() > found.listed ? 1 : 0;
  }
  EXPECT_GT(several, 0U);
}

}  // namespace hold_sets_test
