#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "observation.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

// Rows that trials are compared by, before all are looked at.
inline constexpr std::size_t kRowsToCompare = 48;

/// The fingers whose lengths are scaled: all, or one of two.
using Whose = std::optional<std::size_t>;

/// How many times as long as they were measured the rows say that lengths are.
struct SettledScale {
  double scale = 1;
  double sd = 0;
  Belief belief;  // with it
};

/// By which factor lengths may be off, as by a wrong radius or another unit, of any size.
class LengthScales {
 public:
  /// Both have to outlive it.
  LengthScales(const Problem& problem, const Observation& observed) : problem_(problem), observed_(observed) {}

  /// Where a few rows fit best, the best first.
  std::vector<double> worth_a_look(const Whose& whose) const;

  /// From such a scale on by all rows; none: they ask for any scale, or can't be had with this one.
  std::optional<SettledScale> settled(const Whose& whose, double scale) const;

 private:
  std::vector<double> all(const Whose& whose) const;
  bool may_be_of_two(double scale) const;
  bool may_be(double scale) const;
  std::optional<Belief> belief_with(const Whose& whose, double scale, std::size_t rows) const;

  const Problem& problem_;
  const Observation& observed_;
  mutable double turn_beyond_ = -1;  // what a turn may be off for its length, radians; below 0: not known yet
};

}  // namespace rollfix
