#include "rollfix/part/part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "angle.hpp"
#include "part_data.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/load.hpp"
#include "turning_builder.hpp"

namespace rollfix {

namespace {

constexpr int kAreaSamples = 16;

/// Twice the signed area of a polygon through points of the outline: its sign tells the direction.
double rough_area(const Outline& outline) {
  double sum = 0;
  const Vec2 origin = outline.curves.front().front();
  Vec2 last = Vec2::Zero();
  for (const Curve& curve : outline.curves) {
    const Interval domain = curve.domain();
    for (int k = 1; k <= kAreaSamples; ++k) {
      const Vec2 next = curve.position(domain.lo + domain.width() * k / kAreaSamples) - origin;
      sum += cross(last, next);
      last = next;
    }
  }
  return sum;
}

std::size_t panel_at(const TurningFunction& turning, double base, Side side) {
  const std::vector<Panel>& panels = turning.panels();
  const auto after = side == Side::after
                         ? std::upper_bound(panels.begin(), panels.end(), base,
                                            [](double value, const Panel& panel) { return value < panel.lo; })
                         : std::lower_bound(panels.begin(), panels.end(), base,
                                            [](const Panel& panel, double value) { return panel.lo < value; });
  return after == panels.begin() ? 0 : static_cast<std::size_t>(after - panels.begin()) - 1;
}

}  // namespace

Part::Part(Outline outline, const PartOptions& options) {
  auto data = std::make_shared<Data>();
  const bool is_empty = outline.curves.empty();
  if (outline.closed && !is_empty && (rough_area(outline) < 0) != outline.hole) outline = rollfix::reversed(outline);
  for (int attempt = 0;; ++attempt) {
    TurningFunctionBuilder builder(outline);
    // The polygon of a very thin outline can mislead; the turn of the tangent does not.
    const double turn = builder.turning.period_turn();
    if (outline.closed && attempt == 0 && (outline.hole ? turn > 0 : turn < 0)) {
      outline = rollfix::reversed(outline);
      continue;
    }
    data->turning = std::move(builder.turning);
    data->parametrization = std::move(builder.parametrization);
    data->corners = std::move(builder.corners);
    break;
  }
  data->outline = std::move(outline);
  data->inflections = find_inflections(data->turning);
  data->vertices = find_vertices(data->turning, data->corners);
  data_ = std::move(data);
  if (options.allow_crossing) return;
  if (const auto crossing = find_crossing(*this)) {
    throw InputError(fmt::format(
        "{}: expected an outline that does not cross itself, found that it does near ({:.9g}, {:.9g}), at arc lengths "
        "{:.9g} and {:.9g} of {:.9g}: mend it, or take it as it is with `allow_crossing`",
        name(), crossing->point.x(), crossing->point.y(), crossing->first, crossing->second, perimeter()));
  }
}

const std::string& Part::name() const { return data_->outline.name; }
const Outline& Part::outline() const { return data_->outline; }
bool Part::closed() const { return data_->outline.closed; }
bool Part::reversed() const { return data_->outline.reversed; }
double Part::perimeter() const { return data_->turning.perimeter(); }
const TurningFunction& Part::turning() const { return data_->turning; }
const std::vector<double>& Part::inflections() const { return data_->inflections; }
const std::vector<double>& Part::vertices() const { return data_->vertices; }
const std::vector<Corner>& Part::corners() const { return data_->corners; }

double Part::total_turn() const {
  const TurningFunction& turning = data_->turning;
  if (closed()) return turning.period_turn();
  return turning.spirals().back().end.angle - turning.spirals().front().start.angle;
}

int Part::turns() const {
  return closed() ? static_cast<int>(std::lround(data_->turning.period_turn() / (2 * std::numbers::pi))) : 0;
}

Vec2 Part::point(double s) const {
  const TurningFunction& turning = data_->turning;
  const double base = boundary().base(s);
  const std::size_t index = panel_at(turning, base, Side::after);
  const Panel& panel = turning.panels()[index];
  const Curve& curve = data_->outline.curves[data_->parametrization.pieces[index].curve];
  const Interval domain = curve.domain();
  const double u = data_->parametrization.parameter(index, (base - panel.middle) * panel.inverse_half);
  return curve.position(std::min(std::max(u, domain.lo), domain.hi));
}

double Part::tangent(double s) const {
  const Side side = !closed() && s >= perimeter() ? Side::before : Side::after;
  return nearest_angle(data_->turning.angle(s, side));
}

std::vector<Vec2> Part::polyline(double lo, double hi, int count) const {
  std::vector<double> places;
  for (int k = 0; k <= count; ++k) places.push_back(lo + (hi - lo) * k / count);
  const double period = perimeter();
  for (const Corner& corner : corners()) {
    if (!closed()) {
      if (corner.s > lo && corner.s < hi) places.push_back(corner.s);
      continue;
    }
    for (double s = corner.s + period * std::floor((lo - corner.s) / period); s < hi; s += period) {
      if (s > lo) places.push_back(s);
    }
  }
  std::sort(places.begin(), places.end());
  std::vector<Vec2> points;
  points.reserve(places.size());
  for (const double s : places) points.push_back(point(s));
  return points;
}

Part load_part(const std::string& source) { return Part(load_outline(source)); }

}  // namespace rollfix
