#include "contact/log_table.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

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

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 60;
  text = trimmed(text);
  std::string result(text.substr(0, kMost));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';
  }
  return text.size() > kMost ? result + "..." : result;
}

TableReader::TableReader(std::string_view text, std::string name) : name_(std::move(name)) {
  const std::string_view mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") {
    throw InputError(fmt::format("{}: is UTF-16 text, expected plain text; save it as UTF-8", name_));
  }
  if (text.substr(0, 1024).find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}: is not a text file, expected a log with one row per line", name_));
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  cursor_ = text.data();
  end_ = text.data() + text.size();
}

bool TableReader::next(TableRow& row) {
  while (cursor_ != end_) {
    ++line_;
    const auto rest = static_cast<std::size_t>(end_ - cursor_);
    const auto* const newline = static_cast<const char*>(std::memchr(cursor_, '\n', rest));
    const char* const line_end = newline != nullptr ? newline : end_;
    const std::string_view text(cursor_, static_cast<std::size_t>(line_end - cursor_));
    cursor_ = newline != nullptr ? newline + 1 : end_;

    const std::string_view data = trimmed(text.substr(0, text.find('#')));
    if (data.empty()) continue;
    if (separator_ == '\0') separator_ = separator_of(data);
    row.line = line_;
    row.text = text;
    split(separator_ == '\t' ? text.substr(0, text.find('#')) : data, row.cells);
    return true;
  }
  return false;
}

void TableReader::split(std::string_view data, std::vector<std::string_view>& cells) const {
  cells.clear();
  while (true) {
    const std::size_t mark = separator_ == ' ' ? data.find_first_of(" \t") : data.find(separator_);
    cells.push_back(bare(data.substr(0, mark)));
    if (mark == std::string_view::npos) return;
    data.remove_prefix(mark + 1);
    if (separator_ == ' ') data = trimmed(data);
  }
}

std::string TableReader::where(std::size_t line) const { return fmt::format("{}:{}", name_, line); }

}  // namespace rollfix
