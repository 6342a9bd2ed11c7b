#include "mirror_poses.hpp"

#include <array>
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
