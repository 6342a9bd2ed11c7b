#include "observation.hpp"

#include <algorithm>

#include "rollfix/contact/pair_log.hpp"
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
  if (!problem.at.empty()) throw InputError("`at`: picks instants of a log, found readings");
  Observation observed;
  observed.readings = problem.felt.readings;
  observed.facing = problem.facing;
  observed.roundings = problem.felt.roundings;
  return observed;
}

std::optional<Finger> only_finger(const std::vector<Finger>& fingers) {
  return fingers.empty() ? std::nullopt : std::optional<Finger>(fingers.front());
}

std::optional<FingerPair> both_fingers(const std::vector<Finger>& fingers) {
  return fingers.empty() ? std::nullopt : std::optional<FingerPair>(FingerPair{fingers.front(), fingers.back()});
}

Observation observe_log(const Problem& problem) {
  Observation observed;
  const Log& first = problem.felt.logs.front();
  observed.lengths_reversed = problem.part.reversed() && first.kind != LogKind::contact;
  if (problem.felt.logs.size() == 1) {
    const std::optional<Finger> finger = only_finger(problem.fingers);
    observed.readings = readings(first, problem.part, finger, problem.at);
    observed.roundings = {rounding_of(first, finger)};
    observed.rolls = readings_as_given(first, finger);
    observed.times = times_of(first, rows_at(first, problem.at));
  } else {
    const PairLog log{first, problem.felt.logs.back()};
    const std::optional<FingerPair> fingers = both_fingers(problem.fingers);
    observed.readings = readings(log, problem.part, fingers, problem.at);
    observed.roundings = {rounding_of(log, fingers)};
    observed.facing = facing(log, fingers);
    observed.rolls = readings_as_given(log, fingers);
    observed.times = times_of(first, rows_at(log, problem.at));
  }
  if (observed.lengths_reversed) {
    for (Reading& reading : observed.rolls) reading = in_stored_direction(reading, problem.part);
  }
  observed.pose_time = first.time;
  return observed;
}

}  // namespace

double Observation::length_error() const {
  double most = 0;
  for (const Rounding& rounding : roundings) most = std::max(most, rounding.length);
  return most;
}

Observation observe(const Problem& problem) {
  if (!problem.felt.is_log()) return observe_readings(problem);
  if (problem.facing) throw InputError("`facing`: goes with readings; a log of two fingers has it in u and psi");
  return observe_log(problem);
}

}  // namespace rollfix
