#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "rollfix/curve.hpp"
#include "teach/teaching.hpp"
#include "work/pulse.hpp"

// Notation:
//   (s_k, theta_k)  rows of a run: TurningRun
//   f(s)            cubic spline of least squares: FittedSpline; off: |f(s_k) - theta_k|
//   Theta(s)        values and slopes at nodes, between them cubics: TurningNodes
//   m_k             slope of the chord from node k to the next: `chord`
// Follows docs/teach.md, "What is made of the rows"; F. N. Fritsch and R. E. Carlson, "Monotone piecewise cubic
// interpolation" (1980): slopes of the sign of both chords and at most three times the smaller one are enough.
// Idea: the spans that are off most are halved until every row is within the tolerance; exact rows become nodes
// themselves where that takes nearly as many spans as rows.
namespace rollfix::teaching {

namespace {

/// Weighs the third derivative against the rows. It decides where rows are missing; where there are rows it has to move
/// the curve by less than their tolerance.
constexpr double kStiffness = 1e-11;
/// A span with fewer rows is not split: one row does not tell a bend.
constexpr std::size_t kLeastRows = 2;
/// Exact rows are nodes themselves unless a spline does with a span for so many of them.
constexpr std::size_t kRowsPerSpan = 4;
/// Rounds of halving, at most: then the last spline is taken, met or not.
constexpr int kMostRounds = 60;
/// Spans that are off by this share of the worst are split with it.
constexpr double kWorstShare = 0.5;
/// A closed run without corners starts with this many spans.
constexpr std::size_t kFirstSpans = 4;
/// A slope may be this many times the smaller of the chords' slopes beside it: a cubic is monotone then.
constexpr double kMostSlope = 3;
/// Rows that differ by less do not: rounding of the sums that they come from, radians.
constexpr double kSameAngle = 1e-13;

}  // namespace

Vec2 value_and_slope(const FittedSpline& spline, double s) {
  const std::vector<double>& breaks = spline.knots().breaks;
  const std::size_t span = spline.knots().span_at(s);
  // A span's own parameter is in [0, 1]: its derivative by s is divided by the span's length.
  const double width = breaks[span + 1] - breaks[span];
  const Jet jet = spline.spans()[span].jet((s - breaks[span]) / width);
  return {jet.position.x(), jet.first.x() / width};
}

TurningNodes nodes_at_breaks(const FittedSpline& spline) {
  TurningNodes nodes;
  for (const double s : spline.knots().breaks) nodes.add(s, value_and_slope(spline, s));
  // The first node again, to the bit: rounding must not open the seam.
  if (spline.knots().closed) {
    nodes.angle.back() = nodes.angle.front();
    nodes.slope.back() = nodes.slope.front();
  }
  return nodes;
}

namespace {

/// A least-squares spline through scalar rows.
class RowSpline {
 public:
  RowSpline(const std::vector<double>& s, const std::vector<double>& values) : s_(s) {
    for (const double value : values) points_.emplace_back(value, 0);
  }

  /// Least squares with these knots. With a knot at each row it passes through the rows, up to `kStiffness`.
  FittedSpline through(Knots knots) const { return {std::move(knots), s_, points_, kStiffness}; }

  /// With as few spans as will do. Where no more can be split, or more than `most` would be needed, the last one; `met`
  /// says whether the rows are within.
  FittedSpline within(double tolerance, Knots knots, std::size_t most, bool& met) const {
    std::optional<FittedSpline> spline;
    for (int round = 0;; ++round) {
      spline.emplace(through(knots));
      beat();
      // What the rows of each span are off by at most, and how many there are.
      std::vector<double> worst_of(knots.spans(), 0);
      std::vector<std::size_t> count(knots.spans(), 0);
      double largest = 0;
      double worst = 0;
      for (std::size_t k = 0; k < s_.size(); ++k) {
        const std::size_t span = knots.span_at(s_[k]);
        const double off = std::abs(value_and_slope(*spline, s_[k]).x() - points_[k].x());
        worst_of[span] = std::max(worst_of[span], off);
        ++count[span];
        largest = std::max(largest, off);
      }
      met = largest <= tolerance;
      if (met || round == kMostRounds || knots.spans() > most) return *spline;
      // A span with one row or none can't be split. If it is off, its neighbours have to be: it passes its error on.
      const std::vector<double> own = worst_of;
      for (std::size_t k = 0; k < knots.spans(); ++k) {
        if (count[k] >= kLeastRows) continue;
        if (k > 0) worst_of[k - 1] = std::max(worst_of[k - 1], own[k]);
        if (k + 1 < knots.spans()) worst_of[k + 1] = std::max(worst_of[k + 1], own[k]);
      }
      for (std::size_t k = 0; k < knots.spans(); ++k) {
        if (count[k] >= kLeastRows) worst = std::max(worst, worst_of[k]);
      }
      // Halves the spans that are off by at least half as much as the worst one that can be split.
      Knots finer{{}, {}, knots.closed};
      for (std::size_t k = 0; k < knots.spans(); ++k) {
        finer.breaks.push_back(knots.breaks[k]);
        if (count[k] < kLeastRows || worst_of[k] < std::max(tolerance, kWorstShare * worst)) continue;
        finer.breaks.push_back(0.5 * (knots.breaks[k] + knots.breaks[k + 1]));
      }
      finer.breaks.push_back(knots.breaks.back());
      finer.sharp.assign(finer.breaks.size(), 0);
      if (finer.spans() == knots.spans()) return *spline;
      knots = std::move(finer);
    }
  }

 private:
  std::vector<double> s_;     // places of the rows
  std::vector<Vec2> points_;  // their values as first coordinates; the second ones are 0
};

}  // namespace

/// Fritsch and Carlson's condition: where rows only grow or only fall, or stay, the cubics do as well. At a row that is
/// an extreme among its neighbours nothing is changed: the true extreme lies between rows.
void make_monotone(TurningNodes& nodes, bool round) {
  const std::size_t count = nodes.s.size();
  // Where rows differ by rounding only, Theta stays: a straight side.
  for (std::size_t k = 0; k + 1 < count; ++k) {
    if (std::abs(nodes.angle[k + 1] - nodes.angle[k]) <= kSameAngle) nodes.angle[k + 1] = nodes.angle[k];
  }
  // Slope of the chord behind node k. Beside the ends of a round course the chord across the seam counts.
  const auto chord = [&](std::size_t k) {
    return (nodes.angle[k + 1] - nodes.angle[k]) / (nodes.s[k + 1] - nodes.s[k]);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_end = k == 0 || k + 1 == count;
    const double before = k > 0 ? chord(k - 1) : (round ? chord(count - 2) : chord(0));
    const double after = k + 1 < count ? chord(k) : (round ? chord(0) : chord(count - 2));
    // Two nodes: the straight line between them.
    if (is_end && !round && count == 2) {
      nodes.slope[k] = after;
      continue;
    }
    // An extreme among the nodes: the true one lies beside it, and the slope stays as it is.
    if (before * after < 0) continue;
    // Fritsch and Carlson: of the chords' sign and at most three times the smaller one. At a chord of slope 0 the slope
    // is 0.
    const double most = kMostSlope * std::min(std::abs(before), std::abs(after));
    const double sign = before + after < 0 ? -1 : 1;
    nodes.slope[k] = sign * std::clamp(sign * nodes.slope[k], 0.0, most);
  }
}

namespace {

/// The rows as nodes, with slopes from the spline through them; the run's ends, where no row is, from its first and
/// last cubic.
TurningNodes through_rows(const TurningRun& run) {
  TurningNodes nodes;
  const std::size_t count = run.s.size();
  Knots knots{run.s, {}, false};
  if (count > 4) {  // not a knot: the second and the last but one, so that an end says nothing of its own
    knots.breaks.erase(knots.breaks.end() - 2);
    knots.breaks.erase(knots.breaks.begin() + 1);
  } else {
    knots.breaks = {run.s.front(), run.s.back()};
  }
  knots.sharp.assign(knots.breaks.size(), 0);
  const FittedSpline spline = RowSpline(run.s, run.angle).through(std::move(knots));
  if (run.lo < run.s.front()) nodes.add(run.lo, value_and_slope(spline, run.lo));
  for (std::size_t k = 0; k < count; ++k) {
    nodes.add(run.s[k], {run.angle[k], value_and_slope(spline, run.s[k]).y()});
  }
  if (run.hi > run.s.back()) nodes.add(run.hi, value_and_slope(spline, run.hi));
  return nodes;
}

/// The same of nodes between which there are rows, unless it takes the cubics farther from these than they may be.
void make_monotone_within(TurningNodes& nodes, bool round, const TurningRun& run, double tolerance) {
  TurningNodes monotone = nodes;
  make_monotone(monotone, round);
  for (std::size_t k = 0; k < run.s.size(); ++k) {
    const double off = std::abs(monotone.at(run.s[k]) - run.angle[k]);
    // A row would be off by more than the tolerance, and by more than before: the curve stays as it was.
    if (off > tolerance && off > std::abs(nodes.at(run.s[k]) - run.angle[k])) return;
  }
  nodes = monotone;
}

}  // namespace

/// Exact rows become nodes, unless a spline with a span for every kRowsPerSpan rows is within the tolerance of all of
/// them.
TurningNodes fit(const TurningRun& run, const TurningFit& how) {
  TurningNodes nodes;
  if (run.s.size() == 1) {  // nothing says that it bends
    nodes.add(run.lo, {run.angle[0], 0});
    nodes.add(run.hi, {run.angle[0], 0});
    return nodes;
  }
  bool met = false;
  const std::size_t few = how.rows_are_exact ? run.s.size() / kRowsPerSpan : run.s.size();
  const FittedSpline smooth =
      RowSpline(run.s, run.angle).within(how.tolerance, even_knots(run.lo, run.hi, 1, false), few, met);
  const bool takes_few = met && smooth.knots().spans() <= few;
  nodes = how.rows_are_exact && !takes_few ? through_rows(run) : nodes_at_breaks(smooth);
  make_monotone_within(nodes, false, run, how.tolerance);
  return nodes;
}

TurningNodes fit_round(const TurningRun& run, double turn, const TurningFit& how) {
  // Less an even turn the values are periodic: a closed spline fits them. The even turn is added again at the end.
  const double period = run.hi - run.lo;
  const auto ramp = [&](double s) { return turn * (s - run.lo) / period; };
  std::vector<double> s;
  std::vector<double> rest;
  for (std::size_t k = 0; k < run.s.size(); ++k) {
    if (k > 0 && run.hi - run.s[k] <= 1e-9 * period) continue;  // the first row again
    s.push_back(run.s[k]);
    rest.push_back(run.angle[k] - ramp(run.s[k]));
  }
  const RowSpline rows(s, rest);
  bool met = false;
  const std::size_t few = how.rows_are_exact ? s.size() / kRowsPerSpan : s.size();
  const FittedSpline smooth = rows.within(how.tolerance, even_knots(run.lo, run.hi, kFirstSpans, true), few, met);
  TurningNodes nodes;
  const bool takes_few = met && smooth.knots().spans() <= few;
  if (how.rows_are_exact && !takes_few && s.size() >= kFirstSpans) {
    // Every row is a node; the last knot is the first one, a period later.
    Knots knots{s, {}, true};
    knots.breaks.push_back(s.front() + period);
    knots.sharp.assign(knots.breaks.size(), 0);
    const FittedSpline exact = rows.through(std::move(knots));
    for (std::size_t k = 0; k < s.size(); ++k) nodes.add(s[k], {rest[k], value_and_slope(exact, s[k]).y()});
    nodes.add(s.front() + period, {rest.front(), nodes.slope.front()});
  } else {
    nodes = nodes_at_breaks(smooth);
  }
  for (std::size_t k = 0; k < nodes.s.size(); ++k) {
    nodes.angle[k] += ramp(nodes.s[k]);
    nodes.slope[k] += turn / period;
  }
  make_monotone_within(nodes, true, run, how.tolerance);
  return nodes;
}

// ---- smoothing
// Notation:
//   (s_k, theta_k)  rows of a run, each off by the standard deviation `sd`: TurningRun, RowErrors
//   ramp            how much of a lap's drift a row has: fitted like the row, as its second coordinate
//   f(s)            cubic spline through theta_k, or, where errors gather, through slopes between rows: FittedSpline
//   block           a sixth of a span's rows; chi^2: (sum of off)^2 / (count sd^2), summed over the blocks: `is_off`
//   Theta(s)        f, or its integral: TurningNodes
// Follows docs/teach.md, "What is made of the rows".
// Idea: a span is halved while the means of its blocks are off by more than chance makes them: a bend that f misses
// takes neighbouring rows the same way, noise does not.

namespace {

/// Weighs the third derivative against the rows. It decides where rows are missing; where there are rows it has to move
/// the curve by much less than their noise.
constexpr double kLittleStiffness = 1e-9;
/// Blocks of a span's rows whose means are looked at: what a span is too long for shows at a fraction of its length.
constexpr std::size_t kBlocks = 6;
/// Their chi-square is larger by chance once in eight times (6 degrees of freedom). A span too many costs one row's
/// variance, a bend that is missed as much as it is: less than this.
constexpr double kMostByChance = 10;
/// A span with fewer rows is not halved: each half needs enough to tell four coefficients from noise.
constexpr std::size_t kLeastRowsHalved = 12;
/// Rounds of halving, at most: then the last spline is taken.
constexpr int kMostHalvings = 40;
/// A closed run without corners starts with this many spans.
constexpr std::size_t kFirstRoundSpans = 4;
/// Theta is made monotone where that costs no more than this much chi-square: three standard deviations.
constexpr double kMonotoneCost = 9;

/// Scalar rows by arc length, with a second value that is fitted like the first: the ramp.
struct ScalarRows {
  std::vector<double> s;    // rising
  std::vector<Vec2> value;  // x: the row, radians or radians per length; y: its ramp
  double sd = 0;            // of each x, in its unit
};

/// Value of the spline at s, in both coordinates.
Vec2 value_of(const FittedSpline& spline, double s) {
  const std::vector<double>& breaks = spline.knots().breaks;
  const std::size_t span = spline.knots().span_at(s);
  return spline.spans()[span].jet((s - breaks[span]) / (breaks[span + 1] - breaks[span])).position;
}

/// Whether rows [first, last) are off by more than chance. Each of kBlocks blocks adds (sum of off)^2 / (count sd^2),
/// which has mean 1 if the rows are off by independent noise, and grows with the count where the curve misses a bend.
bool is_off(const std::vector<Vec2>& off, std::size_t first, std::size_t last, double sd) {
  double chi_square = 0;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::size_t from = first + (last - first) * block / kBlocks;
    const std::size_t to = first + (last - first) * (block + 1) / kBlocks;
    double sum = 0;
    for (std::size_t k = from; k < to; ++k) sum += off[k].x();
    if (to > from) chi_square += sum * sum / (static_cast<double>(to - from) * sd * sd);
  }
  return chi_square > kMostByChance;
}

/// Row less curve, of each row and of its ramp.
std::vector<Vec2> off_by(const FittedSpline& spline, const ScalarRows& rows) {
  std::vector<Vec2> off;
  for (std::size_t k = 0; k < rows.s.size(); ++k) off.push_back(rows.value[k] - value_of(spline, rows.s[k]));
  return off;
}

/// The knots with the spans halved that the rows ask for.
Knots finer(const Knots& knots, const ScalarRows& rows, const std::vector<Vec2>& off) {
  Knots result{{}, {}, knots.closed};
  std::size_t first = 0;
  // Invariant: rows [0, first) lie in the spans before this one.
  for (std::size_t span = 0; span < knots.spans(); ++span) {
    result.breaks.push_back(knots.breaks[span]);
    const bool is_last = span + 1 == knots.spans();
    const auto end = std::lower_bound(rows.s.begin(), rows.s.end(), knots.breaks[span + 1]);
    const std::size_t last = is_last ? rows.s.size() : static_cast<std::size_t>(end - rows.s.begin());
    if (last >= first + kLeastRowsHalved && is_off(off, first, last, rows.sd)) {
      // Half of the rows on either side: where they lie unevenly the middle would leave too few.
      const double middle = 0.5 * (rows.s[first + (last - first) / 2 - 1] + rows.s[first + (last - first) / 2]);
      if (middle > knots.breaks[span] && middle < knots.breaks[span + 1]) result.breaks.push_back(middle);
    }
    first = last;
  }
  result.breaks.push_back(knots.breaks.back());
  result.sharp.assign(result.breaks.size(), 0);
  return result;
}

/// The spline with as few knots as the noise allows: fitted again and again, with more knots, until no span asks for
/// halving.
FittedSpline least_squares(const ScalarRows& rows, Knots knots) {
  std::optional<FittedSpline> spline;
  for (int round = 0;; ++round) {
    beat();
    spline.emplace(knots, rows.s, rows.value, kLittleStiffness);
    Knots next = finer(knots, rows, off_by(*spline, rows));
    if (next.spans() == knots.spans() || round == kMostHalvings) return std::move(*spline);
    knots = std::move(next);
  }
}

/// Adds what this fit took and left to the sums. `scale`: what a value's unit is in radians: 1, or a step where slopes
/// were fitted.
void add_sums(const FittedSpline& spline, const ScalarRows& rows, double scale, FitSums& sums) {
  sums.rows += rows.s.size();
  // A cubic spline has a coefficient for each span; an open one three more.
  sums.coefficients += static_cast<double>(spline.knots().spans() + (spline.knots().closed ? 0 : 3));
  for (const Vec2& off : off_by(spline, rows)) {
    sums.squares += scale * scale * off.x() * off.x();
    sums.ramps += off.y() * off.y();
    sums.both += off.x() * off.y();
  }
}

/// Sum of squares of what the rows are off the curve, radians^2.
double squares_of(const TurningNodes& nodes, const TurningRun& run) {
  double sum = 0;
  for (std::size_t k = 0; k < run.s.size(); ++k) {
    const double off = nodes.at(run.s[k]) - run.angle[k];
    sum += off * off;
  }
  return sum;
}

/// Takes the monotone curve where its sum of squares is larger by no more than kMonotoneCost row variances: then noise
/// may have made the inflection.
void make_monotone_if_it_costs_little(TurningNodes& nodes, bool round, const TurningRun& run, double sd) {
  TurningNodes monotone = nodes;
  make_monotone(monotone, round);
  if (squares_of(monotone, run) <= squares_of(nodes, run) + kMonotoneCost * sd * sd) nodes = std::move(monotone);
}

/// The ramp of a row; 0 in a roll that has none.
double ramp_of(const TurningRun& run, std::size_t k) { return run.ramp.empty() ? 0 : run.ramp[k]; }

// ---- Rows that gather errors: what each adds is independent, so that slopes are fitted.

/// Slopes between neighbouring rows of each pass; `step`: their usual distance.
ScalarRows slopes_of(const TurningRun& run, double sd, double& step) {
  std::vector<std::pair<double, double>> slopes;
  std::vector<double> steps;
  // Within one pass only: from the last row of a pass to the first of the next one nothing was measured.
  const int passes = run.pass.empty() ? 1 : 1 + *std::max_element(run.pass.begin(), run.pass.end());
  for (int pass = 0; pass < passes; ++pass) {
    std::optional<std::size_t> before;
    for (std::size_t k = 0; k < run.s.size(); ++k) {
      if (!run.pass.empty() && run.pass[k] != pass) continue;
      if (before && run.s[k] > run.s[*before]) {
        steps.push_back(run.s[k] - run.s[*before]);
        slopes.emplace_back(0.5 * (run.s[k] + run.s[*before]), (run.angle[k] - run.angle[*before]) / steps.back());
      }
      before = k;
    }
  }
  // Slopes of all passes together, by place. `step` is the median distance of neighbouring rows.
  std::sort(slopes.begin(), slopes.end());
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  step = steps[steps.size() / 2];
  ScalarRows rows;
  for (const auto& [s, slope] : slopes) {
    rows.s.push_back(s);
    rows.value.emplace_back(slope, 0);
  }
  // An increment's error over the length of its step. All steps are taken as equally long.
  rows.sd = sd / step;
  return rows;
}

/// Theta whose slope this is: a node at every break and between, where Simpson's rule is exact.
TurningNodes integral_of(const FittedSpline& slope) {
  TurningNodes nodes;
  const std::vector<double>& breaks = slope.knots().breaks;
  nodes.add(breaks.front(), {0, slope.spans().front().jet(0).position.x()});
  for (std::size_t span = 0; span + 1 < breaks.size(); ++span) {
    // The slope is cubic on the span: Simpson's rule integrates it over each half without error.
    const double half = 0.5 * (breaks[span + 1] - breaks[span]);
    const auto at = [&](double share) { return slope.spans()[span].jet(share).position.x(); };
    nodes.add(breaks[span] + half, {nodes.angle.back() + half / 6 * (at(0) + 4 * at(0.25) + at(0.5)), at(0.5)});
    nodes.add(breaks[span + 1], {nodes.angle.back() + half / 6 * (at(0.5) + 4 * at(0.75) + at(1)), at(1)});
  }
  return nodes;
}

/// Moved so that the rows are off by nothing on average.
void level(TurningNodes& nodes, const TurningRun& run) {
  double off = 0;
  for (std::size_t k = 0; k < run.s.size(); ++k) off += run.angle[k] - nodes.at(run.s[k]);
  for (double& angle : nodes.angle) angle += off / static_cast<double>(run.s.size());
}

/// Fits the slopes between rows and integrates them, starting at 0. Increments have independent errors, sums have not:
/// so the slopes are what least squares may be asked of.
TurningNodes smooth_slopes(const TurningRun& run, const RowErrors& errors, std::size_t spans, bool closed,
                           FitSums& sums) {
  double step = 0;
  const ScalarRows rows = slopes_of(run, errors.sd, step);
  const FittedSpline spline = least_squares(rows, even_knots(run.lo, run.hi, spans, closed));
  add_sums(spline, rows, step, sums);
  return integral_of(spline);
}

/// The run without rows at its very end that are the first ones again, one lap later: only those in [lo, hi).
TurningRun without_repeated(const TurningRun& run) {
  TurningRun result{run.lo, run.hi, {}, {}};
  for (std::size_t k = 0; k < run.s.size(); ++k) {
    if (run.s[k] < run.lo || run.s[k] >= run.hi) continue;
    result.s.push_back(run.s[k]);
    result.angle.push_back(run.angle[k]);
    if (!run.pass.empty()) result.pass.push_back(run.pass[k]);
    if (!run.ramp.empty()) result.ramp.push_back(run.ramp[k]);
  }
  return result;
}

}  // namespace

TurningNodes smooth(const TurningRun& run, const RowErrors& errors, FitSums& sums) {
  // With so few rows noise can't be told from shape: within one standard deviation of each.
  if (run.s.size() <= kFirstRoundSpans) return fit(run, {errors.sd, false});
  if (errors.gathers) {
    TurningNodes nodes = smooth_slopes(run, errors, 1, false, sums);
    level(nodes, run);
    return nodes;
  }
  ScalarRows rows{run.s, {}, errors.sd};
  for (std::size_t k = 0; k < run.s.size(); ++k) rows.value.emplace_back(run.angle[k], ramp_of(run, k));
  const FittedSpline spline = least_squares(rows, even_knots(run.lo, run.hi, 1, false));
  add_sums(spline, rows, 1, sums);
  TurningNodes nodes = nodes_at_breaks(spline);
  make_monotone_if_it_costs_little(nodes, false, run, errors.sd);
  return nodes;
}

TurningNodes smooth_round(const TurningRun& whole, double turn, const RowErrors& errors, FitSums& sums) {
  const TurningRun run = without_repeated(whole);
  if (run.s.size() <= 2 * kFirstRoundSpans) return fit_round(whole, turn, {errors.sd, false});
  // Less an even turn the course is periodic, as in fit_round.
  const double period = run.hi - run.lo;
  const auto risen = [&](double s) { return turn * (s - run.lo) / period; };
  TurningNodes nodes;
  if (errors.gathers) {
    nodes = smooth_slopes(run, errors, kFirstRoundSpans, true, sums);
    // What the integral of the slopes misses of the turn is spread by length: of a random walk whose end is known this
    // is the mean course.
    const double excess = nodes.angle.back() - turn;
    for (std::size_t k = 0; k < nodes.s.size(); ++k) {
      nodes.angle[k] -= excess * (nodes.s[k] - run.lo) / period;
      nodes.slope[k] -= excess / period;
    }
    level(nodes, run);
    return nodes;
  }
  ScalarRows rows{run.s, {}, errors.sd};
  for (std::size_t k = 0; k < run.s.size(); ++k) {
    rows.value.emplace_back(run.angle[k] - risen(run.s[k]), ramp_of(run, k));
  }
  const FittedSpline spline = least_squares(rows, even_knots(run.lo, run.hi, kFirstRoundSpans, true));
  add_sums(spline, rows, 1, sums);
  nodes = nodes_at_breaks(spline);
  for (std::size_t k = 0; k < nodes.s.size(); ++k) {
    nodes.angle[k] += risen(nodes.s[k]);
    nodes.slope[k] += turn / period;
  }
  make_monotone_if_it_costs_little(nodes, true, run, errors.sd);
  return nodes;
}

}  // namespace rollfix::teaching
