#pragma once

#include <chrono>
#include <iosfwd>
#include <optional>

#include "rollfix/watch_lines.hpp"
#include "rollfix/watch_writer.hpp"

namespace rollfix::app {

/// Takes lines as they come until there are no more, the user stops it, or none came for `idle_timeout`.
WatchEnd watch_lines(LineSource& source, Watcher& watcher, WatchWriter& writer, const StopSignal& stop,
                     std::optional<std::chrono::duration<double>> idle_timeout, std::ostream& err);

}  // namespace rollfix::app
