#include <algorithm>
#include <cmath>
#include <limits>

#include "belief/grid.hpp"
#include "belief/posterior.hpp"
#include "outline/turn.hpp"
#include "rollfix/part/boundary.hpp"

namespace rollfix::belief {

namespace {

// For what holds 95 %, cells are taken apart where their density changes by more than this, as a logarithm.
constexpr double kRisePerPart = 0.25;
// They hold equal shares of it: more of them than this tell nothing more, and far out a cell may rise by a million.
constexpr double kMostParts = 1000;

/// A run of cells; `turns`: how often each of them lies beyond the seam of a closed boundary.
struct Run {
  std::vector<const GridCell*> cells;
  std::vector<double> turns;
};

/// Cuts the cells of one arc, in order, at the valleys of the density.
std::vector<Run> cut_at_valleys(const Run& arc) {
  std::vector<Run> runs;
  double peak = -std::numeric_limits<double>::infinity();
  double valley = peak;
  std::size_t valley_at = 0;
  std::size_t begin = 0;
  const auto close = [&](std::size_t end) {
    Run run;
    for (std::size_t k = begin; k < end; ++k) {
      run.cells.push_back(arc.cells[k]);
      run.turns.push_back(arc.turns[k]);
    }
    runs.push_back(std::move(run));
    begin = end;
  };
  for (std::size_t k = 0; k < arc.cells.size(); ++k) {
    const double density = arc.cells[k]->log_density;
    const bool has_peak = std::isfinite(peak);
    if (has_peak && density > valley + kValley && valley < peak - kValley) {
      close(valley_at);
      peak = valley = density;
      valley_at = k;
    } else if (density > peak) {
      peak = valley = density;
      valley_at = k;
    } else if (density < valley) {
      valley = density;
      valley_at = k;
    }
  }
  close(arc.cells.size());
  return runs;
}

/// The cells of each arc; a loop's from where the density is least on.
std::vector<Run> arcs_of(const Grid& grid, const TiltedBoundary& boundary) {
  std::vector<Run> arcs(boundary.arcs().size());
  for (const GridCell& cell : grid.cells()) {
    arcs[cell.arc].cells.push_back(&cell);
    arcs[cell.arc].turns.push_back(0);
  }
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    if (!boundary.arcs()[a].loop()) continue;
    Run& arc = arcs[a];
    const auto least = std::min_element(
        arc.cells.begin(), arc.cells.end(),
        [](const GridCell* one, const GridCell* other) { return one->log_density < other->log_density; });
    const auto shift = least - arc.cells.begin();
    std::rotate(arc.cells.begin(), least, arc.cells.end());
    std::fill(arc.turns.end() - shift, arc.turns.end(), 1.0);
  }
  return arcs;
}

class ModeOfRun {
 public:
  ModeOfRun(const Grid& grid, const ModeQuestion& question, const Run& run)
      : grid_(grid), question_(question), run_(run) {}

  Mode mode() const {
    Mode mode;
    const GridPoint& best = best_point();
    for (const GridCell* cell : run_.cells) mode.probability += cell->share;
    const double w = peak(best);
    const double s = arc().at(w).s;
    mode.start = question_.places.on_first_lap(s);
    mode.tangent = w - question_.boundary->tilt() * s;
    mode.end = question_.places.on_first_lap(best.now.after(question_.last).s);
    spread(mode);
    return mode;
  }

 private:
  const TiltedArc& arc() const { return question_.boundary->arcs()[run_.cells.front()->arc]; }

  const GridPoint& best_point() const {
    const GridPoint* best = nullptr;
    for (const GridCell* cell : run_.cells) {
      if (!cell->fine) continue;
      for (const std::size_t k : {cell->first, cell->first + 1}) {
        const GridPoint& point = grid_.point(cell->arc, k);
        if (best == nullptr || point.score.log_likelihood() > best->score.log_likelihood()) best = &point;
      }
    }
    return *best;
  }

  /// From the best point one step of Newton's method, no further than its neighbours are: w.
  double peak(const GridPoint& best) const {
    double lo = best.filter.w();
    double hi = lo;
    for (const GridCell* cell : run_.cells) {
      if (cell->lo == best.filter.w()) hi = cell->hi;
      if (cell->hi == best.filter.w()) lo = cell->lo;
    }
    if (best.score.information <= 0) return best.filter.w();
    const double step = best.score.slope / best.score.information;
    return std::clamp(best.filter.w() + step, lo, hi);
  }

  /// Means, standard deviations and the interval, by the cells.
  void spread(Mode& mode) const {
    const double P = question_.places.perimeter;
    double total = 0;
    double sum = 0;
    double square = 0;
    double end_sum = 0;
    double end_square = 0;
    const double near = run_.cells.front()->s.middle();
    for (std::size_t k = 0; k < run_.cells.size(); ++k) {
      const GridCell& cell = *run_.cells[k];
      if (!cell.fine) continue;
      const double turn = run_.turns[k] * P - near;
      const double width = cell.s.width();
      const double at = cell.s.lo + cell.mean() * width + turn;
      const RollFilter& lower = grid_.point(cell.arc, cell.first).now;
      const RollFilter& upper = grid_.point(cell.arc, cell.first + 1).now;
      const Interval ends{lower.after(question_.last).s, upper.after(question_.last).s};
      const double end = ends.lo + cell.mean() * ends.width() + turn;
      const double end_variance = lower.variance_after(question_.last, question_.own);
      total += cell.share;
      sum += cell.share * at;
      square += cell.share * (at * at + width * width / 12);
      end_sum += cell.share * end;
      end_square += cell.share * (end * end + end_variance);
    }
    const double mean = sum / total;
    const double end_mean = end_sum / total;
    mode.mean = question_.places.on_first_lap(near + mean);
    mode.sd = std::sqrt(std::max(0.0, square / total - mean * mean));
    mode.end_mean = question_.places.on_first_lap(near + end_mean);
    mode.end_sd = std::sqrt(std::max(0.0, end_square / total - end_mean * end_mean));

    const double lo = quantile(0.5 * (1 - kCredible) * total);
    const double hi = quantile(0.5 * (1 + kCredible) * total);
    const double at = question_.places.on_first_lap(lo);
    mode.interval = Interval{at, at + (hi - lo)};
    mode.region = region();
  }

  Interval region() const {
    std::size_t first = 0;
    while (!run_.cells[first]->fine) ++first;
    std::size_t last = run_.cells.size() - 1;
    while (!run_.cells[last]->fine) --last;
    const double lo = at(first, 0);
    const double from = question_.places.on_first_lap(lo);
    return {from, from + (at(last, 1) - lo)};
  }

  /// s in a cell, this share of its width above its lower end.
  double at(std::size_t k, double share) const {
    const GridCell& cell = *run_.cells[k];
    return cell.s.lo + share * cell.s.width() + run_.turns[k] * question_.places.perimeter;
  }

  /// The place up to which there is this much mass.
  double quantile(double mass) const {
    double before = 0;
    for (std::size_t k = 0; k < run_.cells.size(); ++k) {
      const GridCell& cell = *run_.cells[k];
      if (before + cell.share < mass) {
        before += cell.share;
        continue;
      }
      if (cell.share <= 0) continue;
      return at(k, cell.quantile((mass - before) / cell.share));
    }
    return at(run_.cells.size() - 1, 1);
  }

  const Grid& grid_;
  const ModeQuestion& question_;
  const Run& run_;
};

}  // namespace

std::vector<Mode> modes_of(const Grid& grid, const ModeQuestion& question) {
  std::vector<Mode> modes;
  for (const Run& arc : arcs_of(grid, *question.boundary)) {
    if (arc.cells.empty()) continue;
    for (const Run& run : cut_at_valleys(arc)) {
      double probability = 0;
      for (const GridCell* cell : run.cells) probability += cell->share;
      if (probability >= kLeastProbability) modes.push_back(ModeOfRun(grid, question, run).mode());
    }
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) { return a.probability > b.probability; });
  return modes;
}

namespace {

/// Of the part for first contacts in a cell: between what its ends say.
std::optional<PoseSpread> pose_of(const Grid& grid, const GridCell& cell) {
  const RollFilter& lo = grid.point(cell.arc, cell.first).now;
  const RollFilter& hi = grid.point(cell.arc, cell.first + 1).now;
  if (!lo.has_place()) return std::nullopt;
  PoseSpread pose = lo.pose();
  const Pose other = hi.pose().mean;
  pose.mean.x += 0.5 * (other.x - pose.mean.x);
  pose.mean.y += 0.5 * (other.y - pose.mean.y);
  pose.mean.heading += 0.5 * nearest_angle(other.heading - pose.mean.heading);
  return pose;
}

}  // namespace

std::vector<Piece> pieces_of(const Grid& grid, const TiltedBoundary& boundary) {
  std::vector<Piece> pieces;
  for (const GridCell& cell : grid.cells()) {
    if (!(cell.share > kLeastShare)) continue;
    const Interval tangent{cell.lo - boundary.tilt() * cell.s.lo, cell.hi - boundary.tilt() * cell.s.hi};
    pieces.push_back({cell.s.middle(), tangent.middle(), cell.share, pose_of(grid, cell)});
  }
  return pieces;
}

double credible_length(const Grid& grid) {
  struct Stretch {
    double density;
    double share;
    double length;
  };
  std::vector<Stretch> stretches;
  for (const GridCell& cell : grid.cells()) {
    if (!(cell.share > 0)) continue;
    // The density changes within a cell: its parts are looked at by themselves.
    const auto parts = static_cast<int>(std::ceil(std::clamp(std::abs(cell.rise) / kRisePerPart, 1.0, kMostParts)));
    double before = 0;
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      const double to = cell.quantile(share);
      const double length = (to - before) * cell.s.width();
      stretches.push_back({cell.share / parts / std::max(length, 1e-300), cell.share / parts, length});
      before = to;
    }
  }
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.density > b.density; });
  double share = 0;
  double length = 0;
  for (const Stretch& stretch : stretches) {
    if (share >= kCredible) break;
    share += stretch.share;
    length += stretch.length;
  }
  return length;
}

}  // namespace rollfix::belief
