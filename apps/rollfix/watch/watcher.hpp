#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/advise.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/touch.hpp"
#include "rollfix/tracker.hpp"

namespace rollfix::app {

/// Longer than any row of a log: what has no line end up to here is something else.
inline constexpr std::size_t kLongestLine = std::size_t{64} * 1024;

/// In words.
std::string verdict_of(const Tracked& answer);

/// Who is told what happens in a growing log.
class WatchListener {
 public:
  WatchListener() = default;
  virtual ~WatchListener() = default;
  WatchListener(const WatchListener&) = delete;
  WatchListener& operator=(const WatchListener&) = delete;

  virtual void found(const Tracked& answer) = 0;              // contact: a roll begins
  virtual void changed(const Tracked& answer) = 0;            // there is something new to say of it
  virtual void over(const Tracked& answer, RollEnd why) = 0;  // and this is the last that is known of it
  virtual void note(const std::string& message) = 0;          // a line that can't be read, a jump
  /// Whether a change can be told without making the log wait. What is told later is then what is known by then.
  virtual bool is_ready() = 0;
  /// Whether the log is of one finger or of two, once that is known: before anything is found in it.
  virtual void knows_fingers(std::size_t /*count*/) {}
};

/// How a growing log is watched.
struct WatchOptions : TrackOptions {
  std::vector<Finger> fingers;  // for logs of u and psi: one that serves both of two, or each
  Noise noise;
  std::shared_ptr<const Catalog> catalog{};  // which of its parts is it? none: the part is known
  bool midway = false;                       // its first line may be the rest of one: a serial line, a connection
};

struct WatchCounts {
  std::size_t lines = 0;
  std::size_t samples = 0;
  std::size_t rolls = 0;
  std::size_t malformed = 0;
  std::size_t reconnects = 0;
  double seconds = 0;  // spent on the lines, without waiting for them and without telling

  double seconds_per_sample() const;  // not a number without samples
};

class TwoLogs;

/// Turns the lines of a growing log, of one finger or of two, into news of where the contacts are, in constant memory;
/// also the lines of two logs, one of each finger. A Tracker says what the rows mean; here is what lines can be that
/// are heard from the middle, cut, too long or no text. Knows no files or streams.
class Watcher {
 public:
  /// Throws InputError: noise or prior that are not valid.
  /// `part`: with a catalog any of its parts, in its unit.
  Watcher(const Part& part, WatchOptions options, WatchListener& listener);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// One line, of two logs of the first or of the second, 0 or 1. Throws InputError: what LogStream::push and
  /// PairedStream::push throw.
  void push(std::string_view line, std::size_t which = 0);
  /// The connection dropped and is there again.
  void resume(std::size_t which = 0);
  /// Another log begins.
  void restart(std::size_t which = 0);
  /// The log is over.
  void finish();

  /// Whether there are samples that nothing was made of yet, or news that the listener was not ready for: then
  /// catch_up() is due when no line has come for kMostDelay.
  bool is_behind() const { return tracker_.is_behind(); }
  void catch_up();

  /// Of two logs: nothing more of this one should be read before more comes of the other one.
  bool is_ahead(std::size_t which) const;
  /// Of two logs: rows of this one wait for their partners.
  bool has_waiting(std::size_t which) const;
  const WatchCounts& counts() const { return counts_; }
  const Tracked& last_answer() const { return tracker_.last(); }  // roll 0: there was none yet

 private:
  LogStream new_stream() const;
  /// A line of a log that may have been joined in the middle, before it is known what its rows are.
  void push_beginning(std::string_view line);
  /// Tries without a header, as rows of numbers come: twice the same, for the first may be the rest of one.
  void push_numbers(std::string_view line, std::size_t cells);
  /// Whether the line is a header, in place of what was made of rows without one.
  bool take_late_header(std::string_view line);
  void take_line(std::string_view line);
  /// The same of one of two logs.
  void take_line(std::string_view line, std::size_t which);
  void take_row(const LogLine& row);
  void tell_fingers(std::size_t count);
  LogKind kind() const;
  void note_malformed(const LogLine& row);
  void skip(const std::string& why);
  LogLine read(std::string_view line);
  void take(const LogLine& row);
  void tell(const std::vector<Tracked>& told);

  Part part_;
  WatchOptions options_;
  WatchListener& listener_;
  LogStream stream_;
  Tracker tracker_;
  std::unique_ptr<TwoLogs> two_;  // in place of the stream, of two logs
  bool knows_fingers_ = false;
  bool begins_ = true;          // of a log that was joined in the middle: what its rows are is not known yet
  bool has_header_ = true;      // false: it was joined in the middle, and taken without one
  std::string held_;            // its last row of numbers, not taken yet: ...
  std::size_t held_cells_ = 0;  // ... 0: there is none
  std::size_t rows_before_header_ = 0;
  std::size_t rows_back_ = 0;          // in a row, whose time is not after that of the last one that was taken
  std::optional<double> last_time_{};  // of a sample
  WatchCounts counts_;
};

/// What is known after one of the touches.
struct TouchNews {
  std::size_t line = 0;  // of the log
  TouchAnswer answer;    // of all touches so far
  /// Where several poses are left: which touch tells them apart.
  std::optional<NextTouch> next{};
};

/// Who is told what happens in a growing table of touches.
class TouchListener {
 public:
  TouchListener() = default;
  virtual ~TouchListener() = default;
  TouchListener(const TouchListener&) = delete;
  TouchListener& operator=(const TouchListener&) = delete;

  virtual void touched(const TouchNews& news) = 0;
  /// The last that is known, with what may be wrong where the touches fit badly.
  virtual void no_more_touches(const TouchNews& news, RollEnd why) = 0;
  virtual void note(const std::string& message) = 0;
};

/// Ends a search that the user does not wait for.
struct Stopped {};

/// How a growing table of touches is watched.
struct TouchWatchOptions {
  std::string name;      // of the log, for messages
  TouchProblem problem;  // without touches
  TouchTableOptions table{};
  std::size_t every = 0;                  // tell every so many touches; 0: each
  std::vector<std::string> no_use_for{};  // options that were given, and that only a roll has a use for
  std::function<bool()> is_stopped{};     // asked every 20 ms or so of a search; true ends it by Stopped
};

/// Turns the lines of a growing table of touches into the answer of all touches so far. Knows no files or streams. The
/// table is kept: it is read as `locate` reads it, but for lines that can't be read, which are left out.
class TouchWatcher {
 public:
  /// Throws InputError: there is no use for an option.
  TouchWatcher(TouchWatchOptions options, TouchListener& listener);

  /// Whether a line says that what follows is a table of touches.
  static bool begins_with(std::string_view line, const TouchTableOptions& table);

  /// One line. Throws InputError: what parse_touches throws of a header, and `solve` of the problem; Stopped.
  void push(std::string_view line);
  /// Another table begins.
  void restart();
  /// The table is over. Where a search was stopped, what was known before it is the last answer.
  void finish();

  const WatchCounts& counts() const { return counts_; }
  const std::optional<TouchNews>& last() const { return last_; }

 private:
  void skip(const std::string& why);
  void take(TouchTable table);
  void solve_all(bool diagnoses);
  void end(RollEnd why);

  TouchWatchOptions options_;
  TouchListener& listener_;
  std::string text_;        // the lines so far, "#" for each that can't be read
  bool has_begun_ = false;  // the header, or a probe's first report, has come
  std::string header_;      // a device may send it again; empty: there is none
  TouchTable table_;
  std::optional<TouchNews> last_;
  bool was_stopped_ = false;
  WatchCounts counts_;  // samples: touches of all tables
};

}  // namespace rollfix::app
