#include "rollfix/watch/watcher.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "log/log_table.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/log.hpp"
#include "text/table.hpp"
#include "text/text.hpp"
#include "watch/meaning.hpp"

namespace rollfix::app {
namespace {

/// What a line is that may be heard from its middle on, or before a device has found its rate.
struct FirstLine {
  enum class Kind { empty, garbage, numbers, words };  // words: a header
  Kind kind = Kind::empty;
  std::size_t cells = 0;  // of numbers
};

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

/// Without the bytes in front of it that are no text.
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

}  // namespace

/// The lines of two logs that grow, one of each finger, as the rows of one log of two fingers.
class TwoLogs {
 public:
  /// REQUIRES options.name_b. Throws InputError: fingers that are not valid.
  TwoLogs(const Part& part, const WatchOptions& options);

  /// A line of log 0 or 1, with what came of it. Throws InputError as PairedStream does.
  std::vector<LogLine> push(std::size_t which, std::string_view line);
  void resume(std::size_t which) { stream_.resume(which); }
  std::vector<LogLine> restart(std::size_t which);
  std::vector<LogLine> finish() { return stream_.finish(); }

  bool is_ahead(std::size_t which) const { return stream_.is_ahead(which); }
  bool has_waiting(std::size_t which) const { return stream_.has_waiting(which); }
  LogKind kind() const { return stream_.kind(); }
  std::size_t fingers() const { return stream_.fingers(); }  // 0: not known yet

 private:
  LogLine skipped(std::size_t which, const char* why);

  PairedStream stream_;
  bool midway_;
  std::array<bool, 2> has_header_{};
};

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

namespace {

using WorkClock = std::chrono::steady_clock;

// Rows without a header are distance and dturn. Where they have other columns a header may still come: a device that
// sends it now and then does so within that many.
constexpr std::size_t kCellsWithoutHeader = 2;
constexpr std::size_t kMostRowsBeforeHeader = 200;
constexpr const char* kHalfRow = "the end of a row that was not heard whole";
constexpr const char* kNoHeader = "a row before the header, which says what its numbers are";

/// Adds the time that passes while it lives.
class WorkTime {
 public:
  explicit WorkTime(double& seconds) : seconds_(seconds) {}
  ~WorkTime() { seconds_ += std::chrono::duration<double>(WorkClock::now() - start_).count(); }
  WorkTime(const WorkTime&) = delete;
  WorkTime& operator=(const WorkTime&) = delete;

 private:
  double& seconds_;
  WorkClock::time_point start_ = WorkClock::now();
};

WatchOptions as_mirrored(const Part& part, WatchOptions options) {
  const Followed followed = rollfix::as_mirrored({part, options.fingers, options.noise, options});
  options.fingers = followed.fingers;
  static_cast<TrackOptions&>(options) = followed.options;
  return options;
}

TrackOptions told_by(TrackOptions options, WatchListener& listener) {
  options.is_ready = [&listener] { return listener.is_ready(); };
  return options;
}

Tracker tracker_of(const Part& part, const WatchOptions& options, WatchListener& listener) {
  const TrackOptions how = told_by(options, listener);
  return options.catalog ? track(options.catalog, options.fingers, options.noise, how)
                         : Tracker(part, options.fingers, options.noise, how);
}

}  // namespace

double WatchCounts::seconds_per_sample() const {
  return samples > 0 ? seconds / static_cast<double>(samples) : std::numeric_limits<double>::quiet_NaN();
}

std::string verdict_of(const Tracked& answer) {
  if (answer.held) return answer.held->verdict_text();
  return answer.parts ? answer.parts->verdict : answer.verdict.text();
}

Watcher::Watcher(const Part& part, WatchOptions options, WatchListener& listener)
    : part_(part),
      options_(as_mirrored(part, std::move(options))),
      listener_(listener),
      stream_(new_stream()),
      tracker_(tracker_of(part_, options_, listener_)) {
  if (options_.name_b) two_ = std::make_unique<TwoLogs>(part_, options_);
}
Watcher::~Watcher() = default;

void Watcher::push(std::string_view line, std::size_t which) {
  if (two_) return take_line(line, which);
  if (options_.midway && begins_) return push_beginning(line);
  if (!has_header_ && take_late_header(line)) return;
  take_line(line);
}

void Watcher::push_beginning(std::string_view line) {
  const std::string_view text = from_its_text(line);
  const FirstLine first = first_line(text);
  if (first.kind == FirstLine::Kind::garbage || (text.empty() && !line.empty())) {
    return skip("no text, or the end of a line that was not heard whole");
  }
  if (first.kind == FirstLine::Kind::empty) return take_line(text);
  if (first.kind == FirstLine::Kind::numbers) return push_numbers(text, first.cells);
  if (std::exchange(held_cells_, 0) > 0) skip(kHalfRow);
  begins_ = false;
  take_line(text);
}

void Watcher::push_numbers(std::string_view line, std::size_t cells) {
  const std::string before = std::exchange(held_, std::string(line));
  const std::size_t cells_before = std::exchange(held_cells_, cells);
  if (cells_before == 0) return;
  if (cells_before != cells) return skip(kHalfRow);
  if (cells != kCellsWithoutHeader && ++rows_before_header_ < kMostRowsBeforeHeader) return skip(kNoHeader);
  begins_ = has_header_ = false;
  held_cells_ = 0;
  take_line(before);
  take_line(line);
}

bool Watcher::take_late_header(std::string_view line) {
  if (first_line(line).kind != FirstLine::Kind::words) return false;
  LogStream other = new_stream();
  try {
    for (std::size_t k = 0; k < stream_.lines(); ++k) other.push("#");
    other.push(line);
  } catch (const InputError&) {  // no header of a log: a row like any other
    return false;
  }
  tell(tracker_.finish(RollEnd::restarted));
  stream_ = std::move(other);
  ++counts_.lines;
  has_header_ = true;
  listener_.note(
      fmt::format("{}:{}: a header; the rows before it had been taken without one", options_.name, stream_.lines()));
  return true;
}

void Watcher::skip(const std::string& why) {
  stream_.push("#");  // it counts as a line all the same
  ++counts_.lines;
  ++counts_.malformed;
  listener_.note(fmt::format("{}:{}: skipped: {}", options_.name, stream_.lines(), why));
}

void Watcher::take_line(std::string_view line) { take_row(read(line)); }

void Watcher::take_line(std::string_view line, std::size_t which) {
  std::vector<LogLine> rows;
  {
    const WorkTime time(counts_.seconds);
    ++counts_.lines;
    rows = two_->push(which, line);
  }
  tell_fingers(two_->fingers());
  for (const LogLine& row : rows) take_row(row);
}

void Watcher::tell_fingers(std::size_t count) {
  if (knows_fingers_ || count == 0) return;
  knows_fingers_ = true;
  listener_.knows_fingers(count);
}

LogKind Watcher::kind() const { return two_ ? two_->kind() : stream_.kind(); }

bool Watcher::is_ahead(std::size_t which) const { return two_ && two_->is_ahead(which); }

bool Watcher::has_waiting(std::size_t which) const { return two_ && two_->has_waiting(which); }

void Watcher::take_row(const LogLine& row) {
  if (row.kind != LineKind::malformed && row.kind != LineKind::nothing) rows_back_ = 0;
  if (row.kind == LineKind::jump || row.kind == LineKind::stray) listener_.note(row.message);
  if (row.kind == LineKind::malformed) {
    ++counts_.malformed;
    note_malformed(row);
  }
  take(row);
}

void Watcher::take(const LogLine& row) {
  std::vector<Tracked> told;
  {
    const WorkTime time(counts_.seconds);
    told = tracker_.push(row, kind());
  }
  if (row.kind == LineKind::first || row.kind == LineKind::sample || row.kind == LineKind::jump) {
    ++counts_.samples;
    last_time_ = row.sample.time;
  }
  tell(told);
}

void Watcher::tell(const std::vector<Tracked>& told) {
  for (const Tracked& now : told) {
    counts_.rolls = now.roll;
    if (now.over == RollEnd::elsewhere) {
      listener_.note(fmt::format("{}:{}: the rows contradict the roll so far: a new roll begins, from anywhere",
                                 options_.name, stream_.lines()));
    }
    if (now.over) {
      listener_.over(now, *now.over);
    } else {
      now.samples == 1 ? listener_.found(now) : listener_.changed(now);
    }
  }
}

void Watcher::catch_up() { tell(tracker_.catch_up()); }

/// One row whose time does not grow is a row like any other; after the second in a row it is the clock.
void Watcher::note_malformed(const LogLine& row) {
  const std::size_t before = row.goes_back ? rows_back_++ : std::exchange(rows_back_, 0);
  if (!row.goes_back || before == 0 || two_) return listener_.note(row.message);
  if (before > 1) return;
  listener_.note(fmt::format(
      "{}:{}: time went back: rows are left out, and not told one by one, until their time is after {:.9g} s; "
      "where the clock was set anew, or parts of the log were swapped, what follows is a log of its own",
      options_.name, stream_.lines(), last_time_.value_or(0)));
}

void Watcher::resume(std::size_t which) {
  ++counts_.reconnects;
  two_ ? two_->resume(which) : stream_.resume();
}

void Watcher::restart(std::size_t which) {
  tell(tracker_.finish(RollEnd::restarted));
  if (two_) {
    for (const LogLine& row : two_->restart(which)) take_row(row);
    return;
  }
  stream_ = new_stream();
  begins_ = has_header_ = true;
  held_cells_ = rows_before_header_ = 0;
}

void Watcher::finish() {
  if (std::exchange(held_cells_, 0) > 0) take_line(held_);
  if (two_) {
    for (const LogLine& row : two_->finish()) take_row(row);
  }
  tell(tracker_.finish());
}

LogStream Watcher::new_stream() const {
  return LogStream(options_.name, part_, options_.fingers, options_.noise, options_.log, options_.robust);
}

LogLine Watcher::read(std::string_view line) {
  const WorkTime time(counts_.seconds);
  ++counts_.lines;
  if (line.size() <= kLongestLine) {
    LogLine row = stream_.push(line);
    tell_fingers(stream_.fingers());
    return row;
  }
  stream_.push("#");  // it counts as a line all the same
  LogLine row;
  row.kind = LineKind::malformed;
  row.message = fmt::format("{}:{}: expected a row of numbers, found more than {} bytes without a line end",
                            options_.name, stream_.lines(), kLongestLine);
  return row;
}

}  // namespace rollfix::app
