#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <memory_resource>

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief/posterior.hpp"
#include "belief/tilted_boundary.hpp"

namespace rollfix::belief {

/// How outliers are taken: as a share of rows whose place says nothing, spread over `range`. Share 0: there are none.
struct Outliers {
  double share = 0;
  double range = 1;  // length
};

/// What a row adds to a filter. Minus twice the logarithm of its likelihood is cost + log(volume).
struct RowShare {
  double weight;  // probability that it is not an outlier
  double cost;
  double volume;  // det S / det S_w
};

/// Of so many equations: by how much they miss, squared, in standard deviations; and the determinants of their
/// covariance by noise alone, the row's own and what has gathered on the way, and of that with what the rows share.
RowShare share_of(int equations, double squared, double noise, double all, const Outliers& outliers);

/// One first contact on trial: an extended Kalman filter of the errors that the whole roll shares, which gives the
/// samples' likelihood along the way, and how that changes with the place.
class RollFilter {
 public:
  /// `centres`: nullptr where they are not looked at.
  RollFilter(const TiltedArc& arc, double tilt, double w, const SharedCovariance& start, const CentreModel* centres);
  /// The same again, with what the rows were found to share: from the first one on they are linearised about that, and
  /// over what that leaves open.
  RollFilter again(const SharedCovariance& start, std::pmr::memory_resource* memory) const;

  /// Takes a row with its centre, as three equations; see side_by_side.cpp for rows without.
  void update(const Node& node, const Outliers& outliers);
  /// The rows were taken about nearly what they were found to share. `accuracy`: of the contact's place in w after a
  /// full turn, and after this time from the roll's start.
  bool is_settled(double accuracy, double seconds) const {
    constexpr double kFullTurn = 2 * std::numbers::pi;
    if (!found_) return false;
    const Eigen::Matrix<double, kRolling, 1> off = (x_.head<kRolling>() - found_->errors).cwiseAbs();
    return std::max({tilt_ * off[0], off[1], kFullTurn * off[3], seconds * off[4]}) <= accuracy;
  }

  const TiltedArc* arc() const { return arc_; }
  double w() const { return w_; }
  const TiltedPlace& place() const { return place_; }
  /// Minus twice the logarithm of the likelihood, up to what is the same everywhere: the cost is a squared distance.
  /// Both only grow with every node.
  double cost() const { return cost_; }
  double log_volume() const { return log_volume_ + std::log(volume_); }
  /// Of the noise' volume, what has gathered on the way has added: for one noise it is about the same everywhere.
  double log_gathered() const { return log_gathered_ + std::log(gathered_); }
  double deviance() const { return cost_ + log_volume(); }
  /// The deviance is above that: may find out a little late, and takes no logarithm.
  bool is_beyond(double limit) const { return cost_ + log_volume_ > limit; }
  /// Its derivative by w, and the (expected) information on w: the square of the distance's rate of change.
  double slope() const { return -slope_; }
  double information() const { return information_; }
  /// The same if no row were an outlier: no faster can the distance change between here and elsewhere.
  double steepness() const { return steepness_; }
  /// Of each equation's innovations.
  const std::array<Whiteness, 3>& whiteness() const { return whiteness_; }
  void record_to(Innovations& kept) {
    for (std::size_t k = 0; k < kept.size(); ++k) whiteness_[k].record_to(&kept[k]);
  }
  /// Of robust rows those that are no outliers: their number, as a sum of weights, and their part of the cost.
  double right_rows() const { return right_rows_; }
  double right_cost() const { return right_cost_; }
  const Shared& errors() const { return x_; }
  const SharedCovariance& covariance() const { return p_; }

  /// Where the contact is after a roll that is measured as this, of a first contact so little further on.
  TiltedPlace after(const Row& measured, double further = 0) const;
  /// The same at a first contact that looks like this one.
  RollFilter moved(const TiltedArc& arc, const Shift& shift) const;
  /// Where the part is, as far as the rows tell it for this first contact, and how that changes with w. REQUIRES that
  /// the finger's first contact is known; x and y mean something where has_place().
  PoseSpread pose(Eigen::Vector3d* by_w = nullptr) const;
  bool has_place() const { return centres_ != nullptr && centres_->has_place; }
  /// The variance of that place from the shared errors and the row's own.
  double variance_after(const Row& measured, const RowCovariance& own) const;

 private:
  template <int Errors>
  friend class SideBySide;
  struct Corrected {  // a row's length and turn less the shared errors; its time and gyroscope as they are
    double length;
    double turn;
    double sensed;
    double seconds;
  };
  /// What a pass found that a roll's rows share, and what gathered on the whole way.
  struct Found {
    Eigen::Matrix<double, kRolling, 1> errors;
    Eigen::Matrix<double, kRolling, kRolling> covariance;
    Gathered gathered;
  };
  /// What a row is linearised about, and over.
  struct LinearisedAt {
    Shared errors;
    SharedCovariance open;
  };
  struct Equations;
  Equations equations_at(double w, const LinearisedAt& about, double w_variance, const Node& node) const;
  void add_centre(const SpreadPlace& end, double w, const LinearisedAt& about, const Node& node, Equations& rows) const;
  void absorb(const Node& node, const Outliers& outliers);
  LinearisedAt linearised_at(double length) const;
  static Corrected corrected(const Node& node, const Shared& errors) {
    return corrected(node.length, node.turn, node.sensed, node.seconds, errors);
  }
  static Corrected corrected(const Row& row, const Shared& errors) {
    return corrected(row.reading.length[0], row.reading.turn, row.sensed, row.seconds, errors);
  }
  static Corrected corrected(double length, double turn, double sensed, double seconds, const Shared& errors) {
    return {(length - errors[0]) / (1 + errors[2]), turn - errors[1] - errors[3] * sensed - errors[4] * seconds, sensed,
            seconds};
  }

  /// What length and turn are, by the errors that the roll shares.
  static Eigen::Matrix<double, 2, kRolling> by_rolling(const Corrected& roll, const Shared& errors);
  /// The variance of theta + c L, from the shared errors and a row's own.
  double variance_of_roll(const Corrected& roll, const LinearisedAt& about, const RowCovariance& own) const;

  const TiltedArc* arc_;  // that the first contact is on
  const CentreModel* centres_;
  double tilt_;
  double w_;                                        // of the first contact
  TiltedPlace place_;                               // there
  double most_scale_;                               // bounds on |x|: of the scale of lengths, ...
  double most_gyroscope_scale_;                     // ... of a gyroscope's scale, ...
  double most_bias_;                                // ... and of its bias
  double first_turn_;                               // variance of the offset of turn before the first row
  Shared x_ = Shared::Zero();                       // the shared errors, ...
  SharedCovariance p_;                              // ... and their covariance
  Eigen::Matrix2d walk_ = Eigen::Matrix2d::Zero();  // of the first two, from what has gathered alone
  Shared dx_ = Shared::Zero();                      // of x by w
  double cost_ = 0;                                 // sum of e^T S^-1 e
  double log_volume_ = 0;                           // but for the logarithm of ...
  double volume_ = 1;                               // ... this
  double log_gathered_ = 0;                         // likewise
  double gathered_ = 1;
  double slope_ = 0;  // of half the cost, by w
  double information_ = 0;
  double steepness_ = 0;
  std::array<Whiteness, 3> whiteness_;
  double right_rows_ = 0;
  double right_cost_ = 0;
  Gathered on_the_way_;                 // so far
  std::shared_ptr<const Found> found_;  // by the pass before; nullptr in the first
};

struct GridPoint;

/// Nodes that a filter is to take, in order.
struct FilterRun {
  GridPoint* point = nullptr;  // that it is for
  int pass = 0;                // how often it has gone through them
  RollFilter* filter = nullptr;
  const Node* next = nullptr;
  const Node* end = nullptr;
  bool whole = false;  // all of them, however large the deviance gets
};

/// What rows tell of besides lengths and turns.
struct RowEquations {
  bool centres = false;          // two equations more
  bool gyroscope_scale = false;  // one unknown more, ...
  bool bias = false;             // ... and another
};

/// Gives the next run; false: there is none. It is called with the one that is over, to go on from: its filter has
/// taken all nodes, or those before `next` and is beyond the limit. The first ones are called for with an empty one.
using NextRun = std::function<bool(FilterRun&)>;

/// Goes through runs, several side by side, for each is one long chain of operations that wait for each other. What
/// comes of one does not depend on the others. `limit`: of the deviance, as it is by then.
void run_filters(const NextRun& next, const RowEquations& equations, const double& limit, const Outliers& outliers);

}  // namespace rollfix::belief
