#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

#include "pair_find.hpp"

namespace rollfix {

// What is near is looked for along a slant, s + kSlant t: on a part that repeats itself as many pieces as repetitions
// have the same s, or the same t. By the golden ratio, which is far from all fractions.
inline constexpr double kSlant = 0.6180339887498949;

inline double along_slant(const PairPoint& at) { return at[0] + kSlant * at[1]; }

inline Interval along_slant(const PairBox& box) {
  return {along_slant(PairPoint{box[0].lo, box[1].lo}), along_slant(PairPoint{box[0].hi, box[1].hi})};
}

inline PairBox widened(const PairBox& box, double by) {
  return {Interval{box[0].lo - by, box[0].hi + by}, Interval{box[1].lo - by, box[1].hi + by}};
}

/// Their indices in order of where they begin.
inline std::vector<std::size_t> by_place(const std::vector<Interval>& intervals) {
  std::vector<std::size_t> order(intervals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::tie(intervals[a].lo, a) < std::tie(intervals[b].lo, b); });
  return order;
}

}  // namespace rollfix
