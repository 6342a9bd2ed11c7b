#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "contact/log_lines.hpp"
#include "text/text.hpp"

namespace rollfix {

/// The text of a table: one row per line, `#` comments and blank lines left out.
struct TableRow {
  std::size_t line = 0;                 // number in the file, from 1
  std::string_view text;                // as it stands there, for messages
  std::vector<std::string_view> cells;  // without blanks and quotes around them
};

/// Cuts the lines of a comma, semicolon, tab or blank separated table into cells: the first row shows which it is.
class TableCutter {
 public:
  /// Makes a row of the line, false where there is none in it. The row refers to the line.
  bool cut(std::string_view line, std::size_t number, TableRow& row);

  /// The next row shows anew what separates.
  void forget() { separator_ = '\0'; }

 private:
  void split(std::string_view data, std::vector<std::string_view>& cells) const;

  char separator_ = '\0';  // not known yet
};

/// Goes through the rows of such a table.
class TableReader {
 public:
  /// The lines must stay.
  explicit TableReader(LogLines& lines) : lines_(lines) {}

  /// The next row, false at the end. It is good until the next call.
  bool next(TableRow& row);

  const std::string& name() const { return lines_.name(); }

 private:
  LogLines& lines_;
  TableCutter cutter_;
  std::size_t line_ = 0;
};

/// "run.csv:12", for messages.
std::string where(const std::string& name, std::size_t line);

}  // namespace rollfix
