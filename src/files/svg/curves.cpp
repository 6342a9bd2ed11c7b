#include "files/svg/segment.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::svg {

namespace {

/// Half axes of one length and at right angles, but for rounding, are a circle's.
constexpr double kRound = 1e-14;

/// The box around a drawing, and whether its numbers can be worked with.
class Bounds {
 public:
  void add(const Vec2& point) {
    box_.extend(point);
    valid_ = valid_ && point.cwiseAbs().maxCoeff() <= kMostCoordinate && !point.hasNaN();
  }

  /// The points that a segment stays among.
  void add(const Segment& segment) {
    add(segment.from);
    add(segment.to);
    const auto& shape = segment.shape;
    if (segment.kind == SegmentKind::quadratic || segment.kind == SegmentKind::cubic) add(shape[0]);
    if (segment.kind == SegmentKind::cubic) add(shape[1]);
    if (segment.kind == SegmentKind::arc) {
      const Vec2 reach = shape[1].cwiseAbs() + shape[2].cwiseAbs();
      add(shape[0] + reach);
      add(shape[0] - reach);
    }
  }

  bool valid() const { return valid_; }
  double diagonal() const { return box_.isEmpty() ? 0 : box_.diagonal().norm(); }

 private:
  Box box_;
  bool valid_ = true;
};

/// No longer than this, by the polygon around it.
bool is_within(const Segment& segment, double length) {
  const auto is_near = [&](const Vec2& point) { return (point - segment.from).norm() <= length; };
  switch (segment.kind) {
    case SegmentKind::line:
      return is_near(segment.to);
    case SegmentKind::quadratic:
      return is_near(segment.to) && is_near(segment.shape[0]);
    case SegmentKind::cubic:
      return is_near(segment.to) && is_near(segment.shape[0]) && is_near(segment.shape[1]);
    default:
      return std::abs(segment.sweep) * (segment.shape[1].norm() + segment.shape[2].norm()) <= length;
  }
}

Curve arc(const Segment& segment) {
  const auto& [centre, major, minor] = segment.shape;
  const double radius = major.norm();
  const bool is_circle =
      std::abs(major.dot(minor)) <= kRound * radius * radius && std::abs(minor.norm() - radius) <= kRound * radius;
  if (!is_circle) return EllipticArc(centre, major, minor, segment.angle, segment.sweep);
  const double direction = cross(major, minor) > 0 ? 1 : -1;
  const double from =
      std::remainder(std::atan2(major.y(), major.x()) + direction * segment.angle, 2 * std::numbers::pi);
  return Arc(centre, radius, from, direction * segment.sweep);
}

std::vector<Curve> curves_of(const Segment& segment) {
  switch (segment.kind) {
    case SegmentKind::line:
      return {Line(segment.from, segment.to)};
    case SegmentKind::quadratic:
      return bezier_curves({segment.from, segment.shape[0], segment.to});
    case SegmentKind::cubic:
      return bezier_curves({segment.from, segment.shape[0], segment.shape[1], segment.to});
    default:
      return {arc(segment)};
  }
}

/// The segments that have a length, each starting where the one before ends, and back at the start if closed.
std::vector<Segment> chained(Subpath path, double same_point, std::size_t& without_length) {
  std::vector<Segment> kept;
  for (Segment& segment : path.segments) {
    if (is_within(segment, same_point)) {
      ++without_length;
      continue;
    }
    segment.from = kept.empty() ? path.start : kept.back().to;
    kept.push_back(segment);
  }
  if (!path.closed || kept.empty()) return kept;
  if ((kept.back().to - path.start).norm() > same_point) {
    kept.push_back(line(kept.back().to, path.start));
  } else {
    kept.back().to = path.start;
  }
  return kept;
}

}  // namespace

Curves to_curves(std::vector<PlacedSubpath> subpaths, const Text& file) {
  Bounds box;
  for (const PlacedSubpath& subpath : subpaths) {
    for (const Segment& segment : subpath.path.segments) box.add(segment);
    if (!box.valid()) {
      file.refuse(subpath.offset, fmt::format("the {} has a coordinate beyond {}, expected smaller numbers",
                                              subpath.origin.entity, kMostCoordinate));
    }
  }
  const double same_point = kSamePoint * box.diagonal();
  Curves result;
  for (PlacedSubpath& subpath : subpaths) {
    try {
      for (const Segment& segment : chained(std::move(subpath.path), same_point, result.without_length)) {
        for (Curve& curve : curves_of(segment)) result.curves.push_back({std::move(curve), subpath.origin});
      }
    } catch (const InputError& error) {
      file.refuse(subpath.offset, error.what());
    }
  }
  return result;
}

}  // namespace rollfix::svg
