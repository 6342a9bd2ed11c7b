#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rollfix/output/report.hpp"
#include "rollfix/watch/touch_watcher.hpp"
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

}  // namespace rollfix::app
