#include "rollfix/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "outline/refusals.hpp"
#include "outline/turn.hpp"
#include "part_data.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"
#include "work/pulse.hpp"

// Notation:
//   s, base         a place by arc length, and the same on the first lap; x on its panel, u on its curve
//   bend, trend     sign of Theta', and of Theta'', on a spiral that turns by more than rounding: `bend_of`, `trend_of`
//   area            twice the polygon's, whose sign tells the direction of an outline: `rough_area`
// Follows docs/search.md, "Once per part".
// Idea: an inflection is where the bend changes, a vertex where the trend does, with no jump in between; what is flat
// for rounding is passed over.
namespace rollfix {
namespace {

/// Curvatures (and angles, radians) that are this much alike do not jump: a share of the larger curvature, or of that
/// of a circle as long as the part.
constexpr double kAlike = 1e-6;
/// No stretch is halved more often: the turn of one so short is its rounding.
constexpr int kMostHalvings = 40;

/// The samples of samples_of: each spiral's ends, and between them as many places as kSampleTurn and kSampleShare ask.
class Sampler {
 public:
  explicit Sampler(const Part& part) : part_(part), longest_(kSampleShare * part.perimeter()) {}

  std::vector<BoundarySample> samples() {
    for (const Spiral& spiral : part_.turning().spirals()) {
      // Where nothing jumps, the end of the spiral before is the start of this one: one sample.
      if (out_.empty() || jumps(out_.back(), spiral.start)) add(spiral.lo, spiral.start);
      fill(spiral, {spiral.lo, spiral.hi}, spiral.start, spiral.end, 0);
      add(spiral.hi, spiral.end);
    }
    return std::move(out_);
  }

 private:
  /// Appends the sample at s, with the limits of Theta and kappa that the caller means.
  void add(double s, const Turning& at) { out_.push_back({s, part_.point(s), at.angle, at.curvature}); }

  /// Whether Theta or kappa differs between the two sides of a joint by more than rounding.
  bool jumps(const BoundarySample& before, const Turning& after) const {
    const double size =
        std::max({std::abs(before.curvature), std::abs(after.curvature), 2 * std::numbers::pi / part_.perimeter()});
    return std::abs(after.angle - before.tangent) > kAlike ||
           std::abs(after.curvature - before.curvature) > kAlike * size;
  }

  /// What lies between two samples, halved until they are near enough. On a spiral Theta is monotone, so the difference
  /// of its ends is the whole turn in between.
  void fill(const Spiral& spiral, const Interval& range, const Turning& first, const Turning& last, int halvings) {
    const bool is_near = range.width() <= longest_ && std::abs(last.angle - first.angle) <= kSampleTurn;
    if (is_near || halvings == kMostHalvings) return;
    const double middle = range.middle();
    if (!(range.lo < middle && middle < range.hi)) return;  // a bend so small that its places are one number
    const Turning at = part_.turning().on_spiral(spiral, middle);
    fill(spiral, {range.lo, middle}, first, at, halvings + 1);
    add(middle, at);
    fill(spiral, {middle, range.hi}, at, last, halvings + 1);
  }

  const Part& part_;
  double longest_;
  std::vector<BoundarySample> out_;
};

}  // namespace

std::vector<BoundarySample> samples_of(const Part& part) { return Sampler(part).samples(); }

namespace {

constexpr int kAreaSamples = 16;  // for each curve

/// Twice the signed area of a polygon through points of the outline: above 0 where it runs counter-clockwise. Seen from
/// the first point, so that a part far from (0, 0) loses no digits.
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

/// Index of the panel that holds `base`; of two that meet there the later one.
std::size_t panel_at(const std::vector<Panel>& panels, double base) {
  const auto after = std::upper_bound(panels.begin(), panels.end(), base,
                                      [](double value, const Panel& panel) { return value < panel.lo; });
  return after == panels.begin() ? 0 : static_cast<std::size_t>(after - panels.begin()) - 1;
}

// A spiral that turns (for vertices: differs from an arc) by less than this is rounding noise, such as that of a
// spline through points on a straight edge. It stays a spiral, but is no event.
constexpr double kNoiseTurn = 1e-11;
// Curvatures at a joint that differ by less, relative to the larger, are one.
constexpr double kSameCurvature = 1e-7;

/// -1, 0 or 1.
int sign_of(double value) { return value > 0 ? 1 : (value < 0 ? -1 : 0); }

/// To which side a spiral turns: the sign of its kappa; 0 where it is straight but for rounding.
int bend_of(const Spiral& spiral) { return std::abs(spiral.turn()) <= kNoiseTurn ? 0 : sign_of(spiral.turn()); }

/// Whether kappa rises or falls on a spiral; 0 where the spiral is an arc but for rounding: its turn differs from that
/// of an arc by `change` at most.
int trend_of(const Spiral& spiral) {
  const double change = std::abs(spiral.end.curvature - spiral.start.curvature) * (spiral.hi - spiral.lo);
  return change <= kNoiseTurn ? 0 : spiral.trend;
}

/// Where `sign`, of spirals in order, changes from -1 to 1 or back: s in [0, P), rising. Spirals with 0 are passed
/// over, and a change across them is placed in their middle. `breaks(k)`: what came before the start of spiral k counts
/// no more.
template <class Sign, class Breaks>
std::vector<double> changes(const TurningFunction& turning, Sign sign, Breaks breaks) {
  const std::vector<Spiral>& spirals = turning.spirals();
  std::vector<double> found;
  int last = 0;
  double last_end = 0;
  const int laps = turning.closed() ? 2 : 1;  // the first lap only finds what comes before s = 0
  for (int lap = 0; lap < laps; ++lap) {
    // So that the end of the last spiral lies before s = 0, and a stretch of zeros across the seam has a middle.
    if (lap > 0) last_end -= turning.perimeter();
    for (std::size_t k = 0; k < spirals.size(); ++k) {
      if (breaks(k)) last = 0;
      const int now = sign(spirals[k]);
      if (now == 0) continue;
      if (last != 0 && now != last && lap + 1 == laps) {
        // Both are the same where no zeros lie in between.
        const double place = 0.5 * (last_end + spirals[k].lo);
        found.push_back(turning.boundary().base(place));
      }
      last = now;
      last_end = spirals[k].hi;
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

/// Turns the outline so that the material is on its left, measures it, refuses one that crosses itself, and finds its
/// events. The steps are those of docs/search.md, "Once per part".
Part::Part(Outline outline, const PartOptions& options) {
  const Doing doing("computing what the part is like");
  auto data = std::make_shared<Data>();
  const bool is_empty = outline.curves.empty();
  require_few_pieces(outline.curves.size(), outline.name);
  if (outline.closed && !is_empty && (rough_area(outline) < 0) != outline.hole) outline = rollfix::reversed(outline);
  // At most two attempts: after the second the direction is as the tangent's turn says.
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
  data_ = data;
  // The part is complete enough by now for the search to ask it for points and angles.
  const auto crossing = options.allow_crossing ? std::nullopt : find_crossing(*this);
  if (crossing) {
    throw InputError(fmt::format(
        "{}: expected an outline that does not cross itself, found that it {} near {}, at arc lengths "
        "{:.9g} and {:.9g} of {:.9g}: mend it, or take it as it is with `allow_crossing`",
        name(), crossing->is_certain ? "does" : "runs along itself too closely to tell",
        shown_point(crossing->point.x(), crossing->point.y()), crossing->first, crossing->second, perimeter()));
  }
  // Now: finding a crossing takes as much memory as all this, and gives it back.
  data->inflections = find_inflections(data->turning);
  data->vertices = find_vertices(data->turning, data->corners);
  data->tree = TurningTree(data->turning);
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

/// Closed: 2 pi k to the last bit. Open: from the first tangent to the last, corners included.
double Part::total_turn() const {
  const TurningFunction& turning = data_->turning;
  if (closed()) return turning.period_turn();
  return turning.spirals().back().end.angle - turning.spirals().front().start.angle;
}

void require_not_lost(const Part& part, double length, const std::string& what, const std::string& cure) {
  if (!(length < kLengthAccuracy * part.perimeter())) return;
  throw InputError(fmt::format("expected {} that is not lost in the rounding of the perimeter, {:.9g}, found {}{}",
                               what, part.perimeter(), length, cure));
}

/// The turning number k; 0 of an open part, and of a closed one that runs like an 8.
int Part::turns() const {
  return closed() ? static_cast<int>(std::lround(data_->turning.period_turn() / (2 * std::numbers::pi))) : 0;
}

/// alpha(s): from arc length to the panel, its parameter u(x), and the curve itself. Not by integrating Theta, so that
/// errors of angles do not add up.
Vec2 Part::point(double s) const {
  const double base = boundary().base(s);
  return PartAccess::point(*this, panel_at(data_->turning.panels(), base), base);
}

Vec2 PartAccess::point(const Part& part, std::size_t panel_index, double base) {
  const Data& all = data(part);
  const Panel& panel = all.turning.panels()[panel_index];
  const Curve& curve = all.outline.curves[all.parametrization.pieces[panel_index].curve];
  const Interval domain = curve.domain();
  const double u = all.parametrization.parameter(panel_index, (base - panel.middle) * panel.inverse_half);
  // u may be beyond the domain by rounding: the curve is not asked there.
  return curve.position(std::min(std::max(u, domain.lo), domain.hi));
}

/// `likely_panel`, the caller's guess, is tried first.
Touched PartAccess::contact(const Part& part, double base, std::size_t likely_panel) {
  const TurningFunction& turning = part.turning();
  const Panel& likely = turning.panels()[likely_panel];
  const bool is_there = base >= likely.lo && base < likely.hi;
  const std::size_t index = is_there ? likely_panel : panel_at(turning.panels(), base);
  return {point(part, index, base), nearest_angle(turning.on_panel(turning.panels()[index], base).angle)};
}

/// In (-pi, pi], unlike Theta; at a corner the limit from after it.
double Part::tangent(double s) const {
  const Side side = !closed() && s >= perimeter() ? Side::before : Side::after;
  return nearest_angle(data_->turning.angle(s, side));
}

/// Equal steps of arc length, and every corner strictly between lo and hi, on each lap that the range covers.
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

/// A copy of all data: nothing is measured again but the tree.
Part with_unit(const Part& part, const std::string& unit) {
  PartAccess::Data data = PartAccess::data(part);
  data.outline.unit = unit;
  return PartAccess::part(std::move(data));
}

Part with_name(const Part& part, const std::string& name) {
  PartAccess::Data data = PartAccess::data(part);
  data.outline.name = name;
  return PartAccess::part(std::move(data));
}

Part load_part(const std::string& source) { return Part(load_outline(source)); }

/// Corners do not interrupt: a curvature of the other sign behind a corner is an inflection at the corner.
std::vector<double> find_inflections(const TurningFunction& turning) {
  return changes(turning, bend_of, [](std::size_t) { return false; });
}

/// A vertex needs a curvature that goes on: corners, and joints at which the curvature jumps, interrupt.
std::vector<double> find_vertices(const TurningFunction& turning, const std::vector<Corner>& corners) {
  const std::vector<Spiral>& spirals = turning.spirals();
  // Whether spiral k starts at a corner, or with a curvature that differs from the one before by more than rounding:
  // relative to the larger, and to 1 / P.
  const auto jumps = [&](std::size_t k) {
    const double s = spirals[k].lo;
    const auto next = std::lower_bound(corners.begin(), corners.end(), s,
                                       [](const Corner& corner, double place) { return corner.s < place; });
    if (next != corners.end() && next->s == s) return true;
    const double before = spirals[k > 0 ? k - 1 : spirals.size() - 1].end.curvature;
    const double after = spirals[k].start.curvature;
    return std::abs(before - after) > kSameCurvature * std::max(std::abs(before), std::abs(after)) &&
           std::abs(before - after) > kSameCurvature / turning.perimeter();
  };
  std::vector<char> starts_afresh(spirals.size());
  for (std::size_t k = 0; k < spirals.size(); ++k) starts_afresh[k] = jumps(k) ? 1 : 0;
  return changes(turning, trend_of, [&](std::size_t k) { return starts_afresh[k] != 0; });
}

}  // namespace rollfix
