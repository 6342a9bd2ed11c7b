#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix {

/// The text of a table: one row per line, `#` comments and blank lines left out.
struct TableRow {
  std::size_t line = 0;                 // number in the file, from 1
  std::string_view text;                // as it stands there, for messages
  std::vector<std::string_view> cells;  // without blanks and quotes around them
};

/// Goes through the rows of a comma, semicolon, tab or blank separated table: the first row shows which it is.
class TableReader {
 public:
  /// Throws InputError when the text is not plain text. `name` is what messages call it. The text must stay.
  TableReader(std::string_view text, std::string name);

  /// The next row, false at the end. The cells of a row are reused for the next.
  bool next(TableRow& row);

  /// "run.csv:12", for messages.
  std::string where(std::size_t line) const;
  const std::string& name() const { return name_; }

 private:
  void split(std::string_view data, std::vector<std::string_view>& cells) const;

  std::string name_;
  const char* cursor_;
  const char* end_;
  std::size_t line_ = 0;
  char separator_ = '\0';  // not known yet
};

/// A piece of a file as a message can show it: on one line, not too long.
std::string shown(std::string_view text);

}  // namespace rollfix
