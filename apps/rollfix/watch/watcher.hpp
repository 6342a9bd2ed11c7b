#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/identify.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
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

}  // namespace rollfix::app
