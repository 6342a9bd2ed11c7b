#include "text/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"
#include "work/pulse.hpp"

// Text to cells: a file through a buffer, lines, cells.
//   line            up to the next '\n', without it; valid until the next one is asked for
//   cell            between two separators, without blanks and quotes around it; the first row shows the separator
// Reading needs memory for one line, however long the file is.
namespace rollfix {
namespace {

constexpr std::size_t kLineBuffer = 1 << 16;  // bytes; it grows only for a line that is longer

}  // namespace

/// Refuses what is no table of text, each with its cure: UTF-16, gzip, old line ends, zero bytes.
std::string_view plain_beginning(std::string_view text, const std::string& name, std::string_view expected) {
  if (has_utf16_mark(text)) {
    throw InputError(fmt::format("{}: is UTF-16 text, expected plain text; save it as UTF-8", name));
  }
  if (is_gzip(text)) throw InputError(fmt::format("{}: is compressed, expected plain text: gunzip -k {}", name, name));
  if (has_only_returns(text)) throw InputError(about_only_returns(name));
  if (text.substr(0, 1024).find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}: is not a text file, expected {}", name, expected));
  }
  return without_mark(text);
}

TextLines::TextLines(std::string_view text, std::string name) : name_(std::move(name)) {
  text = plain_beginning(text, name_);
  cursor_ = text.data();
  end_ = text.data() + text.size();
}

TextLines::TextLines(std::FILE* file, std::string name, const std::string& first)
    : name_(std::move(name)), file_(file), buffer_(first) {
  buffer_.resize(std::max(kLineBuffer, first.size()));
  cursor_ = buffer_.data();
  end_ = cursor_ + first.size();
  // Something to judge by has to be there: the beginning, read now or before.
  if (first.empty()) refill();
  const auto size = static_cast<std::size_t>(end_ - cursor_);
  cursor_ = plain_beginning({cursor_, size}, name_).data();
}

/// Moves what is left to the front and reads on behind it; false at the end.
bool TextLines::refill() {
  if (file_ == nullptr) return false;
  const auto left = static_cast<std::size_t>(end_ - cursor_);
  // Invariant: [cursor_, end_) is what was read and not given out. It moves to the front; the buffer grows only if one
  // line fills it.
  std::memmove(buffer_.data(), cursor_, left);
  if (left == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::size_t count = std::fread(buffer_.data() + left, 1, buffer_.size() - left, file_);
  if (std::ferror(file_) != 0) throw InputError(fmt::format("{}: can't be read: {}", name_, std::strerror(errno)));
  cursor_ = buffer_.data();
  end_ = cursor_ + left + count;
  return count > 0;
}

bool TextLines::next(std::string_view& line) {
  beat();
  std::size_t seen = 0;  // of the line, without an end
  while (true) {
    // Only what was not searched yet is searched, so that a long line takes linear time.
    const auto rest = static_cast<std::size_t>(end_ - cursor_);
    const void* const found = rest > seen ? std::memchr(cursor_ + seen, '\n', rest - seen) : nullptr;
    if (found != nullptr) {
      const auto* const newline = static_cast<const char*>(found);
      line = {cursor_, static_cast<std::size_t>(newline - cursor_)};
      cursor_ = newline + 1;
      return true;
    }
    seen = rest;
    // No end in what was read: read on. At the end of the file the rest is the last line.
    if (refill()) continue;
    line = {cursor_, static_cast<std::size_t>(end_ - cursor_)};
    cursor_ = end_;
    return !line.empty();
  }
}

char separator_of(std::string_view row) {
  for (const char mark : {',', ';', '\t'}) {
    if (row.find(mark) != std::string_view::npos) return mark;
  }
  return ' ';
}

std::string_view unquoted(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') return trimmed(cell.substr(1, cell.size() - 2));
  return cell;
}

bool TableCutter::cut(std::string_view line, std::size_t number, TableRow& row) {
  // A comment goes to the end of its line.
  const std::string_view bare_line = line.substr(0, line.find('#'));
  const std::string_view data = trimmed(bare_line);
  if (data.empty()) return false;
  row.line = number;
  row.text = line;
  // Decimal commas are possible between semicolons, or where the options say so; between commas 0,5 is two cells.
  const bool may_have_commas = separator_ == '\0' || separator_ == ';' || decimal_comma_ == true;
  std::optional<std::string> converted;
  if (may_have_commas) converted = with_decimal_points(bare_line, decimal_comma_);
  if (converted) with_points_ = std::move(*converted);
  const std::string_view untrimmed = converted ? std::string_view(with_points_) : bare_line;
  // After the commas became points only semicolons can separate, if there are any.
  const bool has_semicolons = converted && untrimmed.find(';') != std::string_view::npos;
  // The first row decides for all.
  if (separator_ == '\0') separator_ = has_semicolons ? ';' : separator_of(trimmed(untrimmed));
  // Between tabs a cell at either end may be empty: blanks there are not trimmed off.
  split(separator_ == '\t' ? untrimmed : trimmed(untrimmed), row.cells);
  return true;
}

/// The cells of a row. Several blanks are one separator; of other marks each one is.
void TableCutter::split(std::string_view data, std::vector<std::string_view>& cells) const {
  cells.clear();
  while (true) {
    const std::size_t mark = separator_ == ' ' ? data.find_first_of(" \t") : data.find(separator_);
    cells.push_back(unquoted(data.substr(0, mark)));
    if (mark == std::string_view::npos) return;
    data.remove_prefix(mark + 1);
    // Blanks in a row are one separator.
    if (separator_ == ' ') data = trimmed(data);
  }
}

std::string where(const std::string& name, std::size_t line) { return fmt::format("{}:{}", name, line); }

}  // namespace rollfix
