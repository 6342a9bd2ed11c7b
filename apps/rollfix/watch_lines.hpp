#pragma once

#include <string>
#include <vector>

#include "rollfix/watch_line_buffer.hpp"
#include "rollfix/watch_source.hpp"

namespace rollfix::app {

/// What the next thing to hear of a growing log is.
enum class Heard {
  line,       // one
  nothing,    // before the deadline, or the user wants to stop
  dropped,    // the connection; a line that had begun is gone
  resumed,    // the connection, in the same log
  restarted,  // another log begins
  ended       // there is no more
};

/// The lines of a growing log, one by one.
class LineSource {
 public:
  explicit LineSource(ByteSource& bytes);

  Heard next(Deadline deadline);

  const ReadLine& line() const { return line_; }     // of Heard::line; valid until the next call
  const std::string& note() const { return note_; }  // of the others, where there is something to tell people

 private:
  Heard take(ReadLine line);

  ByteSource& bytes_;
  LineBuffer buffer_;
  std::vector<char> block_;
  ReadLine line_;
  std::string note_;
  bool ended_ = false;
};

}  // namespace rollfix::app
