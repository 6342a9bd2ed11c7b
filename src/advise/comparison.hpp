#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "rollfix/advise.hpp"

namespace rollfix::advising {

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

/// What has less probability need not be able to roll.
double least_that_counts(const std::vector<PartHypothesis>& hypotheses);

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
    // y_i, radians; of other motions what is foreseen
    double turn = 0;
    double variance = 0;
  };

  /// What place i would measure at x.
  Seen seen_by(std::size_t hypothesis, double x) const;
  /// Enlarges the distances by those at x.
  void compare_at(double x);
  /// Notes which pairs are told by now.
  void note_told(double travel);
  /// The gain of a roll that ends at x, by the distances so far.
  ExpectedGain expected(double x) const;

  const std::vector<PartHypothesis>& hypotheses_;
  const AdviceOptions& options_;
  PerFinger<double> direction_;
  std::vector<double> distance_;             // squared, of each pair
  std::vector<std::array<double, 2>> told_;  // of each pair, the first of which is the true one
  /// Theta and kappa of each place at its contacts now
  std::vector<PerFinger<Turning>> start_;
};

/// -sum p log2 p, bits. `weights` add up to 1.
double entropy(const std::vector<double>& weights);
/// Of the parts that the hypotheses are on, length.
double shortest_perimeter(const std::vector<PartHypothesis>& hypotheses);

/// What is still to be travelled after a roll, for the place where the contact is to be told from the others.
class WayToTell {
 public:
  WayToTell(const std::vector<PartHypothesis>& hypotheses, const Comparison& back, const Comparison& forward);

  /// Whether any place is told from another on this way, for sure or in part.
  bool tells_any() const;
  /// After a roll to x: what is to be expected until all are told apart that can be, this roll included. Which of the
  /// others is the true one is not known by whoever decides to roll on, or back: one way for all.
  double after(double x) const;
  /// The probability that not all are told apart then.
  double open_after(double x) const;
  /// Whether j has to be told from i, if i is the true one: it counts, and is not of the same narrow placement.
  bool matters(std::size_t i, std::size_t j) const;

 private:
  /// Another place, and the travel forward and back that tells it from a true one.
  struct Other {
    double forward = 0;
    double back = 0;
  };

  void add_other(std::size_t i, std::size_t j);
  bool are_one_place(std::size_t i, std::size_t j) const;
  bool counts(std::size_t j) const { return of_label_.at(hypotheses_[j].hypothesis.label) >= least_; }
  bool is_open_after(std::size_t i, double x) const;
  std::array<double, 2> left_after(std::size_t i, double x) const;
  static double shorter_way(const Other& ends, double rolled);

  const std::vector<PartHypothesis>& hypotheses_;
  const Comparison& back_;
  const Comparison& forward_;
  std::map<std::size_t, double> of_label_;  // probability
  double least_ = 0;                        // what has less of it is not waited for
  std::vector<std::vector<Other>> others_;  // of each hypothesis, those that can be told from it
};

}  // namespace rollfix::advising
