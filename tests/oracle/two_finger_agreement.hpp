#pragma once

// What is wrong with an answer of the library about two fingers, in words; nothing where it is all there is.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "oracle/two_fingers.hpp"
#include "rollfix/locate.hpp"

namespace oracle {

class TwoFingerAgreement {
 public:
  TwoFingerAgreement(const Boundary& boundary, const PairQuestion& question, const rollfix::Search& search)
      : boundary_(boundary), truth_(boundary, question), search_(search) {
    if (!truth_.is_told()) return;
    for (const PairCluster& cluster : truth_.clusters()) {
      if (cluster.fit) expect_answered(cluster);
    }
    for (const rollfix::Placement& placement : search.placements) expect_fits(placement);
    expect_apart();
  }

  const std::vector<std::string>& complaints() const { return complaints_; }
  const TwoFingers& truth() const { return truth_; }

 private:
  /// Of the perimeter: what the library's places are accurate to, times its parts' sharpest crossings of two curves.
  static constexpr Real kPlace = 1e-8L;

  template <class... Arguments>
  void complain(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    complaints_.push_back(fmt::format(text, std::forward<Arguments>(arguments)...));
  }

  Real slack() const { return kPlace * boundary_.perimeter(); }

  Real distance(Real one, Real other) const {
    return std::abs(boundary_.closed() ? std::remainder(one - other, boundary_.perimeter()) : one - other);
  }
  Real distance(const Pair& pair, const rollfix::PerFinger<double>& start) const {
    return std::max(distance(pair[0], start[0]), distance(pair[1], start[1]));
  }

  Real outside(Real s, const Interval& arc) const {
    Real least = std::numeric_limits<Real>::infinity();
    for (const int lap : {-2, -1, 0, 1, 2}) {
      const Real at = s + lap * boundary_.perimeter();
      if (lap == 0 || boundary_.closed()) least = std::min(least, std::max({Real{0}, arc.lo - at, at - arc.hi}));
    }
    return least;
  }

  template <class Box>
  bool holds(const Box& box, const Pair& pair) const {
    return outside(pair[0], {box[0].lo, box[0].hi}) <= slack() && outside(pair[1], {box[1].lo, box[1].hi}) <= slack();
  }

  void expect_answered(const PairCluster& cluster) {
    const Pair& fit = *cluster.fit;
    for (const auto& box : search_.unresolved) {
      if (holds(box, fit)) return;
    }
    for (const rollfix::Placement& placement : search_.placements) {
      if (!holds(placement.extent, fit)) continue;
      if (!cluster.is_root || placement.kind == rollfix::Kind::stretch) return;
      for (const auto& root : placement.roots) {
        if (distance(fit, root) <= slack()) return;
      }
    }
    complain("lost: ({:.12g}, {:.12g}) {}", fit[0], fit[1], cluster.is_root ? "is a root" : "fits");
  }

  void expect_fits(const rollfix::Placement& placement) {
    const Pair start{placement.start[0], placement.start[1]};
    for (const PairCluster& cluster : truth_.clusters()) {
      for (const Rectangle& box : cluster.starts) {
        if (holds(box, start)) return;
      }
    }
    complain("does not fit: ({:.12g}, {:.12g})", start[0], start[1]);
  }

  void expect_apart() {
    const auto& placements = search_.placements;
    for (std::size_t i = 0; i < placements.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (placements[i].start == placements[j].start) complain("{} and {} are one", j, i);
      }
    }
  }

  const Boundary& boundary_;
  TwoFingers truth_;
  const rollfix::Search& search_;
  std::vector<std::string> complaints_;
};

}  // namespace oracle
