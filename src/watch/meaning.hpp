#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/tracker.hpp"

namespace rollfix {

/// What is followed, and with which fingers.
struct Followed {
  Part part;  // of a catalog any of its parts
  std::vector<Finger> fingers;
  Noise noise;
  TrackOptions options;

  /// As the log is read: see LogOptions.
  BeliefOptions belief_options() const;
};

/// Where the part lies face down, as a mirror shows it: its outline as it was drawn, with fingers and a log that are
/// mirrored, once. Beside a wheel `solve` sees to it. Throws InputError: an open outline of a finger, or a jaw of which
/// it is asked where it has the part.
Followed as_mirrored(Followed followed);

/// What the samples of a roll mean: where they were felt, on one part or on which of many.
class Meaning {
 public:
  Meaning() = default;
  virtual ~Meaning() = default;
  Meaning(const Meaning&) = delete;
  Meaning& operator=(const Meaning&) = delete;

  /// The next sample of the roll, measured from its first contact.
  virtual void add(const Sample& sample) = 0;
  /// What is known by now goes into the answer.
  virtual void look(Tracked& answer) = 0;
  /// The same when the roll is over, of the roll as a whole. `explains`: and, where its rows fit badly, why, which
  /// takes far longer.
  virtual void conclude(Tracked& answer, bool explains) = 0;
  /// Whether `now` is worth telling to somebody who knows `said`.
  virtual bool is_news(const Tracked& said, const Tracked& now) const = 0;
};

/// Of each roll anew. Where a roll begins it throws InputError: noise or prior that are not valid.
using MakeMeaning = std::function<std::unique_ptr<Meaning>(LogKind kind)>;

/// Of a roll on a known part.
std::unique_ptr<Meaning> meaning_on_part(const Followed& followed, LogKind kind);
/// Of a finger with skin beside a wheel without. REQUIRES options.wheel and options.name_b.
std::unique_ptr<Meaning> meaning_beside_wheel(const Followed& followed);

/// Samples of a roll, evenly spread, not too many: of every so many the first.
class KeptSamples {
 public:
  void add(const Sample& sample);
  /// This one as well, whether it is one of so many or not.
  void end_with(const Sample& sample);
  std::size_t size() const { return kept_.size(); }
  /// As one sample of the roll stands for so many.
  std::size_t each() const { return every_; }
  /// The log that they are of, as the user gave it.
  Log log(LogKind kind, const Part& part, const std::vector<Finger>& fingers = {}, const Noise& noise = {}) const;

 private:
  std::vector<Sample> kept_;
  std::size_t every_ = 1;  // of so many samples the first is kept
  std::size_t seen_ = 0;   // samples so far
};

/// What is asked of all samples together.
Problem problem_of(const Followed& followed, LogKind kind, const KeptSamples& kept);

}  // namespace rollfix
