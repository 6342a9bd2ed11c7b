#include "rollfix/turning_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "part_data.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation:
//   s, P            arc length, in `Panel::lo` to `hi` on a panel; perimeter: `perimeter_`
//   x               arc length on a panel, from -1 to 1: (s - `middle`) `inverse_half`
//   Theta(s)        tangent's angle, unwrapped; kappa = Theta': powers of x in `coefficients_`, a pair for each power
//   y               s = middle + half y, from -1 to 1: `difference` gives Theta(s + L) - Theta(s) by powers of y
//   jump            of Theta at a joint: a corner where it is above `kCornerTurn`
//   spiral          a stretch on which neither kappa nor kappa' changes sign; `trend` is the sign of kappa'
// Follows docs/search.md, "Once per part"; Theta is the turning function of Arkin et al., "An efficiently computable
// metric for comparing polygonal shapes" (1991). Lengths are summed as by Neumaier (1974).
// Idea: panels resolved by resolve.cpp are put in a row, and cut where kappa or kappa' changes sign. At each panel's
// start the curve's own tangent corrects the angle that was integrated, so that roundings do not add up.
namespace rollfix {

/// Binary search by the spirals' starts: the last one that starts at or before base (Side::after), or before it
/// (Side::before). A base below the first start counts as on the first.
std::size_t TurningFunction::spiral_at(double base, Side side) const {
  const auto after = side == Side::after
                         ? std::upper_bound(spirals_.begin(), spirals_.end(), base,
                                            [](double value, const Spiral& spiral) { return value < spiral.lo; })
                         : std::lower_bound(spirals_.begin(), spirals_.end(), base,
                                            [](const Spiral& spiral, double value) { return spiral.lo < value; });
  return after == spirals_.begin() ? 0 : static_cast<std::size_t>(after - spirals_.begin()) - 1;
}

Turning TurningFunction::at(double s, Side side) const {
  // Theta(s + k P) = Theta(s) + k period_turn: only s within one lap is looked up.
  const Wrapped place = boundary().reduced(s, side);
  const Spiral& spiral = spirals_[spiral_at(place.base, side)];
  Turning turning = place.base == spiral.lo   ? spiral.start  // a joint: no need to look
                    : place.base == spiral.hi ? spiral.end
                                              : on_spiral(spiral, place.base);
  if (closed_) turning.angle += place.winding * period_turn_;
  return turning;
}

/// The first panel of these that ends behind base, by binary search; `last` where none does.
std::uint32_t TurningFunction::middle_panel(std::uint32_t first, std::uint32_t last, double base) const {
  const auto found = std::upper_bound(panels_.begin() + first, panels_.begin() + last, base,
                                      [](double value, const Panel& panel) { return value < panel.hi; });
  return static_cast<std::uint32_t>(found - panels_.begin());
}

Powers TurningFunction::difference(const Panel& start, double start_middle, const Panel& end, double end_middle,
                                   double half) const {
  // Both polynomials are brought to y: first their variable x is moved to the new middle, then scaled. The difference
  // is formed power by power, so that what both have in common cancels before any bound is taken.
  const std::size_t count = std::max(start.count, end.count);
  std::array<Pair, kMostPowers> powers;  // of the end and of the start: one vector instruction serves both
  for (std::size_t k = 0; k < count; ++k) {
    powers[k] = {k < end.count ? coefficients_[end.offset + k][0] : 0.0,
                 k < start.count ? coefficients_[start.offset + k][0] : 0.0};
  }
  const Pair centre((end_middle - end.middle) * end.inverse_half, (start_middle - start.middle) * start.inverse_half);
  for (std::size_t first = 0; first + 1 < count; ++first) {  // Horner's scheme, repeated: x = centre + ...
    Pair above = powers[count - 1];
    for (std::size_t k = count - 1; k-- > first;) above = powers[k] += centre * above;
  }
  const Pair ratio(half * end.inverse_half, half * start.inverse_half);  // ... + ratio * y
  Powers f(static_cast<Eigen::Index>(count));
  Pair scale = Pair::Ones();
  for (std::size_t k = 0; k < count; ++k, scale *= ratio) {
    const Pair scaled = powers[k] * scale;
    f[static_cast<Eigen::Index>(k)] = scaled[0] - scaled[1];
  }
  return f;
}

namespace {

using chebyshev::Series;

// A smaller jump of the tangent at a joint is what is left of rounding: no corner.
constexpr double kCornerTurn = 1e-11;
// A panel shorter than this share of its own arc length s has too few numbers in it for a polynomial: some twenty.
constexpr double kLeastPanel = 4e-15;
// A corner this close to a full reversal is a cusp: to which side it turns can't be told.
constexpr double kCuspTurn = 1e-7;
// Curves of one outline must meet to this share of its size.
constexpr double kGap = 1e-9;
constexpr int kSizeSamples = 8;
// A sign change this close to a panel's end, as a share of the panel, is at the end.
constexpr double kPanelEnd = 1e-9;

/// d/dx by powers; of a constant the empty series.
Series derivative(const Series& powers) {
  const Eigen::Index count = std::max<Eigen::Index>(powers.size() - 1, 0);
  Series result(count);
  for (Eigen::Index k = 0; k < count; ++k) result[k] = static_cast<double>(k + 1) * powers[k + 1];
  return result;
}

/// The length of a polygon of kSizeSamples chords for each curve: a size to hold errors against; too small where a
/// curve turns much from one sample to the next.
double rough_length(const Outline& outline) {
  double sum = 0;
  for (const Curve& curve : outline.curves) {
    const Interval domain = curve.domain();
    Vec2 last = curve.front();
    for (int k = 1; k <= kSizeSamples; ++k) {
      const Vec2 next = curve.position(domain.lo + domain.width() * k / kSizeSamples);
      sum += (next - last).norm();
      last = next;
    }
  }
  return sum;
}

// A scan of so many points has no memory to waste: there, powers that change an angle (radians) or a parameter (as a
// share of it) by less than they are rounded are left out, which leaves two or three of nine.
constexpr std::size_t kManyCurves = 20'000;
constexpr double kNoTurn = 1e-16;
constexpr double kNoShare = 8e-16;

}  // namespace

/// Horner's scheme; every piece has at least one coefficient.
double Parametrization::parameter(std::size_t panel, double x) const {
  const Piece& piece = pieces[panel];
  double sum = 0;
  for (std::uint32_t k = piece.count; k-- > 0;) sum = sum * x + coefficients[piece.offset + k];
  return sum;
}

/// Measures the whole outline. The time is linear in the number of panels.
TurningFunctionBuilder::TurningFunctionBuilder(const Outline& outline) : outline_(outline) {
  if (outline.curves.empty()) throw InputError("expected an outline of at least one curve, found none");
  size_ = rough_length(outline);
  if (!(size_ > 0) || !std::isfinite(size_)) {
    throw InputError(fmt::format("expected an outline of finite size above 0, found length {}", size_));
  }
  turning.closed_ = outline.closed;
  const Doing doing("measuring the outline");
  for (std::uint32_t index = 0; index < outline.curves.size(); ++index) {
    beat();
    add_curve(index);
  }
  close();
}

/// Between curve and curve a gap up to kGap of the size, or up to what the outline says of itself, is jumped over: it
/// adds no length.
void TurningFunctionBuilder::add_curve(std::uint32_t index) {
  const Curve& curve = outline_.curves[index];
  const std::size_t before = index > 0 ? index - 1 : outline_.curves.size() - 1;
  if (index > 0 || outline_.closed) {
    const Vec2 end = outline_.curves[before].back();
    const Vec2 start = curve.front();
    if (!((end - start).norm() <= std::max(kGap * size_, outline_.gap))) {
      throw InputError(fmt::format(
          "expected curve {} to start where curve {} ends, at ({:.9g}, {:.9g}); found ({:.9g}, {:.9g}), a gap of "
          "{:.3g}: close the gap or call the outline open",
          index + 1, before + 1, end.x(), end.y(), start.x(), start.y(), (end - start).norm()));
    }
  }
  new_curve_ = true;
  resolve(curve, size_, attempts_, [&](const ResolvedPanel& panel) { add_panel(panel, index); });
}

void TurningFunctionBuilder::add_panel(const ResolvedPanel& resolved, std::uint32_t curve) {
  const double sum = length_ + resolved.length;  // Neumaier: millions of panels must not add up their roundings
  length_rest_ +=
      std::abs(length_) >= resolved.length ? (length_ - sum) + resolved.length : (resolved.length - sum) + length_;
  length_ = sum;
  Panel panel;
  // A panel starts at the very number where the one before ends: no place lies between them.
  panel.lo = turning.panels_.empty() ? 0 : turning.panels_.back().hi;
  panel.hi = length_ + length_rest_;
  // Beside a place where a curve is at rest: what it turns there goes to the joint.
  if (resolved.length < kLeastPanel * panel.hi) return;
  // From here on angle_ is Theta at the panel's start, as the curve's own tangent has it.
  join(resolved.tangent_at_start, panel.lo);
  panel.middle = panel.lo + 0.5 * (panel.hi - panel.lo);
  panel.inverse_half = 2 / (panel.hi - panel.lo);

  // Theta = Theta at the start + the turn since then.
  Series turn = resolved.turn;
  turn[0] += angle_;
  store(turn, resolved.curvature, panel);
  turning.panels_.push_back(panel);

  // Of a dense outline the powers of u(x) that are below its rounding are left out.
  const Series& parameter = resolved.parameter;
  const double least = kNoShare * parameter.cwiseAbs().maxCoeff();
  Eigen::Index size = parameter.size();
  while (size > 1 && is_dense() && std::abs(parameter[size - 1]) <= least) --size;
  parametrization.pieces.push_back(
      {curve, static_cast<std::uint32_t>(parametrization.coefficients.size()), static_cast<std::uint32_t>(size)});
  parametrization.coefficients.insert(parametrization.coefficients.end(), parameter.begin(), parameter.begin() + size);

  // The integral's value at x = 1: Theta at the panel's end.
  angle_ += resolved.turn.sum();
  add_spirals(resolved.curvature);
}

/// A scan: its panels are so many that memory decides, and so short that few powers count.
bool TurningFunctionBuilder::is_dense() const { return outline_.curves.size() >= kManyCurves; }

/// Of a dense outline the last powers are dropped whose share of Theta, and of kappa times half the panel's length, is
/// at most kNoTurn rad. The number of powers is filled up to a multiple of kPanelBlock: the evaluation takes that many
/// at a time.
void TurningFunctionBuilder::store(const Series& turn, const Series& curvature, Panel& panel) {
  auto& all = turning.coefficients_;
  panel.offset = static_cast<std::uint32_t>(all.size());
  const double half = 0.5 * (panel.hi - panel.lo);
  const auto counts = [&](Eigen::Index k) {
    return std::abs(turn[k]) > kNoTurn || (k < curvature.size() && half * std::abs(curvature[k]) > kNoTurn);
  };
  Eigen::Index size = turn.size();
  while (size > 1 && is_dense() && !counts(size - 1)) --size;
  for (Eigen::Index k = 0; k < size; ++k) all.emplace_back(turn[k], k < curvature.size() ? curvature[k] : 0);
  while ((all.size() - panel.offset) % kPanelBlock != 0) all.emplace_back(0, 0);
  panel.count = static_cast<std::uint32_t>(all.size()) - panel.offset;
}

/// The tangent's own direction corrects the accumulated angle, so that roundings do not add up. The jump is taken in
/// (-pi, pi]: above kCornerTurn it is a corner, at which Theta has two values; below it is rounding. A jump of nearly
/// pi has no sign that could be trusted: a cusp, refused.
void TurningFunctionBuilder::join(const Vec2& direction, double s) {
  const double own_angle = std::atan2(direction.y(), direction.x());
  // The first panel: Theta starts with its tangent's angle, in (-pi, pi].
  if (turning.panels_.empty()) {
    angle_ = first_angle_ = own_angle;
    first_direction_ = direction;
    return;
  }
  const double jump = nearest_angle(own_angle - angle_);
  angle_ += jump;
  if (std::abs(jump) <= kCornerTurn) return;
  if (std::abs(jump) >= std::numbers::pi - kCuspTurn) {
    throw InputError(fmt::format(
        "expected the outline to turn by less than 180 degrees at each corner, found a cusp (a full reversal) at "
        "arc length {:.9g}: blunt it",
        s));
  }
  corners.push_back({s, jump});
}

/// Cuts the newest panel where kappa changes its sign (inflection) or kappa' does (vertex). Between two cuts kappa
/// keeps its sign and is monotone: part of a spiral.
void TurningFunctionBuilder::add_spirals(const Series& curvature) {
  const auto index = static_cast<std::uint32_t>(turning.panels_.size() - 1);
  const Panel& panel = turning.panels_[index];
  std::vector<double> cuts = chebyshev::sign_changes(curvature);
  const std::vector<double> slope_cuts = chebyshev::sign_changes(derivative(curvature));
  cuts.insert(cuts.end(), slope_cuts.begin(), slope_cuts.end());
  std::sort(cuts.begin(), cuts.end());
  // The cuts are in rising order; each ends the piece that started at the cut before.
  double lo = panel.lo;
  for (const double cut : cuts) {
    if (1 - std::abs(cut) < kPanelEnd) continue;
    // From x back to arc length. Two cuts that round to one place make one cut.
    const double hi = panel.middle + cut / panel.inverse_half;
    if (hi > lo) {
      add_spiral(lo, hi, index);
      lo = hi;
    }
  }
  add_spiral(lo, panel.hi, index);
}

/// Appends a monotone piece, or lengthens the last spiral by it where that goes on unchanged.
void TurningFunctionBuilder::add_spiral(double lo, double hi, std::uint32_t panel) {
  Spiral spiral;
  spiral.lo = lo;
  spiral.hi = hi;
  spiral.first_panel = spiral.last_panel = panel;
  // One-sided: both ends are evaluated on this panel.
  spiral.start = turning.on_spiral(spiral, lo);
  spiral.end = turning.on_spiral(spiral, hi);
  const double change = spiral.end.curvature - spiral.start.curvature;
  spiral.trend = change > 0 ? 1 : (change < 0 ? -1 : 0);
  turning.most_curvature_ =
      std::max({turning.most_curvature_, std::abs(spiral.start.curvature), std::abs(spiral.end.curvature)});
  std::vector<Spiral>& all = turning.spirals_;
  // The sign of kappa: on a spiral both ends have the same sign, or one of them is 0.
  const auto side = [](const Spiral& one) { return one.start.curvature + one.end.curvature; };
  // Only within one curve, where kappa is continuous, can a spiral go on across a panel's end: with the same trend and
  // on the same side of 0.
  if (!new_curve_ && all.back().trend == spiral.trend && side(all.back()) * side(spiral) >= 0) {
    all.back().hi = hi;
    all.back().end = spiral.end;
    all.back().last_panel = panel;
  } else {
    all.push_back(spiral);
  }
  new_curve_ = false;
}

void TurningFunctionBuilder::close() {
  turning.perimeter_ = turning.panels_.back().hi;
  turning.panels_.back().hi = turning.spirals_.back().hi = turning.perimeter_;
  // The seam is a joint like any other: the first tangent, seen from the last panel's end.
  if (!outline_.closed) return;
  const std::size_t found = corners.size();
  join(first_direction_, turning.perimeter_);
  if (corners.size() > found) {  // the corner at the seam belongs to s = 0
    corners.insert(corners.begin(), Corner{0, corners.back().turn});
    corners.pop_back();
  }
  // angle_ is now the first tangent's angle plus whole turns; rounding to 2 pi k leaves no error in them.
  const double full = 2 * std::numbers::pi;
  turning.period_turn_ = full * std::round((angle_ - first_angle_) / full);
}

}  // namespace rollfix
