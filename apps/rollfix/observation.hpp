#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/pair_log.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// What a finger's sensors said, however it was given.
struct Observation {
  std::vector<Reading> readings;
  std::vector<double> instants;   // of a log with times: of each reading, seconds
  std::vector<std::size_t> rows;  // of a log: all of them, for poses
  std::vector<double> times;      // of a log with times: of all its rows, seconds
  std::vector<Rounding> roundings;
  std::vector<Reading> rolls;         // of a log: all its rows as readings
  bool lengths_turned_round = false;  // a log's lengths were along a clockwise outline
};

/// The same of two fingers. A rounding's `length` is of both lengths together.
struct PairObservation {
  std::vector<PairReading> readings;
  std::vector<double> instants;
  std::vector<std::size_t> rows;
  std::vector<double> times;
  std::vector<Rounding> roundings;
  std::optional<double> facing;  // of a log with u and psi: at the first contacts; not more rounded than a turn
  std::vector<PairReading> rolls;
  bool lengths_turned_round = false;
};

/// How far the digits that were written can have moved any of the lengths.
double length_error_of(const std::vector<Rounding>& roundings);

/// From --reading, each as typed. Throws InputError.
Observation observe_readings(const std::vector<std::string>& texts);

/// From --reading and --facing, each as typed; no facing: "". Throws InputError.
PairObservation observe_pair_readings(const std::vector<std::string>& texts, const std::string& facing);

/// From a log at these instants; none: the last row. Throws InputError.
Observation observe_log(const Log& log, const Part& part, const std::optional<Finger>& finger,
                        const std::vector<double>& instants);

/// From two fingers' log at these instants; none: the middle row and the last. Throws InputError.
PairObservation observe_pair_log(const PairLog& log, const Part& part, const std::optional<FingerPair>& fingers,
                                 const std::vector<double>& instants);

/// What --log names, a log for each finger: one file of one finger or of two, or two files of one each. Two that
/// belong together are what `paired` makes of them. Throws InputError.
std::vector<Log> read_log_argument(const std::vector<std::string>& paths);

/// --at as typed: T1,T2,... in seconds. Throws InputError.
std::vector<double> read_instants(const std::string& text);

}  // namespace rollfix::app
