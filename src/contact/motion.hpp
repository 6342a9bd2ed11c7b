#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "contact/track.hpp"
#include "rollfix/contact/rolling.hpp"

namespace rollfix {

/// A plan made definite for one part: where it starts, and how the finger turns over time.
struct Motion {
  TrackPlace start;
  double start_angle = 0;               // of the tangent
  Contact first;                        // what the sensors say there
  double duration = 0;                  // seconds
  double velocity = 0;                  // rad/s, where it is constant
  std::function<double(double)> omega;  // where it is not

  double omega_at(double time) const { return omega ? omega(time) : velocity; }
};

/// Throws InputError: a plan that contradicts itself or that the finger can't follow.
Motion plan_motion(const Track& track, const RollPlan& plan);

/// Equal times from 0 to the end.
std::vector<double> times_of(const Motion& motion, std::size_t rows);

/// The integral of a rate from the first of these times to each.
std::vector<double> integrals(const std::function<double(double)>& rate, const std::vector<double>& times);

/// One instant of a roll.
struct RollState {
  Contact contact;
  double s = 0;
  double angle = 0;  // of the tangent
};

/// One way to find the roll at these times: eqs. (1) and (2) integrated, or the closed form that they imply.
using Solve = std::vector<RollState> (*)(const Track&, const Motion&, const std::vector<double>& times);
std::vector<RollState> integrated(const Track& track, const Motion& motion, const std::vector<double>& times);
std::vector<RollState> in_closed_form(const Track& track, const Motion& motion, const std::vector<double>& times);

}  // namespace rollfix
