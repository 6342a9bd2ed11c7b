#pragma once

#include <string>
#include <utility>

#include "rollfix/watch_source.hpp"

namespace rollfix::app {

/// How long to wait before the next try: longer after each one that failed, so that a cable that was pulled out is
/// noticed soon and a machine that is off is not pestered.
class BackOff {
 public:
  static constexpr std::chrono::milliseconds kFirst{100};
  static constexpr std::chrono::milliseconds kLongest{5000};

  std::chrono::milliseconds next() { return std::exchange(wait_, wait_ * 2 < kLongest ? wait_ * 2 : kLongest); }
  void reset() { wait_ = kFirst; }

 private:
  std::chrono::milliseconds wait_ = kFirst;
};

/// A connection that may drop: it is tried again, with back-off, until it is there.
class ReconnectingSource : public ByteSource {
 public:
  /// `once`: the first time that it closes is the end.
  ReconnectingSource(std::string name, bool once, const StopSignal& stop)
      : name_(std::move(name)), once_(once), stop_(stop) {}

  Arrived read(char* block, std::size_t size, Deadline deadline) final;
  bool ends_whole() const final { return false; }

 protected:
  /// Tries to connect; empty when that worked, or else why not.
  virtual std::string connect() = 0;
  virtual void disconnect() = 0;
  /// To be read from while connected.
  virtual int descriptor() = 0;

  const std::string& name() const { return name_; }
  const StopSignal& stop() const { return stop_; }
  /// For those who connect at once and refuse what can't be opened at all.
  void set_connected() { connected_ = was_connected_ = true; }

 private:
  Arrived try_again(Deadline deadline);
  Arrived drop(const std::string& why);

  std::string name_;
  bool once_;
  const StopSignal& stop_;
  BackOff back_off_;
  Deadline next_try_{};
  bool connected_ = false;
  bool was_connected_ = false;
  std::string told_;  // why the last try failed: told once and not at every try
};

}  // namespace rollfix::app
