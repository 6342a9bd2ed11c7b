#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "advise/comparison.hpp"

namespace rollfix::belief {

/// What is still to be travelled after a roll, for the place where the contact is to be told from the others.
class Travel {
 public:
  Travel(const std::vector<PartHypothesis>& hypotheses, const Comparison& back, const Comparison& forward);

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
  bool counts(std::size_t j) const { return of_label_.at(hypotheses_[j].hypothesis.label) >= kHypothesisCounts; }
  bool is_open_after(std::size_t i, double x) const;
  std::array<double, 2> left_after(std::size_t i, double x) const;
  static double shorter_way(const Other& ends, double rolled);

  const std::vector<PartHypothesis>& hypotheses_;
  const Comparison& back_;
  const Comparison& forward_;
  std::map<std::size_t, double> of_label_;  // probability
  std::vector<std::vector<Other>> others_;  // of each hypothesis, those that can be told from it
};

}  // namespace rollfix::belief
