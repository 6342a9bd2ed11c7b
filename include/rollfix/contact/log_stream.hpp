#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/noise.hpp"
#include "rollfix/contact/reading.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// One row of a log while the finger touches, measured from the first contact of its roll.
struct Sample {
  std::size_t line = 0;            // of the log
  std::optional<double> time;      // seconds
  Reading reading;                 // from the roll's first contact, in the direction in which the part is stored
  double finger_curvature = 0;     // of the finger where it touches: 1/r of a disk, 0 of a jaw; 0 where not known
  std::optional<Contact> contact;  // u and psi, unwrapped, where the log has them
  std::optional<Vec2> centre;      // of the finger in the world, where the log has it
};

/// What a line of a growing log was.
enum class LineKind {
  nothing,    // a comment, a blank line, the header, a row before the first contact
  first,      // a first contact: a new roll starts (its sample has L = theta = 0 where the log has u and psi)
  sample,     // a further row of the roll
  lost,       // contact is lost: the roll is over
  malformed,  // can't be read: skipped and counted
  jump        // more than is physical since the row before: the roll is over, this row starts a new one
};

struct LogLine {
  LineKind kind = LineKind::nothing;
  Sample sample;        // of first, sample and jump
  std::string message;  // of malformed and jump: "name:line: expected ..., found ..."
};

/// A log that grows, line by line, in constant memory. The format is that of read_log, the header included; what
/// read_log refuses a live stream survives: a line that can't be read, a time that does not grow, is skipped and
/// counted. Each sample is, bit by bit, the last reading of a log that ends there. A later roll of length and turn, or
/// of distance and dturn, is measured from its own first row, as read_rolls does. docs/rolling.md says what a jump is.
class LogStream {
 public:
  /// `finger`: for logs of u and psi. `noise`: widens what counts as a jump. `name`: for messages.
  LogStream(std::string name, const Part& part, std::optional<Finger> finger, const Noise& noise = {});
  ~LogStream();
  LogStream(LogStream&&) noexcept;
  LogStream& operator=(LogStream&&) noexcept;

  /// The next line, with or without its line end. Throws InputError: a header that names no known columns, u and psi
  /// without a finger, two fingers, not a text.
  LogLine push(std::string_view line);

  /// After a dropped connection: the next row continues the roll, however far it is, and a header may come again (of
  /// the same kind of log; its columns may stand in another order, and the clock may have been set anew).
  void resume();

  LogKind kind() const;           // known after the header
  std::size_t lines() const;      // seen
  std::size_t malformed() const;  // of them skipped

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rollfix
