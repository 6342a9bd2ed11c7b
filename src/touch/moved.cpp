#include "moved.hpp"

#include <algorithm>

#include "mistakes.hpp"

namespace rollfix::touch {
namespace {

// Each of so many touches is left out once.
constexpr std::size_t kMostTouches = 12;

/// Some of the rolls alone, without touches and free paths: when these were made is not known.
TouchProblem some_rolls(const TouchProblem& problem, std::size_t begin, std::size_t end) {
  TouchProblem result = problem;
  result.touches.clear();
  result.clear.clear();
  result.diagnose = false;
  result.rolls.assign(problem.rolls.begin() + static_cast<std::ptrdiff_t>(begin),
                      problem.rolls.begin() + static_cast<std::ptrdiff_t>(end));
  return result;
}

bool fits(const TouchAnswer& answer) {
  return answer.status == Status::complete && !answer.poses.empty() && !answer.verdict.fits_badly;
}

/// What the rolls share a pose without: what was said of the pose beforehand, the free paths, or one of the touches.
std::vector<TouchDiagnosis> not_of_rolls(const TouchProblem& problem) {
  std::vector<TouchDiagnosis> told;
  const auto add = [&](TouchDiagnosis what, TouchProblem without) {
    without.diagnose = false;
    const TouchAnswer found = solve_plain(without);
    if (!fits(found)) return;
    what.poses = found.poses.size();
    what.pose = found.poses.front().pose;
    if (found.fit) what.fit = *found.fit;
    told.push_back(what);
  };
  if (problem.pose) {
    TouchProblem without = problem;
    without.pose.reset();
    add({TouchCause::pose}, without);
  }
  if (!problem.clear.empty()) {
    TouchProblem without = problem;
    without.clear.clear();
    add({TouchCause::clear}, without);
  }
  for (std::size_t k = 0; k < std::min(problem.touches.size(), kMostTouches); ++k) {
    TouchProblem without = problem;
    without.touches.erase(without.touches.begin() + static_cast<std::ptrdiff_t>(k));
    TouchDiagnosis what{TouchCause::outlier};
    what.touch = k;
    add(what, without);
  }
  return told;
}

}  // namespace

std::vector<TouchDiagnosis> moved(const TouchProblem& problem, const TouchAnswer& answer) {
  std::vector<TouchDiagnosis> told;
  const auto fits_alone = [](const RollFacts& roll) {
    return roll.alone.name != Verdict::inconsistent && !roll.alone.fits_badly;
  };
  if (!std::all_of(answer.rolls.begin(), answer.rolls.end(), fits_alone)) return told;
  if (problem.pose || !problem.touches.empty() || !problem.clear.empty()) {
    TouchProblem rolls_alone = some_rolls(problem, 0, problem.rolls.size());
    rolls_alone.pose.reset();
    if (fits(solve_plain(rolls_alone))) return not_of_rolls(problem);
  }
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
