#include "moved.hpp"

#include <algorithm>

#include "mistakes.hpp"

namespace rollfix::touch {
namespace {

/// Some of the rolls alone, without the touches: when these were made is not known.
TouchProblem some_rolls(const TouchProblem& problem, std::size_t begin, std::size_t end) {
  TouchProblem result = problem;
  result.touches.clear();
  result.diagnose = false;
  result.rolls.assign(problem.rolls.begin() + static_cast<std::ptrdiff_t>(begin),
                      problem.rolls.begin() + static_cast<std::ptrdiff_t>(end));
  return result;
}

bool fits(const TouchAnswer& answer) {
  return answer.status == Status::complete && !answer.poses.empty() && !answer.verdict.fits_badly;
}

}  // namespace

std::vector<TouchDiagnosis> moved(const TouchProblem& problem, const TouchAnswer& answer) {
  std::vector<TouchDiagnosis> told;
  const auto fits_alone = [](const RollFacts& roll) {
    return roll.alone.name != Verdict::inconsistent && !roll.alone.fits_badly;
  };
  if (!std::all_of(answer.rolls.begin(), answer.rolls.end(), fits_alone)) return told;
  for (std::size_t k = 1; k < problem.rolls.size(); ++k) {
    if (!fits(solve_plain(some_rolls(problem, 0, k)))) continue;
    const TouchAnswer after = solve_plain(some_rolls(problem, k, problem.rolls.size()));
    if (!fits(after)) continue;
    TouchDiagnosis what{TouchCause::moved};
    what.roll = k - 1;
    what.poses = after.poses.size();
    what.pose = after.poses.front().pose;
    if (after.fit) what.fit = *after.fit;
    told.push_back(what);
  }
  return told;
}

}  // namespace rollfix::touch
