#pragma once

// What is wrong with an answer of the library about one finger, in words; nothing where it is all there is.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "oracle/arcs.hpp"
#include "oracle/one_finger.hpp"
#include "rollfix/locate.hpp"

namespace oracle {

class OneFingerAgreement : Arcs {
 public:
  OneFingerAgreement(const Boundary& boundary, const Question& question, const rollfix::Search& search)
      : Arcs(boundary), truth_(boundary, question), question_(question), search_(search) {
    for (const Cluster& cluster : truth_.clusters()) {
      if (cluster.fits) expect_answered(cluster);
      for (const Interval& root : cluster.roots) expect_root(root);
    }
    for (const rollfix::Placement& placement : search.placements) {
      expect_fits(placement);
      expect_ends(placement);
    }
    expect_apart();
  }

  const std::vector<std::string>& complaints() const { return complaints_; }
  const OneFinger& truth() const { return truth_; }

 private:
  template <class... Arguments>
  void complain(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    complaints_.push_back(fmt::format(text, std::forward<Arguments>(arguments)...));
  }

  bool is_left_open(const Interval& starts) const {
    return std::any_of(search_.unresolved.begin(), search_.unresolved.end(),
                       [&](const auto& open) { return meets(extent(open[0]), starts); });
  }

  bool is_answered(const Interval& starts) const {
    return std::any_of(search_.placements.begin(), search_.placements.end(),
                       [&](const rollfix::Placement& placement) { return meets(extent(placement.extent[0]), starts); });
  }

  void expect_answered(const Cluster& cluster) {
    if (is_answered(cluster.starts) || is_left_open(cluster.starts)) return;
    complain("lost: [{:.12g}, {:.12g}] fits", cluster.starts.lo, cluster.starts.hi);
  }

  void expect_root(const Interval& root) {
    for (const rollfix::Placement& placement : search_.placements) {
      if (placement.kind == rollfix::Kind::stretch && meets(extent(placement.extent[0]), root)) return;
      for (const auto& listed : placement.roots) {
        if (meets({listed[0], listed[0]}, root)) return;
      }
    }
    if (!is_left_open(root)) complain("no root listed in [{:.12g}, {:.12g}]", root.lo, root.hi);
  }

  void expect_fits(const rollfix::Placement& placement) {
    const auto holds = [&](const Cluster& cluster) {
      return covers(cluster.starts, shrunk(extent(placement.extent[0])));
    };
    const auto& clusters = truth_.clusters();
    if (std::any_of(clusters.begin(), clusters.end(), holds)) return;
    complain("does not fit: [{:.12g}, {:.12g}]", placement.extent[0].lo, placement.extent[0].hi);
  }

  /// Just beyond an extent's ends nothing fits any more.
  void expect_ends(const rollfix::Placement& placement) {
    if (placement.whole_loop[0]) return;
    const Interval arc = extent(placement.extent[0]);
    const Real off = slack() + kStraight * arc.width();
    for (const Real beyond : {arc.lo - off, arc.hi + off}) {
      if (!boundary_.closed() && (beyond < truth_.events().front() || beyond > truth_.events().back())) continue;
      const Real f = truth_.f(beyond);
      const bool goes_on = std::abs(f) <= question_.tolerance - question_.doubt;
      if (goes_on && !is_answered(beyond) && !near_jump(beyond) && !is_left_open(beyond))
        complain("goes on at {:.12g}: f = {:.3g}", beyond, f);
    }
  }
  bool near_jump(Real s) const {
    return std::any_of(truth_.events().begin(), truth_.events().end(), [&](Real event) {
      return truth_.has_jump(event) && meets({event, event}, {s, s});
    });
  }

  /// Of each connected set there is one placement.
  void expect_apart() {
    for (std::size_t i = 0; i < search_.placements.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (overlap(extent(search_.placements[i].extent[0]), extent(search_.placements[j].extent[0]))) {
          complain("{} and {} overlap", j, i);
        }
      }
    }
  }
  bool overlap(const Interval& one, const Interval& other) const {
    for (const int lap : {-1, 0, 1}) {
      const Real off = lap * boundary_.perimeter();
      if (lap != 0 && !boundary_.closed()) continue;
      const Interval common(std::max(one.lo, other.lo + off), std::min(one.hi, other.hi + off));
      if (common.lo < common.hi || (lap == 0 && one.lo == other.lo && one.hi == other.hi)) return true;
    }
    return false;
  }

  OneFinger truth_;
  Question question_;
  const rollfix::Search& search_;
  std::vector<std::string> complaints_;
};

}  // namespace oracle
