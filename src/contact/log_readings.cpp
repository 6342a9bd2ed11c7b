#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "contact/jump.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// "run.csv:12". Simulated rows have no lines: they are numbered.
std::string place_of(const Log& log, std::size_t row) {
  return row < log.line.size() ? fmt::format("{}:{}", log.name, log.line[row])
                               : fmt::format("{}, row {}", log.name, row + 1);
}

/// Throws InputError where u is beyond the ends of an open finger by more than rounding.
void require_on_finger(const Log& log, const Finger& finger, const Noise& noise) {
  const Interval ends = finger.ends();
  const double slack = end_slack(finger, log.place_rounding, noise);
  for (std::size_t row = 0; row < log.u.size(); ++row) {
    if (log.u[row] >= ends.lo - slack && log.u[row] <= ends.hi + slack) continue;
    throw InputError(fmt::format("{}: {}", place_of(log, row), off_finger(finger, log.u[row])));
  }
}

const Finger& require_finger(const Log& log, const std::optional<Finger>& finger) {
  if (!finger) {
    throw InputError(
        fmt::format("{}: u says where on the finger the contact is, expected the finger's shape as well: --finger "
                    "disk,r=0.01, with "
                    "the radius in the outline's unit",
                    log.name));
  }
  require_valid(*finger);
  return *finger;
}

/// How far from its own time a row may be taken: half the way to the nearer of its neighbours.
double reach_of(const std::vector<double>& time, std::size_t row) {
  double gap = std::numeric_limits<double>::infinity();
  if (row > 0) gap = std::min(gap, time[row] - time[row - 1]);
  if (row + 1 < time.size()) gap = std::min(gap, time[row + 1] - time[row]);
  return gap / 2;
}

std::size_t nearest_row(const std::vector<double>& time, double instant) {
  const auto after = std::lower_bound(time.begin(), time.end(), instant);
  if (after == time.begin()) return 0;
  const auto row = static_cast<std::size_t>(after - time.begin());
  if (row == time.size()) return row - 1;
  return instant - time[row - 1] <= time[row] - instant ? row - 1 : row;
}

[[noreturn]] void refuse_instant(const Log& log, double instant) {
  const auto after = std::upper_bound(log.time.begin(), log.time.end(), instant);
  const bool is_inside = after != log.time.begin() && after != log.time.end();
  const std::string found = is_inside ? fmt::format("whose nearest rows are at {} and {}", *(after - 1), *after)
                                      : fmt::format("which goes from {} to {}", log.time.front(), log.time.back());
  throw InputError(fmt::format(
      "{}: there is no row at the instant {} of this log, {}: expected an instant within half a row's distance of one",
      log.name, instant, found));
}

void require_no_jump(const Log& log, const std::vector<Reading>& all, JumpWatch watch) {
  const bool has_lines = log.line.size() == all.size();
  for (std::size_t row = 0; row < all.size(); ++row) {
    const auto time = log.time.empty() ? std::nullopt : std::optional<double>(log.time[row]);
    const auto why = watch.look(has_lines ? log.line[row] : row + 1, all[row > 0 ? row - 1 : 0], all[row], time);
    if (!why) continue;
    throw InputError(fmt::format("{}: expected a roll that goes on, found a jump: {}; split the log there",
                                 place_of(log, row), *why));
  }
}

}  // namespace

std::vector<std::size_t> rows_at(const Log& log, const std::vector<double>& times) {
  if (times.empty()) return {log.rows() - 1};
  if (log.time.empty()) {
    throw InputError(fmt::format("{}: has no column 'time', so that instants of it can't be chosen", log.name));
  }
  std::vector<std::size_t> rows;
  for (const double instant : times) {
    if (!std::isfinite(instant)) refuse_instant(log, instant);
    const std::size_t row = nearest_row(log.time, instant);
    if (!(std::abs(log.time[row] - instant) <= reach_of(log.time, row))) refuse_instant(log, instant);
    rows.push_back(row);
  }
  return rows;
}

std::vector<Reading> readings_as_given(const Log& log, const std::optional<Finger>& finger) {
  std::vector<Reading> result(log.rows());
  if (log.kind != LogKind::contact) {
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = {log.length[k], log.turn[k]};
    return result;
  }
  const Finger& shape = require_finger(log, finger);
  const std::vector<double> u = unwrapped(log.u, log.place_rounding, shape.period());
  const std::vector<double> psi = unwrapped(log.psi, log.angle_rounding);
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = reading_between(shape, {u.front(), psi.front()}, {u[k], psi[k]});
  }
  return result;
}

std::vector<Reading> readings(const Log& log, const Part& part, const std::optional<Finger>& finger,
                              const std::vector<double>& times, const Noise& noise) {
  std::vector<Reading> all = readings_as_given(log, finger);
  if (log.kind == LogKind::contact) require_on_finger(log, *finger, noise);
  // A contact log needs no change of direction: the finger rolls on the part, however that was drawn.
  if (log.kind != LogKind::contact) {
    for (Reading& reading : all) reading = in_stored_direction(reading, part);
  }
  require_no_jump(log, all, JumpWatch(part, StepError(log.kind, finger, noise)));
  std::vector<Reading> result;
  for (const std::size_t row : rows_at(log, times)) result.push_back(all[row]);
  return result;
}

Rounding rounding_of(const Log& log, const std::optional<Finger>& finger) {
  switch (log.kind) {
    case LogKind::contact: {
      const Finger& shape = require_finger(log, finger);
      return {2 * shape.length_per_u() * log.place_rounding,
              2 * (shape.turn_per_u() * log.place_rounding + log.angle_rounding)};
    }
    case LogKind::travelled:
      return {log.place_rounding, log.angle_rounding};
    case LogKind::increments:
      break;
  }
  const auto count = static_cast<double>(log.rows());
  return {count * log.place_rounding, count * log.angle_rounding};
}

}  // namespace rollfix
