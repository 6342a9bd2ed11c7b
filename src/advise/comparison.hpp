#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rollfix/advise.hpp"

namespace rollfix::belief {

// A hypothesis with less probability is not waited for, nor counted among those that remain.
inline constexpr double kHypothesisCounts = 0.01;

/// On which the fingers roll on: each by so many times a length, the larger of which is 1, over which all hypotheses
/// that count can roll.
struct Way {
  PerFinger<double> direction = 1.0;
  Interval travel;

  /// By how far each finger rolls.
  PerFinger<double> rolled(double length) const {
    PerFinger<double> each = direction;
    for (double& one : each) one *= length;
    return each;
  }
};

/// Whether a hypothesis is so probable that a roll must be possible from it.
bool counts(const PartHypothesis& one, std::size_t hypotheses);

/// The ways that one finger has, or two.
std::vector<Way> ways_of(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options);

/// Hypotheses compared while they roll on a way, forwards or back: the largest distances so far.
class Comparison {
 public:
  Comparison(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options,
             const PerFinger<double>& direction);

  /// Rolls on to x and says what is to be expected then.
  ExpectedGain roll_to(double x);

  /// After which travel j is told from i, if i is the true one: for sure, and in part.
  const std::array<double, 2>& told(std::size_t i, std::size_t j) const { return told_[i * hypotheses_.size() + j]; }

 private:
  struct Seen {
    double turn = 0;
    double variance = 0;
  };

  Seen seen_by(std::size_t hypothesis, double x) const;
  void compare_at(double x);
  void note_told(double travel);
  ExpectedGain expected(double x) const;

  const std::vector<PartHypothesis>& hypotheses_;
  const AdviceOptions& options_;
  PerFinger<double> direction_;
  std::vector<double> distance_;             // squared, of each pair
  std::vector<std::array<double, 2>> told_;  // of each pair, the first of which is the true one
  std::vector<PerFinger<Turning>> start_;
};

double entropy(const std::vector<double>& weights);
double shortest_perimeter(const std::vector<PartHypothesis>& hypotheses);

}  // namespace rollfix::belief
