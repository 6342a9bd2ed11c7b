#include "rollfix/watch_stop.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <limits>

#include "rollfix/error.hpp"

namespace rollfix::app {
namespace {

constexpr std::array<int, 2> kSignals = {SIGINT, SIGTERM};

std::atomic<bool> stop_came{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

// A handler can wake a poll() that is about to begin only through a descriptor.
std::array<int, 2> wake_pipe = {-1, -1};
std::array<struct sigaction, kSignals.size()> actions_before;

extern "C" void mark_stop(int /*signal*/) {
  const int error_before = errno;
  stop_came = true;
  const char byte = 0;
  [[maybe_unused]] const ssize_t written = ::write(wake_pipe[1], &byte, 1);
  errno = error_before;
}

int milliseconds_until(Deadline deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  using Left = decltype(left);
  return static_cast<int>(std::clamp<Left>(left, 0, std::numeric_limits<int>::max()));
}

/// poll(), begun again when another signal breaks it off. A negative descriptor is ignored.
bool poll_readable(int descriptor, Deadline deadline) {
  std::array<pollfd, 2> watched = {pollfd{wake_pipe[0], POLLIN, 0}, pollfd{descriptor, POLLIN, 0}};
  while (!stop_came) {
    const int ready = ::poll(watched.data(), watched.size(), milliseconds_until(deadline));
    if (ready > 0) return watched[0].revents == 0 && watched[1].revents != 0;
    if (ready == 0) return false;
    if (errno != EINTR) throw InternalError("poll: waiting for input failed");
  }
  return false;
}

}  // namespace

StopSignal::StopSignal() {
  if (::pipe2(wake_pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) throw InternalError("pipe: no descriptors left");
  stop_came = false;
  struct sigaction action = {};
  action.sa_handler = mark_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second one does what it always does
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &action, &actions_before[i]);
}

StopSignal::~StopSignal() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &actions_before[i], nullptr);
  for (int& end : wake_pipe) {
    ::close(end);
    end = -1;
  }
}

bool StopSignal::came() const { return stop_came; }

bool StopSignal::wait_readable(int descriptor, Deadline deadline) const { return poll_readable(descriptor, deadline); }

void StopSignal::sleep(Deadline deadline) const { poll_readable(-1, deadline); }

}  // namespace rollfix::app
