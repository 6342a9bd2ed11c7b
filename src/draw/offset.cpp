#include "offset.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::draw {
namespace {

constexpr double kSideCell = 6;  // pixels
constexpr double kStep = 1.5;    // between samples of a boundary, pixels
constexpr double kSlack = 0.06;  // what samples at that step may hide, pixels
constexpr double kFan = 0.15;    // radians between a corner's normals
constexpr int kTries = 8;
constexpr double kNearer = 0.7;  // of the distance at each further try
constexpr double kLeast = 0.08;  // fraction of a path that must survive

struct SidePoint {
  Vec2 point;
  Vec2 normal;
  double s;
};

/// Every vertex with its outward normal; a convex corner has a fan of them.
std::vector<SidePoint> sides(const Trace& stretch) {
  std::vector<SidePoint> out;
  Vec2 last = Vec2::Zero();
  for (std::size_t i = 0; i < stretch.points.size(); ++i) {
    Vec2 next = last;
    if (i + 1 < stretch.points.size()) {
      const Vec2 edge = stretch.points[i + 1] - stretch.points[i];
      if (edge.squaredNorm() > 0) next = outward(edge.normalized());
    }
    if (next.squaredNorm() == 0) continue;  // no direction yet
    if (last.squaredNorm() == 0) last = next;
    // On the page a left turn of the world is clockwise, which the cross product shows as negative.
    const double turn = std::atan2(cross(last, next), last.dot(next));
    const int count = turn < 0 ? 1 + static_cast<int>(-turn / kFan) : 1;
    for (int k = 0; k <= count; ++k) {
      const double angle = turn * k / count;
      const Vec2 normal(std::cos(angle) * last.x() - std::sin(angle) * last.y(),
                        std::sin(angle) * last.x() + std::cos(angle) * last.y());
      if (k == 0 && turn == 0) continue;
      out.push_back({stretch.points[i], normal, stretch.s[i]});
    }
    last = next;
  }
  return out;
}

}  // namespace

Clearance::Clearance(const Trace& boundary) {
  const Trace fine = densify(boundary, kStep);
  box_ = box_around(fine.points);
  columns_ = 1 + static_cast<std::size_t>(box_.sizes().x() / kSideCell);
  rows_ = 1 + static_cast<std::size_t>(box_.sizes().y() / kSideCell);
  cells_.resize(columns_ * rows_);
  for (const Vec2& point : fine.points) {
    cells_[cell_of(point.y(), box_.min().y(), rows_) * columns_ + cell_of(point.x(), box_.min().x(), columns_)]
        .push_back(point);
  }
}

std::size_t Clearance::cell_of(double value, double origin, std::size_t count) const {
  const double cell = std::floor((value - origin) / kSideCell);
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
}

bool Clearance::closer_than(const Vec2& point, double distance) const {
  const std::size_t left = cell_of(point.x() - distance, box_.min().x(), columns_);
  const std::size_t right = cell_of(point.x() + distance, box_.min().x(), columns_);
  const std::size_t top = cell_of(point.y() - distance, box_.min().y(), rows_);
  const std::size_t bottom = cell_of(point.y() + distance, box_.min().y(), rows_);
  for (std::size_t row = top; row <= bottom; ++row) {
    for (std::size_t column = left; column <= right; ++column) {
      for (const Vec2& other : cells_[row * columns_ + column]) {
        if ((other - point).squaredNorm() < distance * distance) return true;
      }
    }
  }
  return false;
}

std::vector<Vec2> path_beside(const Trace& stretch, const Clearance& boundary,
                              const std::function<double(double)>& offset) {
  const std::vector<SidePoint> along = sides(densify(stretch, kStep));
  std::vector<Vec2> path;
  double nearer = 1;
  for (int attempt = 0; attempt < kTries; ++attempt, nearer *= kNearer) {
    path.clear();
    for (const SidePoint& side : along) {
      const double distance = nearer * offset(side.s);
      const Vec2 beside = side.point + distance * side.normal;
      if (!boundary.closer_than(beside, distance - kSlack)) path.push_back(beside);
    }
    if (static_cast<double>(path.size()) >= kLeast * static_cast<double>(along.size())) return path;
  }
  if (path.size() >= 2) return path;
  // Between two sides that touch there is no room at all: run on the boundary itself.
  return stretch.points;
}

}  // namespace rollfix::draw
