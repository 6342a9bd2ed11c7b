#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/log.hpp"
#include "watch/meaning.hpp"

namespace rollfix {

/// The rolls of a log that grows, one after the other: when one begins and when it is over, when it is looked at what
/// its samples mean, and what is told. Knows no lines of text.
class Rolls {
 public:
  /// Throws InputError: a prior, a pose or noise that is not valid.
  Rolls(Followed followed, MakeMeaning make);

  /// The next row, of a log of this kind, and what is worth telling of it. Throws InputError: the log does not have
  /// what the noise or the pose's prior is about.
  std::vector<Tracked> push(const LogLine& row, LogKind kind);
  /// The rest as Tracker has them.
  std::vector<Tracked> finish(RollEnd why);
  const Tracked& now();
  const Tracked& last() const { return answer_; }
  bool is_behind() const;
  std::vector<Tracked> catch_up();

 private:
  void require_evidence(const Sample& first) const;
  void begin_anew(const Sample& sample);
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
  std::vector<Tracked> take_told();

  Followed followed_;
  MakeMeaning make_;
  LogKind kind_ = LogKind::contact;                    // of the last row
  std::unique_ptr<Meaning> meaning_;                   // of the roll that goes on
  std::size_t rolls_ = 0;                              // so far, this one included
  std::size_t samples_ = 0;                            // of this roll
  std::size_t all_samples_ = 0;                        // of all rolls
  Sample last_;                                        // the last of them
  Reading beginning_;                                  // of this roll, as the log measures
  bool is_elsewhere_ = false;                          // the next sample begins another one
  Tracked answer_;                                     // when it was last worked out
  Tracked said_;                                       // what was told
  std::chrono::steady_clock::time_point next_look_{};  // live: not before this
  bool has_news_ = false;                              // the answer is news, and was not told yet
  std::size_t explained_ = 0;  // as many samples there were when it was last looked for what is wrong
  std::vector<Tracked> told_;  // of the row that is pushed
};

/// Rolls, with a stream of one log or of two that makes rows of numbers and of lines.
struct Tracker::State {
  /// Throws InputError: as Tracker does.
  State(const Followed& followed, MakeMeaning make);

  /// A row of either stream: its message is kept, and what is worth telling comes back.
  std::vector<Tracked> take(const LogLine& row, LogKind kind);
  /// The log of numbers. Throws InputError: there are two logs, whose rows are lines.
  LogStream& numbers();

  LogStream stream;                 // of one log, as lines or as numbers
  std::optional<PairedStream> two;  // in place of that, of two logs
  Rolls rolls;
  std::vector<std::string> messages;  // of the last push
};

}  // namespace rollfix
