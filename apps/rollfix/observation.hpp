#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// What a finger's sensors said, however it was given.
struct Observation {
  std::vector<Reading> readings;
  std::vector<double> instants;  // of a log with times: of each reading, seconds
  std::vector<Rounding> roundings;
  bool lengths_turned_round = false;  // a log's lengths were along a clockwise outline
};

/// From --reading, each as typed. Throws InputError.
Observation observe_readings(const std::vector<std::string>& texts);

/// From a log at these instants; none: the last row. Throws InputError.
Observation observe_log(const Log& log, const Part& part, const std::optional<DiskFinger>& finger,
                        const std::vector<double>& instants);

/// --at as typed: T1,T2,... in seconds. Throws InputError.
std::vector<double> read_instants(const std::string& text);

}  // namespace rollfix::app
