#include "rollfix/watch/two_logs.hpp"

#include <fmt/format.h>

#include "rollfix/watch/beginning.hpp"

namespace rollfix::app {

TwoLogs::TwoLogs(const Part& part, const WatchOptions& options)
    : stream_({options.name, *options.name_b}, part, options.fingers, options.noise, options.log, options.robust,
              options.wheel.has_value()),
      midway_(options.midway) {}

std::vector<LogLine> TwoLogs::push(std::size_t which, std::string_view line) {
  if (line.size() > kLongestLine) return {skipped(which, "a line that is too long to be a row of numbers")};
  if (!midway_ || has_header_[which]) return stream_.push(which, line);
  // Of a log that was joined in the middle nothing is guessed: rows belong together by their times, which a header
  // names.
  const std::string_view text = from_its_text(line);
  const FirstLine first = first_line(text);
  has_header_[which] = first.kind == FirstLine::Kind::words;
  if (has_header_[which]) return stream_.push(which, text);
  return {skipped(which, "a row before the header, which says what its numbers are")};
}

LogLine TwoLogs::skipped(std::size_t which, const char* why) {
  stream_.push(which, "#");  // it counts as a line all the same
  LogLine line;
  line.kind = LineKind::malformed;
  line.message = fmt::format("{}:{}: skipped: {}", stream_.name(which), stream_.lines(which), why);
  return line;
}

std::vector<LogLine> TwoLogs::restart(std::size_t which) {
  has_header_[which] = false;
  return stream_.restart(which);
}

}  // namespace rollfix::app
