#include "rollfix/observation.hpp"

#include <fmt/format.h>

#include "rollfix/reading_argument.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {

Observation observe_readings(const std::vector<std::string>& texts) {
  Observation observation;
  for (const std::string& text : texts) {
    const WrittenReading written = read_reading(text);
    observation.readings.push_back(written.reading);
    observation.roundings.push_back(written.rounding);
  }
  return observation;
}

Observation observe_log(const Log& log, const Part& part, const std::optional<DiskFinger>& finger,
                        const std::vector<double>& instants) {
  Observation observation;
  observation.readings = readings(log, part, finger, instants);
  observation.roundings = {rounding_of(log, finger)};
  observation.lengths_turned_round = part.reversed() && log.kind != LogKind::contact;
  if (log.time.empty()) return observation;
  for (const std::size_t row : rows_at(log, instants)) observation.instants.push_back(log.time[row]);
  return observation;
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
