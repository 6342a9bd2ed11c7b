#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/log.hpp"

namespace rollfix {

/// Two logs that grow, one of each finger, as one log of two fingers, or the second one of a wheel without skin: a row
/// waits for its partner, which is the row of the other log with the same time; without a column `time` the row of the
/// same number. Rows that can't be read and rows that turn out to have no partner are skipped. What a sample says is
/// what LogStream says of the same rows side by side; its line is the first log's.
class PairedStream {
 public:
  /// Rows that wait: a reader who keeps to it gives no more lines of a log that is_ahead() until the other one's come.
  static constexpr std::size_t kMostWaiting = 4096;

  /// See LogStream; columns of the options that end in _a or _b are of that log alone. `b_is_pin`: the second log is a
  /// PinLog. Its samples are beside `fingers`: their `reading` is finger a's, `contact` of the pin has a psi, which
  /// without an encoder is not a number, and no step is a jump. Throws InputError: fingers that are not valid.
  PairedStream(const std::array<std::string, 2>& names, const Part& part, std::vector<Finger> fingers,
               const Noise& noise = {}, const LogOptions& options = {}, bool robust = false, bool b_is_pin = false);
  ~PairedStream();
  PairedStream(PairedStream&&) noexcept;
  PairedStream& operator=(PairedStream&&) noexcept;

  /// The next line of log 0 or 1, with what came of it: rows in order, mostly one or none. Throws InputError as
  /// LogStream does, and: logs of different kinds, of which only one has times, or one that is of two fingers already.
  std::vector<LogLine> push(std::size_t which, std::string_view line);

  /// After a dropped connection of that log: the next row continues the roll, however far it is. Throws InputError:
  /// without times nothing says which rows belong together then.
  void resume(std::size_t which);
  /// Another log begins in place of that one, and with it a roll. As long as the other log goes on, rows of both wait
  /// until two belong together. Returned is what was skipped.
  std::vector<LogLine> restart(std::size_t which);
  /// No more of both comes: what still waits is skipped.
  std::vector<LogLine> finish();

  /// So many rows wait that no more of it should be read before more comes of the other one.
  bool is_ahead(std::size_t which) const;
  bool has_waiting(std::size_t which) const;   // rows
  LogKind kind() const;                        // known after both headers
  std::size_t fingers() const;                 // 2 then, a pin included, else 0
  std::size_t lines(std::size_t which) const;  // seen
  const std::string& name(std::size_t which) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rollfix
