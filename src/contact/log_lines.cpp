#include "contact/log_lines.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

constexpr std::size_t kLogBuffer = 1 << 16;  // bytes; it grows only for a line that is longer

}  // namespace

std::string_view plain_beginning(std::string_view text, const std::string& name) {
  const std::string_view mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF") {
    throw InputError(fmt::format("{}: is UTF-16 text, expected plain text; save it as UTF-8", name));
  }
  if (text.substr(0, 1024).find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}: is not a text file, expected a log with one row per line", name));
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  return text;
}

LogLines::LogLines(std::string_view text, std::string name) : name_(std::move(name)) {
  text = plain_beginning(text, name_);
  cursor_ = text.data();
  end_ = text.data() + text.size();
}

LogLines::LogLines(std::FILE* file, std::string name) : name_(std::move(name)), file_(file), buffer_(kLogBuffer, '\0') {
  cursor_ = end_ = buffer_.data();
  refill();
  const auto size = static_cast<std::size_t>(end_ - cursor_);
  cursor_ = plain_beginning({cursor_, size}, name_).data();
}

/// Moves what is left to the front and reads on behind it; false at the end.
bool LogLines::refill() {
  if (file_ == nullptr) return false;
  const auto left = static_cast<std::size_t>(end_ - cursor_);
  std::memmove(buffer_.data(), cursor_, left);
  if (left == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const std::size_t count = std::fread(buffer_.data() + left, 1, buffer_.size() - left, file_);
  if (std::ferror(file_) != 0) throw InputError(fmt::format("{}: can't be read: {}", name_, std::strerror(errno)));
  cursor_ = buffer_.data();
  end_ = cursor_ + left + count;
  return count > 0;
}

bool LogLines::next(std::string_view& line) {
  std::size_t seen = 0;  // of the line, without an end
  while (true) {
    const auto rest = static_cast<std::size_t>(end_ - cursor_);
    const void* const found = rest > seen ? std::memchr(cursor_ + seen, '\n', rest - seen) : nullptr;
    if (found != nullptr) {
      const auto* const newline = static_cast<const char*>(found);
      line = {cursor_, static_cast<std::size_t>(newline - cursor_)};
      cursor_ = newline + 1;
      return true;
    }
    seen = rest;
    if (refill()) continue;
    line = {cursor_, static_cast<std::size_t>(end_ - cursor_)};
    cursor_ = end_;
    return !line.empty();
  }
}

}  // namespace rollfix
