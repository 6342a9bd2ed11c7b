#include "log_jumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "hold_facts.hpp"

namespace rollfix::hold {
namespace {

// The first rows, of which the search for jumps would take any for the roll, are looked at from behind.
constexpr std::size_t kFirstRows = 3;

/// Rows that jump away, from the log's first row on.
std::set<std::size_t> jumps_of(Log log, const HoldProblem& problem, std::size_t number) {
  log.fingers.front().line.clear();  // so that rows are told by their numbers
  std::vector<std::size_t> numbers;
  without_strays(log, problem.part, {finger_of_log(problem, number)}, *problem.noise, &numbers);
  std::set<std::size_t> rows;
  for (const std::size_t one : numbers) rows.insert(one - 1);
  return rows;
}

/// The same from the last row on, as if time went back.
std::set<std::size_t> jumps_backwards(const Log& log, const HoldProblem& problem, std::size_t number) {
  const std::size_t count = log.rows();
  std::vector<std::size_t> rows;
  for (std::size_t row = count; row > 0; --row) rows.push_back(row - 1);
  Log back = with_rows(log, rows);
  for (double& time : back.time) time = -time;
  std::set<std::size_t> found;
  for (const std::size_t row : jumps_of(std::move(back), problem, number)) found.insert(count - 1 - row);
  return found;
}

/// First those at the start, which would be taken for the roll, then the others.
std::set<std::size_t> jumps_in(const Log& log, const HoldProblem& problem, std::size_t number) {
  const std::set<std::size_t> backwards = jumps_backwards(log, problem, number);
  std::size_t start = 0;
  while (start < kFirstRows && backwards.contains(start)) ++start;
  std::vector<std::size_t> rows;
  for (std::size_t row = start; row < log.rows(); ++row) rows.push_back(row);
  std::set<std::size_t> found;
  for (std::size_t row = 0; row < start; ++row) found.insert(row);
  for (const std::size_t row : jumps_of(with_rows(log, rows), problem, number)) found.insert(start + row);
  return found;
}

std::string name_of_row(const Log& log, std::size_t row) {
  const std::vector<std::size_t>& lines = log.fingers.front().line;
  return row < lines.size() ? fmt::format("{}, line {}", log.name, lines[row])
                            : fmt::format("{}, row {}", log.name, row + 1);
}

}  // namespace

Log with_rows(const Log& log, const std::vector<std::size_t>& rows) {
  Log result = log;
  const auto choose = [&](auto& column, const auto& from) {
    if (from.size() != log.rows()) return;
    column.clear();
    for (const std::size_t row : rows) column.push_back(from[row]);
  };
  choose(result.time, log.time);
  const FingerRows& from = log.fingers.front();
  FingerRows& to = result.fingers.front();
  for (const auto column : {&FingerRows::u, &FingerRows::psi, &FingerRows::length, &FingerRows::turn, &FingerRows::x,
                            &FingerRows::y, &FingerRows::distance, &FingerRows::dturn}) {
    choose(to.*column, from.*column);
  }
  choose(to.line, from.line);
  return result;
}

std::vector<std::string> leave_out_jumps(const HoldProblem& problem, std::vector<Log>& logs) {
  std::set<std::size_t> out;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    for (const std::size_t row : jumps_in(logs[k], problem, k)) {
      names.push_back(name_of_row(logs[k], row));
      out.insert(row);
    }
  }
  if (out.empty()) return names;
  std::vector<std::size_t> kept;
  for (std::size_t row = 0; row < logs.front().rows(); ++row) {
    if (!out.contains(row)) kept.push_back(row);
  }
  for (Log& log : logs) log = with_rows(log, kept);
  return names;
}

}  // namespace rollfix::hold
