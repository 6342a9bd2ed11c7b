#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "box_side.hpp"
#include "pair_find.hpp"
#include "plane_curve.hpp"

namespace rollfix::locating {

/// Branch and prune on boxes of two first contacts: where two curves meet, all of it, proved complete. A box goes when
/// its sides can't meet; where J has an inverse on all of it there is one root at the most, and Newton's method says
/// whether; where the curves run alongside each other one equation is followed as a line through the box; what is left
/// is halved.
class BoxSearch {
 public:
  BoxSearch(PlaneCurve& a, PlaneCurve& b, const PairLimits& limits, std::size_t& budget, PairFindings& findings);

  void run();

 private:
  struct Box {
    std::int32_t a;
    std::int32_t b;
    int depth;     // halvings since both sides are on one piece each
    bool covered;  // see PairLimits
  };

  /// Two rows whose Jacobian is invertible on a whole box.
  struct Regular {
    std::array<std::size_t, 2> rows;
    Eigen::Matrix2d inverse;  // of the middle Jacobian
    Eigen::Matrix2d off;      // bounds on 1 - inverse * J, entry by entry
    Eigen::Matrix2d slack;    // (1 - off)^-1
    double radius;            // the spectral radius of `off`: what the simplified Newton step contracts by
  };

  void decide(const Box& box);
  void decide_on_pieces(Box box, const PairBoxSides& sides, const PairLimits& limits);
  enum class Flat { no, settled, covered };

  bool meet_nowhere_across(const Box& box, double lap, double tolerance) const;
  bool is_apart(const PairBoxSides& sides, const PairLimits& limits) const;
  std::optional<Regular> regular(const PairBoxSides& sides) const;
  bool take_regular(const PairBoxSides& sides, const PairLimits& limits, const Regular& regular);
  Flat take_flat(const PairBoxSides& sides, const PairLimits& limits);
  bool corners_vanish(const PairBoxSides& sides) const;
  void halve(const Box& box, bool side_a);
  bool a_is_wider(const Box& box) const;

  PlaneCurve& a_;
  PlaneCurve& b_;
  PairLimits limits_;
  std::size_t& budget_;
  PairFindings& findings_;
  std::vector<Box> waiting_;
};

}  // namespace rollfix::locating
