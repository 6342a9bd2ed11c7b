#include "rollfix/output/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <system_error>

#include "answer/signals_wait.hpp"
#include "text/doing.hpp"

namespace rollfix::app {
namespace {

using Clock = std::chrono::steady_clock;

// Nobody wonders before, and nobody reads faster.
constexpr std::chrono::milliseconds kPatience{500};
constexpr std::chrono::milliseconds kPause{200};

}  // namespace

ProgressLine::ProgressLine(bool wanted) {
  if (!wanted || ::isatty(STDERR_FILENO) != 1) return;
  const SignalsWait wait;  // they are for the thread that works
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {  // no thread to spare: then without
  }
}

ProgressLine::~ProgressLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void ProgressLine::run() {
  const Clock::time_point start = Clock::now();
  std::unique_lock lock(mutex_);
  std::chrono::milliseconds pause = kPatience;
  while (!ended_.wait_for(lock, pause, [this] { return has_ended_; })) {
    show(std::chrono::duration<double>(Clock::now() - start).count());
    pause = kPause;
  }
  clear();
}

void ProgressLine::show(double seconds) {
  const Doing::Now now = Doing::now();
  const std::string share = now.share >= 0 ? fmt::format(", {:.0f} %", 100 * now.share) : "";
  const std::string line = fmt::format("{}{}, {:.0f} s", now.what ? now.what : "working", share, seconds);
  std::fprintf(stderr, "\r%-*s", static_cast<int>(width_), line.c_str());
  width_ = std::max(width_, line.size());
}

void ProgressLine::clear() {
  if (width_ > 0) std::fprintf(stderr, "\r%*s\r", static_cast<int>(width_), "");
}

}  // namespace rollfix::app
