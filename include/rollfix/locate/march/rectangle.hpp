#pragma once

#include <cmath>
#include <cstddef>

#include "rollfix/locate/march/figure_6.hpp"
#include "rollfix/locate/march/pair_result.hpp"

namespace rollfix::march {

/// Section 3.2: all pairs in one pair of monotone intervals, along its correspondence.
class Rectangle {
 public:
  /// `iteration` and `bisection` count the steps of each.
  struct Tallies {
    Tally iteration;
    Tally bisection;
  };

  Rectangle(const Correspondence& way, const PairMarchOptions& options, double perimeter, Tallies& tallies);

  /// Adds pairs, not reduced to one loop, doubts and counts to `result`.
  void search(PairResult& result);

 private:
  void bisect();
  void march();
  bool at_end() const;
  bool root_at(const StartsOfBoth& place) const;
  bool tells(const StartsOfBoth& place) const { return std::fabs(place.excess(1)) > way_.begin.problem->rounding; }
  int side(const StartsOfBoth& place) const;

  void note(const StartsOfBoth& place, const Figure6& how, PairFound found);
  void note_boundary(const StartsOfBoth& place);
  void advance(double amount);
  void reset();
  void escape(std::size_t iterations);
  void doubt(PairDoubt::Why why, const StartsOfBoth& from, const StartsOfBoth& to, std::size_t iterations);

  const Correspondence& way_;
  const PairMarchOptions& options_;
  double perimeter_;
  Tallies& tallies_;
  LimitRule rule_;
  StartsOfBoth at_;
  std::size_t first_find_ = 0;
  PairResult* result_ = nullptr;
};

}  // namespace rollfix::march
