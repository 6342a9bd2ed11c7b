#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "rollfix/watch/watcher.hpp"

namespace rollfix::app {

/// What the samples of a roll mean: where they were felt, on one part or on which of many.
class Meaning {
 public:
  Meaning() = default;
  virtual ~Meaning() = default;
  Meaning(const Meaning&) = delete;
  Meaning& operator=(const Meaning&) = delete;

  virtual void add(const Sample& sample) = 0;
  /// What is known by now goes into the answer.
  virtual void look(WatchAnswer& answer) = 0;
  /// The same when the roll is over, of the roll as a whole. `explains`: and, where its rows fit badly, why, which
  /// takes far longer.
  virtual void conclude(WatchAnswer& answer, bool explains) = 0;
};

/// Of a roll on a known part. Its first sample throws InputError: noise or prior that are not valid.
std::unique_ptr<Meaning> meaning_on_part(const Part& part, const WatchOptions& options, LogKind kind);
/// Of a finger with skin beside a wheel without. REQUIRES options.wheel.
std::unique_ptr<Meaning> meaning_beside_wheel(const Part& part, const WatchOptions& options);
/// REQUIRES options.catalog.
std::unique_ptr<Meaning> meaning_on_catalog(const Part& part, const WatchOptions& options, LogKind kind);

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
  std::size_t every_ = 1;
  std::size_t seen_ = 0;
};

}  // namespace rollfix::app
