#include "teach/turning_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "rollfix/pulse.hpp"

// Notation:
//   (s_k, theta_k)  rows of a run, each off by the standard deviation `sd`: TurningRun, RowErrors
//   ramp            how much of a lap's drift a row has: fitted like the row, as its second coordinate
//   f(s)            cubic spline through theta_k, or, where errors gather, through slopes between rows: FittedSpline
//   block           a sixth of a span's rows; chi^2: (sum of off)^2 / (count sd^2), summed over the blocks: `is_off`
//   Theta(s)        f, or its integral: TurningNodes
// Follows docs/teach.md, "What is made of the rows".
// Idea: a span is halved while the means of its blocks are off by more than chance makes them: a bend that f misses
// takes neighbouring rows the same way, noise does not.
namespace rollfix::teaching {

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
