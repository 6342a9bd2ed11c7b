#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "measured.hpp"
#include "nearest.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::touch {

/// By 90 degrees counter-clockwise.
inline Vec2 turned_left(const Vec2& vector) { return {-vector.y(), vector.x()}; }

/// A touch whose place on the part is held.
struct Held {
  std::size_t touch = 0;
  PathPlace place;
};

/// A pose that fits the touches best, nearby.
struct FittedPose {
  Pose pose;
  std::vector<PathPlace> places;                          // of each touch, the nearest in that pose
  double square = 0;                                      // sum of the squares of all residuals, in their units
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of (x, y, heading) of what lies at `about`
};

/// A touch's share of the normal equations.
struct Normals {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  // half the derivative of the squares, with its sign
};

/// What a held place does to the best pose, and what the touches know of it.
struct ByPlace {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  // d (x, y, heading) / du, of what lies at `about`
  double information = 0;                          // of u, one by its variance, by all touches ...
  double own_information = 0;                      // ... and by the held one, if the pose were known
};

/// How a pose turns the part.
struct PartFrame {
  Vec2 axis = Vec2::UnitX();  // the part's x axis in the world
  Vec2 about = Vec2::Zero();  // the point of the world about which poses are turned, in the part's frame
  Vec2 in_world(const Vec2& v) const {
    return {axis.x() * v.x() - axis.y() * v.y(), axis.y() * v.x() + axis.x() * v.y()};
  }
  Vec2 in_part(const Vec2& v) const {
    return {axis.x() * v.x() + axis.y() * v.y(), axis.x() * v.y() - axis.y() * v.x()};
  }
};

/// What a contact at a place says of the pose, held there.
Normals normals_at(const PartFrame& frame, const InPart& touch, const CentrePoint& point);

/// What moving the contact along the path does to its squares, alone and with the pose: v^T v and J^T v.
struct Mixed {
  Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();
  double weight = 0;
};
Mixed mixed_at(const PartFrame& frame, const InPart& touch, const CentrePoint& point);

/// Least squares over poses, with each touch at its nearest place: Levenberg's method. Poses are moved about a point of
/// the world near the touches.
class PoseFit {
 public:
  /// `touches` outlive this, and each has its tree by the first fit.
  PoseFit(const std::vector<Measured>& touches, const std::optional<PosePrior>& prior);

  /// The pose with this heading that has the finger at the touch when the contact is there.
  Pose pose_at(const Held& held, double heading) const;
  /// The best pose that descents from this one lead to: a local minimum of the sum of squares, no more.
  FittedPose fit(const Pose& from, const std::optional<Held>& held = {});
  /// The same from a pose whose contacts are known, if a little off.
  FittedPose fit(const FittedPose& from, const std::optional<Held>& held = {});

  /// The same, but none where a pose on the way, with its sum of squares, is known to lead to nothing new.
  using IsKnown = std::function<bool(const Pose&, double)>;
  std::optional<FittedPose> fit_unless(const IsKnown& is_known, const Pose& from, const std::optional<Held>& held);

  /// A pose with the contacts at these places, as it is.
  FittedPose at(const Pose& pose, std::vector<PathPlace> places) const;

  /// The same with each contact where it is nearest.
  FittedPose at(const Pose& pose) const;

  /// The point of the world about which poses are turned.
  const Vec2& about() const { return about_; }
  PathTree& tree(std::size_t touch) const { return *touches_[touch].tree; }
  const CentrePath& path(std::size_t touch) const { return tree(touch).path(); }
  const std::vector<Measured>& touches() const { return touches_; }
  /// Cosine and sine of the heading, computed once for many contacts.
  PartFrame frame(const Pose& pose) const;
  /// A touch as the part's frame has it in this pose.
  InPart in_part(const Pose& pose, std::size_t touch) const;
  /// The place of a contact that fits a pose best, by going downhill from another.
  PathPlace downhill_from(const PathPlace& place, const Pose& pose, std::size_t touch) const;
  /// What a contact there adds to the sum of squares.
  double square_at(const Pose& pose, std::size_t touch, const PathPlace& place, bool is_held) const;
  /// Its share of the normal equations, held there.
  Normals held_normals(const Pose& pose, std::size_t touch, const PathPlace& place) const;
  /// REQUIRES a pose that was fitted with the touch held there, and that it is no roll.
  ByPlace by_place(const FittedPose& fitted, const Held& held) const;
  /// How far, in their units, a small step of the pose moves the touches in the part's frame, at the most.
  double touches_moved(const Eigen::Vector3d& step) const;
  /// What is known beforehand, and that a heading has no more than a turn to be in; and its squares alone.
  Normals prior_normals(const Pose& pose) const;
  double prior_square(const Pose& pose) const;
  bool knows_heading() const { return prior_.has_value(); }
  /// By a step (dx, dy, dphi) of what lies at `about`; the heading is not reduced.
  Pose moved(const Pose& pose, const Eigen::Vector3d& step) const;
  /// Whether a nearest place is at a corner, or an end, so that it stays there when the pose moves a little.
  bool is_pinned(const Pose& pose, std::size_t touch, const PathPlace& place) const;
  /// How far the part is moved from one pose to another: at the touches, and as it turns at its own size.
  double distance(const Pose& one, const Pose& other) const;
  /// The covariance of the pose, of that about the point.
  Eigen::Matrix3d at_origin(const Pose& pose, const Eigen::Matrix3d& covariance) const;

 private:
  struct State;
  InPart in_part(const Pose& pose, const PartFrame& frame, std::size_t touch) const;
  OnPath on_path(const PathPlace& place, std::size_t touch) const;
  OnPath nearest_to(const Pose& pose, std::size_t touch) const;
  Normals share_of(std::size_t touch, const State& state, bool is_held) const;
  bool is_pinned_at(const PathPlace& place, std::size_t touch, const Distance& distance) const;
  void go_downhill(State& state, const std::optional<Held>& held, double most = kAnySquare) const;
  Normals normals_of(const State& state, const std::optional<Held>& held) const;
  State start(const Pose& from, const std::optional<Held>& held) const;
  bool descend(State& state, const std::optional<Held>& held, const IsKnown& is_known) const;
  bool jump_nearer(State& state, const std::optional<Held>& held) const;
  std::optional<FittedPose> settled(State state, const std::optional<Held>& held, const IsKnown& is_known) const;

  static constexpr double kAnySquare = std::numeric_limits<double>::infinity();

  const std::vector<Measured>& touches_;
  // None: nothing is known beforehand.
  std::optional<PosePrior> prior_;
  // Mean of the measured centres, in the world.
  Vec2 about_ = Vec2::Zero();
};

}  // namespace rollfix::touch
