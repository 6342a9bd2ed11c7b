#pragma once

#include <algorithm>
#include <array>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>

#include "rollfix/output/report.hpp"
#include "rollfix/watch/source.hpp"
#include "rollfix/watch/watcher.hpp"
#include "rollfix/watch/writer.hpp"

namespace rollfix::app {

/// What watches a log: rolls, or once a line says that it is a table of touches, those.
class Watching {
 public:
  /// `touches`: none: the log can't be a table of touches. Throws InputError: noise or prior that are not valid, where
  /// it can't.
  Watching(const Part& part, const WatchOptions& options, std::optional<TouchWatchOptions> touches,
           WatchWriter& writer);

  /// Of two logs of log 0 or 1. Throws InputError: as Watcher and TouchWatcher do.
  void push(std::string_view line, std::size_t which = 0);
  void resume(std::size_t which = 0);
  void restart(std::size_t which = 0);
  bool is_ahead(std::size_t which) const { return rolls_ && rolls_->is_ahead(which); }
  bool has_waiting(std::size_t which) const { return rolls_ && rolls_->has_waiting(which); }
  void catch_up();
  void finish();
  void end(WatchEnd why);

  /// Whether there is an answer.
  bool has_found() const;
  ExitCode exit_code() const;
  WatchCounts counts() const;

 private:
  bool begins_touches(std::string_view line) const;

  WatchWriter& writer_;
  std::optional<TouchWatchOptions> touch_options_;
  std::optional<Watcher> rolls_;
  bool is_of_catalog_;
  std::string name_;
  std::string refused_{};  // where there can't be rolls: why
  std::optional<TouchWatcher> touches_;
};

using Seconds = std::chrono::duration<double>;

/// As long as it lives, SIGINT and SIGTERM only stop the io_context, so that the program can end cleanly; a second one
/// of them ends it at once. Afterwards they do what they did before.
class StopSignals {
 public:
  explicit StopSignals(asio::io_context& io)
      : set_(io, kSignals[0], kSignals[1]), aside_set_(aside_, kSignals[0], kSignals[1]) {
    set_.async_wait([&io](const error_code& /*error*/, int /*signal*/) { io.stop(); });
    aside_set_.async_wait([this](const error_code& error, int /*signal*/) { has_come_ = has_come_ || !error; });
    for (const int signal : kSignals) {
      struct sigaction action = {};
      ::sigaction(signal, nullptr, &action);
      // What is being printed is printed; the second one also ends it where nobody takes that.
      action.sa_flags |= static_cast<int>(SA_RESTART | SA_RESETHAND);
      ::sigaction(signal, &action, nullptr);
    }
  }
  ~StopSignals() {
    error_code ignored;
    set_.clear(ignored);
    aside_set_.clear(ignored);
    for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
  }
  /// Whether one has come since this was asked before: what is being done within the io_context asks, which itself
  /// learns of it only afterwards.
  bool has_come() {
    aside_.poll();
    return std::exchange(has_come_, false);
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  static constexpr std::array<int, 2> kSignals = {SIGINT, SIGTERM};
  static std::array<struct sigaction, 2> handlers() {
    std::array<struct sigaction, 2> found = {};
    for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], nullptr, &found[i]);
    return found;
  }

  std::array<struct sigaction, 2> before_ = handlers();
  asio::signal_set set_;
  asio::io_context aside_;  // hears the same
  asio::signal_set aside_set_;
  bool has_come_ = false;
};

/// Hears a log, or two, and watches them, until they end, the user stops it, or no line came for too long.
class Hearing {
 public:
  Hearing(asio::io_context& io, Watching& watcher, WatchWriter& writer, std::ostream& err,
          std::optional<Seconds> patience, std::size_t logs)
      : io_(io), timer_(io), watcher_(watcher), writer_(writer), err_(err), patience_(patience), going_on_(logs) {}

  /// `which`: of the logs.
  void hear(Heard what, std::string_view text, std::size_t which) {
    if (what == Heard::line) {
      last_line_ = std::chrono::steady_clock::now();
      watcher_.push(text, which);
    } else if (!text.empty()) {
      err_ << "rollfix: " << text << std::endl;
    }
    if (what == Heard::ended && --going_on_ == 0) return stop(WatchEnd::stream);
    if (what == Heard::restarted) watcher_.restart(which);
    if (what == Heard::resumed) watcher_.resume(which);
    if (what != Heard::line) writer_.show();  // the header may be the next line
  }

  WatchEnd run() {
    last_line_ = std::chrono::steady_clock::now();
    look_after_a_while();
    try {
      io_.run();
    } catch (const Stopped&) {
      why_ = WatchEnd::signal;
    }
    return why_;
  }

 private:
  /// Sees to what waits for its time, again and again.
  void look_after_a_while() {
    const Seconds pause = std::min<Seconds>(kMostDelay, patience_.value_or(kMostDelay));
    timer_.expires_after(std::chrono::ceil<std::chrono::milliseconds>(pause));
    timer_.async_wait([this](const error_code& /*error*/) {
      watcher_.catch_up();
      if (patience_ && std::chrono::steady_clock::now() - last_line_ >= *patience_) return stop(WatchEnd::idle);
      writer_.show();
      look_after_a_while();
    });
  }

  void stop(WatchEnd why) {
    why_ = why;
    io_.stop();
  }

  asio::io_context& io_;
  asio::steady_timer timer_;
  Watching& watcher_;
  WatchWriter& writer_;
  std::ostream& err_;
  std::optional<Seconds> patience_;
  std::size_t going_on_;  // logs
  std::chrono::steady_clock::time_point last_line_;
  WatchEnd why_ = WatchEnd::signal;  // stopped, but not by this
};

}  // namespace rollfix::app
