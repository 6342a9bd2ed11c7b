#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/log.hpp"
#include "rollfix/solve.hpp"
#include "watch/meaning.hpp"

namespace rollfix {

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

/// What is asked of all samples together.
Problem problem_of(const Followed& followed, LogKind kind, const KeptSamples& kept);

}  // namespace rollfix
