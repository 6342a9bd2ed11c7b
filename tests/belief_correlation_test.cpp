// Rows that are off alike: they count as the few that they are worth.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "belief_cases.hpp"
#include "rollfix/solve.hpp"

namespace belief_correlation_test {
namespace {

using rollfix::Answer;
using rollfix::Noise;
using rollfix::Part;

constexpr std::size_t kRows = 60;
constexpr double kLengthShare = 0.3;  // of the roll, of the perimeter

/// How well the start is known where a sensor at rest says every row again, so many times in all.
double sd_of(const Part& part, std::size_t times, double correlation) {
  const double P = part.perimeter();
  Noise noise{1e-3 * P, 1e-2, 0, 0};
  rollfix::Log log = belief_cases::roll_on(part, 0.03 * P, 0.3 * P, kLengthShare * P, kRows, noise, test_seed()).log;
  const rollfix::FingerRows once = log.fingers[0];
  rollfix::FingerRows& rows = log.fingers[0];
  for (std::vector<double>* column : {&log.time, &rows.u, &rows.psi, &rows.x, &rows.y}) column->clear();
  for (std::size_t k = 0; k < times * once.u.size(); ++k) {
    log.time.push_back(static_cast<double>(k));
    rows.u.push_back(once.u[k / times]);
    rows.psi.push_back(once.psi[k / times]);
    rows.x.push_back(once.x[k / times]);
    rows.y.push_back(once.y[k / times]);
  }
  noise.correlation = correlation;
  const Answer answer = rollfix::solve({part, log, {rollfix::disk(0.03 * P)}, noise});
  EXPECT_FALSE(answer.placements.empty());
  return answer.placements.empty() ? std::nan("") : answer.placements.front().sd[0];
}

}  // namespace

TEST(BeliefCorrelation, rows_at_rest_make_the_answer_neither_surer_nor_less_sure) {
  const Part part = belief_cases::part_of("cam");
  const double step = kLengthShare * part.perimeter() / (kRows - 1);
  const double once = sd_of(part, 1, 0.5 * step);  // every row is worth one
  // How far the finger went for a row is known only so well, and no row is worth more than one.
  EXPECT_NEAR(sd_of(part, 5, 0.5 * step) / once, 1, 0.08);
  EXPECT_NEAR(sd_of(part, 50, 0.5 * step) / once, 1, 0.08);
}

}  // namespace belief_correlation_test
