#include "rollfix/watch/beginning.hpp"

#include "log/log_table.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// How many bytes of text the line, not empty, begins with: a character, or a blank; 0: something else.
std::size_t text_length(std::string_view line) {
  const auto first = static_cast<unsigned char>(line.front());
  if (first == '\t' || first == '\r') return 1;
  return first < 0x20 || first == 0x7F ? 0 : utf8_length(line);
}

bool is_text(std::string_view line) {
  while (!line.empty()) {
    const std::size_t length = text_length(line);
    if (length == 0) return false;
    line.remove_prefix(length);
  }
  return true;
}

}  // namespace

std::string_view from_its_text(std::string_view line) {
  while (!line.empty() && text_length(line) == 0) line.remove_prefix(1);
  return line;
}

FirstLine first_line(std::string_view line) {
  if (!is_text(line)) return {FirstLine::Kind::garbage};
  TableCutter cutter(false);
  TableRow row;
  if (!cutter.cut(line, 1, row)) return {FirstLine::Kind::empty};
  if (is_data(row)) return {FirstLine::Kind::numbers, row.cells.size()};
  return {FirstLine::Kind::words};
}

}  // namespace rollfix::app
