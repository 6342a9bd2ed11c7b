#include "all_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "log/mirrored.hpp"
#include "outline/turn.hpp"

namespace rollfix::touch {
namespace {

Interval negative(const Interval& interval) { return {-interval.hi, -interval.lo}; }

void mirror(RollFacts& roll) {
  for (Vec2& centre : roll.track) centre.x() = -centre.x();
  for (double& length : roll.reading.length) length = -length;
  roll.reading.turn = -roll.reading.turn;
  roll.searched = in_mirror(std::move(roll.searched));
}

void mirror(TouchPose& pose) {
  pose.pose = {-pose.pose.x, pose.pose.y, -pose.pose.heading};
  for (std::array<Interval, 3>* one : {&pose.extent, &pose.interval}) {
    (*one)[0] = negative((*one)[0]);
    (*one)[2] = negative((*one)[2]);
  }
  Pose& mean = pose.spread.mean;
  mean = {-mean.x, mean.y, -mean.heading};
  const Eigen::Vector3d signs(-1, 1, -1);
  pose.spread.covariance = Eigen::Matrix3d(signs.asDiagonal() * pose.spread.covariance * signs.asDiagonal());
  for (const std::size_t i : {0U, 2U}) {
    for (MixtureTerm& term : pose.density[i]) term.mean = -term.mean;
  }
  for (TouchContact& contact : pose.contacts) {
    if (contact.turn) contact.turn = -*contact.turn;
  }
}

}  // namespace

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

RollSearched in_mirror(RollSearched roll) {
  if (roll.at) roll.at->x() = -roll.at->x();
  roll.normal = nearest_angle(std::numbers::pi - roll.normal);
  return roll;
}

TouchProblem in_mirror(const TouchProblem& problem) {
  TouchProblem result = problem;
  for (MeasuredTouch& touch : result.touches) {
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
  for (Clear& path : result.clear) {
    path.from.x() = -path.from.x();
    path.to.x() = -path.to.x();
  }
  for (Log& roll : result.rolls) mirror(roll.fingers.front(), problem.finger ? &*problem.finger : nullptr);
  if (result.finger && !result.rolls.empty()) result.finger = rollfix::mirrored(*problem.finger);
  if (result.pose) result.pose->mean = {-problem.pose->mean.x, problem.pose->mean.y, -problem.pose->mean.heading};
  return result;
}

void out_of_mirror(TouchAnswer& answer) {
  for (TouchPose& pose : answer.poses) mirror(pose);
  for (RollFacts& roll : answer.rolls) mirror(roll);
}

}  // namespace rollfix::touch
