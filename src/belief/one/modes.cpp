#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "belief/one/grid.hpp"
#include "belief/posterior.hpp"
#include "locate/remaining.hpp"
#include "outline/turn.hpp"
#include "rollfix/turning_function.hpp"

// Notation:
//   cell            of the grid, with its share of the mass: GridCell; its density is exponential, e^`rise` across it
//   arc, run        cells side by side: along the boundary, and cut at valleys: Run
//   valley          log density falls by `kValley` below the lower of two peaks: then they are two modes
//   w, s            tilted turning and place of the first contact; its tangent is w - c s, c the tilt
//   g, F            slope and information of log L at the likeliest point: the peak is a step of Newton's, g / F, away
// Follows docs/belief.md, "The computation".
// Idea: a run is a mode; its mean and standard deviation, the median and 95 % follow from its cells. As long as what
// holds 95 % of all modes (`credible_length`) are the densest cells, the ones cut finely in which the density changes.
namespace rollfix::belief {

namespace {

// For what holds 95 %, cells are taken apart where their density changes by more than this, as a logarithm.
constexpr double kRisePerPart = 0.25;
// Parts of a cell hold equal shares of it. There are no more than kMostParts, as far out a cell may rise by a million,
// and none need hold less than kLeastPart of all mass.
constexpr double kMostParts = 1000;
constexpr double kLeastPart = 1e-4;

/// A run of cells; `turns`: how often each of them lies beyond the seam of a closed boundary.
struct Run {
  explicit Run(std::pmr::memory_resource* memory) : cells(memory), turns(memory) {}

  std::pmr::vector<const GridCell*> cells;  // side by side, by growing w
  std::pmr::vector<double> turns;           // laps, 0 or 1, one for each cell
};
using Runs = std::pmr::vector<Run>;

/// Cuts the cells of one arc, in order, at the valleys of the density.
Runs cut_at_valleys(const Run& arc, std::pmr::memory_resource* memory) {
  Runs runs(memory);
  // Of the run so far: its highest density, and the lowest one after that, with its cell.
  double peak = -std::numeric_limits<double>::infinity();
  double valley = peak;
  std::size_t valley_at = 0;
  std::size_t begin = 0;
  const auto close = [&](std::size_t end) {
    Run run(memory);
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
    // Both this cell and the peak stand out above the valley by kValley: the run ends there.
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
Runs arcs_of(const Grid& grid, const TiltedBoundary& boundary) {
  Runs arcs(grid.memory());
  arcs.reserve(boundary.arcs().size());
  while (arcs.size() < boundary.arcs().size()) arcs.emplace_back(grid.memory());
  for (const GridCell& cell : grid.cells()) {
    Run& arc = arcs[cell.arc + boundary.shift(cell.fold).arcs];
    arc.cells.push_back(&cell);
    arc.turns.push_back(0);
  }
  // No mode is cut where a loop is opened: the density is least there.
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    if (!boundary.arcs()[a].loop()) continue;
    Run& arc = arcs[a];
    const auto least = std::min_element(
        arc.cells.begin(), arc.cells.end(),
        [](const GridCell* one, const GridCell* other) { return one->log_density < other->log_density; });
    const auto shift = least - arc.cells.begin();
    std::rotate(arc.cells.begin(), least, arc.cells.end());
    // What was before the new first cell is a lap further on now.
    std::fill(arc.turns.end() - shift, arc.turns.end(), 1.0);
  }
  return arcs;
}

/// One mode, made from its run of cells.
class ModeOfRun {
 public:
  ModeOfRun(const Grid& grid, const ModeQuestion& question, const Run& run)
      : grid_(grid), question_(question), run_(run) {}

  Mode mode() const {
    Mode mode;
    for (const GridCell* cell : run_.cells) mode.probability += cell->share;
    // Means and intervals first: the start is held against the interval.
    spread(mode);
    const End best = best_end();
    const RollFilter filter = grid_.filter(*run_.cells[best.cell], best.end);
    start(mode, filter, peak(best, filter.w()));
    if (!question_.places.contains(mode.interval[0], mode.start[0])) start_in_the_middle(mode);
    return mode;
  }

 private:
  /// The first contact at w, with its tangent Theta = w - c s and the contact now by the filter's estimate.
  void start(Mode& mode, const RollFilter& filter, double w) const {
    const double s = filter.arc()->at(w).s;
    mode.start = question_.places.on_first_lap(s);
    mode.tangent = w - question_.boundary->tilt() * s;
    mode.end = question_.places.on_first_lap(filter.after(question_.last, w - filter.w()).s);
  }
  /// Where a density is flat its peak is a ripple somewhere, at an edge as well, and says nothing: the median does.
  void start_in_the_middle(Mode& mode) const {
    double total = 0;
    for (const GridCell* cell : run_.cells) total += cell->share;
    const Place middle = place_of(0.5 * total);
    const GridCell& cell = *run_.cells[middle.cell];
    start(mode, grid_.filter(cell, middle.share < 0.5 ? 0 : 1), cell.lo + middle.share * (cell.hi - cell.lo));
  }

  /// The lower or the upper one of a cell.
  struct End {
    std::size_t cell = 0;
    std::size_t end = 0;
  };

  /// Of the point at that end, prior included.
  const Score& score_at(const End& at) const { return grid_.point(*run_.cells[at.cell], at.end).score; }

  /// The likeliest one.
  End best_end() const {
    std::optional<End> best;
    for (std::size_t k = 0; k < run_.cells.size(); ++k) {
      if (!run_.cells[k]->fine) continue;
      for (const End end : {End{k, 0}, End{k, 1}}) {
        if (!best || score_at(end).log_likelihood() > score_at(*best).log_likelihood()) best = end;
      }
    }
    return *best;
  }

  /// From there one step of Newton's method, no further than its neighbours are: w.
  double peak(const End& best, double w) const {
    const Score& score = score_at(best);
    // Nothing is known of w there: no step.
    if (score.information <= 0) return w;
    const auto width = [&](std::size_t k) { return k < run_.cells.size() ? run_.cells[k]->hi - run_.cells[k]->lo : 0; };
    // The cells on either side of the point, within the run: 0 where there is none.
    const std::size_t above = best.cell + best.end;
    const double below = above > 0 ? width(above - 1) : 0;
    return w + std::clamp(score.slope / score.information, -below, width(above));
  }

  /// Means, standard deviations and the interval, by the cells.
  void spread(Mode& mode) const {
    const double P = question_.places.perimeter;
    double total = 0;
    double sum = 0;
    double square = 0;
    double end_sum = 0;
    double end_square = 0;
    // Sums are about a place of the run: squares of small numbers keep their digits.
    const double near = run_.cells.front()->s.middle();
    for (std::size_t k = 0; k < run_.cells.size(); ++k) {
      const GridCell& cell = *run_.cells[k];
      if (!cell.fine) continue;
      const double turn = run_.turns[k] * P - near;
      const double width = cell.s.width();
      // The mean of the cell's exponential density; s is straight across a cell.
      const double at = cell.s.lo + cell.mean() * width + turn;
      const RollFilter& lower = grid_.point(cell, 0).now;
      const RollFilter& upper = grid_.point(cell, 1).now;
      // Where the contact is now for both ends of the cell, and in between likewise.
      const Interval ends{lower.after(question_.last).s, upper.after(question_.last).s};
      const double end = ends.lo + cell.mean() * ends.width() + turn + question_.boundary->shift(cell.fold).s;
      const double end_variance = lower.variance_after(question_.last, question_.own);
      total += cell.share;
      sum += cell.share * at;
      // An even density of this width has the variance width^2 / 12.
      square += cell.share * (at * at + width * width / 12);
      end_sum += cell.share * end;
      end_square += cell.share * (end * end + end_variance);
    }
    const double mean = sum / total;
    const double end_mean = end_sum / total;
    mode.mean = question_.places.on_first_lap(near + mean);
    mode.sd = std::sqrt(std::max(0.0, square / total - mean * mean));
    mode.end_mean = question_.places.on_first_lap(near + end_mean);
    // The end's variance: between cells, and in each that of the roll from a fixed start.
    mode.end_sd = std::sqrt(std::max(0.0, end_square / total - end_mean * end_mean));

    // The 95 % interval leaves as much below as above.
    const double lo = quantile(0.5 * (1 - kCredible) * total);
    const double hi = quantile(0.5 * (1 + kCredible) * total);
    const double at = question_.places.on_first_lap(lo);
    mode.interval = Interval{at, at + (hi - lo)};
    mode.region = region();
  }

  /// From the first resolved cell to the last one.
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

  /// In a cell, this share of its width above its lower end.
  struct Place {
    std::size_t cell = 0;
    double share = 0;
  };

  /// s, unwrapped, up to which the run holds this much mass.
  double quantile(double mass) const {
    const Place place = place_of(mass);
    return at(place.cell, place.share);
  }

  /// The place up to which there is this much mass.
  Place place_of(double mass) const {
    double before = 0;
    for (std::size_t k = 0; k < run_.cells.size(); ++k) {
      const GridCell& cell = *run_.cells[k];
      // `before`: the mass of the cells that are passed.
      if (before + cell.share < mass) {
        before += cell.share;
        continue;
      }
      if (cell.share <= 0) continue;
      return {k, cell.quantile((mass - before) / cell.share)};
    }
    return {run_.cells.size() - 1, 1};
  }

  const Grid& grid_;
  const ModeQuestion& question_;
  const Run& run_;
};

}  // namespace

/// Arcs are cut at valleys into runs. Runs that are probable enough (`is_listed`) become modes.
std::pmr::vector<Mode> modes_of(const Grid& grid, const ModeQuestion& question) {
  std::pmr::vector<Mode> modes(grid.memory());
  const auto is_likelier = [](const Mode& a, const Mode& b) { return a.probability > b.probability; };
  std::pmr::vector<Run> runs(grid.memory());
  std::pmr::vector<double> probability(grid.memory());
  for (const Run& arc : arcs_of(grid, *question.boundary)) {
    if (arc.cells.empty()) continue;
    for (Run& run : cut_at_valleys(arc, grid.memory())) {
      double& of_run = probability.emplace_back(0);
      for (const GridCell* cell : run.cells) of_run += cell->share;
      runs.push_back(std::move(run));
    }
  }
  if (runs.empty()) return modes;
  // Probabilities first: most runs are too improbable to be listed, and cost no more.
  const double likeliest = *std::max_element(probability.begin(), probability.end());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!is_listed(probability[k], likeliest)) continue;
    const Mode mode = ModeOfRun(grid, question, runs[k]).mode();
    modes.insert(std::upper_bound(modes.begin(), modes.end(), mode, is_likelier), mode);
  }
  return modes;
}

namespace {

/// Of the part for first contacts in a cell: between what its ends say.
std::optional<PoseSpread> pose_of(const Grid& grid, const GridCell& cell) {
  const RollFilter lo = grid.filter(cell, 0);
  const RollFilter hi = grid.filter(cell, 1);
  if (!lo.has_place()) return std::nullopt;
  PoseSpread pose = lo.pose();
  const Pose other = hi.pose().mean;
  // In the middle of both ends; the covariance is the lower end's.
  pose.mean.x += 0.5 * (other.x - pose.mean.x);
  pose.mean.y += 0.5 * (other.y - pose.mean.y);
  pose.mean.heading += 0.5 * nearest_angle(other.heading - pose.mean.heading);
  return pose;
}

}  // namespace

std::vector<MassPiece> pieces_of(const Grid& grid, const TiltedBoundary& boundary) {
  std::vector<MassPiece> pieces;
  for (const GridCell& cell : grid.cells()) {
    // Far out there are many cells with less.
    if (!(cell.share > kLeastShare)) continue;
    // Theta = w - c s at both ends.
    const Interval tangent{cell.lo - boundary.tilt() * cell.s.lo, cell.hi - boundary.tilt() * cell.s.hi};
    pieces.push_back({cell.s.middle(), tangent.middle(), cell.share, pose_of(grid, cell)});
  }
  return pieces;
}

std::vector<PosePiece> pose_pieces_of(const Grid& grid, const TiltedBoundary& boundary) {
  std::vector<PosePiece> pieces;
  for (const GridCell& cell : grid.cells()) {
    if (!(cell.share > kLeastShare)) continue;
    PosePiece piece;
    piece.lo = {cell.s.lo, cell.lo - boundary.tilt() * cell.s.lo, grid.filter(cell, 0).pose()};
    piece.hi = {cell.s.hi, cell.hi - boundary.tilt() * cell.s.hi, grid.filter(cell, 1).pose()};
    piece.probability = cell.share;
    piece.rise = cell.rise;
    pieces.push_back(piece);
  }
  return pieces;
}

namespace {

/// Evenly spread mass.
struct EvenMass {
  double density;
  double share;
  double length;
};

/// The densest first.
void sort_by_density(std::pmr::vector<EvenMass>& stretches) {
  std::sort(stretches.begin(), stretches.end(),
            [](const EvenMass& a, const EvenMass& b) { return a.density > b.density; });
}

/// By s, from where it is least to where it is largest: an exponential.
Interval densities_in(const GridCell& cell) {
  // The maximum of an exponential with this mean and rise is mean * rise / (1 - exp(-rise)).
  const double mean = cell.share / std::max(cell.s.width(), 1e-300);
  const double rise = std::max(std::abs(cell.rise), 1e-300);
  const double most = mean * rise / -std::expm1(-rise);
  return {most * std::exp(-rise), most};
}

/// The density changes within a cell: its parts are looked at by themselves.
void add_parts(const GridCell& cell, std::pmr::vector<EvenMass>& stretches) {
  const double enough = std::clamp(cell.share / kLeastPart, 1.0, kMostParts);
  const auto parts = static_cast<int>(std::ceil(std::clamp(std::abs(cell.rise) / kRisePerPart, 1.0, enough)));
  double before = 0;
  for (int k = 1; k <= parts; ++k) {
    // Each part holds the same share: where the density is low it is long.
    const double to = cell.quantile(static_cast<double>(k) / parts);
    const double length = (to - before) * cell.s.width();
    stretches.push_back({cell.share / parts / std::max(length, 1e-300), cell.share / parts, length});
    before = to;
  }
}

/// Cells that hold what is credible are everywhere as dense as this.
double density_of_enough(const Grid& grid) {
  std::pmr::vector<EvenMass> cells(grid.memory());
  for (const GridCell& cell : grid.cells()) {
    if (cell.share > 0) cells.push_back({densities_in(cell).lo, cell.share, 0});
  }
  sort_by_density(cells);
  double held = 0;
  for (const EvenMass& cell : cells) {
    held += cell.share;
    if (held >= kCredible) return cell.density;
  }
  return 0;
}

}  // namespace

/// The densest stretches are taken until they hold 95 %: the shortest set with that share. Length.
double credible_length(const Grid& grid) {
  // Cells that are nowhere as dense are none of those that are asked for. What one fold holds the others hold as well.
  const double enough = density_of_enough(grid);
  const auto folds = static_cast<double>(grid.folds());
  std::pmr::vector<EvenMass> stretches(grid.memory());
  for (const GridCell& cell : grid.cells()) {
    if (cell.fold == 0 && cell.share > 0 && densities_in(cell).hi >= enough) add_parts(cell, stretches);
  }
  sort_by_density(stretches);
  double share = 0;
  double length = 0;
  for (const EvenMass& stretch : stretches) {
    if (share >= kCredible) break;
    // A stretch has a copy on each fold: as many of them as are still needed.
    const double count = std::min(folds, std::ceil((kCredible - share) / stretch.share));
    share += count * stretch.share;
    length += count * stretch.length;
  }
  return length;
}

}  // namespace rollfix::belief
