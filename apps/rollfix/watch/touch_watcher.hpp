#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/advise.hpp"
#include "rollfix/touch.hpp"
#include "rollfix/watch/watcher.hpp"

namespace rollfix::app {

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
