#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/watch/watcher.hpp"

namespace rollfix::app {

/// The lines of two logs that grow, one of each finger, as the rows of one log of two fingers.
class TwoLogs {
 public:
  /// REQUIRES options.name_b. Throws InputError: fingers that are not valid.
  TwoLogs(const Part& part, const WatchOptions& options);

  /// A line of log 0 or 1, with what came of it. Throws InputError as PairedStream does.
  std::vector<LogLine> push(std::size_t which, std::string_view line);
  void resume(std::size_t which) { stream_.resume(which); }
  std::vector<LogLine> restart(std::size_t which);
  std::vector<LogLine> finish() { return stream_.finish(); }

  bool is_ahead(std::size_t which) const { return stream_.is_ahead(which); }
  bool has_waiting(std::size_t which) const { return stream_.has_waiting(which); }
  LogKind kind() const { return stream_.kind(); }
  std::size_t fingers() const { return stream_.fingers(); }  // 0: not known yet

 private:
  LogLine skipped(std::size_t which, const char* why);

  PairedStream stream_;
  bool midway_;
  std::array<bool, 2> has_header_{};
};

}  // namespace rollfix::app
