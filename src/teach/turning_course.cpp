#include "teach/turning_course.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include "rollfix/curve.hpp"
#include "rollfix/pulse.hpp"

namespace rollfix {

namespace {

/// A gap below this share of the length is closed: rounding.
constexpr double kClosed = 1e-14;
constexpr int kNewtonRounds = 50;
/// Changes of Theta beyond this are no correction any more, radians.
constexpr double kMostCorrection = 1;

/// Adds the cubic over [0, width] in pieces that turn little enough.
void add_spans(TurningPath& path, double s, TurningSpan::Cubic cubic, double width) {
  if (span_turn(cubic, width) > kMostSpanTurn) {
    const double half = 0.5 * width;
    const double value = cubic[0] + half * (cubic[1] + half * (cubic[2] + half * cubic[3]));
    const double slope = cubic[1] + half * (2 * cubic[2] + half * 3 * cubic[3]);
    add_spans(path, s, cubic, half);
    add_spans(path, s + half, {value, slope, cubic[2] + 3 * half * cubic[3], cubic[3]}, width - half);
    return;
  }
  path.spans.emplace_back(path.point.back(), cubic, width);
  path.s.push_back(s);
  path.point.push_back(path.spans.back().jet(width).position);
}

}  // namespace

TurningSpan::Cubic TurningNodes::cubic(std::size_t k) const {
  const double width = s[k + 1] - s[k];
  const double chord = (angle[k + 1] - angle[k]) / width;
  return {angle[k], slope[k], (3 * chord - 2 * slope[k] - slope[k + 1]) / width,
          (slope[k] + slope[k + 1] - 2 * chord) / (width * width)};
}

std::size_t TurningNodes::cubic_at(double place) const {
  const auto after = std::upper_bound(s.begin() + 1, s.end() - 1, place);
  return static_cast<std::size_t>(after - s.begin()) - 1;
}

void TurningNodes::add(double place, const Vec2& value_and_slope) {
  s.push_back(place);
  angle.push_back(value_and_slope.x());
  slope.push_back(value_and_slope.y());
}

double TurningNodes::at(double place) const {
  const std::size_t k = cubic_at(place);
  const TurningSpan::Cubic c = cubic(k);
  const double x = place - s[k];
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

double TurningNodes::slope_at(double place) const {
  const std::size_t k = cubic_at(place);
  const TurningSpan::Cubic c = cubic(k);
  const double x = place - s[k];
  return c[1] + x * (2 * c[2] + x * 3 * c[3]);
}

double TurningPath::size() const {
  Vec2 least = point.front();
  Vec2 most = point.front();
  for (const Vec2& each : point) {
    least = least.cwiseMin(each);
    most = most.cwiseMax(each);
  }
  return (most - least).norm();
}

TurningPath path_of(const TurningCourse& course, const Vec2& start) {
  TurningPath path;
  path.point.push_back(start);
  for (const TurningNodes& nodes : course) {
    for (std::size_t k = 0; k + 1 < nodes.s.size(); ++k) {
      add_spans(path, nodes.s[k], nodes.cubic(k), nodes.s[k + 1] - nodes.s[k]);
    }
  }
  return path;
}

void split_at(TurningNodes& nodes, double place) {
  const auto after = std::upper_bound(nodes.s.begin(), nodes.s.end(), place);
  if (after == nodes.s.begin() || after == nodes.s.end() || *(after - 1) == place) return;
  const auto k = after - nodes.s.begin() - 1;
  const TurningSpan::Cubic c = nodes.cubic(static_cast<std::size_t>(k));
  const double x = place - nodes.s[static_cast<std::size_t>(k)];
  nodes.s.insert(nodes.s.begin() + k + 1, place);
  nodes.angle.insert(nodes.angle.begin() + k + 1, c[0] + x * (c[1] + x * (c[2] + x * c[3])));
  nodes.slope.insert(nodes.slope.begin() + k + 1, c[1] + x * (2 * c[2] + x * 3 * c[3]));
}

Closure close_gap(TurningCourse& course) {
  const TurningCourse original = course;
  Eigen::Vector2d weights(0, 0);
  Closure closure;
  for (int round = 0; round < kNewtonRounds; ++round) {
    beat();
    const TurningPath path = path_of(course, Vec2::Zero());
    const double length = path.end() - path.s.front();
    const Vec2 gap = path.gap();
    closure.closed = gap.norm() <= kClosed * length;
    if (closure.closed) break;
    // The end moves by the integral of the change times the normal, and the change is the normal times the weights.
    Eigen::Matrix2d moves = Eigen::Matrix2d::Zero();
    for (const TurningSpan& span : path.spans) {
      const double width = span.domain().hi;
      for (const double share : {0.0, 0.5, 1.0}) {  // Simpson's rule
        const Vec2 tangent = span.velocity(share * width);
        const Vec2 normal(-tangent.y(), tangent.x());
        moves += (share == 0.5 ? 4.0 : 1.0) * width / 6 * normal * normal.transpose();
      }
    }
    const Eigen::Vector2d step = moves.inverse() * gap;
    if (!step.allFinite() || (weights + step).norm() > kMostCorrection) return closure;
    weights += step;
    closure.correction = weights.norm();
    for (std::size_t run = 0; run < course.size(); ++run) {
      for (std::size_t k = 0; k < course[run].s.size(); ++k) {
        const double angle = original[run].angle[k];
        const double change = -weights.x() * std::sin(angle) + weights.y() * std::cos(angle);
        const double rate = -weights.x() * std::cos(angle) - weights.y() * std::sin(angle);
        course[run].angle[k] = angle + change;
        course[run].slope[k] = original[run].slope[k] * (1 + rate);
      }
    }
  }
  return closure;
}

}  // namespace rollfix
