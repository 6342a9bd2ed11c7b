#include "belief/one/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "belief/posterior.hpp"
#include "rollfix/turning_function.hpp"

// Notation:
//   w               tilted turning of the first contact, Theta + c s: the grid's coordinate; h is a cell's width
//   d^2, log V      `Score::cost`, the rows' squared distance, and `log_volume`: -2 log L(w) = d^2 + log V
//   F               `information`; `steepness`: with every row as right, the square of the rate at which d can change
//                   with w. Far from a peak robust rows count little, and F says nothing of how narrow it is
//   heat            `fit_.widened`^2: log-likelihoods are divided by it where the rows fit badly
//   prior           ds along the boundary, at a corner r dTheta (`corner_length_`): `log_prior`, by w
//   fold            one of the m-th parts of a boundary that looks the same m times
// Follows docs/belief.md, "The computation", from "The filters stand on a grid over w" on.
// Idea: between two points d can't fall faster than its steepness allows (times `kSlopeSafety`: a safety factor, not a
// proof). A cell that can't hold a share of exp(-`kNegligible`) of the mass is left; the others are halved until d
// changes by less than `kFineStep`, and are integrated by Simpson's rule with the slopes at both ends (`weigh`).
namespace rollfix::belief {

namespace {

// The grid begins with this many cells, and with every kink, seen from the first contact and from this many instants of
// the roll: between them the likelihood has no corners that a few cells would step over.
constexpr double kFirstCells = 64;
constexpr std::size_t kInstants = 8;
// Where the mass is, cells are no wider than one of this many equal ones, unless they are even: log L deviates from a
// straight line by kEvenRise at most, and s(w) by the share kEvenSlope. Cells whose mass is below exp(-kShallow) of the
// best need not be even.
constexpr double kMostCells = 256;
constexpr double kEvenRise = 0.05;
constexpr double kEvenSlope = 0.1;
constexpr double kShallow = 12;
// The distance's rate of change varies within a cell: it is taken as this much larger than at the ends.
constexpr double kSlopeSafety = 2;
// Where all robust rows are outliers cells are no narrower than one of so many: a peak is as wide as a few deviations
// of a row, and of sensors better than 2e-5 of the perimeter it may be lost.
constexpr double kRobustCells = 50000;
constexpr double kRobustCellsToWeigh = 5000;  // of one explanation among many
// Cells whose mass is below this share of the best one's are not looked into: exp(-25) = 1e-11.
constexpr double kNegligible = 25;
// A cell is resolved when the distance changes by no more than this within it, in standard deviations.
constexpr double kFineStep = 0.5;
// A cell that holds exp(-kDepth) of the best one's mass may have twice that step, exp(-2 kDepth) three times, and so
// on: far out a cell is only summed.
constexpr double kDepth = 4;
// By how much the log-likelihood's middle can be off the mean of its ends in a cell, of the distance's change squared:
// four times what the information makes of it, h^2 F / 8.
constexpr double kMostBend = 0.5;
// Where s grows with w by less than this share of what it does on a straight side, the contact is in a corner.
constexpr double kCornerSlope = 1e-6;
// Cells are not made smaller than this share of the boundary.
constexpr double kLeastCell = 1e-13;
// Rounds of halving: 2^-kMostRounds of the first cells is below kLeastCell.
constexpr int kMostRounds = 50;
// A density that changes by less than this share is even.
constexpr double kEven = 1e-6;
// ... and one that changes by more, as a logarithm, is as good as all at its upper end.
constexpr double kSteep = 600;

/// A lower bound on d^2 between two points. Within h, d is at least (d_lo + d_hi - rate h) / 2 if it changes no faster
/// than `rate`; the rate is doubled, as it varies. It is never above the cost at either end.
double least_cost_of(const Score& lo, const Score& hi, double rate, double h) {
  const double distances = std::sqrt(lo.cost) + std::sqrt(hi.cost);
  const double least_distance = std::max(0.0, 0.5 * (distances - kSlopeSafety * rate * h));
  return std::min({square(least_distance), lo.cost, hi.cost});
}

}  // namespace

/// The density is taken as exp(rise x), x from 0 to 1 across the cell: its integral (exp(rise x) - 1) / rise is
/// inverted.
double GridCell::quantile(double share_of_mass) const {
  // The density as an exponential: its integral, solved for where it ends.
  if (std::abs(rise) < kEven) return share_of_mass;
  // Beyond kSteep it is more than a double can hold.
  const double at =
      rise > kSteep ? 1 + std::log(share_of_mass) / rise : std::log1p(share_of_mass * std::expm1(rise)) / rise;
  return std::clamp(at, 0.0, 1.0);
}

/// Even ones, both ends of each arc, and each kink as seen from the first contact and from `kInstants` instants.
std::size_t most_first_points(const TiltedBoundary& boundary) {
  auto most = static_cast<std::size_t>(kFirstCells);
  for (const TiltedArc& arc : boundary.arcs()) most += 2 + arc.kinks().size() * (1 + kInstants);
  return most;
}

Grid::Grid(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options,
           const Boundary& places, double corner_length, const CentreModel* centres, std::pmr::memory_resource* memory,
           std::size_t most_points)
    : memory_(memory),
      most_points_(most_points),
      boundary_(&boundary),
      options_(options),
      places_(places),
      scorer_(boundary, errors, options, places, centres, memory),
      corner_length_(corner_length),
      can_be_alike_(!errors.gathers_rows() && options.noise.correlation == 0),
      folds_(options.prior || options.pose || !options.within.empty() ? 1 : boundary.folds()),
      ranges_(memory),
      points_(memory),
      spare_(memory),
      cells_(memory) {
  for (const TiltedArc& arc : boundary.arcs()) {
    length_ += arc.hi() - arc.lo();
    ranges_.push_back({arc.lo(), arc.hi()});
  }
  if (folds_ == 1) return;
  // Points lie on the first fold alone: on its share of the loop, or on the first arcs of several.
  const Shift fold = boundary.shift(1);
  if (fold.arcs == 0) ranges_.front().hi = ranges_.front().lo + fold.w;
  if (fold.arcs > 0) ranges_.resize(fold.arcs);
}

/// The point's filter moved to the fold of the cell, whose arc may be another one.
RollFilter Grid::filter(const GridCell& cell, std::size_t end) const {
  const Shift shift = boundary_->shift(cell.fold);
  return point(cell, end).now.moved(boundary_->arcs()[cell.arc + shift.arcs], shift);
}

/// By bisection among the points that were kept: `spare_` is in order of w.
GridPointer Grid::point_at(std::size_t arc, double w) {
  if (arc < spare_.size()) {
    std::pmr::vector<SparePoint>& spare = spare_[arc];
    const auto known = std::lower_bound(spare.begin(), spare.end(), w,
                                        [](const SparePoint& point, double place) { return point.w < place; });
    if (known != spare.end() && known->w == w && known->point) return std::move(known->point);
  }
  std::pmr::polymorphic_allocator<> allocator(memory_);
  return {allocator.new_object<GridPoint>(scorer_.make(boundary_->arcs()[arc], w)), GiveBack{memory_}};
}

/// The first points: even ones, and every w from where the contact is at a kink at one of the instants. They are at
/// least `kLeastCell` of the boundary apart.
void Grid::lay_out(const Nodes& nodes) {
  const double step = length_ / kFirstCells;
  std::pmr::vector<double> rolls({0.0}, memory_);
  const std::pmr::vector<Node>& complete = nodes.complete();
  for (std::size_t k = 1; k <= kInstants && !complete.empty(); ++k) {
    const Node& node = complete[(complete.size() * k - 1) / kInstants];
    // A contact that starts at w is at w + theta + c L then: a kink there is seen from w = kink - roll.
    rolls.push_back(node.turn + boundary_->tilt() * node.length);
  }
  keep_points(nodes);
  for (std::size_t a = 0; a < ranges_.size(); ++a) {
    const TiltedArc& arc = boundary_->arcs()[a];
    const Interval& range = ranges_[a];
    std::pmr::vector<double> ws(memory_);
    for (const double kink : arc.kinks()) {
      if (kink > range.hi) break;
      for (const double roll : rolls) {
        const double w = arc.loop() ? range.lo + wrap(kink - roll - range.lo, range.width()).base : kink - roll;
        if (w > range.lo && w < range.hi) ws.push_back(w);
      }
    }
    // Even ones, both ends of the range among them.
    const auto count = static_cast<std::size_t>(std::ceil(range.width() / step));
    for (std::size_t k = 0; k <= count; ++k) {
      ws.push_back(range.lo + range.width() * static_cast<double>(k) / static_cast<double>(count));
    }
    std::sort(ws.begin(), ws.end());
    points_.emplace_back();
    double last = -std::numeric_limits<double>::infinity();
    for (const double w : ws) {
      if (w - last <= kLeastCell * length_) continue;
      points_.back().push_back(point_at(a, w));
      last = w;
    }
    count_ += points_.back().size();
  }
}

void Grid::keep_points(const Nodes& nodes) {
  spare_.clear();
  for (GridPoints& arc : points_) {
    spare_.emplace_back();
    for (GridPointer& point : arc) {
      if (point->generation != nodes.generation()) continue;
      const double w = point->filter.w();
      spare_.back().push_back({w, std::move(point)});
    }
  }
  points_.clear();
  count_ = 0;
}

/// All points next to which the first contact may be. Without a restriction these are all.
void Grid::refresh_all(const Nodes& nodes) {
  std::pmr::vector<GridPoint*> points(memory_);
  for (const GridPoints& arc : points_) {
    for (std::size_t k = 0; k < arc.size(); ++k) {
      const GridPoint& before = *arc[k > 0 ? k - 1 : k];
      const GridPoint& after = *arc[std::min(k + 1, arc.size() - 1)];
      if (can_start_in({before.filter.place().s, after.filter.place().s})) points.push_back(arc[k].get());
    }
  }
  scorer_.refresh_likely_first(points, nodes);
}

/// `base`: the laps of s.lo, so that the stretches are compared on the same lap, and on the next one as well.
bool Grid::can_start_in(const Interval& s) const {
  if (options_.within.empty()) return true;
  const double lap = places_.closed ? places_.perimeter : 0;
  const double base = places_.closed ? s.lo - places_.reduced(s.lo).base : 0;
  return std::any_of(options_.within.begin(), options_.within.end(), [&](const Interval& one) {
    return (one.lo + base <= s.hi && one.hi + base >= s.lo) || one.lo + base + lap <= s.hi;
  });
}

/// The logarithm of the prior's mass over `width` of w. Its density by w is ds/dw = length / h along the boundary, and
/// `corner_length_` (r) in a corner, where s stays.
double Grid::log_prior(double length, double h, double width) const {
  const double slope = length / h;
  return std::log((slope * boundary_->tilt() > kCornerSlope ? slope : corner_length_) * width);
}

/// The log likelihood divided by the heat, plus the logarithms of the prior's density and of the peak's width.
double Grid::log_mass(const GridPoint& point) const {
  // A peak is about one standard deviation wide, and no wider than the boundary.
  const double width = 1 / (std::sqrt(point.score.information) / fit_.widened + 1 / length_);
  return point.score.log_likelihood() / square(fit_.widened) + log_prior(point.now.place().slope, 1) + std::log(width);
}

/// Whether log L between the points is close to a straight line, by Hermite's cubic through both, and so is s(w).
bool Grid::is_even(const GridPoint& lo, const GridPoint& hi, double length) const {
  const double h = hi.filter.w() - lo.filter.w();
  const double heat = square(fit_.widened);
  const double rise = hi.score.log_likelihood() - lo.score.log_likelihood();
  // `off` is 0 where log L is a quadratic. `bend` is how far the cubic's middle is above the mean of both ends.
  const double off = rise - 0.5 * h * (lo.score.slope + hi.score.slope);
  const double bend = 0.125 * h * (lo.score.slope - hi.score.slope);
  const double slope = lo.filter.place().slope;
  return std::abs(off) <= kEvenRise * heat && std::abs(bend) <= kEvenRise * heat &&
         std::abs(length - slope * h) <= kEvenSlope * length;
}

Score Grid::at_least(Score score, const GridPoint& point) const {
  // What stopped on the way, and what did not although it is as far off, must look alike: else the grid would be made
  // ever finer between them.
  if (point.deviance > scorer_.limit()) {
    score.cost = farthest_;
    score.log_volume = scorer_.limit() - farthest_;
  }
  score.cost = std::min(score.cost, farthest_);
  return score;
}

Score Grid::of_rows(const GridPoint& point) const {
  const Score prior = scorer_.narrow_prior(point);
  Score score = point.score;
  score.cost = std::max(0.0, score.cost - prior.cost);
  score.information = std::max(0.0, score.information - prior.information);
  score.steepness = std::max(0.0, score.steepness - prior.information);
  return at_least(score, point);
}

/// The larger one of what the steepness at both ends allows and of the change from one end to the other. A plateau of
/// robust rows is looked at in so many cells at most: sqrt(d^2) falls to 0 within one of them.
double Grid::rate_of(const Score& lo, const Score& hi, double h) const {
  const double cells = options_.by_rows ? kRobustCellsToWeigh : kRobustCells;
  const double plateau = std::sqrt(std::min(lo.cost, hi.cost)) * cells / length_;
  const double steep = std::min(std::sqrt(std::max(lo.steepness, hi.steepness)), plateau);
  return std::max({std::sqrt(std::max(lo.information, hi.information)), steep,
                   std::abs(std::sqrt(hi.cost) - std::sqrt(lo.cost)) / h});
}

/// A narrow prior is bounded by itself: together with the rows it would look like a distance that changes fast.
Grid::Bound Grid::bound_of(const GridPoint& lo, const GridPoint& hi, const GridCell& cell) const {
  const double h = cell.hi - cell.lo;
  const Score at_lo = of_rows(lo), at_hi = of_rows(hi);
  const double cost = least_cost_of(at_lo, at_hi, rate_of(at_lo, at_hi, h), h) + scorer_.least_narrow_cost(cell.s);
  const double log_volume = std::min(at_least(lo.score, lo).log_volume, at_least(hi.score, hi).log_volume);
  return {rate_of(at_least(lo.score, lo), at_least(hi.score, hi), h),
          -0.5 * (cost + log_volume) / square(fit_.widened)};
}

/// One round over all cells: brings the ends of those that matter up to date, decides which cells are resolved, and
/// halves the others. False: nothing has changed.
bool Grid::refine(const Nodes& nodes) {
  const double heat = square(fit_.widened);
  bool changed = false;
  cells_.clear();
  rest_ = 0;
  for (std::size_t a = 0; a < points_.size(); ++a) {
    const TiltedArc& arc = boundary_->arcs()[a];
    const double least = kLeastCell * (arc.hi() - arc.lo());
    // Wider cells are resolved only where density and boundary are even in them, or far below the best one.
    const double narrow = length_ / kMostCells;
    const GridPoints& points = points_[a];
    std::pmr::vector<double> added(memory_);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      GridPoint& lo = *points[k];
      GridPoint& hi = *points[k + 1];
      // Where the first contact can't be, a cell stays empty: it is not `fine`, and no rest either.
      GridCell cell{a, k, lo.filter.w(), hi.filter.w(), {lo.filter.place().s, hi.filter.place().s}};
      if (!can_start_in(cell.s)) {
        cells_.push_back(cell);
        continue;
      }
      const double h = cell.hi - cell.lo;
      const double log_width = log_prior(cell.s.width(), h, h);
      Bound bound = bound_of(lo, hi, cell);
      // A cost only grows with more samples: one that was too large before is so now.
      const bool stale = PointScorer::is_stale(lo, nodes) || PointScorer::is_stale(hi, nodes);
      if (stale && bound.log_density + log_width - best_mass_ > -kNegligible) {
        scorer_.refresh(std::array{&lo, &hi}, nodes);
        bound = bound_of(lo, hi, cell);
        changed = changed || (!PointScorer::is_stale(lo, nodes) && !PointScorer::is_stale(hi, nodes));
      }
      // The most mass that the cell can hold, and how far below the best peak's that is, as logarithms.
      const double most = bound.log_density + log_width;
      const double depth = best_mass_ - most;
      const bool negligible = depth > kNegligible;
      cell.steps = bound.rate * h / fit_.widened;
      const bool is_resolved = cell.steps <= kFineStep * (1 + std::max(0.0, depth) / kDepth) &&
                               (h <= narrow || depth > kShallow || is_even(lo, hi, cell.s.width()));
      // A cell at the least width counts as resolved, whatever its density does.
      cell.fine = !negligible && (is_resolved || h <= 2 * least);
      if (!negligible && !cell.fine && count_ + added.size() < most_points_) {
        added.push_back(cell.lo + 0.5 * h);
        // Negligible cells, and those that there is no room to halve: their bound goes to the rest.
      } else if (!cell.fine) {
        rest_ += std::exp(std::min(0.0, most - best_ / heat));
      }
      cells_.push_back(cell);
    }
    changed = split(a, added, nodes) || changed;
  }
  return changed;
}

/// Merges new points into an arc's, both in order of w, and scores them. True: there were new ones.
bool Grid::split(std::size_t arc, std::span<const double> added, const Nodes& nodes) {
  if (added.empty()) return false;
  GridPoints& points = points_[arc];
  GridPoints merged(memory_);
  merged.reserve(points.size() + added.size());
  std::pmr::vector<GridPoint*> fresh(memory_);
  std::size_t next = 0;
  for (GridPointer& point : points) {
    while (next < added.size() && added[next] < point->filter.w()) {
      merged.push_back(point_at(arc, added[next++]));
      fresh.push_back(merged.back().get());
    }
    merged.push_back(std::move(point));
  }
  count_ += added.size();
  points = std::move(merged);
  scorer_.refresh(fresh, nodes);
  return true;
}

/// The mass of each resolved cell, and the sum of all: `log_total_` is of the whole boundary, with all folds.
void Grid::weigh() {
  const double heat = square(fit_.widened);
  double total = 0;
  for (GridCell& cell : cells_) {
    if (!cell.fine) {
      cell.log_density = -std::numeric_limits<double>::infinity();
      continue;
    }
    const Score& lo = points_[cell.arc][cell.first]->score;
    const Score& hi = points_[cell.arc][cell.first + 1]->score;
    const double h = cell.hi - cell.lo;
    const double at_lo = (lo.log_likelihood() - best_) / heat;
    const double at_hi = (hi.log_likelihood() - best_) / heat;
    // Hermite's cubic through both ends, and Simpson's rule. At a kink the slopes mislead: the middle is no further off
    // than a resolved cell allows.
    const double bend = 0.125 * h * (lo.slope - hi.slope) / heat;
    const double most_bend = kMostBend * square(cell.steps);
    const double at_middle = 0.5 * (at_lo + at_hi) + std::clamp(bend, -most_bend, most_bend);
    const double mean = (std::exp(at_lo) + 4 * std::exp(at_middle) + std::exp(at_hi)) / 6;
    cell.log_density = std::log(mean) + log_prior(cell.s.width(), h);
    cell.rise = at_hi - at_lo;
    cell.share = std::exp(cell.log_density) * h;
    total += cell.share;
  }
  // Each fold has the same mass.
  log_total_ = std::log(total * static_cast<double>(folds_));
  // Where so few points are allowed that no cell is resolved, nothing is known.
  rest_ = total > 0 ? std::min(1.0, rest_ / total) : 1;
  if (!(total > 0)) return;
  for (GridCell& cell : cells_) cell.share /= total;
}

/// Until here shares add up to 1 on the first fold: each is divided by the number of folds.
void Grid::unfold() {
  const std::size_t count = cells_.size();
  for (GridCell& cell : cells_) cell.share /= static_cast<double>(folds_);
  cells_.reserve(count * folds_);
  // Copies lie further on by whole folds in w and in s, and share the points of the first.
  for (std::size_t fold = 1; fold < folds_; ++fold) {
    const Shift shift = boundary_->shift(fold);
    for (std::size_t k = 0; k < count; ++k) {
      GridCell cell = cells_[k];
      cell.fold = fold;
      cell.lo += shift.w;
      cell.hi += shift.w;
      cell.s = {cell.s.lo + shift.s, cell.s.hi + shift.s};
      cells_.push_back(cell);
    }
  }
}

/// Each round the fit is that of the likeliest point so far: with it `widened` and the best mass change.
void Grid::resolve(const Nodes& nodes) {
  for (int round = 0; round < kMostRounds; ++round) {
    measure_fit(nodes);
    if (!refine(nodes)) break;
  }
}

/// Whether the first points are to be laid out anew, in one of four cases:
/// - The rows have doubled: as the roll goes on, other places of the boundary decide.
/// - Nodes were joined. The scatter within a joined node costs nothing, so that deviances by the nodes before and after
///   can't be compared.
/// - Half of the room for points is used: none may be left for those that decide now.
/// - No cell is resolved.
bool Grid::is_outgrown(const Nodes& nodes) const {
  const bool has_room = 2 * count_ <= most_points_;
  const auto is_fine = [](const GridCell& cell) { return cell.fine; };
  return !has_room || nodes.rows() >= 2 * laid_out_at_ || nodes.generation() != generation_ ||
         std::none_of(cells_.begin(), cells_.end(), is_fine);
}

void Grid::settle(const Nodes& nodes) {
  scorer_.forget_limit();
  if (is_outgrown(nodes)) {
    lay_out(nodes);
    generation_ = nodes.generation();
    laid_out_at_ = std::max<std::size_t>(1, nodes.rows());
    refresh_all(nodes);
  } else {
    // Points that matter by the rows before: all ends of resolved cells, each once. `refine` looks after the others.
    std::pmr::vector<GridPoint*> ends(memory_);
    for (const GridCell& cell : cells_) {
      if (!cell.fine || cell.fold > 0) continue;
      for (const std::size_t end : {cell.first, cell.first + 1}) {
        GridPoint* point = points_[cell.arc][end].get();
        if (ends.empty() || ends.back() != point) ends.push_back(point);
      }
    }
    scorer_.refresh(ends, nodes);
  }
  trend_ = {};
  resolve(nodes);
  // Of the likeliest point alone, and once it is known: where its innovations drift, more of the boundary matters.
  trend_ = scorer_.trend(best_point(nodes), nodes, traced_);
  if (trend_.sigmas > kExcessSigma) resolve(nodes);
  // What is still there of the layout before is not needed any more.
  spare_.clear();
  measure_fit(nodes);
  weigh();
  measure_scale();
  unfold();
}

/// A resolved cell, or a point whose mass is not negligible beside the rival's.
bool Grid::holds_something(const Nodes& nodes, const Rival& rival) const {
  const auto is_fine = [](const GridCell& cell) { return cell.fine; };
  if (std::any_of(cells_.begin(), cells_.end(), is_fine)) return true;
  for (const GridPoints& arc : points_) {
    for (const GridPointer& point : arc) {
      if (!PointScorer::is_stale(*point, nodes) && log_mass(*point) > rival.log_evidence - kNegligible) return true;
    }
  }
  return false;
}

bool Grid::is_hopeless(const Nodes& nodes, const Rival& rival) {
  // As settle() does, but that cells have to matter next to the rival. What is far off at first is not cut short at
  // what would matter: by how much it is off tells how soon it may be near.
  scorer_.forget_limit();
  lay_out(nodes);
  refresh_all(nodes);
  measure_fit(nodes);
  // `refine` compares with these: the rival's noise, and its evidence in place of the best mass.
  fit_.widened = rival.widened;
  best_mass_ = rival.log_evidence;
  bool holds = holds_something(nodes, rival);
  for (int round = 0; !holds && round < kMostRounds; ++round) {
    const bool goes_on = refine(nodes);
    holds = holds_something(nodes, rival);
    if (!goes_on) break;
  }
  points_.clear();
  spare_.clear();
  cells_.clear();
  return !holds;
}

}  // namespace rollfix::belief
