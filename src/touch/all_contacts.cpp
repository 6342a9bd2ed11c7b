#include "all_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace rollfix::touch {

std::vector<Measured> measured(const TouchProblem& problem) {
  std::vector<Measured> touches;
  for (const MeasuredTouch& touch : problem.touches) {
    Measured one;
    one.has_place = touch.has_place();
    if (one.has_place) one.at = touch.at;
    if (touch.normal) one.tangent = *touch.normal + 0.5 * std::numbers::pi;
    const Noise none;
    const Noise& noise = problem.noise ? *problem.noise : none;
    one.place_unit = problem.noise ? touch.position_sd.value_or(noise.position) : problem.tolerance->length;
    one.angle_unit = problem.noise ? touch.normal_sd.value_or(noise.angle) : problem.tolerance->angle;
    const double most = problem.noise ? kTouchSigmas : 1;
    one.place_most = one.has_place ? most * one.place_unit : std::numeric_limits<double>::infinity();
    one.angle_most = std::min(most * one.angle_unit, std::numbers::pi);
    touches.push_back(one);
  }
  return touches;
}

AllContacts::AllContacts(const TouchProblem& problem, double radius, std::vector<RollContact> of_rolls)
    : rolls(std::move(of_rolls)) {
  for (const RollContact& roll : rolls) each.push_back(roll.measured);
  if (problem.touches.empty()) return;
  path.emplace(problem.part, radius);
  if (!path->stretches().empty()) tree.emplace(*path);
  for (Measured touch : measured(problem)) {
    if (tree) touch.tree = &*tree;
    each.push_back(touch);
  }
}

bool AllContacts::one_fits_nowhere() const {
  return (path && path->stretches().empty()) ||
         std::any_of(rolls.begin(), rolls.end(), [](const RollContact& roll) { return roll.fits_nowhere(); });
}

}  // namespace rollfix::touch
