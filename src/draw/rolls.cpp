#include "rolls.hpp"

#include <algorithm>
#include <cmath>

#include "labels.hpp"
#include "outline/turn.hpp"

// Notation:
//   run             from which length of a roll to which one it goes in one direction: Run; each has a lane of its own
//   lane            how far beside the boundary a path is drawn: `assign_lanes` takes the first that is free there
//   d(s)            its distance from the boundary: `offset`; the path is p(s) + d n(s), at a convex corner with a fan
//                   of n
// Idea: such a path runs into itself where the boundary is hollow. Points nearer to any other stretch of the boundary
// than d are left out, and if hardly any is left it is drawn nearer.
namespace rollfix::draw {

namespace {

constexpr std::size_t kMostRuns = 3;  // more changes of direction than that are noise or a mess to look at

int lanes_for(const Run& run, const Boundary& boundary) {
  return goes_round(run, boundary) ? 1 + static_cast<int>(std::ceil(run.size() / boundary.perimeter)) : 1;
}

}  // namespace

bool goes_round(const Run& run, const Boundary& boundary) {
  return boundary.closed && run.size() > boundary.perimeter * (1 + 1e-9);
}

Roll roll_of(const std::vector<Reading>& readings, const Boundary& boundary, std::size_t finger) {
  Roll roll;
  double at = 0;
  for (const Reading& reading : readings) {
    const double length = reading.length[finger];
    roll.contacts.push_back(length);
    roll.hull.lo = std::min(roll.hull.lo, length);
    roll.hull.hi = std::max(roll.hull.hi, length);
    if (length == at) continue;
    const bool goes_on = !roll.runs.empty() && (length > at) == (roll.runs.back().to > roll.runs.back().from);
    if (!goes_on) roll.runs.push_back({at, at, 0});
    roll.runs.back().to = length;
    at = length;
  }
  roll.tangled = roll.runs.size() > kMostRuns;
  if (roll.tangled) roll.runs.assign(1, Run{roll.hull.lo, roll.hull.hi, 0});
  roll.lanes = 0;
  for (Run& run : roll.runs) {
    run.lane = roll.lanes;
    roll.lanes += lanes_for(run, boundary);
  }
  roll.lanes = std::max(roll.lanes, 1);
  return roll;
}

Lanes assign_lanes(const std::vector<Interval>& stretches, const Boundary& boundary, double gap) {
  const auto with_gap = [&](const Interval& stretch) { return Interval{stretch.lo, stretch.hi + gap}; };
  Lanes lanes;
  std::vector<std::vector<Interval>> taken;
  for (const Interval& stretch : stretches) {
    const auto is_free = [&](const std::vector<Interval>& lane) {
      return std::none_of(lane.begin(), lane.end(), [&](const Interval& other) {
        return boundary.intersects(with_gap(stretch), with_gap(other));
      });
    };
    auto lane = std::find_if(taken.begin(), taken.end(), is_free);
    if (lane == taken.end()) lane = taken.emplace(taken.end());
    lane->push_back(stretch);
    lanes.of.push_back(static_cast<int>(std::distance(taken.begin(), lane)));
  }
  lanes.count = static_cast<int>(taken.size());
  return lanes;
}

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
    const double turn = angle_between(last, next);
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

namespace {

constexpr std::string_view kFingerColour = "#8a8a8a";
constexpr double kMostFingerReach = 2;  // beyond the part, as a fraction of its size: a larger finger is cut off

}  // namespace

std::vector<Vec2> RollPen::path(double start, const Run& run, const std::function<double(double)>& offset,
                                std::size_t most) const {
  const double from = start + run.from, to = start + run.to;
  const auto beside = [&](double s) { return offset(std::abs(s - from)); };
  std::vector<Vec2> path =
      path_beside(slice(scene_.boundary, std::min(from, to), std::max(from, to)), clearance_, beside);
  path = pick(path, simplify(path, kInvisible, most));
  if (to < from) std::reverse(path.begin(), path.end());
  return path;
}

void RollPen::stems(double start, const Run& run, const std::vector<Vec2>& path, std::string_view colour) {
  const std::vector<Vec2> ends = {scene_.at(start + run.from), path.front(), scene_.at(start + run.to), path.back()};
  svg_.segments(ends, stroke(colour, 0.7, "", 0.8));
  obstacles_.add({ends[0], ends[1]});
  obstacles_.add({ends[2], ends[3]});
}

void RollPen::arc(const std::vector<Vec2>& path, std::string_view colour, double width, bool head) {
  svg_.open_group("arc");
  const double size = head ? 4 + 2 * width : 0;
  svg_.polyline(without_tip(path, 0.7 * size), stroke(colour, width));
  if (head) draw_arrowhead(svg_, path, size, colour);
  svg_.close_group();
  obstacles_.add(path);
}

void RollPen::start(double s, std::string_view colour, double radius) {
  marker(s, radius, with_rim(colour, kPaper, 0.6));
}

void RollPen::contact(double s, std::string_view colour, double radius) {
  marker(s, radius, with_rim(kPaper, colour, 1.4));
}

void RollPen::marker(double s, double radius, const Paint& paint) {
  const Vec2 at = scene_.at(s), half = Vec2::Constant(radius);
  svg_.circle(at, radius, paint);
  obstacles_.add_box(at - half, at + half);
}

void RollPen::finger(const Part& part, double s, double radius, double spoke) {
  const Vec2 centre = scene_.view(finger_centre(part, s, radius));
  const double size = scene_.pixels(radius);
  Paint disk = with_rim(kFingerColour, kFingerColour, 1.2);
  disk.fill_opacity = 0.15;
  svg_.circle(centre, size, disk);
  const std::vector<Vec2> line = {centre, centre + size * Vec2(std::cos(spoke), -std::sin(spoke))};
  svg_.segments(line, stroke(kFingerColour, 1));
  svg_.circle(centre, 1.8, filled(kFingerColour));
  obstacles_.add(line);
  obstacles_.add_circle(centre, size);
}

Vec2 finger_centre(const Part& part, double s, double radius) {
  const double at = part.closed() ? s : std::clamp(s, 0.0, part.perimeter());
  const TurningFunction& turning = part.turning();
  const double tangent = 0.5 * (turning.angle(at, Side::before) + turning.angle(at, Side::after));
  return part.point(at) + radius * Vec2(std::sin(tangent), -std::cos(tangent));
}

bool include_finger(Box& box, const Box& bounds, const Part& part, double s, double radius) {
  const Vec2 reach = Vec2::Constant(kMostFingerReach * bounds.sizes().maxCoeff());
  const Box most(bounds.min() - reach, bounds.max() + reach);
  const Vec2 centre = finger_centre(part, s, radius);
  const Box finger(centre - Vec2::Constant(radius), centre + Vec2::Constant(radius));
  box.extend(finger.intersection(most));
  return most.contains(finger);
}

}  // namespace rollfix::draw
