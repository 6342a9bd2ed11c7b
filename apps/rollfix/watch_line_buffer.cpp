#include "rollfix/watch_line_buffer.hpp"

#include <algorithm>

namespace rollfix::app {

void LineBuffer::append(std::string_view bytes) {
  bytes_.erase(0, start_);
  scanned_ -= start_;
  start_ = 0;
  bytes_.append(bytes);
}

std::optional<ReadLine> LineBuffer::next() {
  for (;;) {
    const std::size_t end = bytes_.find('\n', scanned_);
    if (end != std::string::npos) {
      const std::optional<ReadLine> line = cut(end, end + 1);
      if (line) return line;
      continue;
    }
    scanned_ = bytes_.size();
    if (skipping_) {
      start_ = scanned_;
    } else if (scanned_ - start_ > kLongestLine) {
      skipping_ = true;
      const std::string_view beginning = std::string_view(bytes_).substr(start_, kLongestLine);
      start_ = scanned_;
      return ReadLine{beginning, true};
    }
    return std::nullopt;
  }
}

std::optional<ReadLine> LineBuffer::last() {
  if (start_ == bytes_.size()) return std::nullopt;
  return cut(bytes_.size(), bytes_.size());
}

void LineBuffer::drop_partial() {
  start_ = scanned_ = bytes_.size();
  skipping_ = false;
}

/// The line up to `end`; nothing when it is the rest of one that was too long.
std::optional<ReadLine> LineBuffer::cut(std::size_t end, std::size_t next_start) {
  std::string_view text = std::string_view(bytes_).substr(start_, end - start_);
  start_ = scanned_ = next_start;
  if (skipping_) {
    skipping_ = false;
    return std::nullopt;
  }
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return ReadLine{text.substr(0, kLongestLine), text.size() > kLongestLine};
}

}  // namespace rollfix::app
