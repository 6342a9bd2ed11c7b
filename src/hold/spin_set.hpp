#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix::hold {

/// What an encoder's zero can be: some intervals, modulo a period if there is one. Nothing known: all.
class SpinSet {
 public:
  explicit SpinSet(double period) : period_(period) {}

  bool is_empty() const { return intervals_ && intervals_->empty(); }

  /// What this and another set of intervals have in common.
  void keep(const std::vector<Interval>& others) {
    if (!intervals_) {
      intervals_ = joined(others);
      return;
    }
    std::vector<Interval> common;
    for (const Interval& one : *intervals_) {
      for (const Interval& other : others) add_common(one, other, common);
    }
    intervals_ = joined(std::move(common));
  }

 private:
  void add_common(const Interval& one, const Interval& other, std::vector<Interval>& common) const {
    const double first = period_ > 0 ? std::ceil((one.lo - other.hi) / period_) : 0;
    const double last = period_ > 0 ? std::floor((one.hi - other.lo) / period_) : 0;
    for (double lap = first; lap <= last; lap += 1) {
      const Interval both{std::max(one.lo, other.lo + lap * period_), std::min(one.hi, other.hi + lap * period_)};
      if (both.lo <= both.hi) common.push_back(both);
    }
  }

  /// In order, those that overlap as one.
  static std::vector<Interval> joined(std::vector<Interval> intervals) {
    std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
    std::vector<Interval> result;
    for (const Interval& one : intervals) {
      if (!result.empty() && one.lo <= result.back().hi) {
        result.back().hi = std::max(result.back().hi, one.hi);
      } else {
        result.push_back(one);
      }
    }
    return result;
  }

  double period_ = 0;
  std::optional<std::vector<Interval>> intervals_;
};

}  // namespace rollfix::hold
