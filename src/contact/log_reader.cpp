#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contact/log_columns.hpp"
#include "contact/log_rows.hpp"
#include "contact/log_table.hpp"
#include "outline/text_file.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// Goes through the rows after the header. With two fingers there is contact where both touch.
class LogReader {
 public:
  LogReader(const TableReader& reader, const std::vector<Columns>& fingers) : reader_(reader) {
    for (const Columns& columns : fingers) fingers_.emplace_back(reader, columns);
  }

  void take(const TableRow& row) {
    require_width(row);
    const auto touching =
        std::count_if(fingers_.begin(), fingers_.end(), [&](const LogRows& finger) { return finger.touches(row); });
    const std::optional<double> time = fingers_.front().time(row);
    if (static_cast<std::size_t>(touching) < fingers_.size()) {
      any_without_contact_ = true;
      if (rows() > 0 && lost_line_ == 0) lost_line_ = row.line;
      return;
    }
    if (lost_line_ != 0) {
      throw InputError(fmt::format(
          "{}: contact is lost here and found again in line {}, expected one unbroken roll; split the log there",
          reader_.where(lost_line_), row.line));
    }
    for (LogRows& finger : fingers_) finger.add(row, time);
  }

  std::vector<Log> finish() {
    const std::size_t least = fingers_.front().log().kind == LogKind::contact ? 2 : 1;
    if (rows() < least) {
      const bool none_in_contact = rows() == 0 && any_row_;
      throw InputError(fmt::format("{}: holds {} row{} of a roll{}, expected at least {}", reader_.name(), rows(),
                                   rows() == 1 ? "" : "s", none_in_contact ? " in contact" : "",
                                   least == 2 ? "2: the first contact and where it went from there" : "1"));
    }
    std::vector<Log> logs;
    for (LogRows& finger : fingers_) {
      finger.log().contact_was_off = any_without_contact_;
      logs.push_back(std::move(finger.log()));
    }
    return logs;
  }

 private:
  std::size_t rows() { return fingers_.front().log().rows(); }

  void require_width(const TableRow& row) {
    any_row_ = true;
    const std::size_t count = fingers_.front().columns().count;
    for (std::size_t k = count; k < row.cells.size(); ++k) {
      if (row.cells[k].empty()) continue;
      throw InputError(fmt::format(
          "{}: '{}' has {} cells, expected {} as in the first row; numbers take a decimal point, not a comma",
          reader_.where(row.line), shown(row.text), row.cells.size(), count));
    }
  }

  const TableReader& reader_;
  std::vector<LogRows> fingers_;
  std::size_t lost_line_ = 0;
  bool any_row_ = false;
  bool any_without_contact_ = false;
};

std::string name_of(const std::string& path) { return path == "-" ? "standard input" : path; }

std::vector<Log> parse(std::string_view text, const std::string& name, std::size_t most_fingers) {
  TableReader reader(text, name);
  TableRow row;
  if (!reader.next(row)) {
    throw InputError(fmt::format("{}: is empty, expected a log with a header such as 'time,u,psi'", name));
  }
  const bool is_bare = is_data(row);
  std::vector<Columns> fingers;
  if (is_bare) {
    fingers.push_back(bare_columns(row, reader));
  } else {
    fingers = columns_of(row, reader);
  }
  if (fingers.size() > most_fingers) {
    throw InputError(
        fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", reader.where(row.line)));
  }
  LogReader log(reader, fingers);
  if (is_bare) log.take(row);
  while (reader.next(row)) log.take(row);
  return log.finish();
}

}  // namespace

std::vector<Log> parse_logs(std::string_view text, const std::string& name) { return parse(text, name, 2); }

Log parse_log(std::string_view text, const std::string& name) { return std::move(parse(text, name, 1).front()); }

std::vector<Log> read_logs(const std::string& path) { return parse_logs(read_text(path), name_of(path)); }

Log read_log(const std::string& path) { return parse_log(read_text(path), name_of(path)); }

}  // namespace rollfix
