#include "rollfix/contact/pair_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "part/angle.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

// Two clocks' readings of one instant may differ by this share of the roll's duration: rounding, not a delay.
constexpr double kSameInstant = 1e-9;

std::string columns_in(const Log& log) {
  switch (log.kind) {
    case LogKind::contact:
      return "u and psi";
    case LogKind::travelled:
      return "length and turn";
    case LogKind::increments:
      break;
  }
  return "distance and dturn";
}

std::string row_in_file(const Log& log, std::size_t row) { return fmt::format("{}:{}", log.name, log.line[row]); }

double duration_of(const Log& log) { return log.time.back() - log.time.front(); }

void require_same_kind(const Log& a, const Log& b) {
  if (a.kind != b.kind) {
    throw InputError(fmt::format("{} has {}, {} has {}: expected the same columns of both fingers", a.name,
                                 columns_in(a), b.name, columns_in(b)));
  }
  if (a.time.empty() != b.time.empty()) {
    throw InputError(fmt::format("{} has a column 'time' and {} has none: expected the same instants in both",
                                 a.time.empty() ? b.name : a.name, a.time.empty() ? a.name : b.name));
  }
}

std::vector<double> cut(const std::vector<double>& column, std::size_t from, std::size_t to) {
  if (column.empty()) return column;
  return {column.begin() + static_cast<std::ptrdiff_t>(from), column.begin() + static_cast<std::ptrdiff_t>(to)};
}

/// The rows of a log of u and psi that lie between these times.
void keep_between(Log& log, double first, double last) {
  const auto from =
      static_cast<std::size_t>(std::lower_bound(log.time.begin(), log.time.end(), first) - log.time.begin());
  const auto to = static_cast<std::size_t>(std::upper_bound(log.time.begin(), log.time.end(), last) - log.time.begin());
  if (to < from + 2) {
    throw InputError(
        fmt::format("{}: holds {} of a roll in which the other finger touches the part as well, expected "
                    "at least 2: the first contacts and where they went from there",
                    log.name, to <= from ? "no row" : "1 row"));
  }
  for (std::vector<double>* column : {&log.time, &log.u, &log.psi, &log.x, &log.y}) *column = cut(*column, from, to);
  log.line = {log.line.begin() + static_cast<std::ptrdiff_t>(from), log.line.begin() + static_cast<std::ptrdiff_t>(to)};
}

/// One finger may have found the part earlier or lost it later than the other.
void keep_common_contact(Log& a, Log& b) {
  const bool is_about_contact = a.contact_was_off || b.contact_was_off;
  if (!is_about_contact || a.kind != LogKind::contact || a.line == b.line) return;
  if (a.time.empty()) {
    throw InputError(
        fmt::format("{} and {}: rows without contact were left out and there is no column 'time', so that it is not "
                    "known which rows "
                    "belong together; add the times",
                    a.name, b.name));
  }
  const double slack = kSameInstant * std::max(duration_of(a), duration_of(b));
  const double first = std::max(a.time.front(), b.time.front()) - slack;
  const double last = std::min(a.time.back(), b.time.back()) + slack;
  keep_between(a, first, last);
  keep_between(b, first, last);
}

void require_same_times(const Log& a, const Log& b) {
  const double slack = a.time.empty() ? 0 : kSameInstant * std::max(duration_of(a), duration_of(b));
  const std::size_t both = std::min(a.time.size(), b.time.size());
  for (std::size_t k = 0; k < both; ++k) {
    if (std::abs(a.time[k] - b.time[k]) <= slack) continue;
    throw InputError(
        fmt::format("{} is at the time {} and {} at {}: expected the same times in both logs, row by row; resample one "
                    "of them",
                    row_in_file(a, k), a.time[k], row_in_file(b, k), b.time[k]));
  }
}

void require_same_rows(const Log& a, const Log& b) {
  if (a.rows() == b.rows()) return;
  const Log& longer = a.rows() > b.rows() ? a : b;
  const Log& shorter = a.rows() > b.rows() ? b : a;
  throw InputError(
      fmt::format("{} has {} rows and {} has {}: expected the same instants in both, but {} has no partner", a.name,
                  a.rows(), b.name, b.rows(), row_in_file(longer, shorter.rows())));
}

std::optional<Finger> one_of(const std::optional<FingerPair>& fingers, std::size_t which) {
  if (!fingers) return std::nullopt;
  return (*fingers)[which];
}

}  // namespace

PairLog paired(Log a, Log b) {
  require_same_kind(a, b);
  keep_common_contact(a, b);
  require_same_times(a, b);
  require_same_rows(a, b);
  return {std::move(a), std::move(b)};
}

PairLog parse_pair_log(std::string_view text, const std::string& name) {
  std::vector<Log> logs = parse_logs(text, name);
  if (logs.size() == 2) return paired(std::move(logs[0]), std::move(logs[1]));
  throw InputError(fmt::format(
      "{}: this log is of one finger, two are needed: give the other finger's log as well, or one file with "
      "columns such as 'u_a', 'psi_a', 'u_b' and 'psi_b'",
      name));
}

std::vector<std::size_t> rows_at(const PairLog& log, const std::vector<double>& times) {
  if (!times.empty()) return rows_at(log.a, times);
  const std::size_t last = log.rows() - 1;
  const std::size_t middle = last / 2;
  const std::size_t first_reading = log.a.kind == LogKind::contact ? 1 : 0;  // before it is the first contact
  if (middle < first_reading || middle == last) return {last};
  return {middle, last};
}

std::vector<Reading> readings_as_given(const PairLog& log, const std::optional<FingerPair>& fingers) {
  const std::vector<Reading> a = readings_as_given(log.a, one_of(fingers, 0));
  const std::vector<Reading> b = readings_as_given(log.b, one_of(fingers, 1));
  std::vector<Reading> result;
  result.reserve(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) result.push_back({a[k].length[0], b[k].length[0], a[k].turn - b[k].turn});
  return result;
}

std::vector<Reading> readings(const PairLog& log, const Part& part, const std::optional<FingerPair>& fingers,
                              const std::vector<double>& times) {
  const std::vector<Reading> all = readings_as_given(log, fingers);
  // As of one finger: u and psi do not know how the outline was drawn, and turns are the same either way.
  const bool is_turned_round = part.reversed() && log.a.kind != LogKind::contact;
  std::vector<Reading> result;
  for (const std::size_t row : rows_at(log, times)) {
    result.push_back(all[row]);
    if (!is_turned_round) continue;
    result.back().length[0] = -result.back().length[0];
    result.back().length[1] = -result.back().length[1];
  }
  return result;
}

std::optional<double> facing(const PairLog& log, const std::optional<FingerPair>& fingers) {
  if (log.a.kind != LogKind::contact || log.rows() == 0) return std::nullopt;
  const auto direction = [&](const Log& one, std::size_t which) {
    const Contact first{one.u.front(), one.psi.front()};
    return fingers ? facing((*fingers)[which], first) : first.facing();
  };
  return nearest_angle(direction(log.a, 0) - direction(log.b, 1));
}

Rounding rounding_of(const PairLog& log, const std::optional<FingerPair>& fingers) {
  const Rounding a = rounding_of(log.a, one_of(fingers, 0));
  const Rounding b = rounding_of(log.b, one_of(fingers, 1));
  return {a.length + b.length, a.turn + b.turn};
}

}  // namespace rollfix
