#include "box_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "line_search.hpp"
#include "locate/searches.hpp"
#include "outline/turn.hpp"
#include "plane_curve.hpp"
#include "work/pulse.hpp"

// Notation:
//   s, t            first contacts of finger a and of finger b; in a box the coordinates x of two nodes (at a corner x
//                   is the angle that the finger has pivoted by)
//   A(s), B(t)      the two fingers' curves, with a component (`row`) for each equation: `a_`, `b_`
//   f_k(s, t)       A_k(s) - B_k(t), in the facing's row less whole turns (`lap`): `residual`
//   p, q            two rows that a box is decided by; J = ((A_p', -B_p'), (A_q', -B_q')) is their Jacobian
//   Y               inverse of J with the middles of all slopes: `Regular::inverse`
//   |1 - Y J|       bounded entry by entry in `Regular::off`; `spectral_radius` is its spectral radius, `slack` (1 -
//   off)^-1
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Two fingers", steps 2 and 3. Uniqueness is
// Hadamard's global inverse theorem, for f continued beyond the box by its tangents.
// Idea: a box goes when the two sides can't meet. Where `spectral_radius` is below 1 it has one root at the most, and
// Newton's method says whether. What is neither is followed as a line (line_search.cpp) or halved.
namespace rollfix::locating {
namespace {

// The simplified Newton step must contract by this at least, in the end: then the box has one root at the most.
constexpr double kMostContraction = 0.9;
// Rows whose determinant is below this share of its terms may be parallel: curvatures are rounded.
constexpr double kParallel = 1e-12;
// Curves that run alongside each other are first halved this often, which is cheap, for the halves are shared; every so
// often they are looked at for an overlap, which no halving would ever end.
constexpr int kPlainBoxHalvings = 16;
constexpr int kOverlapInterval = 8;
// Within an extent the curves are taken as straight where their directions vary by this share at the most.
constexpr double kBoxExtentBend = 0.01;
// Rounds of Newton's method at most; from half of them on it takes the simplified step, which contracts for sure.
constexpr int kMostBoxRounds = 60;
// Boxes and finds that there is room for at first.
constexpr std::size_t kBoxRoom = 32;
// Steps of Newton's method on the cubics through a box's ends, the first one by their chords.
constexpr int kCubicRounds = 3;
// Newton's step below this share of the box leaves less than rounding: the tangents tell where it leads.
constexpr double kLastBoxStep = 1e-9;
// Newton's step that is below this share of the box is the last one.
constexpr double kBoxRootStep = 1e-14;
// So is one below this share that is more than half as large as the one before: rounding moves it.
constexpr double kSmallBoxStep = 1e-6;
// On a flat box of zeros the slopes vanish as well, up to this many radians over a perimeter.
constexpr double kFlatSlope = 1e-9;

/// From one end of a side to the other, in the plane of components p and q.
Vec2 chord(const BoxSide& side, std::size_t p, std::size_t q) {
  const PlaneCurve::Component& one = side.component(p);
  const PlaneCurve::Component& two = side.component(q);
  return {one.last - one.first, two.last - two.first};
}

/// by.x() times component p and by.y() times component q of a side.
PlaneCurve::Combination combination(const BoxSide& side, const Vec2& by, std::size_t p, std::size_t q) {
  return {by.x(), by.y(), side.component(p), side.component(q)};
}

/// Bounds on a combination of two components along a side.
Range along(const BoxSide& side, const Vec2& direction, std::size_t p, std::size_t q) {
  return combination(side, direction, p, q).value(side.width());
}

/// The spectral radius of a matrix without entries below 0. Below 1, the powers of every matrix whose entries it bounds
/// in size vanish.
double spectral_radius(const Eigen::Matrix2d& bound) {
  const double middle = 0.5 * bound.trace();
  const double half = 0.5 * (bound(0, 0) - bound(1, 1));
  return middle + std::sqrt(half * half + bound(0, 1) * bound(1, 0));
}

/// Of a row at a place on each side.
double residual(const PairBoxSides& sides, const PairLimits& limits, const CurvePoint& on_a, const CurvePoint& on_b,
                std::size_t row) {
  return on_a.value(row) - on_b.value(row) - sides.shift(row, limits);
}

/// The largest |f_k| at a place on each side.
double largest_residual(const PairBoxSides& sides, const PairLimits& limits, const CurvePoint& on_a,
                        const CurvePoint& on_b) {
  double largest = 0;
  for (std::size_t row = 0; row < sides.a.rows(); ++row) {
    largest = std::max(largest, std::abs(residual(sides, limits, on_a, on_b, row)));
  }
  return largest;
}

/// The part of the box in which all |f_k| are within the tolerance, with f taken as straight about a place: a convex
/// polygon, empty where there is none. Of two rows it is a parallelogram, if all of that is in the box.
Polygon set_about(const PairBoxSides& sides, const PairLimits& limits, const std::array<std::size_t, 2>& rows,
                  const CurvePoint& on_a, const CurvePoint& on_b) {
  const auto f = [&](std::size_t row) { return residual(sides, limits, on_a, on_b, row); };
  const auto slope = [&](std::size_t row) { return Vec2(on_a.slope(row), -on_b.slope(row)); };
  const Vec2 at(on_a.x, on_b.x);
  const Vec2 lo(sides.a.lo(), sides.b.lo());
  const Vec2 hi(sides.a.hi(), sides.b.hi());
  const auto [p, q] = rows;
  Eigen::Matrix2d jacobian;
  jacobian << slope(p).transpose(), slope(q).transpose();
  const Eigen::Matrix2d inverse = jacobian.inverse();
  Polygon set;
  bool fits = true;
  // The corners of the parallelogram |f_p|, |f_q| <= tolerance, through the inverse of J. If one is outside, start from
  // the whole box instead and cut it by every row.
  for (const Vec2& sign : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
    const Vec2& corner = set.emplace_back(at + inverse * (limits.tolerance * sign - Vec2(f(p), f(q))));
    fits = fits && (corner.array() >= lo.array()).all() && (corner.array() <= hi.array()).all();
  }
  if (!fits) set = {lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}};
  for (std::size_t row = 0; row < sides.a.rows() && !set.empty(); ++row) {
    if (!fits || (row != p && row != q)) set = within(set, at, f(row), slope(row), limits.tolerance);
  }
  return set;
}

/// A piece of a convex set of pairs, in coordinates of the box, with a place in it: as s and t, so that pivots are
/// points.
PairPiece piece_around(const PairBoxSides& sides, const Polygon& extent, const Vec2& inner) {
  Vec2 least = inner;
  Vec2 most = inner;
  for (const Vec2& x : extent) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  }
  PairPiece piece;
  piece.box = {Interval{sides.a.s(least.x()), sides.a.s(most.x())},
               Interval{sides.b.s(least.y()), sides.b.s(most.y())}};
  piece.corner = sides.pivots();
  piece.hull.reserve(extent.size());
  for (const Vec2& x : extent) piece.hull.push_back({sides.a.s(x.x()), sides.b.s(x.y())});
  return piece;
}

/// About where the curves cross, or the nearest place in the box: where both sides' chords cross, then Newton's method
/// on both sides' cubics, which needs no evaluation of the curves. A start for Newton's method on the curves
/// themselves.
Vec2 about_crossing(const PairBoxSides& sides, const PairLimits& limits, const std::array<std::size_t, 2>& rows) {
  const std::array<ResidualCubic, 2> on_a{sides.a.cubic(rows[0]), sides.a.cubic(rows[1])};
  const std::array<ResidualCubic, 2> on_b{sides.b.cubic(rows[0]), sides.b.cubic(rows[1])};
  Eigen::Matrix2d slopes;
  Vec2 f;
  Vec2 shares = Vec2::Zero();
  for (int round = 0; round < kCubicRounds; ++round) {
    for (const Eigen::Index k : {0, 1}) {
      const std::size_t row = rows[static_cast<std::size_t>(k)];
      const ResidualCubic& a = on_a[static_cast<std::size_t>(k)];
      const ResidualCubic& b = on_b[static_cast<std::size_t>(k)];
      f[k] = a.value(shares.x()) - b.value(shares.y()) - sides.shift(row, limits);
      if (round == 0) {
        slopes.row(k) << a.value(1) - a.value(0), b.value(0) - b.value(1);
      } else {
        slopes.row(k) << a.slope(shares.x()), -b.slope(shares.y());
      }
    }
    shares = (shares - slopes.inverse() * f).cwiseMax(0).cwiseMin(1);
  }
  // Chords or cubics that are parallel: the middle will do.
  if (!shares.allFinite()) return {sides.a.middle(), sides.b.middle()};
  return {sides.a.lo() + shares.x() * sides.a.width(), sides.b.lo() + shares.y() * sides.b.width()};
}

}  // namespace

PairBoxSearch::PairBoxSearch(PlaneCurve& a, PlaneCurve& b, const PairLimits& limits, std::size_t& budget,
                             PairFindings& findings)
    : a_(a), b_(b), limits_(limits), budget_(budget), findings_(findings) {}

void PairBoxSearch::run() {
  if (a_.root() < 0 || b_.root() < 0) return;
  waiting_.reserve(kBoxRoom);
  findings_.pieces.reserve(kBoxRoom);
  findings_.roots.reserve(kBoxRoom);
  waiting_.push_back({a_.root(), b_.root(), 0, false});
  while (!waiting_.empty()) {
    const Box box = waiting_.back();
    waiting_.pop_back();
    decide(box);
  }
}

void PairBoxSearch::decide(const Box& box) {
  beat();
  ++findings_.counts.intervals;
  const PairLimits limits = box.covered ? limits_.inside() : limits_;
  const double tolerance = limits.tolerance;
  bool one_lap = true;
  double lap = 0;
  const PlaneCurve::Component* on_a = a_.components(box.a);
  const PlaneCurve::Component* on_b = b_.components(box.b);
  for (std::size_t row = 0; row < a_.rows(); ++row) {
    // One row alone can exclude the box. The facing row is modulo 2 pi: the multiples within reach are counted. Bounds
    // that need the multiple are used only where a single one is left.
    const Range f = on_a[row].value - on_b[row].value;
    if (limits_.facing && row + 1 == a_.rows()) {
      const double least = std::ceil((f.least - tolerance) / kFullTurn);
      const double most = std::floor((f.most + tolerance) / kFullTurn);
      if (least > most) return;
      one_lap = least == most;
      lap = least * kFullTurn;
    } else if (!f.comes_within(tolerance)) {
      return;
    }
  }
  if (one_lap && meet_nowhere_across(box, lap, tolerance)) return;
  // Nodes over many pieces come with the part: halving them costs nothing of the budget.
  if (!a_.node(box.a).on_one_piece() || !b_.node(box.b).on_one_piece()) {
    halve(box, a_is_wider(box));
    return;
  }
  const PairBoxSides sides{{a_, box.a}, {b_, box.b}, lap};
  if (one_lap && is_apart(sides, limits)) return;
  if (box.depth > 0 && budget_ == 0) {
    findings_.unresolved.push_back({Interval{sides.a.s(sides.a.lo()), sides.a.s(sides.a.hi())},
                                    Interval{sides.b.s(sides.b.lo()), sides.b.s(sides.b.hi())}});
    return;
  }
  // The first box of each pair of pieces is free: there are as many as the part has, whatever the tolerance.
  if (box.depth > 0) --budget_;
  if (one_lap) {
    decide_on_pieces(box, sides, limits);
  } else {
    halve(box, a_is_wider(box));
  }
}

/// Are A_0 + A_1 and B_0 + B_1 further apart than the tolerance allows, or A_0 - A_1 and B_0 - B_1? Each of the two may
/// be off by both rows' tolerances.
bool PairBoxSearch::meet_nowhere_across(const Box& box, double lap, double tolerance) const {
  if (a_.rows() < 2) return false;
  const double shift = limits_.facing && a_.rows() == 2 ? lap : 0;
  const auto& of_a = a_.node(box.a).diagonals;
  const auto& of_b = b_.node(box.b).diagonals;
  const Range sum = of_a[0] - of_b[0] - Range{shift, shift};
  const Range difference = of_a[1] - of_b[1] + Range{shift, shift};
  return !sum.comes_within(2 * tolerance) || !difference.comes_within(2 * tolerance);
}

void PairBoxSearch::decide_on_pieces(Box box, const PairBoxSides& sides, const PairLimits& limits) {
  // First what ends most boxes: at most one root, and it is found or excluded.
  if (const auto rows = regular(sides); rows && take_regular(sides, limits, *rows)) return;
  // Then f that does not vary enough for halving to tell more.
  const Flat flat = take_flat(sides, limits);
  if (flat == Flat::settled) return;
  box.covered = box.covered || flat == Flat::covered;
  // J is singular in the box. Two straight sides cross or run along each other, which a line decides at once; else a
  // line is followed after many halvings, and earlier only where an overlap shows.
  const bool is_last_resort = box.depth >= kPlainBoxHalvings || (sides.a.is_straight() && sides.b.is_straight());
  const bool overlap_due = box.depth > 0 && box.depth % kOverlapInterval == 0;
  if (is_last_resort || overlap_due || corners_vanish(sides)) {
    LineSearch line(sides, box.covered ? limits_.inside() : limits_, budget_, findings_);
    if ((is_last_resort || line.may_overlap()) && line.run()) return;
  }
  halve(box, a_is_wider(box));
}

/// Which side to halve: the one that is still over many pieces, else the one that f varies more along.
bool PairBoxSearch::a_is_wider(const Box& box) const {
  const PlaneCurve::Node& a = a_.node(box.a);
  const PlaneCurve::Node& b = b_.node(box.b);
  if (a.on_one_piece() != b.on_one_piece()) return b.on_one_piece();
  double spread_a = 0;
  double spread_b = 0;
  for (std::size_t row = 0; row < a_.rows(); ++row) {
    spread_a += a_.components(box.a)[row].value.spread();
    spread_b += b_.components(box.b)[row].value.spread();
  }
  if (spread_a == spread_b) return a.width() >= b.width();
  return spread_a > spread_b;
}

void PairBoxSearch::halve(const Box& box, bool side_a) {
  const bool on_pieces = a_.node(box.a).on_one_piece() && b_.node(box.b).on_one_piece();
  const int depth = on_pieces ? box.depth + 1 : 0;
  const auto [left, right] = side_a ? a_.halves(box.a) : b_.halves(box.b);
  // Depth first, the left half next: the last one in is decided first.
  for (const std::int32_t half : {right, left}) {
    if (half >= 0) waiting_.push_back({side_a ? half : box.a, side_a ? box.b : half, depth, box.covered});
  }
}

/// Are the two sides further apart than the tolerance, seen along either one's chord? Across its own chord a side is
/// thin: its bounds fall with the square of its length. Both are bounded as one combination of two components.
bool PairBoxSearch::is_apart(const PairBoxSides& sides, const PairLimits& limits) const {
  for (std::size_t p = 0; p + 1 < a_.rows(); ++p) {
    for (std::size_t q = p + 1; q < a_.rows(); ++q) {
      for (const Vec2& direction : {chord(sides.a, p, q), chord(sides.b, p, q)}) {
        const Vec2 across(-direction.y(), direction.x());
        if (across == Vec2::Zero()) continue;
        const double by = across.x() * sides.shift(p, limits_) + across.y() * sides.shift(q, limits_);
        const Range f = along(sides.a, across, p, q) - along(sides.b, across, p, q) - Range{by, by};
        // What both rows' tolerances come to in this combination.
        const double reach = limits.tolerance * across.lpNorm<1>();
        if (!f.comes_within(reach)) return true;
      }
    }
  }
  return false;
}

/// Each entry of J has bounds on the box. With Y the inverse of their middles, |1 - Y J| is bounded entry by entry
/// (`off`). If the spectral radius of that is below 1, Y J is invertible anywhere in the box, and so is J.
std::optional<PairBoxSearch::Regular> PairBoxSearch::regular(const PairBoxSides& sides) const {
  std::optional<Regular> best;
  for (std::size_t p = 0; p + 1 < a_.rows(); ++p) {
    for (std::size_t q = p + 1; q < a_.rows(); ++q) {
      // Rows p, q: the middles of all four slopes' bounds.
      Eigen::Matrix2d middle;
      for (const Eigen::Index k : {0, 1}) {
        const Range at_a = sides.a.slope(k == 0 ? p : q);
        const Range at_b = sides.b.slope(k == 0 ? p : q);
        middle.row(k) << at_a.middle(), -at_b.middle();
      }
      const double determinant = middle.determinant();
      const double rounding =
          kParallel * (std::abs(middle(0, 0) * middle(1, 1)) + std::abs(middle(0, 1) * middle(1, 0)));
      if (std::abs(determinant) <= rounding || !std::isfinite(1 / determinant)) continue;
      Regular found{{p, q}, middle.inverse(), {}, {}, 0};
      // Entry (i, j) of Y J combines the slopes of both rows on side j: only a combination sees the terms that they
      // share.
      const Vec2 first = found.inverse.row(0);
      const Vec2 second = found.inverse.row(1);
      found.off(0, 0) = combination(sides.a, first, p, q).slope_radius();
      found.off(1, 1) = combination(sides.b, second, p, q).slope_radius();
      if (!(std::max(found.off(0, 0), found.off(1, 1)) <= kMostContraction)) continue;  // no more than the radius
      found.off(0, 1) = combination(sides.b, first, p, q).slope_radius();
      found.off(1, 0) = combination(sides.a, second, p, q).slope_radius();
      found.spectral_radius = spectral_radius(found.off);
      if (!(found.spectral_radius <= kMostContraction) || (best && found.spectral_radius >= best->spectral_radius))
        continue;
      found.slack = (Eigen::Matrix2d::Identity() - found.off).inverse();
      best = found;
    }
  }
  return best;
}

/// J is invertible on the box: f, continued beyond the box by its tangents there, has exactly one zero x* in the whole
/// plane (Hadamard). Newton's method finds it. Lists it as a crossing if it is in the box, with the set within the
/// tolerance around it.
bool PairBoxSearch::take_regular(const PairBoxSides& sides, const PairLimits& limits, const Regular& regular) {
  const auto [p, q] = regular.rows;
  const Eigen::Array2d same_place(sides.a.same_place(limits_), sides.b.same_place(limits_));
  const Eigen::Array2d width = Eigen::Array2d(sides.a.width(), sides.b.width()).max(same_place);
  const Vec2 lo(sides.a.lo(), sides.b.lo());
  const Vec2 hi(sides.a.hi(), sides.b.hi());
  // From x the zero is at most (1 - off)^-1 |Y f(x)| away, since |x* - x + Y f| <= off |x* - x| entry by entry.
  const auto reached = [&](const Vec2& step) -> Vec2 { return regular.slack * step.cwiseAbs(); };
  const Vec2 reach = reached(regular.inverse.cwiseAbs() * Vec2::Constant(limits.tolerance));
  // How much the directions in the box vary, as a share, and how much of that the set within the tolerance sees.
  const double turn = (regular.off * width.matrix()).cwiseQuotient(width.matrix()).maxCoeff();
  const double bend = turn * std::min(1.0, (reach.array() / width).maxCoeff());
  if (bend > kBoxExtentBend) return false;
  Vec2 at = about_crossing(sides, limits_, regular.rows);
  CurvePoint on_a;
  CurvePoint on_b;
  Eigen::Matrix2d jacobian;
  double last = std::numeric_limits<double>::infinity();  // step, in parts of the box
  for (int round = 0;; ++round) {
    on_a = sides.a.point(at.x());
    on_b = sides.b.point(at.y());
    const Vec2 f(residual(sides, limits_, on_a, on_b, p), residual(sides, limits_, on_a, on_b, q));
    const Vec2 middle_step = regular.inverse * f;
    // x* is within off (1 - off)^-1 |Y f| of the simplified Newton step's end, and the set within the tolerance within
    // `reach` of x*. If that is outside the box, nothing is in it.
    const Eigen::Array2d near = (at - middle_step).array();
    const Eigen::Array2d off = (regular.off * reached(middle_step) + reach).array();
    if (((near + off < lo.array()) || (near - off > hi.array())).any()) return true;
    jacobian << on_a.slope(p), -on_b.slope(p), on_a.slope(q), -on_b.slope(q);
    if (round == kMostBoxRounds) break;
    const bool full = round < kMostBoxRounds / 2;  // Newton's own step, then the one that contracts for sure
    const Vec2 step = full ? Vec2(jacobian.inverse() * f) : middle_step;
    if ((step.array().abs() <= kBoxRootStep * width + 1e-3 * same_place).all()) break;
    const double size = (step.array().abs() / width).maxCoeff();
    if (size < kSmallBoxStep && size > 0.5 * last) break;  // nothing but rounding moves it any more
    last = size;
    at -= step;
    if (full && size < kLastBoxStep) {
      on_a.step(-step.x());
      on_b.step(-step.y());
      break;
    }
  }

  // Here `at` is x* but for rounding. It counts as in the box where rounding may have moved it out: a neighbour may
  // find it again, and finds of one root are joined later.
  Polygon extent = set_about(sides, limits, regular.rows, on_a, on_b);
  // Of more than two equations the others must vanish as well.
  const bool exact = largest_residual(sides, limits_, on_a, on_b) <= kRootTurn;
  const Vec2 edge = reached(regular.inverse.cwiseAbs() * Vec2::Constant(kTurnAccuracy)) + same_place.matrix();
  const bool inside = ((at + edge).array() >= lo.array() && (at - edge).array() <= hi.array()).all();
  if (extent.empty() && !(inside && exact)) return true;
  if (extent.empty()) extent.push_back(at);
  const Vec2 root(std::clamp(at.x(), lo.x(), hi.x()), std::clamp(at.y(), lo.y(), hi.y()));
  // Inside a set that is listed already only roots are missing.
  if (!limits.covered) {
    findings_.pieces.push_back(piece_around(sides, extent, inside ? root : extent.front()));
    findings_.pieces.back().error = 0.25 * bend * reach.minCoeff();
  }
  if (inside && (exact || !limits.covered)) {
    const PairPoint start{sides.a.s(root.x()), sides.b.s(root.y())};
    findings_.roots.push_back({start, jacobian.determinant() > 0 ? 1 : -1, sides.pivots(), exact});
  }
  return true;
}

/// Decides a box where one of four conditions holds: f is 0 all over it (a continuum, `exact`, if the slopes are 0
/// too), f is within the tolerance all over it, f varies by less than a share of the tolerance, or the box is as small
/// as rounding. The box is out if the middle of f's bounds is. Else it is listed. `covered`: its roots are still to be
/// found.
PairBoxSearch::Flat PairBoxSearch::take_flat(const PairBoxSides& sides, const PairLimits& limits) {
  const bool tiny = sides.a.width() <= sides.a.same_place(limits) && sides.b.width() <= sides.b.same_place(limits);
  const double small_spread = kSmallVariation * limits.tolerance;
  for (std::size_t row = 0; row < a_.rows() && !tiny; ++row) {  // nearly always the first one settles it
    const Range f = sides.value(row, limits);
    if (f.spread() > small_spread && f.size() > limits.tolerance) return Flat::no;
  }
  double size = 0;
  double spread = 0;
  double middle = 0;
  double steepest = 0;
  for (std::size_t row = 0; row < a_.rows(); ++row) {
    const Range f = sides.value(row, limits);
    size = std::max(size, f.size());
    spread = std::max(spread, f.spread());
    middle = std::max(middle, 0.5 * std::abs(f.least + f.most));
    steepest = std::max({steepest, sides.a.slope(row).size(), sides.b.slope(row).size()});
  }
  const bool zero = size <= kTurnAccuracy;
  const bool small = spread <= small_spread;
  if (!zero && !tiny && !small && size > limits.tolerance) return Flat::no;
  // Out, as the middle of f's bounds is.
  if (middle > limits.tolerance) return Flat::settled;
  PairPiece piece;
  piece.box = {Interval{sides.a.s(sides.a.lo()), sides.a.s(sides.a.hi())},
               Interval{sides.b.s(sides.b.lo()), sides.b.s(sides.b.hi())}};
  // An exact set needs slopes of 0 too: else f = 0 only because the box is small.
  piece.exact = zero && steepest * limits.perimeter <= kFlatSlope;
  piece.corner = sides.pivots();
  if (!piece.exact) piece.error = kSmallVariation * std::max(piece.box[0].width(), piece.box[1].width());
  if (!limits.covered || piece.exact) findings_.pieces.push_back(piece);
  if (!zero && !tiny && !limits.covered) return Flat::covered;
  const PairPoint at{piece.box[0].middle(), piece.box[1].middle()};
  if (piece.exact) {
    findings_.roots.push_back({{piece.box[0].lo, piece.box[1].lo}, 0, sides.pivots()});
  } else if (middle <= kTurnAccuracy) {
    findings_.roots.push_back({at, 0, sides.pivots()});
  }
  return Flat::settled;
}

/// Is f zero at two corners of the box? Then the curves may run along each other from one to the other.
bool PairBoxSearch::corners_vanish(const PairBoxSides& sides) const {
  std::array<bool, 4> zero{true, true, true, true};
  for (std::size_t row = 0; row < a_.rows(); ++row) {
    const PlaneCurve::Component& of_a = sides.a.component(row);
    const PlaneCurve::Component& of_b = sides.b.component(row);
    const double shift = sides.shift(row, limits_);
    const auto vanishes = [&](double a, double b) { return std::abs(a - b - shift) <= kRootTurn; };
    zero[0] = zero[0] && vanishes(of_a.first, of_b.first);
    zero[1] = zero[1] && vanishes(of_a.first, of_b.last);
    zero[2] = zero[2] && vanishes(of_a.last, of_b.first);
    zero[3] = zero[3] && vanishes(of_a.last, of_b.last);
    if (std::count(zero.begin(), zero.end(), true) < 2) return false;
  }
  return true;
}

}  // namespace rollfix::locating
