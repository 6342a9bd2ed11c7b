#include "observation.hpp"

#include <algorithm>

#include "corner_ways.hpp"
#include "finger_corners.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace {

std::vector<double> times_of(const Log& log, const std::vector<std::size_t>& rows) {
  std::vector<double> times;
  if (log.time.empty()) return times;
  for (const std::size_t row : rows) times.push_back(log.time[row]);
  return times;
}

Observation observe_readings(const Problem& problem) {
  if (!problem.at.empty()) throw InputError("`at` picks instants of a log: give a `log` as well");
  Observation observed;
  observed.readings = problem.felt.readings;
  observed.facing = problem.facing;
  observed.roundings = problem.felt.roundings;
  return observed;
}

Observation observe_log(const Problem& problem) {
  Observation observed;
  const Log& log = *problem.felt.log;
  observed.lengths_reversed = problem.part.reversed() && log.kind != LogKind::contact;
  const Noise noise = problem.noise.value_or(Noise{});
  observed.readings = readings(log, problem.part, problem.fingers, problem.at, noise);
  observed.roundings = {rounding_of(log, problem.fingers)};
  observed.facing = facing(log, problem.fingers);
  observed.rolls = readings_as_given(log, problem.fingers, noise);
  observed.on_corners = rows_on_corners(log, problem.fingers, noise);
  const std::vector<std::size_t> rows = rows_to_search(problem, observed.on_corners);
  observed.times = times_of(log, rows);
  if (!observed.on_corners.empty()) {
    observed.readings.clear();
    for (const std::size_t row : rows) observed.readings.push_back(observed.rolls[row]);
  }
  if (observed.lengths_reversed) {
    for (Reading& reading : observed.rolls) reading = in_stored_direction(reading, problem.part);
  }
  observed.pose_time = log.time;
  if (log.kind != LogKind::contact) return observed;
  observed.contacts = PerFinger<std::vector<Contact>>::of(log.fingers.size());
  for (std::size_t which = 0; which < log.fingers.size(); ++which) {
    (*observed.contacts)[which] = contacts_of(log.fingers[which], *finger_of(problem.fingers, which));
  }
  return observed;
}

}  // namespace

double Observation::length_error() const {
  double most = 0;
  for (const Rounding& rounding : roundings) most = std::max(most, rounding.length);
  return most;
}

Observation observe(const Problem& problem) {
  if (problem.felt.is_log() && problem.facing) {
    throw InputError("`facing` goes with `reading`: a log of two fingers has it in u and psi");
  }
  Observation observed = problem.felt.is_log() ? observe_log(problem) : observe_readings(problem);
  if (!problem.noise) put_on_corners(problem.part, observed.length_error(), observed.readings);
  return observed;
}

}  // namespace rollfix
