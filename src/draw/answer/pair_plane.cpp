// The square of all pairs: where each equation holds, and the placements.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "draw/answer/answer_plan.hpp"
#include "draw/answer/densities.hpp"
#include "draw/labels.hpp"

namespace rollfix::draw {
namespace {

constexpr double kPlaneShare = 0.4;  // of the page's width
constexpr double kPlaneLeft = 64;    // room for the numbers and the name of the axis, pixels
constexpr double kPlaneAbove = 24;
constexpr double kPlaneBelow = 42;
constexpr double kPlaneRight = 16;
constexpr double kCellSize = 0.8;               // of the grid on which lines are looked for, pixels
constexpr double kVisibleBox = 5;               // a wider extent gets a box, pixels
constexpr double kPlaneNumberSize = 10.5;       // pixels
constexpr std::size_t kMostLinePoints = 20000;  // of a line
constexpr int kTicks = 6;
constexpr std::string_view kOutside = "#f0f0f0";
constexpr std::string_view kStretch = "#F0E442";

/// At the right of the part, half-way up.
Axes plane_of(const AnswerPlan& plan) {
  const double side = kPlaneShare * plan.width();
  const double spare = drawing_height(plan.framing) - plan.framing.least_height;
  Axes axes;
  axes.corner = Vec2(plan.framing.width + kPlaneLeft, kHeaderHeight + kPlaneAbove + 0.5 * spare);
  axes.size = Vec2(side, side);
  axes.x = axes.y = {0, plan.part().perimeter()};
  return axes;
}

class PlanePicture {
 public:
  PlanePicture(Svg& svg, const AnswerPlan& plan)
      : svg_(svg), plan_(plan), axes_(plane_of(plan)), obstacles_(svg.width(), svg.height()) {}

  void draw() {
    svg_.open_group("plane");
    outside();
    const Ticks ticks = round_ticks(axes_.x, kTicks);
    draw_axes(svg_, axes_, ticks, ticks, {{"pairs of first contacts that fit each equation"}},
              plan_.has_noise() ? "ellipses: 95 %" : "");
    names();
    svg_.open_clip(axes_.corner.x() - 1, axes_.corner.y() - 1, axes_.size.x() + 2, axes_.size.y() + 2);
    for (const Placement& placement : plan_.placements()) {
      if (plan_.has_noise()) {
        spread(placement);
      } else {
        wide(placement);
      }
    }
    for (const PairLine& line : plan_.lines) draw_line(line);
    unresolved();
    svg_.close_group();
    dots();
    if (plan_.has_labels()) numbers();
    svg_.close_group();
  }

 private:
  /// Where on an open part the rolls don't fit: no pair can be there.
  void outside() {
    std::array<Interval, 2> room{axes_.x, axes_.y};
    for (std::size_t finger = 0; finger < 2 && !plan_.part().closed(); ++finger) {
      room[finger] = {axes_.x.lo - plan_.rolls[finger].hull.lo, axes_.x.hi - plan_.rolls[finger].hull.hi};
    }
    room_ = room;
    const Vec2 lo = axes_(room[0].lo, room[1].hi), hi = axes_(room[0].hi, room[1].lo), end = axes_.corner + axes_.size;
    const auto box = [&](const Vec2& from, const Vec2& to) {
      if (to.x() > from.x() && to.y() > from.y()) {
        svg_.rectangle(from.x(), from.y(), to.x() - from.x(), to.y() - from.y(), filled(kOutside));
      }
    };
    box(axes_.corner, {lo.x(), end.y()});
    box({hi.x(), axes_.corner.y()}, end);
    box({lo.x(), axes_.corner.y()}, {hi.x(), lo.y()});
    box({lo.x(), hi.y()}, {hi.x(), end.y()});
  }

  void names() {
    const Text first = contact_name(plan_, {0, 0}, 0), second = contact_name(plan_, {0, 1}, 0);
    draw_x_name(svg_, axes_, with_unit(Text{first[0], first[1], {" of finger a"}}, plan_.part()));
    TextStyle style;
    style.align = Align::middle;
    style.turn = -90;
    svg_.text(axes_.corner + Vec2(-44, 0.5 * axes_.size.y()),
              with_unit(Text{second[0], second[1], {" of finger b"}}, plan_.part()), style);
  }

  // ---- lines

  /// Places that are a fraction of a pixel apart, with the value there.
  template <class F>
  Samples sample(const Interval& range, F&& value) const {
    const double count = std::ceil(axes_.size.x() / kCellSize);
    Samples samples;
    for (double k = 0; k <= count; ++k) {
      samples.at.push_back(range.lo + range.width() * k / count);
      samples.value.push_back(value(samples.at.back()));
    }
    return samples;
  }

  void draw_line(const PairLine& line) {
    if (!(room_[0].width() > 0 && room_[1].width() > 0)) return;
    const TurningFunction& turning = plan_.part().turning();
    svg_.open_group("equation");
    if (line.reading) {
      const Reading& reading = plan_.readings[*line.reading];
      const auto turn = [&](double length) {
        return [&turning, length](double s) { return turning.angle(s + length) - turning.angle(s); };
      };
      draw_level(sample(room_[0], turn(reading.length[0])), sample(room_[1], turn(reading.length[1])), reading.turn,
                 line);
    } else {
      const auto angle = [&](double s) { return turning.angle(s); };
      const Samples g = sample(room_[0], angle), h = sample(room_[1], angle);
      const auto [least_g, most_g] = std::minmax_element(g.value.begin(), g.value.end());
      const auto [least_h, most_h] = std::minmax_element(h.value.begin(), h.value.end());
      const double turn = 2 * std::numbers::pi, facing = *plan_.facing;
      for (double k = std::ceil((*least_g - *most_h - facing) / turn); facing + turn * k <= *most_g - *least_h; ++k) {
        draw_level(g, h, facing + turn * k, line);
      }
    }
    svg_.close_group();
  }

  void draw_level(const Samples& g, const Samples& h, double level, const PairLine& style) {
    for (const std::vector<Vec2>& line : level_lines(g, h, level)) {
      std::vector<Vec2> path;
      for (const Vec2& pair : line) path.push_back(axes_(pair.x(), pair.y()));
      path = pick(path, simplify(path, kInvisible, kMostLinePoints));
      svg_.polyline(path, stroke(style.colour, 1.2, style.dash));
      obstacles_.add(path);
    }
  }

  // ---- placements

  /// What is more than a point: a stretch's line, or a box around a wide extent, also of a stretch that is no line.
  void wide(const Placement& placement) {
    const PerFinger<Interval>& extent = placement.extent;
    Box box;
    box.extend(axes_(extent[0].lo, extent[1].hi));
    box.extend(axes_(extent[0].hi, extent[1].lo));
    const bool is_line = placement.family.size() > 1;
    const double spread = is_line ? placement.family_error * axes_.size.x() / axes_.x.width() : box.sizes().maxCoeff();
    if (!is_line && spread < kVisibleBox) return;
    svg_.open_group(placement.kind == Kind::stretch ? "stretch" : "extent");
    if (spread >= kVisibleBox) {
      fill(box);
    } else {
      std::vector<Vec2> path;
      for (const PerFinger<double>& pair : placement.family) path.emplace_back(axes_(pair[0], pair[1]));
      band(path);
    }
    svg_.close_group();
  }

  /// With noise: the ellipse that holds 95 %, as far as it is a normal distribution.
  void spread(const Placement& placement) {
    const Boundary places = plan_.part().boundary();
    Vec2 mean;
    for (const std::size_t finger : {0U, 1U}) {
      const double start = placement.start[finger];
      mean[static_cast<Eigen::Index>(finger)] = start + places.offset(start, placement.mean[finger]);
    }
    std::vector<Vec2> rim;
    for (const Vec2& at : ellipse(mean, placement.covariance, kEllipse95)) rim.emplace_back(axes_(at.x(), at.y()));
    Paint paint = stroke(kInk, 1);
    paint.fill = std::string(kEllipseFill);
    paint.fill_opacity = 0.25 + 0.6 * placement.probability;
    svg_.open_group("ellipse");
    for (const Vec2& shift : shifts(box_around(rim))) {
      std::vector<Vec2> moved;
      for (const Vec2& point : rim) moved.emplace_back(point + shift);
      svg_.polygon(moved, paint);
    }
    svg_.close_group();
  }

  // On a closed part both may run over the square's edge and go on at the opposite one.

  void band(const std::vector<Vec2>& path) {
    for (const Vec2& shift : shifts(box_around(path))) {
      std::vector<Vec2> moved;
      for (const Vec2& point : path) moved.emplace_back(point + shift);
      svg_.polyline(pick(moved, simplify(moved, kInvisible, kMostLinePoints)), stroke(kStretch, 6));
    }
  }

  void fill(const Box& box) {
    const Vec2 size = box.sizes().cwiseMax(2);
    for (const Vec2& shift : shifts(box)) {
      const Vec2 lo = box.min() + shift;
      svg_.rectangle(lo.x(), lo.y(), size.x(), size.y(), filled(kStretch, 0.6));
    }
  }

  /// By which whole squares a drawing has to be moved so that all of it is seen.
  std::vector<Vec2> shifts(const Box& box) const {
    if (!plan_.part().closed()) return {Vec2::Zero()};
    const Vec2 end = axes_.corner + axes_.size;
    std::vector<Vec2> all;
    const auto first = [&](int axis) { return std::ceil((axes_.corner[axis] - box.max()[axis]) / axes_.size[axis]); };
    const auto last = [&](int axis) { return std::floor((end[axis] - box.min()[axis]) / axes_.size[axis]); };
    for (double i = first(0); i <= last(0); ++i) {
      for (double j = first(1); j <= last(1); ++j) all.emplace_back(i * axes_.size.x(), j * axes_.size.y());
    }
    return all;
  }

  void unresolved() {
    for (const PerFinger<Interval>& box : plan_.figure->answer->unresolved) {
      const Vec2 lo = axes_(box[0].lo, box[1].hi), size = axes_(box[0].hi, box[1].lo) - lo;
      svg_.open_group("unresolved");
      svg_.rectangle(lo.x(), lo.y(), std::max(size.x(), 3.0), std::max(size.y(), 3.0), stroke(kSoftInk, 1, "2 3"));
      svg_.close_group();
    }
  }

  double dot_size() const { return plan_.placements().size() > 200 ? 1.6 : plan_.has_labels() ? 3.2 : 2.4; }

  void dots() {
    svg_.open_group("dots");
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      if (plan_.shown != i) dot(i);
    }
    if (plan_.shown) dot(*plan_.shown);
    svg_.close_group();
  }

  void dot(std::size_t i) {
    const PerFinger<double>& start = plan_.placements()[i].start;
    const Vec2 at = axes_(start[0], start[1]);
    const bool shown = plan_.shown == i;
    const double size = shown ? 3.8 : dot_size();
    svg_.circle(at, size, shown ? with_rim(kPaper, kInk, 1.6) : with_rim(kInk, kPaper, 0.6));
    obstacles_.add_box(at - Vec2::Constant(size), at + Vec2::Constant(size));
  }

  void numbers() {
    const Vec2 end = axes_.corner + axes_.size;
    obstacles_.forbid({0, 0}, {axes_.corner.x() - 2, svg_.height()});
    obstacles_.forbid({0, 0}, {svg_.width(), axes_.corner.y() - 1});
    obstacles_.forbid({0, end.y() + 1}, {svg_.width(), svg_.height()});
    LabelSet labels;
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      const PerFinger<double>& start = plan_.placements()[i].start;
      labels.add({axes_(start[0], start[1])}, Vec2(std::numbers::sqrt2 / 2, -std::numbers::sqrt2 / 2),
                 {{std::to_string(i), false, true, false}}, kInk, kPlaneNumberSize);
    }
    labels.draw(svg_, obstacles_);
  }

  Svg& svg_;
  const AnswerPlan& plan_;
  Axes axes_;
  Obstacles obstacles_;
  std::array<Interval, 2> room_;  // where first contacts may be
};

}  // namespace

double plane_width(double page_width) { return kPlaneShare * page_width + kPlaneLeft + kPlaneRight; }
double plane_height(double page_width) { return kPlaneShare * page_width + kPlaneAbove + kPlaneBelow; }

void draw_pair_plane(Svg& svg, const AnswerPlan& plan) { PlanePicture(svg, plan).draw(); }

}  // namespace rollfix::draw
