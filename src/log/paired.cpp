#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "log/log_rows.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "text/text.hpp"

// Two logs, of a finger each, as one of both.
namespace rollfix {
namespace {

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

/// Simulated rows come from no file.
std::string row_in_file(const Log& log, std::size_t row) {
  const std::vector<std::size_t>& line = log.fingers[0].line;
  return line.empty() ? fmt::format("{}, row {}", log.name, row + 1) : where(log.name, line[row]);
}

double duration_of(const Log& log) { return log.time.back() - log.time.front(); }

void require_one_finger(const Log& log) {
  if (log.fingers.size() == 1) return;
  throw InputError(fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", log.name));
}

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

template <class Column>
void keep(Column& column, std::size_t from, std::size_t to) {
  if (column.empty()) return;
  column.erase(column.begin() + static_cast<std::ptrdiff_t>(to), column.end());
  column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(from));
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
  FingerRows& rows = log.fingers[0];
  for (std::vector<double>* column : {&log.time, &rows.u, &rows.psi, &rows.x, &rows.y}) keep(*column, from, to);
  keep(rows.line, from, to);
}

/// One finger may have found the part earlier or lost it later than the other.
void keep_common_contact(Log& a, Log& b) {
  const bool is_about_contact = a.contact_was_off || b.contact_was_off;
  if (!is_about_contact || a.kind != LogKind::contact || a.fingers[0].line == b.fingers[0].line) return;
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

}  // namespace

Log paired(Log a, Log b) {
  require_one_finger(a);
  require_one_finger(b);
  require_same_kind(a, b);
  keep_common_contact(a, b);
  require_same_times(a, b);
  require_same_rows(a, b);
  a.fingers[0].name = a.name;
  b.fingers[0].name = b.name;
  a.fingers.push_back(std::move(b.fingers[0]));
  a.contact_was_off = a.contact_was_off || b.contact_was_off;
  a.skipped.insert(a.skipped.end(), b.skipped.begin(), b.skipped.end());
  a.notes.clear();  // each was of one finger
  return a;
}

}  // namespace rollfix
