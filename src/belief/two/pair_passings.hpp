#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "belief/nodes.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {

struct PairModel;

// What is wider than so many standard deviations of a contact has a flat middle between passings.
inline constexpr double kWide = 6;

/// A place of a first contact from where a node is at a corner, or at an open outline's end, with its standard
/// deviation.
struct Passing {
  double s = 0;
  double sd = 0;
};

/// All of one finger. Between two neighbours the likelihood is smooth: nearly constant, on flat sides; at each it
/// changes within the passing's standard deviation.
class Passings {
 public:
  Passings(const PairModel& model, std::size_t finger, const std::vector<PairNode>& nodes);

  bool empty() const { return passings_.empty(); }
  /// In order. REQUIRES on a closed outline: both on the first lap.
  std::span<const Passing> between(double lo, double hi) const;
  /// The least standard deviation of those within `reach` of s; infinite where there are none.
  double sharpest(double s, double reach) const;
  /// From the last one before s to the next after it, unwrapped as s is; infinite where there is none.
  Interval gap(double s) const;

 private:
  Boundary boundary_;
  std::vector<Passing> passings_;  // in order
};

/// Does it turn by more than the noise of the facing?
bool is_felt(const PairModel& model, const Corner& corner);

}  // namespace rollfix::belief
