#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contact/log_columns.hpp"
#include "contact/log_lines.hpp"
#include "contact/log_rows.hpp"
#include "contact/log_table.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/error.hpp"
#include "text/text_file.hpp"

namespace rollfix {

namespace {

using RollLogs = std::vector<Log>;  // of one roll: a log for each finger

/// What a reader makes of contact that is lost and found again.
enum class Splitting { refused, into_rolls };

/// Rows that a roll needs, so that there is a reading.
std::size_t least_rows(LogKind kind, bool is_later_roll) {
  return kind == LogKind::contact || is_later_roll ? 2 : 1;  // else the first contact lies before the rows
}

/// Goes through the rows after the header. With two fingers there is contact where both touch.
class LogReader {
 public:
  LogReader(const std::string& name, const std::vector<Columns>& fingers, Splitting splitting)
      : name_(name), splitting_(splitting) {
    for (const Columns& columns : fingers) parsers_.emplace_back(name, columns);
    start_roll();
  }

  void take(const TableRow& row) {
    any_row_ = true;
    parsers_.front().require_width(row);
    const auto touching =
        std::count_if(parsers_.begin(), parsers_.end(), [&](const RowParser& finger) { return finger.touches(row); });
    const std::optional<double> time = parsers_.front().time(row);
    parsers_.front().keep(time, row.line);
    if (static_cast<std::size_t>(touching) < parsers_.size()) {
      any_without_contact_ = true;
      if (rows() > 0 && lost_line_ == 0) lost_line_ = row.line;
      return;
    }
    if (lost_line_ != 0) find_again(row.line);
    for (std::size_t k = 0; k < parsers_.size(); ++k) fingers_[k].add(parsers_[k].parse(row), time);
  }

  std::vector<RollLogs> finish() {
    const std::size_t last_rows = rows();
    end_roll();
    if (rolls_.empty()) {
      const std::size_t least = least_rows(parsers_.front().columns().kind, false);
      const bool none_in_contact = last_rows == 0 && any_row_;
      throw InputError(fmt::format("{}: holds {} row{} of a roll{}, expected at least {}", name_, last_rows,
                                   last_rows == 1 ? "" : "s", none_in_contact ? " in contact" : "",
                                   least == 2 ? "2: the first contact and where it went from there" : "1"));
    }
    for (RollLogs& roll : rolls_) {
      for (Log& log : roll) {
        log.contact_was_off = any_without_contact_;
        if (rolls_.size() > 1) log.name += fmt::format(", lines {} to {}", log.line.front(), log.line.back());
      }
    }
    return std::move(rolls_);
  }

 private:
  std::size_t rows() { return fingers_.front().log().rows(); }

  void start_roll() {
    fingers_.clear();
    for (const RowParser& parser : parsers_) fingers_.emplace_back(name_, parser.columns(), is_later_roll_);
  }

  /// Keeps the roll, unless it is too short to be one.
  void end_roll() {
    if (rows() < least_rows(parsers_.front().columns().kind, is_later_roll_)) return;
    rolls_.emplace_back();
    for (LogRows& finger : fingers_) rolls_.back().push_back(std::move(finger.log()));
  }

  void find_again(std::size_t line) {
    if (splitting_ == Splitting::refused) {
      throw InputError(
          fmt::format("{}: contact is lost here and found again in line {}, expected one unbroken roll; "
                      "split the log there, or choose one of its rolls with --roll",
                      where(name_, lost_line_), line));
    }
    end_roll();
    is_later_roll_ = true;
    lost_line_ = 0;
    start_roll();
  }

  std::string name_;
  Splitting splitting_;
  std::vector<RowParser> parsers_;
  std::vector<LogRows> fingers_;
  std::vector<RollLogs> rolls_;
  std::size_t lost_line_ = 0;
  bool is_later_roll_ = false;
  bool any_row_ = false;
  bool any_without_contact_ = false;
};

std::string name_of(const std::string& path) { return path == "-" ? "standard input" : path; }

std::vector<RollLogs> parse(LogLines& lines, std::size_t most_fingers, Splitting splitting) {
  const std::string& name = lines.name();
  TableReader reader(lines);
  TableRow row;
  if (!reader.next(row)) {
    throw InputError(fmt::format("{}: is empty, expected a log with a header such as 'time,u,psi'", name));
  }
  const bool is_bare = is_data(row);
  std::vector<Columns> fingers;
  if (is_bare) {
    fingers.push_back(bare_columns(row, name));
  } else {
    fingers = columns_of(row, name);
  }
  if (fingers.size() > most_fingers) {
    throw InputError(
        fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", where(name, row.line)));
  }
  LogReader log(name, fingers, splitting);
  if (is_bare) log.take(row);
  while (reader.next(row)) log.take(row);
  return log.finish();
}

std::vector<RollLogs> parse_text(std::string_view text, const std::string& name, std::size_t most_fingers,
                                 Splitting splitting) {
  LogLines lines(text, name);
  return parse(lines, most_fingers, splitting);
}

std::vector<RollLogs> parse_file(const std::string& path, std::size_t most_fingers, Splitting splitting) {
  const OpenFile file = open_text(path);
  LogLines lines(file.get(), name_of(path));
  return parse(lines, most_fingers, splitting);
}

std::vector<Log> firsts_of(std::vector<RollLogs> rolls) {
  std::vector<Log> logs;
  for (RollLogs& roll : rolls) logs.push_back(std::move(roll.front()));
  return logs;
}

}  // namespace

Log parse_log(std::string_view text, const std::string& name) {
  return std::move(parse_text(text, name, 1, Splitting::refused).front().front());
}

Log read_log(const std::string& path) { return std::move(parse_file(path, 1, Splitting::refused).front().front()); }

std::vector<Log> parse_logs(std::string_view text, const std::string& name) {
  return std::move(parse_text(text, name, 2, Splitting::refused).front());
}

std::vector<Log> read_logs(const std::string& path) {
  return std::move(parse_file(path, 2, Splitting::refused).front());
}

std::vector<Log> parse_rolls(std::string_view text, const std::string& name) {
  return firsts_of(parse_text(text, name, 1, Splitting::into_rolls));
}

std::vector<Log> read_rolls(const std::string& path) { return firsts_of(parse_file(path, 1, Splitting::into_rolls)); }

std::vector<std::vector<Log>> parse_rolls_of_fingers(std::string_view text, const std::string& name) {
  return parse_text(text, name, 2, Splitting::into_rolls);
}

std::vector<std::vector<Log>> read_rolls_of_fingers(const std::string& path) {
  return parse_file(path, 2, Splitting::into_rolls);
}

}  // namespace rollfix
