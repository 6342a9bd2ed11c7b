#include "steps.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "centre_path.hpp"
#include "free_space.hpp"
#include "log/mirrored.hpp"
#include "measured.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"
#include "problem.hpp"

// Notation:
//   phi, X        heading and place of the part in the world; R = R(phi)
//   o(u), nu(u)   the finger's centre and the outward normal's direction, in the part's frame, at place u of the path
//   q, n          the measured centre and normal's direction: phi = n - nu(u), X = q - R o(u)
namespace rollfix::touch {
namespace {

// Poses of one set that are looked at where it is a continuum: along its longest direction, in its standard deviations.
constexpr double kAlong[] = {-2, -1.5, -1, -0.5, 0, 0.5, 1, 1.5, 2};
// Poses that are looked at, the most probable ones.
constexpr std::size_t kMostPoses = 60;
// A pose was led back along a continuum if by more of its standard deviations.
constexpr double kLedBack = 0.25;
// Poses that stand for all that one touch leaves.
constexpr std::size_t kOfOneTouch = 150;
// One that clear paths leave less of is none.
constexpr double kLeastFree = 1e-6;

/// Moves poses of a set to where they fit the touches that count: those along a continuum lie on a curve.
class Refit {
 public:
  /// `answer`: not mirrored, as poses are fitted as the part is stored. `set`: its outliers do not count.
  Refit(const TouchAnswer& answer, const TouchPose& set)
      : touches_(measured_of(answer, set)), path_(answer.part, answer.radius), tree_(path_), fit_(touches_, {}) {
    for (Measured& touch : touches_) touch.tree = &tree_;
  }
  Refit(const Refit&) = delete;
  Refit& operator=(const Refit&) = delete;

  /// The best pose nearby.
  Pose operator()(const Pose& pose) { return fit_.fit(pose).pose; }

 private:
  /// Tolerances of the answer are kPossibleSigmas standard deviations, as noise was stated.
  static std::vector<Measured> measured_of(const TouchAnswer& answer, const TouchPose& set) {
    std::vector<Measured> touches;
    for (std::size_t k = 0; k < answer.touches.size(); ++k) {
      if (std::binary_search(set.outliers.begin(), set.outliers.end(), k)) continue;
      const TouchTolerance& most = answer.tolerance[k];
      Measured one;
      one.has_place = answer.touches[k].has_place();
      if (one.has_place) one.at = answer.touches[k].at;
      if (answer.touches[k].normal) one.tangent = *answer.touches[k].normal + 0.5 * std::numbers::pi;
      one.place_most = most.length;
      one.angle_most = most.angle;
      if (one.has_place) one.place_unit = most.length / kPossibleSigmas;
      if (most.angle > 0) one.angle_unit = most.angle / kPossibleSigmas;
      touches.push_back(one);
    }
    return touches;
  }

  std::vector<Measured> touches_;
  CentrePath path_;
  PathTree tree_;
  PoseFit fit_;
};

/// A pose that fits near one of a line: the line's own where least squares led back along it, to the best of all.
/// `along`: one standard deviation of the continuum.
Pose beside(const Pose& of_line, const Pose& fitted, const Eigen::Vector3d& along) {
  const Eigen::Vector3d off(fitted.x - of_line.x, fitted.y - of_line.y,
                            nearest_angle(fitted.heading - of_line.heading));
  const double back = off.dot(along) / along.squaredNorm();
  return std::abs(back) <= kLedBack ? fitted : of_line;
}

/// Without noise, or of a pose that is held: the answer's pose. Of a continuum with noise: kAlong standard deviations
/// along its longest direction, each with an equal share of the weight, led back to where the touches fit.
std::vector<LikelyPose> poses_of_sets(const TouchAnswer& answer) {
  std::vector<LikelyPose> poses;
  for (std::size_t k = 0; k < answer.poses.size(); ++k) {
    const TouchPose& set = answer.poses[k];
    const double weight = answer.noise ? set.probability : 1.0;
    if (!answer.noise || !set.continuum) {
      poses.push_back({k, weight, set.pose, answer.noise ? set.spread.covariance : Eigen::Matrix3d::Zero().eval()});
      continue;
    }
    std::optional<Refit> refit;
    // Of a part face down the straight line has to do.
    if (!answer.mirrored) refit.emplace(answer, set);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(set.spread.covariance);
    const Eigen::Vector3d along = solver.eigenvectors().col(2) * std::sqrt(std::max(0.0, solver.eigenvalues()(2)));
    // What is left of the covariance across that direction.
    const Eigen::Matrix3d across = set.spread.covariance - along * along.transpose();
    for (const double share : kAlong) {
      const Pose& mean = set.spread.mean;
      const Pose along_line{mean.x + share * along(0), mean.y + share * along(1), mean.heading + share * along(2)};
      const Pose pose = refit ? beside(along_line, (*refit)(along_line), along) : along_line;
      poses.push_back({k, weight / static_cast<double>(std::size(kAlong)), pose, across});
    }
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const LikelyPose& a, const LikelyPose& b) { return a.weight > b.weight; });
  if (poses.size() > kMostPoses) poses.resize(kMostPoses);
  return poses;
}

/// Places all along the path, each with as much of its length.
/// `apart`: gets the length of the path of centres between two of them.
std::vector<PathPlace> even_places(const CentrePath& path, std::size_t count, double& apart) {
  double total = 0;
  for (const CentreStretch& stretch : path.stretches()) total += path.length(stretch, stretch.u);
  apart = total / static_cast<double>(count);
  std::vector<PathPlace> places;
  // Of the path, up to stretch k.
  double before = 0;
  for (std::size_t k = 0; k < path.stretches().size(); ++k) {
    const CentreStretch& stretch = path.stretches()[k];
    const double length = path.length(stretch, stretch.u);
    while (places.size() < count && (static_cast<double>(places.size()) + 0.5) * apart < before + length) {
      const double share = ((static_cast<double>(places.size()) + 0.5) * apart - before) / length;
      places.push_back({k, stretch.u.lo + share * (stretch.u.hi - stretch.u.lo)});
    }
    before += length;
  }
  return places;
}

/// A touch with a normal fits at every place of the path, in one heading each.
class AfterOneTouch {
 public:
  explicit AfterOneTouch(const TouchAnswer& answer) : answer_(answer), path_(answer.part, answer.radius) {
    const double share = answer.noise ? kPossibleSigmas : 1;
    place_sd_ = answer.tolerance.front().length / share;
    turn_sd_ = answer.tolerance.front().angle / share;
  }

  std::vector<LikelyPose> poses() {
    const std::vector<PathPlace> places = even_places(path_, kOfOneTouch, apart_);
    std::vector<LikelyPose> result;
    for (const PathPlace& place : places) result.push_back(pose_at(place));
    return result;
  }

 private:
  /// -1 of a part face down: x of the outline changes its sign.
  double side() const { return answer_.mirrored ? -1 : 1; }

  /// phi = n - nu(u), X = q - R o(u).
  LikelyPose pose_at(const PathPlace& place) const {
    const MeasuredTouch& touch = answer_.touches.front();
    const CentrePoint point = path_.at(place);
    const Vec2 outward(side() * std::sin(point.angle), -std::cos(point.angle));
    LikelyPose one;
    one.weight = 1;
    one.pose.heading = nearest_angle(*touch.normal - std::atan2(outward.y(), outward.x()));
    const Vec2 centre = one.pose.turned({side() * point.centre.x(), point.centre.y()});
    const Vec2 along = one.pose.turned({side() * point.along.x(), point.along.y()});
    one.pose.x = touch.at.x() - centre.x();
    one.pose.y = touch.at.y() - centre.y();
    one.covariance = covariance(centre, along, side() * point.bend);
    return one;
  }

  /// Of the pose: from the places and headings that it stands for, and from what was measured.
  Eigen::Matrix3d covariance(const Vec2& centre, const Vec2& along, double bend) const {
    const auto moved = [&](double du, double turn) {
      const Vec2 by = -along * du - turned_left(centre) * turn;
      return Eigen::Vector3d(by.x(), by.y(), turn);
    };
    // Uniform between two places: sd = distance / sqrt(12), in u.
    const double du = along.norm() > 0 ? apart_ / std::sqrt(12) / along.norm() : 0;
    const Eigen::Vector3d by_place = moved(du, -bend * du);
    const Eigen::Vector3d by_turn = moved(0, turn_sd_);
    Eigen::Matrix3d result = by_place * by_place.transpose() + by_turn * by_turn.transpose();
    result.topLeftCorner<2, 2>() += place_sd_ * place_sd_ * Eigen::Matrix2d::Identity();
    return result;
  }

  const TouchAnswer& answer_;
  CentrePath path_;
  double apart_ = 0;
  double place_sd_ = 0;
  double turn_sd_ = 0;
};

/// The question that was answered, as far as free space needs it: without rolls and prior.
TouchProblem problem_of(const TouchAnswer& answer) {
  TouchProblem problem{answer.part, answer.touches};
  if (answer.radius > 0) problem.finger = disk(answer.radius);
  problem.noise = answer.noise;
  problem.tolerance = answer.tolerance.front();
  problem.clear = answer.clear;
  return problem;
}

/// As it is, or as a mirror shows it.
PosteriorNode node_of(const LikelyPose& one, bool face_down) {
  PoseSpread seen{one.pose, one.covariance};
  if (face_down) seen = mirrored(seen);
  PosteriorNode node;
  node.pose = seen.mean;
  node.covariance = seen.covariance;
  return node;
}

/// What clear paths leave of poses that only touches were asked about.
/// If nothing is left, the paths contradict the touch: then all stay.
std::vector<LikelyPose> left_free(const std::vector<LikelyPose>& poses, const TouchAnswer& answer) {
  if (answer.clear.empty()) return poses;
  const TouchProblem problem = answer.mirrored ? in_mirror(problem_of(answer)) : problem_of(answer);
  FreeSpace space(problem, measured(problem));
  std::vector<LikelyPose> left;
  for (LikelyPose one : poses) {
    std::vector<PosteriorNode> node{node_of(one, answer.mirrored)};
    // By the probability that all paths are free; without noise free or not.
    if (answer.noise) {
      space.weigh(node);
      one.weight *= std::exp(node.front().log_weight);
    } else if (space.is_blocked(node.front().pose)) {
      one.weight = 0;
    }
    if (one.weight > kLeastFree) left.push_back(one);
  }
  return left.empty() ? poses : left;
}

}  // namespace

/// Weights are made to add up to 1.
std::vector<LikelyPose> likely_poses(const TouchAnswer& answer) {
  std::vector<LikelyPose> poses = answer.touches.size() == 1 && answer.poses.empty()
                                      ? left_free(AfterOneTouch(answer).poses(), answer)
                                      : poses_of_sets(answer);
  double total = 0;
  for (const LikelyPose& one : poses) total += one.weight;
  for (LikelyPose& one : poses) one.weight /= total;
  return poses;
}

}  // namespace rollfix::touch
