#include "belief/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "belief/posterior.hpp"
#include "rollfix/part/boundary.hpp"

namespace rollfix::belief {

namespace {

// The grid begins with this many cells, and with every end of a smooth piece, seen from the first contact and from
// this many instants of the roll: between them the likelihood has no corners that a few cells would step over.
constexpr double kFirstCells = 256;
constexpr std::size_t kInstants = 8;
// The distance's rate of change varies within a cell: it is taken as this much larger than at the ends.
constexpr double kSlopeSafety = 2;
// Cells whose mass is below this share of the best one's are not looked into: exp(-25) = 1e-11.
constexpr double kNegligible = 25;
// A cell is resolved when the distance changes by no more than this within it, in standard deviations.
constexpr double kFineStep = 0.5;
// By how much the log-likelihood's middle can be off the mean of its ends in such a cell, about h^2 F / 8.
constexpr double kMostBend = 0.125;
// A point whose deviance is further above another's than this takes no more samples: neither it nor what is near it can
// matter. (What can matter is 100 above; points that stop early say less about what lies between them.)
constexpr double kBeyondMatter = 10000;
// Cells are not made smaller than this share of the boundary.
constexpr double kLeastCell = 1e-13;
// Rounds of halving: 2^-kMostRounds of the first cells is below kLeastCell.
constexpr int kMostRounds = 50;
// A grid does not grow beyond this; what is not resolved by then counts as rest.
constexpr std::size_t kMostPoints = 400000;

/// No more than this can be in a cell: the distance can't fall faster than it changes at the ends.
struct Bound {
  double rate = 0;         // of the distance, by w
  double log_density = 0;  // without the prior
};

Bound bound_of(const Score& lo, const Score& hi, double h, double heat) {
  const double from = std::sqrt(lo.cost);
  const double to = std::sqrt(hi.cost);
  const double rate = std::max(std::sqrt(std::max(lo.information, hi.information)), std::abs(to - from) / h);
  const double least_distance = std::max(0.0, 0.5 * (from + to - kSlopeSafety * rate * h));
  const double cost = std::min({square(least_distance), lo.cost, hi.cost});
  return {rate, -0.5 * (cost + std::min(lo.log_volume, hi.log_volume)) / heat};
}

}  // namespace

Grid::Grid(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options,
           const Boundary& places, double corner_length)
    : boundary_(&boundary),
      errors_(errors),
      options_(options),
      outliers_{options.robust ? kOutlierShare : 0, places.perimeter},
      places_(places),
      corner_length_(corner_length) {
  for (const TiltedArc& arc : boundary.arcs()) length_ += arc.hi() - arc.lo();
}

std::size_t Grid::points() const {
  std::size_t count = 0;
  for (const std::vector<GridPoint>& arc : points_) count += arc.size();
  return count;
}

const GridPoint& Grid::best() const { return points_[best_arc_][best_index_]; }

GridPoint Grid::make(const TiltedArc& arc, double w) const {
  const RollFilter fresh(arc, boundary_->tilt(), w, errors_.start());
  return {fresh, 0, 0, static_cast<std::size_t>(-1), fresh, {}};
}

void Grid::refresh(GridPoint& point, const Nodes& nodes) {
  if (!is_stale(point, nodes) && point.generation == nodes.generation()) return;
  const std::vector<Node>& complete = nodes.complete();
  if (point.generation != nodes.generation()) {
    // Joined nodes are worth what they were one by one; half of one can't be given back.
    const std::size_t shift = nodes.generation() - point.generation;
    if (((point.taken >> shift) << shift) != point.taken) point = make(*point.filter.arc(), point.filter.w());
    point.taken >>= shift;
    point.generation = nodes.generation();
  }
  for (; point.taken < complete.size() && point.filter.deviance() <= limit_; ++point.taken) {
    point.filter.update(complete[point.taken], outliers_);
  }
  point.now = point.filter;
  point.score = {point.now.cost(), point.now.log_volume(), point.now.slope(), point.now.information()};
  if (point.taken < complete.size()) {
    point.rows = static_cast<std::size_t>(-1);
    return;
  }
  if (const std::optional<Node> pending = nodes.pending()) point.now.update(*pending, outliers_);
  point.rows = nodes.rows();
  point.score = {point.now.cost(), point.now.log_volume(), point.now.slope(), point.now.information()};
  if (options_.prior) {
    // The prior is one sample more.
    const TiltedPlace& place = point.now.place();
    const double precision = 1 / square(options_.prior->sd);
    const double off = places_.offset(options_.prior->s, place.s);
    point.score.cost += square(off) * precision;
    point.score.slope -= off * place.slope * precision;
    point.score.information += square(place.slope) * precision;
  }
  lower_limit(point.score.cost + point.score.log_volume, nodes);
}

void Grid::lower_limit(double deviance, const Nodes& nodes) {
  // As if this were the best: its own noise, were it larger than is given, makes all others matter the more.
  const auto freedom = static_cast<double>(nodes.complete().size() + 1);
  limit_ = std::min(limit_, deviance + kBeyondMatter * std::max(1.0, deviance / freedom));
}

void Grid::lay_out(const Nodes& nodes) {
  const double step = length_ / kFirstCells;
  std::vector<double> rolls{0};
  const std::vector<Node>& complete = nodes.complete();
  for (std::size_t k = 1; k <= kInstants && !complete.empty(); ++k) {
    const Node& node = complete[(complete.size() * k - 1) / kInstants];
    rolls.push_back(node.turn + boundary_->tilt() * node.length);
  }
  points_.clear();
  for (const TiltedArc& arc : boundary_->arcs()) {
    std::vector<double> ws;
    for (const double end : arc.breaks()) {
      for (const double roll : rolls) {
        const double w = arc.loop() ? arc.lo() + wrap(end - roll - arc.lo(), arc.hi() - arc.lo()).base : end - roll;
        if (w > arc.lo() && w < arc.hi()) ws.push_back(w);
      }
    }
    const auto count = static_cast<std::size_t>(std::ceil((arc.hi() - arc.lo()) / step));
    for (std::size_t k = 0; k <= count; ++k) {
      ws.push_back(arc.lo() + (arc.hi() - arc.lo()) * static_cast<double>(k) / static_cast<double>(count));
    }
    std::sort(ws.begin(), ws.end());
    points_.emplace_back();
    double last = -std::numeric_limits<double>::infinity();
    for (const double w : ws) {
      if (w - last <= kLeastCell * length_) continue;
      points_.back().push_back(make(arc, w));
      last = w;
    }
  }
}

double Grid::log_prior(const TiltedPlace& middle) const {
  return std::log(middle.slope > 0 ? middle.slope : corner_length_);
}

void Grid::measure_excess(const Nodes& nodes) {
  const GridPoint* best = nullptr;
  for (std::size_t a = 0; a < points_.size(); ++a) {
    for (std::size_t k = 0; k < points_[a].size(); ++k) {
      const GridPoint& point = points_[a][k];
      if (is_stale(point, nodes)) continue;
      if (best != nullptr && point.score.log_likelihood() <= best->score.log_likelihood()) continue;
      best = &point;
      best_arc_ = a;
      best_index_ = k;
    }
  }
  best_ = best->score.log_likelihood();
  const double freedom = static_cast<double>(nodes.complete().size() + (nodes.pending() ? 1 : 0));
  excess_ = excess_of(best->score.cost, freedom, options_.robust);
  // A peak is about one standard deviation wide, and no wider than the boundary.
  const double width = 1 / (std::sqrt(best->score.information) / excess_ + 1 / length_);
  best_mass_ = best_ / square(excess_) + log_prior(best->now.place()) + std::log(width);
}

bool Grid::refine(const Nodes& nodes) {
  const double heat = square(excess_);
  bool changed = false;
  cells_.clear();
  rest_ = 0;
  for (std::size_t a = 0; a < points_.size(); ++a) {
    const TiltedArc& arc = boundary_->arcs()[a];
    const double least = kLeastCell * (arc.hi() - arc.lo());
    std::vector<GridPoint>& points = points_[a];
    std::vector<double> added;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const double h = points[k + 1].filter.w() - points[k].filter.w();
      GridCell cell{a, k, points[k].filter.w(), points[k + 1].filter.w(), arc.at(points[k].filter.w() + 0.5 * h)};
      const double log_width = log_prior(cell.middle) + std::log(h);
      Bound bound = bound_of(points[k].score, points[k + 1].score, h, heat);
      // A cost only grows with more samples: one that was too large before is so now.
      const bool stale = is_stale(points[k], nodes) || is_stale(points[k + 1], nodes);
      if (stale && bound.log_density + log_width - best_mass_ > -2 * kNegligible) {
        refresh(points[k], nodes);
        refresh(points[k + 1], nodes);
        bound = bound_of(points[k].score, points[k + 1].score, h, heat);
        changed = changed || (!is_stale(points[k], nodes) && !is_stale(points[k + 1], nodes));
      }
      const double most = bound.log_density + log_width;
      const bool negligible = most - best_mass_ < -kNegligible;
      cell.fine = !negligible && (bound.rate * h <= kFineStep * excess_ || h <= 2 * least);
      if (!negligible && !cell.fine && Grid::points() + added.size() < kMostPoints) {
        added.push_back(points[k].filter.w() + 0.5 * h);
      } else if (!cell.fine) {
        rest_ += std::exp(std::min(0.0, most - best_ / heat));
      }
      cells_.push_back(cell);
    }
    if (added.empty()) continue;
    changed = true;
    std::vector<GridPoint> merged;
    merged.reserve(points.size() + added.size());
    std::size_t next = 0;
    for (GridPoint& point : points) {
      while (next < added.size() && added[next] < point.filter.w()) {
        merged.push_back(make(arc, added[next++]));
        refresh(merged.back(), nodes);
      }
      merged.push_back(std::move(point));
    }
    points = std::move(merged);
  }
  return changed;
}

void Grid::weigh() {
  const double heat = square(excess_);
  double total = 0;
  for (GridCell& cell : cells_) {
    if (!cell.fine) {
      cell.log_density = -std::numeric_limits<double>::infinity();
      continue;
    }
    const Score& lo = points_[cell.arc][cell.first].score;
    const Score& hi = points_[cell.arc][cell.first + 1].score;
    const double h = cell.hi - cell.lo;
    const double at_lo = (lo.log_likelihood() - best_) / heat;
    const double at_hi = (hi.log_likelihood() - best_) / heat;
    // Hermite's cubic through both ends, and Simpson's rule. At a kink the slopes mislead: the middle is no further off
    // than a resolved cell allows.
    const double bend = 0.125 * h * (lo.slope - hi.slope) / heat;
    const double at_middle = 0.5 * (at_lo + at_hi) + std::clamp(bend, -kMostBend, kMostBend);
    const double mean = (std::exp(at_lo) + 4 * std::exp(at_middle) + std::exp(at_hi)) / 6;
    cell.log_density = std::log(mean) + log_prior(cell.middle);
    cell.share = std::exp(cell.log_density) * h;
    total += cell.share;
  }
  for (GridCell& cell : cells_) cell.share /= total;
  rest_ = std::min(1.0, rest_ / total);
}

void Grid::settle(const Nodes& nodes) {
  limit_ = std::numeric_limits<double>::infinity();
  // As the roll goes on, other places of the boundary decide: the first points are laid out anew at each doubling.
  // So they are when nodes were joined: what a point was worth node by node can't be compared with what a point that
  // takes the joined ones is worth, because the scatter within the joined ones costs it nothing.
  if (points_.empty() || nodes.rows() >= 2 * laid_out_at_ || nodes.generation() != generation_) {
    lay_out(nodes);
    generation_ = nodes.generation();
    laid_out_at_ = std::max<std::size_t>(1, nodes.rows());
    for (std::vector<GridPoint>& arc : points_) {
      for (GridPoint& point : arc) refresh(point, nodes);
    }
  } else {
    for (const GridCell& cell : cells_) {
      if (!cell.fine) continue;
      refresh(points_[cell.arc][cell.first], nodes);
      refresh(points_[cell.arc][cell.first + 1], nodes);
    }
  }
  for (int round = 0; round < kMostRounds; ++round) {
    measure_excess(nodes);
    if (!refine(nodes)) break;
  }
  measure_excess(nodes);
  weigh();
}

}  // namespace rollfix::belief
