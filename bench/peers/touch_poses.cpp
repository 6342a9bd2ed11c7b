#include "touch_poses.hpp"

#include <ceres/tiny_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bench {
namespace {

using namespace rollfix;

constexpr std::size_t kPoints = 4096;  // of an outline
constexpr std::size_t kCells = 256;    // of the grid, each way
constexpr double kMargin = 0.5;        // of the diagonal, around the outline
constexpr int kMatches = 60;           // rounds of ICP at the most
constexpr double kStill = 1e-3;        // standard deviations: ICP ends where it moves touches by less
constexpr int kCoolings = 12;          // rounds of particles
constexpr double kFirstNoise = 0.1;    // of the diagonal, in the first round
constexpr double kShake = 0.3;         // of the round's noise

double square(double x) { return x * x; }

/// A touch in the part's frame.
Vec2 seen(const Pose& pose, const Vec2& at) {
  const Vec2 away = at - Vec2(pose.x, pose.y);
  const double c = std::cos(pose.heading);
  const double s = std::sin(pose.heading);
  return {c * away.x() + s * away.y(), -s * away.x() + c * away.y()};
}

double off_outline(const NearestPoints::Place& place, const Vec2& point) {
  return place.tangent.y() * (point - place.point).x() - place.tangent.x() * (point - place.point).y();
}

/// Measured direction of the tangent less that of the part.
double off_tangent(const NearestPoints::Place& place, double normal, const Pose& pose) {
  return std::remainder(normal + 0.5 * std::numbers::pi - pose.heading - place.angle, 2 * std::numbers::pi);
}

/// The first touch at a random place.
Pose random_start(const TouchQuestion& question, std::mt19937_64& generator) {
  const NearestPoints::Place& place = question.outline.random(generator);
  const MeasuredTouch& first = question.touches.front();
  Pose pose;
  pose.heading = first.normal ? *first.normal + 0.5 * std::numbers::pi - place.angle
                              : std::uniform_real_distribution<double>(0, 2 * std::numbers::pi)(generator);
  const Vec2 turned = pose.turned(place.point);
  pose.x = first.at.x() - turned.x();
  pose.y = first.at.y() - turned.y();
  return pose;
}

/// Residuals by their standard deviations, and what a change of x, y and heading makes of them.
class Residuals {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 3 };  // NOLINT(readability-identifier-naming): Ceres' names

  explicit Residuals(const TouchQuestion& question) : question_(question) {
    for (const MeasuredTouch& touch : question.touches) count_ += touch.normal ? 2 : 1;
  }
  int NumResiduals() const { return count_; }  // NOLINT(readability-identifier-naming)

  bool operator()(const double* at, double* residuals, double* jacobian) const {
    const Pose pose{at[0], at[1], at[2]};
    const Vec2 x_axis = seen({0, 0, pose.heading}, {1, 0});
    const Vec2 y_axis = seen({0, 0, pose.heading}, {0, 1});
    int row = 0;
    for (const MeasuredTouch& touch : question_.touches) {
      const Vec2 point = seen(pose, touch.at);
      const NearestPoints::Place place = question_.outline.nearest(point);
      const Vec2 normal(place.tangent.y(), -place.tangent.x());
      const Vec2 turned(point.y(), -point.x());  // how the point moves as the part turns
      residuals[row] = off_outline(place, point) / question_.place_sd;
      if (jacobian != nullptr) {
        set_row(jacobian, row, -normal.dot(x_axis), -normal.dot(y_axis), normal.dot(turned), question_.place_sd);
      }
      ++row;
      if (!touch.normal) continue;
      residuals[row] = off_tangent(place, *touch.normal, pose) / question_.normal_sd;
      if (jacobian != nullptr) {
        const double bend = place.curvature;
        set_row(jacobian, row, bend * place.tangent.dot(x_axis), bend * place.tangent.dot(y_axis),
                -1 - bend * place.tangent.dot(turned), question_.normal_sd);
      }
      ++row;
    }
    return true;
  }

 private:
  void set_row(double* jacobian, int row, double x, double y, double heading, double sd) const {
    jacobian[row] = x / sd;
    jacobian[count_ + row] = y / sd;
    jacobian[2 * count_ + row] = heading / sd;
  }

  const TouchQuestion& question_;
  int count_ = 0;
};

double chi_square(const TouchQuestion& question, const Pose& pose, double widened) {
  double sum = 0;
  for (const MeasuredTouch& touch : question.touches) {
    const Vec2 point = seen(pose, touch.at);
    const NearestPoints::Place place = question.outline.nearest(point);
    sum += (point - place.point).squaredNorm() / square(widened * question.place_sd);
    if (touch.normal) sum += square(off_tangent(place, *touch.normal, pose) / (widened * question.normal_sd));
  }
  return sum;
}

/// One round of ICP: by how much the touches moved.
double match(const TouchQuestion& question, Pose& pose) {
  const double count = static_cast<double>(question.touches.size());
  std::vector<Vec2> nearest;
  Vec2 mean = Vec2::Zero();
  Vec2 mean_touch = Vec2::Zero();
  for (const MeasuredTouch& touch : question.touches) {
    nearest.push_back(question.outline.nearest(seen(pose, touch.at)).point);
    mean += nearest.back() / count;
    mean_touch += touch.at / count;
  }
  double sine = 0;
  double cosine = 0;
  for (std::size_t k = 0; k < nearest.size(); ++k) {
    const Vec2 part = nearest[k] - mean;
    const Vec2 world = question.touches[k].at - mean_touch;
    sine += part.x() * world.y() - part.y() * world.x();
    cosine += part.dot(world);
  }
  Pose next;
  next.heading = std::atan2(sine, cosine);
  const Vec2 turned = next.turned(mean);
  next.x = mean_touch.x() - turned.x();
  next.y = mean_touch.y() - turned.y();
  double moved = 0;
  for (const MeasuredTouch& touch : question.touches) {
    moved = std::max(moved, (seen(next, touch.at) - seen(pose, touch.at)).norm());
  }
  pose = next;
  return moved;
}

}  // namespace

NearestPoints::NearestPoints(const Part& part) {
  Vec2 least = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 most = -least;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double s = part.perimeter() * (static_cast<double>(k) + 0.5) / kPoints;
    const Turning there = part.turning().at(s);
    const Vec2 point = part.point(s);
    const double angle = part.tangent(s);
    places_.push_back({point, {std::cos(angle), std::sin(angle)}, angle, there.curvature});
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  diagonal_ = (most - least).norm();
  corner_ = least - Vec2::Constant(kMargin * diagonal_);
  step_ = ((most - least).maxCoeff() + 2 * kMargin * diagonal_) / kCells;
  for (std::size_t k = 0; k < kCells * kCells; ++k) {
    const Vec2 middle =
        corner_ + step_ * Vec2(static_cast<double>(k % kCells) + 0.5, static_cast<double>(k / kCells) + 0.5);
    const auto nearer = [&](const Place& one, const Place& other) {
      return (one.point - middle).squaredNorm() < (other.point - middle).squaredNorm();
    };
    cells_.push_back(
        static_cast<std::uint32_t>(std::min_element(places_.begin(), places_.end(), nearer) - places_.begin()));
  }
}

NearestPoints::Place NearestPoints::nearest(const Vec2& point) const {
  const auto cell = [&](double offset) {
    return static_cast<std::size_t>(std::clamp(offset / step_, 0.0, static_cast<double>(kCells) - 1));
  };
  std::size_t index = cells_[cell(point.y() - corner_.y()) * kCells + cell(point.x() - corner_.x())];
  const auto distance = [&](std::size_t k) { return (places_[k].point - point).squaredNorm(); };
  for (const std::size_t step : {std::size_t{1}, kPoints - 1}) {  // downhill along the outline, forwards or back
    for (std::size_t next = (index + step) % kPoints; distance(next) < distance(index);
         next = (index + step) % kPoints) {
      index = next;
    }
  }
  Place place = places_[index];
  const double half = 0.5 * (places_[(index + 1) % kPoints].point - place.point).norm();
  const double along = std::clamp(place.tangent.dot(point - place.point), -half, half);
  place.point += along * place.tangent;
  place.angle += along * place.curvature;
  place.tangent = {std::cos(place.angle), std::sin(place.angle)};
  return place;
}

const NearestPoints::Place& NearestPoints::random(std::mt19937_64& generator) const {
  return places_[std::uniform_int_distribution<std::size_t>(0, kPoints - 1)(generator)];
}

bool fits(const TouchQuestion& question, const Pose& pose) {
  return std::all_of(question.touches.begin(), question.touches.end(), [&](const MeasuredTouch& touch) {
    const Vec2 point = seen(pose, touch.at);
    const NearestPoints::Place place = question.outline.nearest(point);
    if ((point - place.point).norm() > kPossibleSigmas * question.place_sd) return false;
    return !touch.normal || std::abs(off_tangent(place, *touch.normal, pose)) <= kPossibleSigmas * question.normal_sd;
  });
}

std::vector<Pose> poses_by_least_squares(const TouchQuestion& question, int starts) {
  const Residuals residuals(question);
  ceres::TinySolver<Residuals> solver;
  std::mt19937_64 generator(1);
  std::vector<Pose> found;
  for (int k = 0; k < starts; ++k) {
    const Pose start = random_start(question, generator);
    Eigen::Vector3d at(start.x, start.y, start.heading);
    solver.Solve(residuals, &at);
    const Pose pose{at[0], at[1], at[2]};
    if (fits(question, pose)) found.push_back(pose);
  }
  return found;
}

std::vector<Pose> poses_by_icp(const TouchQuestion& question, int starts) {
  std::mt19937_64 generator(1);
  std::vector<Pose> found;
  for (int k = 0; k < starts; ++k) {
    Pose pose = random_start(question, generator);
    for (int round = 0; round < kMatches; ++round) {
      if (match(question, pose) < kStill * question.place_sd) break;
    }
    if (fits(question, pose)) found.push_back(pose);
  }
  return found;
}

std::vector<Pose> poses_by_particles(const TouchQuestion& question, int particles) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  std::vector<Pose> cloud;
  for (int k = 0; k < particles; ++k) cloud.push_back(random_start(question, generator));
  const double first = std::max(1.0, kFirstNoise * question.outline.diagonal() / question.place_sd);
  const Vec2 about = question.touches.front().at;
  for (int round = 0; round < kCoolings; ++round) {
    const double widened = std::pow(first, 1 - static_cast<double>(round) / (kCoolings - 1));
    std::vector<double> chances;
    double least = std::numeric_limits<double>::infinity();
    for (const Pose& pose : cloud) {
      chances.push_back(chi_square(question, pose, widened));
      least = std::min(least, chances.back());
    }
    for (double& chance : chances) chance = std::exp(-0.5 * (chance - least));
    std::discrete_distribution<std::size_t> draw(chances.begin(), chances.end());
    std::vector<Pose> drawn;
    const double shake = round + 1 < kCoolings ? kShake * widened * question.place_sd : 0;
    for (int k = 0; k < particles; ++k) {
      Pose pose = cloud[draw(generator)];
      const double turn = normal(generator) * shake / question.outline.diagonal();
      const Vec2 arm = Vec2(pose.x, pose.y) - about;  // turned about the first touch
      pose.heading += turn;
      pose.x += normal(generator) * shake - turn * arm.y();
      pose.y += normal(generator) * shake + turn * arm.x();
      drawn.push_back(pose);
    }
    cloud = std::move(drawn);
  }
  cloud.erase(std::remove_if(cloud.begin(), cloud.end(), [&](const Pose& pose) { return !fits(question, pose); }),
              cloud.end());
  return cloud;
}

}  // namespace bench
