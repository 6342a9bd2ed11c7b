#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/locate/pair_reading.hpp"

namespace rollfix::belief {

/// Errors that two fingers' whole roll shares: of a's and b's lengths as measured, of the scales of both, and of the
/// turn as measured.
using PairShared = Eigen::Matrix<double, 5, 1>;
using PairSharedCovariance = Eigen::Matrix<double, 5, 5>;

/// Neighbouring rows as one: their mean.
struct PairNode {
  bool is_facing = false;             // the first contacts' facing: a row of its own, without lengths
  std::array<double, 2> length{};     // of finger a and of finger b
  double turn = 0;                    // what Theta(s) - Theta(t) should be there, or how much it should have changed
  double rows = 1;                    // as many rows' worth
  double gathered = 0;                // rows since the node before
  std::array<double, 2> travelled{};  // length since the node before
};

/// How the sensors' noise enters two fingers' lengths and turn; docs/two_fingers.md derives it.
class PairErrors {
 public:
  /// `finger_curvature`: of both disks; 0 where it is not known or a jaw. `facing`: the first contacts' facing is
  /// known.
  PairErrors(const BeliefOptions& options, LogKind kind, const std::array<double, 2>& finger_curvature, bool facing,
             double perimeter);

  PairErrors with_scale(double sd) const;
  PairErrors with_slip(double per_length) const;

  /// Of the shared errors before the first row.
  const PairSharedCovariance& start() const { return start_; }
  /// What they gather up to a node, on its diagonal.
  PairShared gathered(const PairNode& node) const;
  /// They gather anything: then no one value of them serves all rows.
  bool drifts() const;

  /// Rows say where the tangents point against each other, not only how that has changed since the first.
  bool absolute() const { return absolute_; }
  double turn_variance() const { return turn_variance_; }        // of a row's turn, on its own
  double contact_variance() const { return contact_variance_; }  // of a row's length, on its own
  double contact_sd() const;
  double facing_variance() const { return facing_variance_; }
  /// With the place u, its error turns the normal that it tells: 1/r for logs of u, else 0.
  double normal_turn(std::size_t finger) const { return normal_turn_[finger]; }
  double perimeter() const { return perimeter_; }

 private:
  LogKind kind_;
  bool bare_;
  bool absolute_;
  double contact_variance_;
  double turn_variance_;
  double facing_variance_;
  double angle_variance_;  // of one finger's row
  double row_contact_variance_;
  std::array<double, 2> normal_turn_{};
  double perimeter_;
  double slip_ = 0;
  PairSharedCovariance start_ = PairSharedCovariance::Zero();
};

/// A roll's rows as at most `most` nodes. `facing`: the first contacts', then the first node. `robust`: of rows that
/// make a node medians are taken, so that a stray one does not move it.
std::vector<PairNode> pair_nodes(const std::vector<PairReading>& rows, const std::optional<double>& facing,
                                 bool absolute, bool robust, std::size_t most);

/// Some of the nodes, evenly, the first and the last among them.
std::vector<PairNode> some_of(const std::vector<PairNode>& nodes, std::size_t most);

}  // namespace rollfix::belief
