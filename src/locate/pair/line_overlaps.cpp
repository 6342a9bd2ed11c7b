#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "line_search.hpp"
#include "locate/corner_sets.hpp"

// Where curves run along each other: the other equations vanish all along the line that the guide leaves.
// Notation, as in line_search.cpp:
//   x, y, g         the free contact and the bound one; the guide, the equation that is solved for y: `guide_`
//   r_k(x)          the other equations along that line: `residual`
//   rounding        what an r_k that is 0 may be off, by the rates of all contacts: `residual_rounding`
//   overlap         a stretch of x, in the box, on which every r_k and its slope are 0 but for rounding
// Follows docs/search.md, "Two fingers", step 5.
// Idea: on one piece r_k has fewer degrees of freedom than there are samples: zero at all of them, it is zero in
// between. Where both fingers go straight, its two ends are enough.
namespace rollfix::locating {
namespace {

// Zero at more points than the functions have degrees of freedom on one piece: zero between them, too.
constexpr int kOverlapSamples = 19;
// On an overlap the slope along the line is 0 too, up to this share of the rates that it is made of.
constexpr double kOverlapSlope = 1e-8;
// An overlap shorter than this share of the perimeter can't be told from a root.
constexpr double kShortestOverlap = 1e-9;
// An arc length is rounded to this share of the perimeter: times the curvature, an angle.
constexpr double kResidualRounding = 4e-15;

}  // namespace

bool LineSearch::may_overlap() {
  if (!choose_guide() || is_apart_midway()) return false;
  Stretch all{place(free().lo()), place(free().hi()), 0, false};
  if (!clip(all, 0)) return false;
  return vanishes(place(0.5 * (all.lo.free.x + all.hi.free.x)));
}

/// Is another equation surely not 0 at a place of the line in the box? Looks about in the middle, where one point on
/// each side and the slopes' bounds nearly always tell that curves do not run along each other. False: not known.
bool LineSearch::is_apart_midway() const {
  const PlaneCurve::Component& of_free = free().component(guide_);
  const PlaneCurve::Component& of_bound = bound().component(guide_);
  const double shift = (free_is_a_ ? 1 : -1) * sides_.shift(guide_, limits_);
  const double rise = of_free.last - of_free.first;
  const auto reached = [&](double value) {  // along the chord, in the box
    return rise == 0 ? 0.5 : std::clamp((value + shift - of_free.first) / rise, 0.0, 1.0);
  };
  const double share = 0.5 * (reached(of_bound.first) + reached(of_bound.last));
  const double level = of_free.first + share * rise - shift;
  const double across = std::clamp((level - of_bound.first) / (of_bound.last - of_bound.first), 0.0, 1.0);
  const CurvePoint on_free = free().point(free().lo() + share * free().width());
  const CurvePoint on_bound = bound().point(bound().lo() + across * bound().width());
  // The guide is nearly 0 at the two points. Its slope's bounds tell how far y may be from the line there.
  const double off = on_free.value(guide_) - on_bound.value(guide_) - shift;
  const Range way = Range{off, off} / bound().slope(guide_);  // of the bound contact to where the guide is 0
  if (on_bound.x + way.least < bound().lo() || on_bound.x + way.most > bound().hi()) return false;
  const double rounding = residual_rounding({on_free, on_bound});
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row == guide_) continue;
    const double turns = (free_is_a_ ? 1 : -1) * sides_.shift(row, limits_);
    const double residual = on_free.value(row) - on_bound.value(row) - turns;
    // Bounds on r_k on the line itself.
    const Range there = Range{residual, residual} - way * bound().slope(row);
    if (there.least > rounding || there.most < -rounding) return true;
  }
  return false;
}

/// Are all residuals 0 but for rounding? The guide's is by construction.
bool LineSearch::vanishes(const Place& place) const {
  const double rounding = residual_rounding(place);
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row != guide_ && std::abs(residual(place, row)) > rounding) return false;
  }
  return true;
}

/// What a residual that is 0 may be computed as, radians: Theta's accuracy, and the rounding of places times all rates.
double LineSearch::residual_rounding(const Place& place) const {
  double rates = 0;
  for (const double rate : place.free.rates()) rates += std::abs(rate);
  for (const double rate : place.bound.rates()) rates += std::abs(rate);
  return 2 * kTurnAccuracy + kResidualRounding * limits_.perimeter * rates;
}

/// Do the curves coincide all along the part of a stretch that lies in the box?
bool LineSearch::overlaps(const Stretch& whole, std::vector<Place>& samples) const {
  for (const Place* end : {&whole.lo, &whole.hi}) {  // one that is not clipped: nearly always that settles it
    if (end->bound.x >= bound().lo() && end->bound.x <= bound().hi() && !vanishes(*end)) return false;
  }
  Stretch stretch = whole;
  if (turns_round(stretch)) {  // all of it must be in the box
    const Range reached = bounds(stretch).bound_x;
    if (reached.least < bound().lo() || reached.most > bound().hi()) return false;
  } else if (!clip(stretch, 0)) {
    return false;
  }
  const double width = stretch.hi.free.x - stretch.lo.free.x;
  if (width <= kShortestOverlap * (free().pivots() ? 1 : limits_.perimeter)) return false;
  if (!vanishes(stretch.lo) || !vanishes(stretch.hi)) return false;
  if (free().is_straight() && bound().is_straight()) {  // zero in between where it is at both ends
    if (!slopes_vanish(stretch.lo)) return false;
    samples = {stretch.lo, stretch.hi};
    return true;
  }
  samples.reserve(kOverlapSamples + 1);
  samples.push_back(stretch.lo);
  for (int k = 1; k < kOverlapSamples; ++k) {
    samples.push_back(place(stretch.lo.free.x + width * k / kOverlapSamples));
    if (!slopes_vanish(samples.back()) || !vanishes(samples.back())) return false;
  }
  samples.push_back(stretch.hi);
  return true;
}

bool LineSearch::slopes_vanish(const Place& at) const {
  double scale = 1 / limits_.perimeter;
  for (const double rate : at.free.rates()) scale += std::abs(rate);
  for (const double rate : at.bound.rates()) scale += std::abs(rate * direction(at));
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row != guide_ && std::abs(residual_slope(at, row)) > kOverlapSlope * scale) return false;
  }
  return true;
}

/// Where dy/dx changes sign between two places: the line's extreme y there, by bisection to the last bit.
LineSearch::Place LineSearch::turn_between(const Place& one, const Place& two) const {
  double lo = one.free.x;
  double hi = two.free.x;
  const bool rises = direction(one) > 0;
  while (true) {
    const double middle = 0.5 * (lo + hi);
    if (!(middle > lo && middle < hi)) return place(lo);
    ((direction(place(middle)) > 0) == rises ? lo : hi) = middle;
  }
}

/// The set within the tolerance is a band about the line: it also holds what lies beyond the line's ends, where the
/// line leaves the box at a slant.
void LineSearch::take_overlap(const Stretch& whole, std::vector<Place> samples) {
  for (std::size_t k = samples.size() - 1; k > 0; --k) {  // backwards: what is put in moves the rest
    if (direction(samples[k - 1]) * direction(samples[k]) >= 0) continue;
    samples.insert(samples.begin() + static_cast<std::ptrdiff_t>(k), turn_between(samples[k - 1], samples[k]));
  }
  PairPiece piece;
  piece.exact = true;
  piece.corner = sides_.pivots();
  for (const Place& sample : samples) piece.line.push_back(contacts(sample));
  std::vector<PairPoint> around = piece.line;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    // Between two samples the line is no further from its chord than its change of direction allows; twice that, for
    // the direction may change more in between.
    const double width = samples[k].free.x - samples[k - 1].free.x;
    const double bend = 0.5 * width * std::abs(direction(samples[k]) - direction(samples[k - 1]));
    piece.error = std::max(piece.error, bend);
    for (const Vec2& corner : band(samples[k - 1], samples[k], bend)) around.push_back(contacts(corner));
  }
  piece.box = box_about(around);
  piece.error = length_of(piece.error + margin_);
  findings_.roots.push_back({piece.line.front(), 0, piece.corner});
  findings_.pieces.push_back(std::move(piece));
  if (whole.covered) return;
  if (whole.lo.free.x < samples.front().free.x) add_beyond(whole.lo, samples.front());
  if (whole.hi.free.x > samples.back().free.x) add_beyond(samples.back(), whole.hi);
}

/// What a line that has left the box still has within the tolerance in it.
void LineSearch::add_beyond(const Place& lo, const Place& hi) {
  const Range y = bounds({lo, hi, 0, false}).bound_x;
  if (!passes_by(lo, hi, y)) add_piece(lo, hi, y);
}

}  // namespace rollfix::locating
