#include "teach/turning_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rollfix/curve.hpp"
#include "rollfix/pulse.hpp"

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

}  // namespace rollfix::teaching
