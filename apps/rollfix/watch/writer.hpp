#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rollfix/watch/watcher.hpp"

namespace rollfix::app {

/// Why the watch is over.
enum class WatchEnd {
  stream,  // the log ended
  signal,  // the user stopped it
  idle     // nothing came for too long
};

/// Lets a few notes through at once and then one now and then, so that a broken sensor does not flood the screen.
class NoteLimit {
 public:
  static constexpr std::size_t kAtOnce = 3;
  static constexpr std::chrono::seconds kOneMoreEvery{5};

  /// Nothing: leave this note out. Otherwise how many were left out since the last one that was told.
  std::optional<std::size_t> allow(std::chrono::steady_clock::time_point now);

 private:
  std::size_t told_ = 0;  // lately
  std::size_t left_out_ = 0;
  std::chrono::steady_clock::time_point last_{};
};

/// Tells what happens, as it happens: data to `out`, a whole line at a time, and notes to `err`.
class WatchWriter : public WatchListener, public TouchListener {
 public:
  /// `is_ready`: whether `out` takes a line without waiting.
  WatchWriter(std::ostream& out, std::ostream& err, std::function<bool()> is_ready);

  /// What is watched. It is shown before anything else is, or by show(): a log that can't be read at all shows nothing.
  virtual void begin(const Part& part, const WatchOptions& options) = 0;
  /// The log turns out to be of touches.
  virtual void begin_touches() = 0;
  void show();
  virtual void resumed(const WatchCounts& counts) = 0;  // after a dropped connection
  virtual void end(WatchEnd why, const Tracked& last, const WatchCounts& counts) = 0;
  virtual void end_touches(WatchEnd why, const std::optional<TouchNews>& last, const WatchCounts& counts) = 0;

  void note(const std::string& message) final;  // not all of them when there are many
  bool is_ready() final { return is_ready_(); }

 protected:
  void announce(std::string lines) { announced_ = std::move(lines); }
  bool has_shown() const { return announced_.empty(); }  // what was announced
  /// Throws InputError: can't be written to.
  void write(const std::string& lines);

 private:
  std::string announced_;  // and not shown yet
  std::ostream& out_;
  std::ostream& err_;
  std::function<bool()> is_ready_;
  NoteLimit limit_;
};

/// For people: a table that grows.
std::unique_ptr<WatchWriter> watch_text(const Part& part, std::ostream& out, std::ostream& err,
                                        std::function<bool()> is_ready);
/// For programs: an object per line, "rollfix/watch/1"; docs/json.md lists the fields.
std::unique_ptr<WatchWriter> watch_jsonl(const Part& part, std::ostream& out, std::ostream& err,
                                         std::function<bool()> is_ready);

}  // namespace rollfix::app
