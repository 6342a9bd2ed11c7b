#include "rollfix/watch_loop.hpp"

#include <algorithm>
#include <ostream>

namespace rollfix::app {
namespace {

constexpr std::chrono::hours kForever{24};  // then one more look, and on

}  // namespace

WatchEnd watch_lines(LineSource& source, Watcher& watcher, WatchWriter& writer, const StopSignal& stop,
                     std::optional<std::chrono::duration<double>> idle_timeout, std::ostream& err) {
  const Clock::duration patience =
      idle_timeout ? std::chrono::duration_cast<Clock::duration>(*idle_timeout) : Clock::duration(kForever);
  Clock::time_point last_line = Clock::now();
  bool is_shown = false;
  while (!stop.came()) {
    const Deadline idle = last_line + patience;
    const bool soon = !is_shown || watcher.is_behind();
    const Heard heard = source.next(soon ? std::min(idle, Clock::now() + kMostDelay) : idle);
    if (!source.note().empty()) err << "rollfix: " << source.note() << std::endl;
    switch (heard) {
      case Heard::line:
        last_line = Clock::now();
        watcher.push(source.line());
        break;
      case Heard::nothing:
        watcher.catch_up();
        if (Clock::now() < idle) break;
        if (idle_timeout) return WatchEnd::idle;
        last_line = Clock::now();
        break;
      case Heard::dropped:
        break;
      case Heard::resumed:
        watcher.resume();
        writer.resumed(watcher.counts());
        break;
      case Heard::restarted:
        watcher.restart();
        break;
      case Heard::ended:
        return WatchEnd::stream;
    }
    writer.show();
    is_shown = true;
  }
  return WatchEnd::signal;
}

}  // namespace rollfix::app
