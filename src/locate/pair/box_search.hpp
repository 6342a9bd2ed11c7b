#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "components.hpp"
#include "plane_curve.hpp"

namespace rollfix::locating {

/// Branch and prune on boxes of two first contacts: where two curves meet, all of it, proved complete. A box goes when
/// its sides can't meet; where J has an inverse on all of it there is one root at the most, and Newton's method says
/// whether; where the curves run alongside each other one equation is followed as a line through the box; what is left
/// is halved.
class PairBoxSearch {
 public:
  /// Both curves have the same rows; their trees grow during the search. `budget` is taken from, `findings` is added
  /// to.
  PairBoxSearch(PlaneCurve& a, PlaneCurve& b, const PairLimits& limits, std::size_t& budget, PairFindings& findings);

  /// Decides all pairs of places on the two curves, depth first. What is left when the budget ends goes to
  /// `unresolved`.
  void run();

 private:
  /// A pair of nodes, one of each tree.
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
    double spectral_radius;   // of `off`: what the simplified Newton step contracts by
  };

  /// Excludes a box by the bounds of its two nodes, or decides it on its pieces, or halves it.
  void decide(const Box& box);
  void decide_on_pieces(Box box, const PairBoxSides& sides, const PairLimits& limits);
  /// Of take_flat: f varies too much to tell; the box is decided; or all of it is listed and only its roots are
  /// missing.
  enum class Flat { no, settled, covered };

  bool meet_nowhere_across(const Box& box, double lap, double tolerance) const;
  bool is_apart(const PairBoxSides& sides, const PairLimits& limits) const;
  /// Two rows whose J is proved invertible on the whole box, those that contract most; empty: none.
  std::optional<Regular> regular(const PairBoxSides& sides) const;
  /// False: the set within the tolerance bends too much in this box to be taken as straight.
  bool take_regular(const PairBoxSides& sides, const PairLimits& limits, const Regular& regular);
  Flat take_flat(const PairBoxSides& sides, const PairLimits& limits);
  bool corners_vanish(const PairBoxSides& sides) const;
  /// Halves one side, a's or b's.
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
