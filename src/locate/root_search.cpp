#include "root_search.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

#include "work/pulse.hpp"

// Notation:
//   s, s + L        start and end of a roll: `s`; the end's place on its spiral is `s + pair.offset`, whole laps taken
//                   off
//   theta           the measured turn: `pair.turn`, the turn of the same laps taken off
//   f(s)            Theta(s + L) - Theta(s) - theta: `ResidualSample::value`
//   f'(s)           kappa(s + L) - kappa(s): `slope()`, of `end_curvature` and `start_curvature`
//   f''             its sign, where it is known: `bend`
//   tolerance       |f| <= `tolerance_` is an answer, |f| <= `kTurnAccuracy` is 0; radians
//   strip           f is no further from its chord than a quarter of each curvature's change times the width: `is_far`
//                   (root_search.hpp), which leaves most intervals
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/search.md, "Once per reading", steps 3 to 5. An extremum
// is bracketed by Alefeld, Potra and Shi, "Algorithm 748: enclosing zeros of continuous functions" (1995).
// Idea: on a spiral kappa is monotone, so that its values at both ends of an interval bound f', and with f at the ends
// they bound f. Either these exclude 0, or f is monotone, convex or concave there and is solved, or it is halved.
namespace rollfix::locating {
namespace {

// A bracket of a root, or a step to it, that is below this share of the perimeter is the last one.
constexpr double kRootStep = 1e-11;
// A root is known where interpolation by two samples is off by no more than this share of the perimeter: by three it is
// off by less.
constexpr double kRootAgreement = 1e-13;
// A sample need not be taken where one can be interpolated, by curvatures that are off by the product of the distances
// to two others: below this share of the perimeter's square.
constexpr double kRootArea = 1e-11;
// Where f turns by less than this on a perimeter, at its slope, roots are as far off as rounding makes them: there the
// step decides.
constexpr double kSteep = 1e-4;
// A roll shorter than this share of the perimeter has an f of rounding size: the sign of its slope is not sure.
constexpr double kShortRoll = 1e-6;
// Rounds of `solve` until it returns what it has.
constexpr int kMostRounds = 100;
// An extent may be off by this share of its width: there f is taken as straight.
constexpr double kExtentBend = 1e-3;
// On an extent that is shorter than this share of a stretch f bends no more than on the stretch in the mean.
constexpr double kShortExtent = 1e-7;
// An interval of zeros shorter than this share of the perimeter can't be told from a root.
constexpr double kShortestStretch = 1e-9;
// On a stretch the slope of f vanishes as well, up to this share of the curvatures that it is the difference of.
constexpr double kStretchSlope = 1e-9;
// An arc length is rounded to this share of the perimeter: times the curvature, an angle.
constexpr double kPlaceRounding = 1e-15;
// Zero at more points than the polynomials have terms: zero between them, too.
constexpr int kStretchSamples = 19;
// Bounds by monotone curvature are tried this often before those by polynomials, which cost more.
constexpr int kPlainHalvings = 4;
// Rounding errors of a polynomial's bounds: hundreds of operations on angles of some radians.
constexpr double kBoundsRounding = 1e-14;
// The extremum of f is approached by the secant of its slope this long, then bracketed.
constexpr int kMostSecants = 12;

/// least <= value <= most.
struct Bounds {
  double least;
  double most;
};

/// Bounds on f' from the curvatures at the ends, because curvature is monotone on a spiral.
Bounds slope_bounds(const ResidualSample& lo, const ResidualSample& hi) {
  return {std::min(lo.end_curvature, hi.end_curvature) - std::max(lo.start_curvature, hi.start_curvature),
          std::max(lo.end_curvature, hi.end_curvature) - std::min(lo.start_curvature, hi.start_curvature)};
}

/// |f''| between the ends, on average, at most: both monotone curvatures' changes over the width.
double mean_bend(const ResidualSample& lo, const ResidualSample& hi) {
  return (std::abs(hi.end_curvature - lo.end_curvature) + std::abs(hi.start_curvature - lo.start_curvature)) /
         (hi.s - lo.s);
}

/// Bounds on f from its values at the ends and from bounds on its slope, one below 0 and one above (the cone): f is
/// above lo.value + least (s - lo.s) and above hi.value - most (hi.s - s), whose lines meet at the lower bound; the
/// upper one likewise.
Bounds value_bounds(const ResidualSample& lo, const ResidualSample& hi, const Bounds& slope) {
  const double width = hi.s - lo.s;
  const double span = slope.most - slope.least;
  const double scale = slope.least * slope.most * width;
  return {(slope.most * lo.value - slope.least * hi.value + scale) / span,
          (slope.most * hi.value - slope.least * lo.value - scale) / span};
}

/// The sign of f'' = kappa'(s + L) - kappa'(s) where the spirals' trends settle it. 1: kappa does not fall at the end
/// and does not rise at the start, so f'' >= 0. -1: the other way round. 0: not known.
int bend_by_trends(const SpiralPair& pair) {
  if (pair.end.trend >= 0 && pair.start.trend <= 0) return 1;
  if (pair.end.trend <= 0 && pair.start.trend >= 0) return -1;
  return 0;
}

/// One of these places that lies between lo and hi, or lo.
double first_inside(double lo, double hi, const std::array<double, 4>& places) {
  for (const double place : places) {
    if (place > lo && place < hi) return place;
  }
  return lo;
}

}  // namespace

RootSearch::RootSearch(double tolerance, std::size_t budget, double perimeter)
    : tolerance_(tolerance), perimeter_(perimeter), same_place_(kLengthAccuracy * perimeter) {
  findings.budget = budget;
}

void RootSearch::look_at(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi) {
  beat();
  // Another pair of spirals: the panels of the last sample belong to the one before.
  start_panel_ = end_panel_ = nullptr;
  // Before all bounds: halving would never end on an interval of zeros.
  if (is_stretch(pair, lo, hi)) {
    add_piece(lo.s, hi.s, true);
    findings.roots.push_back({lo.s});
  } else {
    ++findings.counts.intervals;
    decide_near(pair, {lo, hi, 0, 0});
  }
}

bool RootSearch::is_stretch(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi) {
  // f is 0 but for the accuracy of Theta and for the rounding of s, which times kappa is an angle.
  const double period = pair.turning.perimeter();
  const auto vanishes = [&](const ResidualSample& at) {
    const double curvature = std::abs(at.start_curvature) + std::abs(at.end_curvature);
    return std::abs(at.value) <= kTurnAccuracy + kPlaceRounding * period * curvature;
  };
  if (!vanishes(lo) || !vanishes(hi) || hi.s - lo.s < kShortestStretch * period) return false;
  // Between lines and arcs f is straight: one more place tells.
  const int samples = pair.start.trend == 0 && pair.end.trend == 0 ? 2 : kStretchSamples;
  for (int k = 1; k < samples; ++k) {
    const ResidualSample at = sample(pair, lo.s + (hi.s - lo.s) * k / samples);
    const double scale = std::abs(at.start_curvature) + std::abs(at.end_curvature) + 1 / period;
    if (!vanishes(at) || std::abs(at.slope()) > kStretchSlope * scale) return false;
  }
  return true;
}

void RootSearch::decide(const SpiralPair& pair, const SampledRange& range) {
  beat();
  ++findings.counts.intervals;
  // Not decided, so not excluded: it is listed, and the search is incomplete.
  if (findings.budget == 0) {
    findings.unresolved.push_back({range.lo.s, range.hi.s});
    return;
  }
  --findings.budget;
  if (!is_far(range.lo, range.hi)) decide_near(pair, range);
}

void RootSearch::decide_near(const SpiralPair& pair, const SampledRange& range) {
  const ResidualSample& lo = range.lo;
  const ResidualSample& hi = range.hi;
  // f' has one sign here, so at most one root.
  const Bounds slope = slope_bounds(lo, hi);
  if (slope.least >= 0 || slope.most <= 0) {
    take_monotone(pair, lo, hi);
    return;
  }
  // The cone misses [-tolerance, tolerance]: nothing is here.
  const Bounds value = value_bounds(lo, hi, slope);
  if (value.least > tolerance_ || value.most < -tolerance_) return;
  // Zero to rounding everywhere, or a single place: no halving can tell more.
  if (std::max(std::abs(value.least), std::abs(value.most)) <= kTurnAccuracy || hi.s - lo.s <= same_place_) {
    take_flat(lo, hi, std::abs(lo.value) <= kTurnAccuracy);
    return;
  }
  // kappa(s + L) - kappa(s) by the same monotone curvature: of one sign.
  if (&pair.start == &pair.end && std::abs(pair.offset) > kShortRoll * perimeter_) {
    take_monotone(pair, lo, hi);
    return;
  }
  // kappa(s + L) and kappa(s) change in opposite directions: f is convex or concave.
  const int bend = range.bend != 0 ? range.bend : bend_by_trends(pair);
  if (bend != 0) {
    decide_bent(pair, {lo, hi, bend, range.depth});
    return;
  }
  // Neither sign is known: a few halvings first, which cost less than the polynomial.
  if (range.depth < kPlainHalvings) {
    halve(pair, range, 0.5 * (lo.s + hi.s));
    return;
  }
  // The polynomial needs one panel at either end of the roll: cut where one of the two passes into another panel.
  const Panel& start = pair.turning.panel_on(pair.start, 0.5 * (lo.s + hi.s));
  const Panel& end = pair.turning.panel_on(pair.end, 0.5 * (lo.s + hi.s) + pair.offset);
  const double cut = first_inside(lo.s + same_place_, hi.s - same_place_,
                                  {start.lo, start.hi, end.lo - pair.offset, end.hi - pair.offset});
  if (cut > lo.s + same_place_) {
    halve(pair, range, cut);
  } else {
    decide_by_polynomial(pair, range, start, end);
  }
}

/// With both ends of the roll on one panel each, f is one polynomial. What both ends have in common cancels in its
/// coefficients. So nearly congruent stretches and double roots are decided here, where bounds on either end alone
/// would never close.
void RootSearch::decide_by_polynomial(const SpiralPair& pair, const SampledRange& range, const Panel& start,
                                      const Panel& end) {
  const ResidualSample& lo = range.lo;
  const ResidualSample& hi = range.hi;
  const double half = 0.5 * (hi.s - lo.s);
  const double middle = lo.s + half;
  // f(middle + half y) = f_0 + f_1 y + f_2 y^2 + ...; |y| <= 1, so that |f - f_0| <= |f_1| + |f_2| + ...
  Powers f = pair.turning.difference(start, middle, end, middle + pair.offset, half);  // in y in [-1, 1]
  f[0] -= pair.turn;
  double reach = kBoundsRounding;  // how far f gets from its middle value, its slope from the middle slope, and so on
  double slope_reach = kBoundsRounding;
  double bend_reach = kBoundsRounding;
  for (Eigen::Index k = 1; k < f.size(); ++k) {
    const double size = std::abs(f[k]);
    const auto order = static_cast<double>(k);
    reach += size;
    if (k > 1) slope_reach += order * size;
    if (k > 2) bend_reach += order * (order - 1) * size;
  }
  // |f| stays above the tolerance.
  if (std::abs(f[0]) > tolerance_ + reach) return;
  // |f_1| is more than all else can change f' by: f' has one sign.
  if (std::abs(f[1]) > slope_reach) {
    take_monotone(pair, lo, hi);
  } else if (reach <= kTurnAccuracy) {  // constant to rounding
    take_flat(lo, hi, std::abs(f[0]) <= kTurnAccuracy);
  } else if (2 * std::abs(f[2]) > bend_reach) {
    decide_bent(pair, {lo, hi, f[2] > 0 ? 1 : -1, range.depth});
  } else {
    halve(pair, range, middle);
  }
}

/// f is 0 to rounding on [lo, hi], or the interval is as narrow as rounding: a root of high order. The middle stands
/// for it; `exact` says whether f is 0 there or only within the tolerance.
void RootSearch::take_flat(const ResidualSample& lo, const ResidualSample& hi, bool exact) {
  add_piece(lo.s, hi.s);
  findings.roots.push_back({0.5 * (lo.s + hi.s), exact});
}

/// Decides both sides of `place`, which lies inside the range. What was known of f'' is dropped.
void RootSearch::halve(const SpiralPair& pair, const SampledRange& range, double place) {
  const ResidualSample middle = sample(pair, place);
  decide(pair, {range.lo, middle, 0, range.depth + 1});
  decide(pair, {middle, range.hi, 0, range.depth + 1});
}

/// f'' keeps its sign, so f has one extremum at most, and two roots at most. The comments are for a convex f (bend >
/// 0); a concave one is its mirror image.
void RootSearch::decide_bent(const SpiralPair& pair, const SampledRange& range) {
  const ResidualSample& lo = range.lo;
  const ResidualSample& hi = range.hi;
  // f' is monotone: with the same sign at both ends it has that sign in between, and f is monotone.
  const bool turns = (lo.slope() < 0) != (hi.slope() < 0);
  const bool lo_far = std::abs(lo.value) > tolerance_;
  const bool hi_far = std::abs(hi.value) > tolerance_;
  // Beyond the tolerance at both ends, on opposite sides: f is convex, so it crosses 0 once.
  const bool crosses_once = lo_far && hi_far && (lo.value < 0) != (hi.value < 0);
  if (!turns || crosses_once) {
    take_monotone(pair, lo, hi);
    return;
  }
  const bool above = range.bend > 0 ? lo.value > 0 : lo.value < 0;
  if (lo_far && hi_far && !above) return;  // a convex f is below its chord
  // An end is within the tolerance: the set may hold the extremum or end before it.
  if (!lo_far || !hi_far) {
    split_at_extremum(pair, range);
    return;
  }
  // Both ends above: look near the lowest point, where the slope's chord vanishes.
  const double place = lo.s - lo.slope() * (hi.s - lo.s) / (hi.slope() - lo.slope());
  const ResidualSample inner = sample(pair, std::clamp(place, lo.s, hi.s));
  const bool inner_above = range.bend > 0 ? inner.value > tolerance_ : inner.value < -tolerance_;
  if (std::abs(inner.value) <= tolerance_ || !(inner.s > lo.s && inner.s < hi.s) || range.depth > kMostSecants) {
    split_at_extremum(pair, range);
  } else if (!inner_above) {  // below: one crossing on either side
    decide(pair, {lo, inner, range.bend, range.depth + 1});
    decide(pair, {inner, hi, range.bend, range.depth + 1});
  } else if ((inner.slope() < 0) == (lo.slope() < 0)) {  // still above: the lowest point is on the side it slopes to
    decide(pair, {inner, hi, range.bend, range.depth + 1});
  } else {
    decide(pair, {lo, inner, range.bend, range.depth + 1});
  }
}

/// f' is monotone and changes sign: f is monotone on either side of the place where it vanishes, and each side is
/// solved by itself.
void RootSearch::split_at_extremum(const SpiralPair& pair, const SampledRange& range) {
  // f' = 0 is bracketed by the ends, where it has opposite signs; 46 bits of s are asked for.
  std::uintmax_t rounds = 100;
  const auto bracket = boost::math::tools::toms748_solve([&](double s) { return sample(pair, s).slope(); }, range.lo.s,
                                                         range.hi.s, range.lo.slope(), range.hi.slope(),
                                                         boost::math::tools::eps_tolerance<double>(46), rounds);
  const ResidualSample extremum = sample(pair, 0.5 * (bracket.first + bracket.second));
  const double size = std::abs(extremum.value);
  // All three on one side of 0, the extremum nearest to it and still beyond the tolerance: no root on either side.
  if (size > tolerance_ && (extremum.value > 0) == (range.lo.value > 0) &&
      (extremum.value > 0) == (range.hi.value > 0) &&
      size <= std::min(std::abs(range.lo.value), std::abs(range.hi.value))) {
    return;  // passes 0 by
  }
  // A near miss: an answer within the tolerance, though f need not be 0 anywhere.
  if (size > kTurnAccuracy && size <= tolerance_) findings.roots.push_back({extremum.s, false});
  take_monotone(pair, range.lo, extremum);
  take_monotone(pair, extremum, range.hi);
}

/// One root at most, and one piece: from where |f| comes within the tolerance to where it leaves it.
void RootSearch::take_monotone(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi) {
  const double least = std::min(lo.value, hi.value);
  const double most = std::max(lo.value, hi.value);
  // A monotone f lies between its values at the ends.
  if (least > tolerance_ || most < -tolerance_) return;

  Root root;
  bool near_root = false;  // where f may be taken as straight
  double reach = 0;
  // An end that is 0 to rounding is the root. Else a change of sign has one inside. Else f is not 0, but within the
  // tolerance somewhere: a piece without a root.
  if (std::abs(lo.value) <= kTurnAccuracy) {
    root.s = lo.s;
  } else if (std::abs(hi.value) <= kTurnAccuracy) {
    root.s = hi.s;
  } else if ((lo.value < 0) != (hi.value < 0)) {
    const ResidualSample found = solve(pair, 0, lo, hi);
    const auto panel = static_cast<std::uint32_t>(start_panel_ - pair.turning.panels().data());
    root = {found.s, true, false, true, panel, found};
    reach = tolerance_ / std::abs(found.slope());
    near_root = takes_ends_as_straight_ && is_straight(pair, found, reach, lo, hi);
  } else {
    root.exact = false;
  }
  if (root.exact) findings.roots.push_back(root);

  // Where the piece ends towards `end`: there, if |f| is within the tolerance at it, else where |f| equals the
  // tolerance.
  const auto end_at = [&](const ResidualSample& end, double direction) {
    if (std::abs(end.value) <= tolerance_) return end.s;
    if (near_root) return root.s + direction * reach;
    return solve(pair, std::copysign(tolerance_, end.value), lo, hi).s;
  };
  const double from = end_at(lo, -1);
  const double to = end_at(hi, 1);
  add_piece(std::max(from, lo.s), std::min(to, hi.s));
}

/// Is f straight from its root to where it reaches the tolerance on either side, `reach` away? Then the piece's ends
/// need no solving. First by the bend of the whole interval, then, unless the piece is very short against it, by f
/// there.
bool RootSearch::is_straight(const SpiralPair& pair, const ResidualSample& root, double reach, const ResidualSample& lo,
                             const ResidualSample& hi) {
  if (reach * mean_bend(lo, hi) > kExtentBend * std::abs(root.slope())) return false;
  if (reach <= kShortExtent * (hi.s - lo.s)) return true;
  const auto is_where_expected = [&](double s) {
    return s > lo.s && s < hi.s && std::abs(std::abs(sample(pair, s).value) - tolerance_) <= kExtentBend * tolerance_;
  };
  return is_where_expected(root.s - reach) && is_where_expected(root.s + reach);
}

/// Where f, monotone between the ends, has the value `level`, which lies between its values there. Each round takes the
/// root of the polynomial through the last three samples and keeps it inside the bracket. Flat: each round waits for
/// the one before, so that a call inside it costs its full length.
[[gnu::flatten]] ResidualSample RootSearch::solve(const SpiralPair& pair, double level, ResidualSample lo,
                                                  ResidualSample hi) {
  const bool rises = hi.value > lo.value;
  const double short_step = kRootStep * perimeter_;
  // A first guess that lies inside: by the cubic, else by the chord, else the middle.
  double s = cubic_root(lo, hi, level);
  if (!(s > lo.s && s < hi.s)) s = lo.s + (hi.s - lo.s) * (level - lo.value) / (hi.value - lo.value);
  if (!(s > lo.s && s < hi.s)) s = 0.5 * (lo.s + hi.s);
  const bool lo_is_nearer = std::abs(lo.value - level) < std::abs(hi.value - level);
  ResidualSample last = lo_is_nearer ? lo : hi;
  ResidualSample third = lo_is_nearer ? hi : lo;
  bool is_known = false;
  for (int round = 0;; ++round) {
    // Here [lo, hi] brackets the root; `last` and `third` are the two latest samples, at first the ends, the nearer
    // first.
    const Quintic quintic(s, last, third);
    const ResidualSample at = sample(pair, s);
    // The round before knew the root this well; the sample is for its curvatures.
    if (is_known) return at;
    const QuinticRoot root = quintic.root(at, level);
    const double newton = (level - at.value) / at.slope();
    if (std::abs(newton) <= short_step) return beside(at, at, s + newton);  // `last` may be nearer still
    if (at.value == level || round == kMostRounds) return at;
    // f is monotone: the side of `level` that f is on at s tells which end of the bracket moves there.
    ((at.value > level) == rises ? hi : lo) = at;
    if (hi.s - lo.s <= short_step) return at;
    const auto is_inside = [&](double place) { return place >= lo.s && place <= hi.s; };
    // The quintic's root; outside the bracket Newton's step, outside as well the middle.
    s = at.s + root.step;
    if (!is_inside(s)) {
      s = is_inside(at.s + newton) ? at.s + newton : 0.5 * (lo.s + hi.s);
    } else if (is_settled(root, at)) {
      // So near to two samples that their curvatures, interpolated, are as good as new ones.
      if (std::abs(root.step * (s - last.s)) <= kRootArea * perimeter_ * perimeter_) {
        ResidualSample found = beside(at, last, s);
        found.value = level + root.rest;  // the polynomial tells it better than the slopes do
        return found;
      }
      is_known = true;
    }
    third = last;
    last = at;
  }
}

/// Is the quintic's root as good as exact? `rest` over the slope is how far it may be off. Where f is nearly flat the
/// answer is no: rounding moves such a root by more than this.
bool RootSearch::is_settled(const QuinticRoot& root, const ResidualSample& at) const {
  const double slope = std::abs(at.slope());
  return slope * perimeter_ > kSteep && root.rest <= kRootAgreement * perimeter_ * slope;
}

void RootSearch::add_piece(double lo, double hi, bool exact) { findings.pieces.push_back({lo, hi, exact, false}); }

}  // namespace rollfix::locating
