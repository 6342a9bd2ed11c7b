#include "rollfix/observation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "rollfix/error.hpp"
#include "rollfix/reading_argument.hpp"
#include "rollfix/typed_number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// The times of these rows, where the log has times.
std::vector<double> times_of(const Log& log, const std::vector<std::size_t>& rows) {
  std::vector<double> times;
  if (log.time.empty()) return times;
  for (const std::size_t row : rows) times.push_back(log.time[row]);
  return times;
}

std::vector<std::size_t> all_rows(std::size_t count) {
  std::vector<std::size_t> rows(count);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  return rows;
}

}  // namespace

double length_error_of(const std::vector<Rounding>& roundings) {
  double most = 0;
  for (const Rounding& rounding : roundings) most = std::max(most, rounding.length);
  return most;
}

Observation observe_readings(const std::vector<std::string>& texts) {
  Observation observation;
  for (const std::string& text : texts) {
    const WrittenReading written = read_reading(text);
    observation.readings.push_back(written.reading);
    observation.roundings.push_back(written.rounding);
  }
  return observation;
}

PairObservation observe_pair_readings(const std::vector<std::string>& texts, const std::string& facing) {
  PairObservation observation;
  for (const std::string& text : texts) {
    const WrittenPairReading written = read_pair_reading(text);
    observation.readings.push_back(written.reading);
    observation.roundings.push_back(written.rounding);
  }
  if (!facing.empty()) {
    const WrittenAngle written = read_written_angle(facing, "--facing");
    observation.facing = written.angle;
    observation.roundings.push_back({0, written.rounding});
  }
  return observation;
}

Observation observe_log(const Log& log, const Part& part, const std::optional<Finger>& finger,
                        const std::vector<double>& instants) {
  Observation observation;
  observation.readings = readings(log, part, finger, instants);
  observation.roundings = {rounding_of(log, finger)};
  observation.lengths_turned_round = part.reversed() && log.kind != LogKind::contact;
  observation.rolls = readings_as_given(log, finger);
  if (observation.lengths_turned_round) {
    for (Reading& reading : observation.rolls) reading = in_stored_direction(reading, part);
  }
  observation.rows = all_rows(log.rows());
  observation.times = log.time;
  observation.instants = times_of(log, rows_at(log, instants));
  return observation;
}

PairObservation observe_pair_log(const PairLog& log, const Part& part, const std::optional<FingerPair>& fingers,
                                 const std::vector<double>& instants) {
  PairObservation observation;
  observation.readings = readings(log, part, fingers, instants);
  observation.roundings = {rounding_of(log, fingers)};
  observation.facing = facing(log, fingers);
  observation.lengths_turned_round = part.reversed() && log.a.kind != LogKind::contact;
  observation.rolls = readings_as_given(log, fingers);
  if (observation.lengths_turned_round) {
    for (PairReading& reading : observation.rolls) {
      reading.length_a = -reading.length_a;
      reading.length_b = -reading.length_b;
    }
  }
  observation.rows = all_rows(log.rows());
  observation.times = log.a.time;
  observation.instants = times_of(log.a, rows_at(log, instants));
  return observation;
}

std::vector<Log> read_log_argument(const std::vector<std::string>& paths) {
  if (paths.size() == 1) return read_logs(paths.front());
  if (paths.size() != 2) {
    throw InputError(
        fmt::format("--log is given {} times, expected one log, or one of each of two fingers", paths.size()));
  }
  const PairLog log = read_pair_log(paths.front(), paths.back());
  return {log.a, log.b};
}

std::vector<double> read_instants(const std::string& text) {
  std::vector<double> instants;
  if (text.empty()) return instants;
  for (const std::string_view field : split(text, ',')) {
    instants.push_back(read_number(field, fmt::format("--at {}", text)));
  }
  return instants;
}

}  // namespace rollfix::app
