#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "box_search.hpp"
#include "held_rows.hpp"
#include "rollfix/part.hpp"
#include "wheel_pins.hpp"

namespace rollfix::hold {

/// First contacts of all fingers; with noise how much longer each finger's lengths are than measured, and how much
/// larger each wheel's radius; the zero of each wheel's encoder.
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kMostFingers, 1>;
using UnknownsMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * kMostFingers, 2 * kMostFingers>;

/// Unknowns by their numbers.
using Held = std::vector<Eigen::Index>;

/// The part at one instant: where a point in its middle is in the world, and how it is turned.
struct Placed {
  Vec2 middle = Vec2::Zero();
  double heading = 0;     // radians
  double heading_sd = 0;  // beside wheels, with the unknowns given; else 0
};

/// First contacts with the poses that suit them best.
struct HeldState {
  Unknowns unknowns;           // first contacts, unwrapped, then stretches, then of each wheel ...
                               // ... how much its radius is larger and its encoder's zero
  std::vector<Placed> placed;  // at each row
  double square = 0;           // of all residuals over their errors, and of priors: chi-square
  double cost = 0;             // that, and with noise what corners add to the logarithm of the errors' size
  double steps = 0;            // in both: of going from pose to pose where rows have several, see hold_paths.cpp
  double right_square = 0;     // of what is no outlier, without priors
  double prior_square = 0;     // of what was known of the first contact and of the pose beforehand
  double strays = 0;           // measurements that are outliers, by their probabilities
};

/// The pose at one row by the unknowns: mean, its change with them, and what is unknown besides.
struct PoseAtRow {
  Pose pose;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2 * kMostFingers> by_unknowns;  // of x, y, heading
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();                          // with the unknowns given
};

/// The normal equations of the unknowns, with all poses eliminated.
struct Reduced {
  UnknownsMatrix matrix;  // H: sum over the rows of M - B^T P^-1 B, and priors
  Unknowns slope;         // minus half the gradient of the square
  double log_volume = 0;  // of the poses and of the errors: what the density has besides the squares
};

/// What was measured of one contact less what it would be, and its derivatives.
struct ContactResidual {
  Vec2 place = Vec2::Zero();  // in the world
  double turn = 0;            // radians
};

/// Least squares over first contacts, with a pose of its own at each row: Levenberg's method on what is left when the
/// poses are eliminated.
class HoldFit {
 public:
  /// All three have to outlive it.
  HoldFit(const Part& part, const HeldRows& rows, const WheelPaths& wheels);

  const HeldRows& rows() const { return rows_; }
  std::size_t fingers() const { return rows_.fingers(); }
  std::size_t wheels() const { return rows_.wheels.size(); }
  /// How many unknowns there are.
  Eigen::Index size() const { return size_; }
  bool has_stretches() const { return has_stretches_; }
  /// A standard deviation of an unknown that is no first contact, before the roll; of an encoder's zero pi.
  double scale_of(Eigen::Index unknown) const;

  /// The state with these first contacts, and poses near a guess of each row.
  HeldState at(const std::vector<double>& first_contacts) const;
  /// The state with these unknowns, its poses fitted from those of another.
  HeldState at(const Unknowns& unknowns, const HeldState& near) const;
  /// Beside wheels with poses that follow from one another: see hold_paths.cpp.
  HeldState afresh(const Unknowns& unknowns) const;
  /// The nearest minimum of the cost, by Levenberg's method. `held`: these unknowns stay.
  HeldState fit(HeldState state, const Held& held = {}) const;
  /// Without noise: about the state whose largest residual, over its tolerance, is smallest; ends as soon as that is at
  /// most 1. A local search: that it finds none proves nothing.
  HeldState best_worst(HeldState from);

  /// The state, and with other poses at its first and its last row all that fit these as well: a finger beside wheels
  /// that is on a corner there may face them in several ways.
  std::vector<HeldState> poses_at_ends(const HeldState& state) const;

  /// The normal equations of the unknowns at a state, linear about its poses.
  Reduced reduced(const HeldState& state) const;
  /// The part's pose at a row: x and y of the origin of its frame, heading.
  PoseAtRow pose_at(const HeldState& state, std::size_t row) const;
  /// r and t of a contact.
  ContactResidual residual(const HeldState& state, std::size_t row, std::size_t finger) const;
  /// The largest residual as a share of what it may be: without noise at most 1 fits.
  double worst(const HeldState& state) const;
  /// What a contact in the world gains by its finger's stretch, per e: with a wrong radius the arm is too long.
  Vec2 by_stretch(std::size_t row, std::size_t finger) const {
    return -rows_.errors[finger].arm_share * rows_.rows[row].contacts[finger].lever;
  }
  /// How much longer a finger's lengths are than measured, as a share: e.
  double stretch_of(const HeldState& state, std::size_t finger) const {
    return has_stretches_ ? state.unknowns(static_cast<Eigen::Index>(fingers() + finger)) : 0;
  }
  /// Where a contact is by its first contact and length alone, unwrapped: z + L / (1 + e).
  double place_of(const HeldState& state, std::size_t row, std::size_t finger) const;
  /// With noise: the error n of a row's contact along the boundary, as its normal tells it. The contact is at
  /// z + L / (1 + e) - n.
  struct ContactError {
    double mean = 0;       // length
    double by_turn = 0;    // change of the mean with r
    double variance = 0;   // that r leaves
    double curvature = 0;  // of the part there
  };
  ContactError contact_error(const HeldState& state, std::size_t row, std::size_t finger) const;
  /// Where a wheel touches at a row, how that changes with the pose, and its variance with the pose given.
  struct WheelAt {
    double s = 0;
    Eigen::RowVector3d by_pose = Eigen::RowVector3d::Zero();
    double variance = 0;
  };
  WheelAt wheel_at(const HeldState& state, std::size_t row, std::size_t wheel) const;
  /// How far off the wheel is in length, first coordinate, and its encoder in angle.
  ContactResidual wheel_residual(const HeldState& state, std::size_t row, std::size_t wheel) const;
  /// The unknown that scales a contact's lengths, or a wheel's radius. None: they are as said.
  std::optional<Eigen::Index> scale_unknown(std::size_t contact) const;
  /// That scale, give or take, where the unknown is `value`: lengths are 1 / (1 + e) times what was measured.
  std::pair<double, double> scale_of_lengths(std::size_t contact, double value, double sd) const;
  /// Numbers that the rows say, less those that each row's pose takes; angles of pivots count as one for each corner.
  double freedom(const HeldState& state) const;
  /// With noise: how probable rows are that contradict a fit so much by one measurement alone, by the lengths of one
  /// finger or of all, or by a slip, whichever is the least: hold_doubt.cpp. Of fits with
  /// outliers or beside wheels 1: there it is not looked for.
  double p_of_oddest(const HeldState& state) const;

 private:
  struct Sight;
  /// What turns a row's normal beside its orientation: a row that is the mean of so many; by the contact's error, a
  /// standard deviation, unevenly or not; by corners, a variance.
  struct TurnErrors {
    double rows = 1;
    double bend = 0;
    double corner = 0;
    bool is_bent = false;
  };
  Sight sight(double s, double stretch, std::size_t row, std::size_t finger) const;
  void weigh_exactly(Sight& sight, const HeldErrors& errors, double times) const;
  void weigh(Sight& sight, const HeldContact& contact, const HeldErrors& errors, double rows) const;
  static void weigh_place(Sight& sight, const HeldContact& contact, const HeldErrors& errors, const TurnErrors& turn);
  std::vector<Sight> sights_at(const HeldState& state, std::size_t row) const;
  struct Look;
  Look look(const Sight& sight, const Placed& placed, std::size_t row, std::size_t finger) const;
  Look look(const HeldState& state, std::size_t row, std::size_t finger) const;
  void bend(Look& look, double finger_curvature) const;
  static void charge(Look& look, double off);
  static void pivot(Look& look, double finger_tangent, double side_tangent);
  struct RowEquations;
  RowEquations equations(const HeldState& state, std::size_t row, const std::vector<Sight>& sights,
                         bool with_unknowns) const;
  struct PinLook;
  PinLook pin_look(const HeldState& state, std::size_t row, std::size_t wheel) const;
  void add_pin(const HeldState& state, std::size_t row, std::size_t wheel, bool with_unknowns, RowEquations& sum) const;
  NearPin near_pin(const HeldState& state, std::size_t row, std::size_t wheel) const;
  double unwrapped_heading(const HeldState& state, std::size_t row) const;
  double spin_of(const HeldState& state, std::size_t row, std::size_t wheel, const NearPin& near) const;
  /// The part as the finger may have it, and how far the wheels are from touching it then.
  struct Facing {
    Placed placed;
    double off = 0;  // sum over the wheels of distances, length
  };
  std::vector<Facing> facings(const HeldState& state, std::size_t row) const;
  Facing faced(std::size_t row, const Vec2& point, const Vec2& touched, double heading) const;
  std::vector<Placed> touching(const HeldState& state, std::size_t row) const;
  void face_wheels(HeldState& state, std::size_t row) const;
  std::vector<HeldState> poses_of(const HeldState& state, std::size_t row) const;
  std::vector<HeldState> paths(const HeldState& state) const;
  void zero_spins(HeldState& state, std::size_t rows) const;
  struct PathPose;
  std::vector<PathPose> poses_at(HeldState& state, std::size_t row) const;
  using PosesOfRows = std::vector<std::vector<PathPose>>;
  PosesOfRows all_poses(HeldState& state) const;
  static std::vector<double> step_costs(const Placed& from, const std::vector<PathPose>& to, double step);
  static double step_of(const PosesOfRows& rows);
  static void follow(PosesOfRows& rows, std::optional<std::size_t> first);
  static void take(const PosesOfRows& rows, std::size_t last, HeldState& state);
  void follow(HeldState& state) const;
  double worst_of_wheel(const HeldState& state, std::size_t row, std::size_t wheel) const;
  double worst_of(const HeldState& state, std::size_t row, std::size_t contact) const;
  std::optional<Eigen::Index> radius_unknown(std::size_t wheel) const;
  std::optional<Eigen::Index> spin_unknown(std::size_t wheel) const;
  /// `contact`: of a finger, or behind all of them of a wheel.
  double weight(std::size_t row, std::size_t contact) const {
    return weights_.empty() ? 1 : weights_[row * (fingers() + wheels()) + contact];
  }
  RowEquations settled(HeldState& state, std::size_t row) const;
  /// How a measurement counts that may be an outlier.
  struct Counted {
    double cost = 0;   // in place of its square
    double right = 1;  // probability that it is none
  };
  Counted counted(const Look& look, double square) const;
  RowEquations settled_by_fewer(HeldState& state, std::size_t row, const RowEquations& all) const;
  double prior_offset(const HeldState& state) const;
  void add_pose_prior(const Placed& placed, RowEquations& sum) const;
  void settle(HeldState& state) const;
  void guess(HeldState& state, std::size_t row) const;
  HeldState guessed(const Unknowns& unknowns) const;
  void refer(HeldState& state, std::size_t row) const;
  double pivot_length(const HeldContact& contact) const;
  double p_of_measurement(const HeldState& state, std::size_t row, std::size_t finger,
                          const Eigen::Matrix3d& pose_covariance) const;
  double p_of_worst_measurement(const HeldState& state) const;
  /// What a row says of the unknowns, with its pose eliminated.
  struct RowShare {
    UnknownsMatrix matrix;
    Unknowns slope;
  };
  std::vector<RowShare> row_shares(const HeldState& state) const;
  /// How far each finger's contact moves at each row, in some way.
  using Way = std::function<double(std::size_t row, std::size_t finger)>;
  struct Moved {
    const Way* way = nullptr;  // nullptr: the unknowns can make up for all of them
    double by = 0;             // times what the way says, by the normal equations
  };
  Moved best_moved(const std::vector<Way>& ways, const HeldState& state) const;
  double p_of_moved(const std::vector<Way>& ways, const HeldState& state) const;
  double p_of_lengths(const HeldState& state) const;
  double p_of_slip(const HeldState& state) const;
  double prior_precision(Eigen::Index unknown) const;

  const Part& part_;
  const HeldRows& rows_;
  const WheelPaths& wheels_;
  mutable std::vector<std::optional<touch::PathPlace>> feet_;  // of each row, of each wheel: where it was found last
  bool has_stretches_ = false;                                 // lengths of fingers are unknowns
  double settled_ = 0;           // a step that gains no more than this share of all squares and 1 is the last
  Eigen::Index size_ = 0;        // unknowns
  Vec2 middle_ = Vec2::Zero();   // m, in the part's frame: poses are by where it is
  std::vector<double> weights_;  // of each contact and wheel of each row; empty: 1 each
};

/// The boundary at a place that is known to some length only: a corner nearby is blurred by it.
struct BlurredPlace {
  double side = 0;          // Theta at the place itself, radians: how the point goes
  double angle = 0;         // mean of Theta, radians
  double bend = 0;          // its derivative by s, corners included
  double curvature = 0;     // without corners
  double variance = 0;      // of Theta, by corners
  double pivoting = 0;      // how probable it is that the finger pivots, at the likeliest corner there, ...
  double past = 0;          // ... and how far the place is past that, length
  double other = 0;         // Theta on the other side of the nearest corner there
  bool has_corner = false;  // near enough to be seen
  double half_turn = 0;     // without blur: Theta is within this of `angle`
};

/// p(s); beyond an open boundary's end its tangent continues it, so that a fit that has left it can return.
Vec2 point_about(const Part& part, double s);

/// Theta on average over a normal distribution about s. `pivot`: the length that a radian of pivoting counts as, of a
/// disk its radius: its centre goes as far about a corner.
BlurredPlace blurred(const Part& part, double s, double sd, double pivot);

/// Theta at s + m less Theta at s; beyond an open boundary's end it stays.
double turn_from(const Part& part, double s, double m);
double curvature_at(const Part& part, double s);

/// Theta's range within `reach` of s: for measurements that are exact but for their digits.
BlurredPlace ranged(const Part& part, double s, double reach);

/// Where contacts are exact they are still blurred by this share of the perimeter, so that corners have a slope.
inline constexpr double kLeastBlur = 1e-7;
/// Of a standard deviation of the heading: poses of a row that differ by less are one.
inline constexpr double kSamePose = 0.05;
/// A pose by whose square a row is so much worse is five standard deviations off.
inline constexpr double kFitsToo = 25;

using RowBlock = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2 * kMostFingers>;

/// Where a contact is on the part, and how far it may be off: whatever the part's pose.
struct HoldFit::Sight {
  BlurredPlace at;
  Vec2 point = Vec2::Zero();                                    // if it is evidence
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();        // C^-1, 0 for what is not measured
  Eigen::Matrix3d plain_information = Eigen::Matrix3d::Zero();  // without corners
  double log_size = 0;                                          // log det C, corners by their share
  double blur_size = 0;                                         // of it what corners add
  double angles = 1;                                            // numbers that the angle counts as
  double plain = 0;                                             // variance of t without corners
  double turn_variance = 0;                                     // of t without n, with what a corner adds
  double s = 0;                                                 // the contact's place, z + L / (1 + e)
  double stretch = 0;                                           // e
  // Where the normal turns unevenly over the contact's error n: without n.
  std::optional<Eigen::Matrix3d> bare_information{};
  double bare_log_size = 0;
  double error = 0;  // standard deviation of n
};

/// A contact's residuals with their derivatives: of r (two rows) and of t.
struct HoldFit::Look : Sight {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();     // a row of each residual; columns A.x, A.y, phi
  Eigen::Vector3d by_place = Eigen::Vector3d::Zero();    // by s
  Eigen::Vector3d by_stretch = Eigen::Vector3d::Zero();  // by e, s moving along
};

/// A wheel's residuals, of closure, encoder and line of force, with their derivatives; what is not measured is 0.
struct HoldFit::PinLook {
  NearPin near;  // where the wheel touches
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Zero();      // a row of each residual
  Eigen::Vector3d information = Eigen::Vector3d::Zero();  // 1 / variance of each
  double by_radius = 0;  // of the first by the radius, of the second by the encoder's zero
  double by_spin = 0;
  double log_size = 0;
};

/// The normal equations of one row, and what it adds to chi-square and to the density.
struct HoldFit::RowEquations {
  Eigen::Matrix3d pose = Eigen::Matrix3d::Zero();   // P = sum of A^T C^-1 A, by x, y of A and the heading
  Eigen::Matrix3d plain = Eigen::Matrix3d::Zero();  // the same without corners, for the density
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  // minus half the gradient of the square by the pose
  RowBlock mixed;                                   // B; this and the next two only if asked for
  UnknownsMatrix own;                               // M
  Unknowns own_slope;                               // minus half the gradient by the unknowns
  double square = 0;                                // of all residuals, with priors of the first row
  double right_square = 0;                          // see HeldState, as are the next two
  double prior_square = 0;
  double strays = 0;
  double log_size = 0;   // sum of log det C over the measurements
  double blur_size = 0;  // of it what corners add
};

}  // namespace rollfix::hold
