#include "held_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hold_facts.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part.hpp"

namespace rollfix::hold {
namespace {

/// In the order of time.
HeldRows chosen_rows(const HeldRows& rows, std::vector<std::size_t> chosen) {
  std::sort(chosen.begin(), chosen.end());
  HeldRows result = rows;
  result.rows.clear();
  for (const std::size_t row : chosen) result.rows.push_back(rows.rows[row]);
  return result;
}

}  // namespace

WheelPaths paths_of(const HoldProblem& problem) {
  WheelPaths paths;
  for (const PassiveWheel& wheel : problem.wheels) {
    paths.push_back(std::make_unique<WheelPath>(problem.part, wheel.radius));
    if (!paths.back()->is_empty()) continue;
    throw InputError(fmt::format(
        "fingers on a free part: a wheel with radius {} can touch {} nowhere without entering it; check the radius and "
        "the part's unit",
        wheel.radius, problem.part.name()));
  }
  return paths;
}

std::vector<Log> logs_of(const HoldProblem& problem) {
  std::vector<Log> logs;
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    logs.push_back(in_unit(problem.logs[k], problem.part.unit(), {finger_of_log(problem, k)}));
  }
  for (const PassiveWheel& wheel : problem.wheels) {
    logs.push_back(in_unit(wheel.log.rows, problem.part.unit(), {disk(wheel.radius)}));
  }
  return aligned(std::move(logs));
}

ReachOfFingers::ReachOfFingers(const HoldProblem& problem) {
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    const Finger& finger = finger_of_log(problem, k);
    const bool is_known = finger.is_disk() || (finger.is_jaw() && !problem.wheels.empty());
    if (!is_known) {
      each.push_back(nullptr);
      continue;
    }
    const double radius = finger.is_jaw() ? 0 : finger.disk()->radius;  // 0: a jaw
    const auto known = reaches_.find(radius);
    const auto& reach = known != reaches_.end()
                            ? known->second
                            : reaches_[radius] = std::make_unique<Reach>(
                                  radius > 0 ? reach_of_disk(problem.part, radius) : reach_of_jaw(problem.part));
    each.push_back(reach.get());
  }
}

HeldQuestion::HeldQuestion(const HoldProblem& problem, HeldRows rows, const std::vector<std::size_t>& instants,
                           const WheelPaths& wheels)
    : wheels_(wheels.size()),
      rows_(std::move(rows)),
      searched_(chosen_rows(rows_, instants)),
      part_(problem.part),
      reach_(problem),
      search_(part_, rows_, instants, reach_.each, wheels, problem.budget.value_or(kHoldBudget)) {}

std::vector<FoundSet> HeldQuestion::sets(const std::vector<Box>& boxes) {
  const Boundary boundary = part().boundary();
  std::vector<FoundSet> found;
  for (std::vector<Box>& own : sets_of(search_, boxes, boundary)) {
    FoundSet one{std::move(own), {}};
    for (std::size_t k = 0; k < search_.fingers(); ++k) {
      one.set.extent.push_back(extent_of(search_, one.boxes, k, boundary));
    }
    for (std::size_t k = 0; k < wheels_; ++k) {
      one.set.wheels.push_back(wheel_extent(search_, one.boxes, k, boundary));
    }
    found.push_back(std::move(one));
  }
  return found;
}

}  // namespace rollfix::hold
