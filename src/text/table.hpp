#pragma once

#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix {

/// Goes through the lines of a text, or of a file through a buffer that does not grow with the file.
class TextLines {
 public:
  /// `name` is what messages call it. The text, or the file, must stay. `first`: what was read of the file already.
  /// Throws InputError when it is not plain text.
  TextLines(std::string_view text, std::string name);
  TextLines(std::FILE* file, std::string name, const std::string& first = "");
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// The next line without its end, good until the next call; false behind the last. Throws InputError: can't be read.
  bool next(std::string_view& line);

  const std::string& name() const { return name_; }

 private:
  bool refill();

  std::string name_;
  std::FILE* file_ = nullptr;     // none: a text
  std::string buffer_;            // a piece of the file
  const char* cursor_ = nullptr;  // what was not given out yet: [cursor_, end_)
  const char* end_ = nullptr;
};

/// Takes the byte order mark off the beginning of a table. Throws InputError when it does not begin like plain text,
/// but was `expected` to be one.
std::string_view plain_beginning(std::string_view text, const std::string& name,
                                 std::string_view expected = "a log with one row per line");

/// What separates the cells of this row: a comma, a semicolon or a tab if it has one, in this order, else blanks.
char separator_of(std::string_view row);

/// A cell without blanks and without quotes around it, which spreadsheets write.
std::string_view unquoted(std::string_view cell);

/// The text of a table: one row per line, `#` comments and blank lines left out.
struct TableRow {
  std::size_t line = 0;                 // number in the file, from 1
  std::string_view text;                // as it stands there, for messages
  std::vector<std::string_view> cells;  // without blanks and quotes around them
};

/// Cuts the lines of a comma, semicolon, tab or blank separated table into cells: the first row shows which it is.
class TableCutter {
 public:
  /// `decimal_comma`: as in the options of a log.
  explicit TableCutter(std::optional<bool> decimal_comma) : decimal_comma_(decimal_comma) {}

  /// Makes a row of the line, false where there is none in it. The row refers to the line, or to what this holds until
  /// the next one.
  bool cut(std::string_view line, std::size_t number, TableRow& row);

  /// The next row shows anew what separates.
  void forget() { separator_ = '\0'; }

 private:
  void split(std::string_view data, std::vector<std::string_view>& cells) const;

  std::optional<bool> decimal_comma_;
  char separator_ = '\0';    // not known yet
  std::string with_points_;  // of a row with decimal commas
};

/// "run.csv:12", for messages.
std::string where(const std::string& name, std::size_t line);

}  // namespace rollfix
