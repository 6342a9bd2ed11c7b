#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace rollfix::app {

/// Longer than any row of a log: what has no line end up to here is something else, and is not kept.
inline constexpr std::size_t kLongestLine = std::size_t{64} * 1024;

/// One line, without its line end.
struct ReadLine {
  std::string_view text;
  bool too_long = false;  // then `text` is its beginning
};

/// Cuts bytes into lines as they come, in constant memory: a line that has begun waits for its end.
class LineBuffer {
 public:
  void append(std::string_view bytes);

  /// The next line that is complete; valid until the next call of any of these.
  std::optional<ReadLine> next();

  /// No more bytes will come: what is left without a line end is a line as well.
  std::optional<ReadLine> last();

  /// A line that has begun will not be continued.
  void drop_partial();

 private:
  std::optional<ReadLine> cut(std::size_t end, std::size_t next_start);

  std::string bytes_;
  std::size_t start_ = 0;    // of the next line in bytes_
  std::size_t scanned_ = 0;  // no line end in [start_, scanned_)
  bool skipping_ = false;    // until the end of a line that was too long
};

}  // namespace rollfix::app
