// A jaw with skin, and a wheel of which only the pin's place is known, held against a scan of all places.
#include <gtest/gtest.h>

#include "hold/rig_cases.hpp"
#include "hold/rig_scan.hpp"
#include "rollfix/files.hpp"

namespace rig_scan_test {
namespace {

using namespace rig_cases;

Part ellipse() { return rollfix::load_part("gallery:ellipse,a=2,b=1"); }

void expect_scan(const HoldProblem& problem) {
  const HoldAnswer answer = rollfix::solve(problem);
  EXPECT_EQ(answer.status, rollfix::Status::complete);
  expect_same_places(answer, scanned(problem, 3000));
}

}  // namespace

TEST(RigScan, of_all_places_finds_no_other_at_one_instant) {
  const std::vector<Held> one{{1.3, 5.2, {0.2, 0.1, 0.4}}, {1.3, 5.2, {0.2, 0.1, 0.4}}};
  expect_scan(held_at(ellipse(), 0.4, one));
  expect_scan(held_at(rollfix::load_part("gallery:cam"), 0.4, one));
}

TEST(RigScan, of_all_places_finds_no_other_at_two) {
  expect_scan(held_at(ellipse(), 0.4, {{1.3, 5.2, {0.2, 0.1, 0.4}}, {1.9, 5.9, {0.3, 0.1, 0.1}}}));
}

}  // namespace rig_scan_test
