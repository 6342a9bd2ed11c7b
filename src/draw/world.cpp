#include "world.hpp"

#include <algorithm>

#include "legend.hpp"

namespace rollfix::draw {
namespace {

constexpr double kWorldLeft = 58;  // around the frame, pixels
constexpr double kWorldRight = 16;
constexpr double kWorldAbove = 22;
constexpr double kWorldBelow = 34;
constexpr double kWorldLeastHeight = 160;
constexpr double kWorldMostHeight = 720;
constexpr double kWorldMargin = 0.06;       // of what is shown
constexpr double kWorldLeastMargin = 1e-9;  // of the perimeter: a point has no size

}  // namespace

World::World(const Box& seen, const Part& part, double width) {
  const double margin = std::max(kWorldMargin * seen.sizes().maxCoeff(), kWorldLeastMargin * part.perimeter());
  const Box wide(seen.min() - Vec2::Constant(margin), seen.max() + Vec2::Constant(margin));
  const double across = width - kWorldLeft - kWorldRight;
  const double height = std::clamp(across * wide.sizes().y() / wide.sizes().x(), kWorldLeastHeight, kWorldMostHeight);
  scale_ = std::min(across / wide.sizes().x(), height / wide.sizes().y());
  const Vec2 half = 0.5 * Vec2(across, height) / scale_;
  axes_.corner = {kWorldLeft, kHeaderHeight + kWorldAbove};
  axes_.size = {across, height};
  axes_.x = {wide.center().x() - half.x(), wide.center().x() + half.x()};
  axes_.y = {wide.center().y() - half.y(), wide.center().y() + half.y()};
}

double World::bottom() const { return axes_.corner.y() + axes_.size.y() + kWorldBelow; }

std::vector<Vec2> World::path(const std::vector<Vec2>& points) const {
  std::vector<Vec2> page;
  for (const Vec2& point : points) page.push_back(at(point));
  return page;
}

void World::open(Svg& svg, const std::string& words) const {
  svg.open_group("world");
  draw_axes(svg, axes_, round_ticks(axes_.x, 5), round_ticks(axes_.y, 5), {{words}}, "");
  svg.open_clip(axes_.corner.x(), axes_.corner.y(), axes_.size.x(), axes_.size.y());
}

void World::close(Svg& svg) {
  svg.close_group();
  svg.close_group();
}

std::vector<Vec2> posed(const std::vector<Vec2>& points, const Pose& pose, bool mirrored) {
  std::vector<Vec2> world;
  for (const Vec2& point : points) world.push_back(pose.world({mirrored ? -point.x() : point.x(), point.y()}));
  return world;
}

}  // namespace rollfix::draw
