#include "contact/log_table.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "text/text.hpp"

namespace rollfix {

namespace {

std::string_view bare(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') return trimmed(cell.substr(1, cell.size() - 2));
  return cell;
}

char separator_of(std::string_view row) {
  for (const char mark : {',', ';', '\t'}) {
    if (row.find(mark) != std::string_view::npos) return mark;
  }
  return ' ';
}

}  // namespace

bool TableCutter::cut(std::string_view line, std::size_t number, TableRow& row) {
  const std::string_view bare_line = line.substr(0, line.find('#'));
  const std::string_view data = trimmed(bare_line);
  if (data.empty()) return false;
  if (separator_ == '\0') separator_ = separator_of(data);
  row.line = number;
  row.text = line;
  split(separator_ == '\t' ? bare_line : data, row.cells);
  return true;
}

void TableCutter::split(std::string_view data, std::vector<std::string_view>& cells) const {
  cells.clear();
  while (true) {
    const std::size_t mark = separator_ == ' ' ? data.find_first_of(" \t") : data.find(separator_);
    cells.push_back(bare(data.substr(0, mark)));
    if (mark == std::string_view::npos) return;
    data.remove_prefix(mark + 1);
    if (separator_ == ' ') data = trimmed(data);
  }
}

bool TableReader::next(TableRow& row) {
  std::string_view line;
  while (lines_.next(line)) {
    if (cutter_.cut(line, ++line_, row)) return true;
  }
  return false;
}

std::string where(const std::string& name, std::size_t line) { return fmt::format("{}:{}", name, line); }

}  // namespace rollfix
