#include "roll_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "outline/turn.hpp"

namespace rollfix::touch {
namespace {

// A place at an arc's end is on it, a share of the perimeter.
constexpr double kSeam = 1e-9;

/// The 95 % interval of a normal distribution.
Interval normal_interval(double mean, double variance) {
  const double half = 1.959964 * std::sqrt(std::max(0.0, variance));
  return {mean - half, mean + half};
}

TouchContact contact_of(const Placement& placement) {
  TouchContact contact;
  contact.s = placement.start[0];
  contact.point = placement.point[0];
  contact.tangent = placement.tangent[0];
  contact.end = placement.end[0];
  contact.extent = placement.extent[0];
  return contact;
}

/// The heading where only that is known.
double heading_of(const RollContact& roll, const Placement& placement) {
  return nearest_angle(*roll.measured.tangent - placement.tangent[0]);
}

TouchPose pose_of(const RollContact& roll, const Placement& placement) {
  TouchPose pose;
  pose.contacts = {contact_of(placement)};
  pose.pose = {0, 0, heading_of(roll, placement)};
  if (placement.pose_spread) {
    pose.pose = placement.pose_spread->mean;
    pose.spread = *placement.pose_spread;
  } else if (!placement.pose.empty()) {
    pose.pose = placement.pose.front();
  }
  pose.continuum = placement.kind == Kind::stretch || placement.whole_loop[0];
  pose.probability = placement.probability;
  const std::array<double, 3> mean{pose.pose.x, pose.pose.y, pose.pose.heading};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    pose.interval[i] = normal_interval(mean[i], pose.spread.covariance(k, k));
    pose.extent[i] = {mean[i], mean[i]};
    pose.density[i] = {{1, mean[i], std::sqrt(pose.spread.covariance(k, k))}};
  }
  return pose;
}

}  // namespace

bool is_reference(const Measured& contact) {
  return contact.has_place && contact.tree != nullptr && contact.place_most >= contact.tree->path().part().perimeter();
}

void add_roll_ends(const std::vector<RollContact>& rolls, const std::vector<Measured>& contacts, TouchAnswer& answer) {
  const Boundary boundary = answer.part.boundary();
  for (TouchPose& pose : answer.poses) {
    for (std::size_t k = 0; k < rolls.size(); ++k) {
      TouchContact& contact = pose.contacts[k];
      const double end = contact.s + rolls[k].travelled;
      contact.end = boundary.closed ? boundary.canonical(end) : std::clamp(end, 0.0, boundary.perimeter);
      for (const Interval& arc : rolls[k].confined.arcs) {
        if (!contact.extent && boundary.contains(arc, contact.s, kSeam * boundary.perimeter)) contact.extent = arc;
      }
      if (is_reference(contacts[k])) contact.distance = 0;
    }
    if (answer.place != PlaceKnown::unknown) continue;
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    pose.pose.x = pose.pose.y = pose.spread.mean.x = pose.spread.mean.y = kUnknown;
    for (std::array<Interval, 3>* range : {&pose.extent, &pose.interval}) {
      (*range)[0] = (*range)[1] = {kUnknown, kUnknown};
    }
    pose.spread.covariance.topRows<2>().setConstant(kUnknown);
    pose.spread.covariance.leftCols<2>().setConstant(kUnknown);
  }
}

void take_over_doubts(const std::vector<RollContact>& rolls, TouchAnswer& answer) {
  for (std::size_t k = 0; k < rolls.size(); ++k) {
    const Answer& alone = rolls[k].alone;
    answer.verdict.fits_badly |= alone.verdict.fits_badly;
    if (alone.status == Status::complete || answer.status == Status::incomplete) continue;
    answer.status = Status::incomplete;
    answer.verdict.name = Verdict::undecided;
    answer.unresolved_touch = k;
    for (const PerFinger<Interval>& arc : alone.unresolved) answer.unresolved.push_back(arc[0]);
  }
}

void take_from(const RollContact& roll, TouchAnswer& answer) {
  const Answer& alone = roll.alone;
  answer.status = alone.status;
  answer.verdict = alone.verdict;
  for (const PerFinger<Interval>& arc : alone.unresolved) answer.unresolved.push_back(arc[0]);
  if (alone.weighing) {
    answer.rest = alone.weighing->rest;
    answer.improbable = alone.weighing->improbable.size();
  }
  for (const Placement& placement : alone.placements) {
    if (!placement.is_contradicted) answer.poses.push_back(pose_of(roll, placement));
  }
}

}  // namespace rollfix::touch
