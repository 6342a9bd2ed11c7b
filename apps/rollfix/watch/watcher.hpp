#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/catalog/catalog.hpp"
#include "rollfix/catalog/identify.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// Longer than any row of a log: what has no line end up to here is something else.
inline constexpr std::size_t kLongestLine = std::size_t{64} * 1024;

/// What is known of a roll after one of its samples.
struct WatchAnswer {
  std::size_t roll = 0;     // from 1
  std::size_t samples = 0;  // of this roll so far
  Sample sample;            // the last of them, after which the rest holds
  Verdict verdict;
  std::vector<Mode> modes;           // the most probable first
  double rest = 0;                   // probability outside of them
  Fit fit;                           // how well the samples fit, and what they tell of the scales and of a bias
  std::size_t impossible = 0;        // of a roll that is over: places that fit, and that the fingers can't have
  std::vector<Diagnosis> diagnoses;  // of a roll that is over, where its rows fit badly: why, see Answer
  /// Of a catalog: the parts that remain. The places are theirs then, and there are no modes.
  std::shared_ptr<const Identified> parts{};
  /// Beside a wheel without skin: what `locate` says, of which the modes have the places of both.
  std::shared_ptr<const HoldAnswer> held{};
};

/// In words.
std::string verdict_of(const WatchAnswer& answer);

/// Whether somebody who knows the one answer wants to hear the other: another verdict, or the most probable place is
/// not one that was known, or it is twice as certain, or its probability is another by a tenth. That two places which
/// are about as probable change ranks is no news.
bool is_news(const WatchAnswer& said, const WatchAnswer& now, const Part& part);

/// Why a roll is over.
enum class RollEnd {
  lost,       // contact
  jump,       // the next row is farther away than is physical: another roll
  restarted,  // another log began
  ended,      // there is no more of the log
  elsewhere   // it contradicts what was measured before: the finger was carried to another place
};

/// Who is told what happens in a growing log.
class WatchListener {
 public:
  WatchListener() = default;
  virtual ~WatchListener() = default;
  WatchListener(const WatchListener&) = delete;
  WatchListener& operator=(const WatchListener&) = delete;

  virtual void found(const WatchAnswer& answer) = 0;              // contact: a roll begins
  virtual void changed(const WatchAnswer& answer) = 0;            // there is something new to say of it
  virtual void over(const WatchAnswer& answer, RollEnd why) = 0;  // and this is the last that is known of it
  virtual void note(const std::string& message) = 0;              // a line that can't be read, a jump
  /// Whether a change can be told without making the log wait. What is told later is then what is known by then.
  virtual bool is_ready() = 0;
  /// Whether the log is of one finger or of two, once that is known: before anything is found in it.
  virtual void knows_fingers(std::size_t /*count*/) {}
};

/// How a growing log is watched.
struct WatchOptions {
  std::string name;                          // of the log, for messages
  std::optional<std::string> name_b{};       // of two logs, one of each finger, that of finger b
  std::vector<Finger> fingers;               // for logs of u and psi: one that serves both of two, or each
  std::optional<double> wheel{};             // finger b is a wheel without skin: its radius; `name_b` its pin's log
  std::optional<double> squeezed{};          // beside a wheel: see HoldProblem
  bool mirrored = false;                     // likewise; else LogOptions::mirrored says it
  BeliefOptions belief;                      // a pose's prior is of every roll's first contacts
  bool may_overlap = false;                  // see Problem
  LogOptions log;                            // what its columns are called, and the part's unit
  std::shared_ptr<const Catalog> catalog{};  // which of its parts is it? none: the part is known
  bool midway = false;                       // its first line may be the rest of one: a serial line, a connection
  bool again = false;                        // a roll that is contradicted is over, and another begins
  std::size_t every = 0;                     // tell every so many samples; 0: when there is news
  bool live = false;  // somebody waits: nothing that is new is kept back for longer than kMostDelay
};

/// Somebody who watches a screen, and a robot's next decision, can wait this long.
inline constexpr std::chrono::milliseconds kMostDelay{100};

struct WatchCounts {
  std::size_t lines = 0;
  std::size_t samples = 0;
  std::size_t rolls = 0;
  std::size_t malformed = 0;
  std::size_t reconnects = 0;
  double seconds = 0;  // spent on the lines, without waiting for them and without telling

  double seconds_per_sample() const;  // not a number without samples
};

class Meaning;
class TwoLogs;

/// Turns the lines of a growing log, of one finger or of two, into news of where the contacts are, in constant memory;
/// also the lines of two logs, one of each finger. Knows no files or streams.
///
/// Taking a sample is cheap, working out what it means is not. So that is done after every sample at first, and then
/// each time a roll has grown by a quarter; where it is live as often as kMostDelay asks for as well.
class Watcher {
 public:
  /// Throws InputError: noise or prior that are not valid.
  /// `part`: with a catalog any of its parts, in its unit.
  Watcher(const Part& part, WatchOptions options, WatchListener& listener);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// One line, of two logs of the first or of the second, 0 or 1. Throws InputError: what LogStream::push and
  /// PairedStream::push throw.
  void push(std::string_view line, std::size_t which = 0);
  /// The connection dropped and is there again.
  void resume(std::size_t which = 0);
  /// Another log begins.
  void restart(std::size_t which = 0);
  /// The log is over.
  void finish();

  /// Whether there are samples that nothing was made of yet, or news that the listener was not ready for: then
  /// catch_up() is due when no line has come for kMostDelay.
  bool is_behind() const;
  void catch_up();

  /// Of two logs: nothing more of this one should be read before more comes of the other one.
  bool is_ahead(std::size_t which) const;
  /// Of two logs: rows of this one wait for their partners.
  bool has_waiting(std::size_t which) const;
  const WatchCounts& counts() const { return counts_; }
  const WatchAnswer& last_answer() const { return answer_; }  // roll 0: there was none yet

 private:
  LogStream new_stream() const;
  /// A line of a log that may have been joined in the middle, before it is known what its rows are.
  void push_beginning(std::string_view line);
  /// Tries without a header, as rows of numbers come: twice the same, for the first may be the rest of one.
  void push_numbers(std::string_view line, std::size_t cells);
  /// Whether the line is a header, in place of what was made of rows without one.
  bool take_late_header(std::string_view line);
  void take_line(std::string_view line);
  /// The same of one of two logs.
  void take_line(std::string_view line, std::size_t which);
  void take_row(const LogLine& row);
  void tell_fingers(std::size_t count);
  LogKind kind() const;
  void note_malformed(const LogLine& row);
  void skip(const std::string& why);
  LogLine read(std::string_view line);
  /// Throws InputError: the log does not have what the noise or the pose's prior is about.
  void require_evidence(const Sample& first) const;
  void begin_roll(const Sample& sample);
  void begin_elsewhere(const Sample& sample);
  void add(const Sample& as_logged);
  void take(const Sample& sample);
  bool is_time_to_look() const;
  /// The roll goes on elsewhere than where it was: nothing fits all of it, and something did.
  bool is_contradicted() const;
  /// The sample as measured from where the roll begins that goes on.
  Sample from_beginning(Sample sample) const;
  void begin_answer();
  void look();
  void end_roll(RollEnd why);
  void tell_news();
  void tell();

  Part part_;
  WatchOptions options_;
  WatchListener& listener_;
  LogStream stream_;
  std::unique_ptr<TwoLogs> two_;  // in place of that, of two logs
  bool knows_fingers_ = false;
  bool begins_ = true;          // of a log that was joined in the middle: what its rows are is not known yet
  bool has_header_ = true;      // false: it was joined in the middle, and taken without one
  std::string held_;            // its last row of numbers, not taken yet: ...
  std::size_t held_cells_ = 0;  // ... 0: there is none
  std::size_t rows_before_header_ = 0;
  std::size_t rows_back_ = 0;         // in a row, whose time is not after that of the last one that was taken
  std::unique_ptr<Meaning> meaning_;  // of the roll that goes on
  std::size_t samples_ = 0;           // of this roll
  Sample last_;                       // of these
  Reading beginning_;                 // of this roll, as the log measures
  bool is_elsewhere_ = false;         // the next sample begins another one
  WatchAnswer answer_;                // when it was last worked out
  WatchAnswer said_;                  // what the listener knows
  std::chrono::steady_clock::time_point next_look_{};
  bool has_news_ = false;
  std::size_t explained_ = 0;  // as many samples there were when it was last looked for what is wrong
  WatchCounts counts_;
};

}  // namespace rollfix::app
