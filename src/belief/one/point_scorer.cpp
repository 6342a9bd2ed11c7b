#include "belief/one/grid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "belief/posterior.hpp"
#include "outline/turn.hpp"

// Notation:
//   w               tilted turning of the first contact on trial: GridPoint::filter
//   -2 log L        `cost + log_volume` of its filter, with what the priors add: Score
//   dL/dw, F        `slope` of log L and `information`
//   d               the root of the deviance: a point beyond `kBeyondMatter` of what can matter takes no more rows
// Follows docs/belief.md, "The computation": the prior of s, of the pose, and the order in which first points are
// looked at.
// Idea: deviances only grow with rows, so that a point beyond the limit need not take the rest. Likely points go first,
// for then the limit is low early; several filters run side by side (side_by_side.cpp).
namespace rollfix::belief {

namespace {

// So many of the nodes tell which of the first points to look at first.
constexpr std::size_t kTrialNodes = 6;
// What can matter has a deviance no more than this above the best's, ...
constexpr double kMatters = 50;
// ... and a point that is farther than that by this distance, the deviance's root, takes no more samples: what is near
// it can't matter either. A distance, for it is that which changes evenly from point to point, however many samples
// there are.
constexpr double kBeyondMatter = 5;
// Where angles are so noisy that a row is not linear in what all rows share, it is gone through so many times.
constexpr int kPassesOfWide = 3;
// ... unless contacts move by no more than this with what they share, radians: the lines would be the same ones, for a
// kink is felt over what an angle is off, 20 times as far.
constexpr double kSettledTurn = 1e-3;
// What a prior narrower than this share of the boundary leaves of a cell is known without looking into it, and must be:
// else the distance that it is off, many of its standard deviations, hides that the rows alone change slowly, and cells
// all around are split down to its width.
constexpr double kNarrowPrior = 0.01;

/// A copy of these values in a memory resource.
std::pmr::vector<double> in(std::pmr::memory_resource* memory, std::span<const double> values = {}) {
  return {values.begin(), values.end(), memory};
}

/// By the rows alone.
Score score_of(const RollFilter& filter) {
  return {filter.cost(), filter.log_volume(), filter.slope(), filter.information(), filter.steepness()};
}

/// A pose prior as one sample more: the pose of the filter less the prior's, with both covariances. By the heading
/// alone where no place is known.
Score score_of(const PosePrior& prior, const RollFilter& filter) {
  Eigen::Vector3d by_w;
  const PoseSpread pose = filter.pose(&by_w);
  const Eigen::Vector3d off(pose.mean.x - prior.mean.x, pose.mean.y - prior.mean.y,
                            nearest_angle(pose.mean.heading - prior.mean.heading));
  Eigen::Matrix3d precision = Eigen::Matrix3d::Zero();
  if (std::isfinite(prior.place_sd)) {
    Eigen::Matrix3d variance = pose.covariance;
    variance.diagonal() += Eigen::Vector3d(square(prior.place_sd), square(prior.place_sd), square(prior.heading_sd));
    precision = variance.inverse();
  } else {
    precision(2, 2) = 1 / (pose.covariance(2, 2) + square(prior.heading_sd));
  }
  return {off.dot(precision * off), 0, -off.dot(precision * by_w), by_w.dot(precision * by_w)};
}

}  // namespace

PointScorer::PointScorer(const TiltedBoundary& boundary, const ErrorModel& errors, const BeliefOptions& options,
                         const Boundary& places, const CentreModel* centres, std::pmr::memory_resource* memory)
    : tilt_(boundary.tilt()),
      centres_(centres),
      errors_(errors),
      options_(options),
      outliers_{options.robust ? kOutlierShare : 0, places.perimeter},
      memory_(memory),
      places_(places) {}

/// Before any row, with P0.
RollFilter PointScorer::fresh_filter(const TiltedArc& arc, double w) const {
  return {arc, tilt_, w, errors_.start(), centres_};
}

/// Stale: its number of rows is one that no roll has.
GridPoint PointScorer::make(const TiltedArc& arc, double w) const {
  const RollFilter fresh = fresh_filter(arc, w);
  return {fresh, 0, 0, 0, static_cast<std::size_t>(-1), fresh, {}};
}

void PointScorer::refresh(std::span<GridPoint* const> points, const Nodes& nodes) {
  const PendingNodes pending = nodes.pending();
  auto next = points.begin();
  // First what is left of a lane's own point, then the next point that is stale or of nodes that are no more.
  const auto next_of_all = [&](FilterRun& run) {
    if (run.point != nullptr && next_run(run, nodes, pending)) return true;
    for (; next != points.end(); ++next) {
      if (!is_stale(**next, nodes) && (*next)->generation == nodes.generation()) continue;
      run = first_run(**next++, nodes);
      return true;
    }
    return false;
  };
  run_filters(std::ref(next_of_all), equations(), limit_, outliers_);
}

void PointScorer::refresh_likely_first(std::span<GridPoint* const> points, const Nodes& nodes) {
  const std::pmr::vector<Node> trial = some_of(nodes.complete(), kTrialNodes);
  std::pmr::vector<RollFilter> filters(memory_);
  filters.reserve(points.size());
  for (const GridPoint* point : points) filters.push_back(fresh_filter(*point->filter.arc(), point->filter.w()));
  // All take the trial nodes, however far off they are: only their order matters.
  std::size_t begun = 0;
  const auto next = [&](FilterRun& run) {
    if (begun == filters.size()) return false;
    run = {points[begun], 1, &filters[begun], trial.data(), trial.data() + trial.size(), true};
    ++begun;
    return true;
  };
  run_filters(std::ref(next), equations(), limit_, outliers_);
  std::pmr::vector<std::size_t> order(points.size(), memory_);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return filters[a].deviance() < filters[b].deviance(); });
  std::pmr::vector<GridPoint*> ordered(memory_);
  ordered.reserve(points.size());
  for (const std::size_t k : order) ordered.push_back(points[k]);
  refresh(ordered, nodes);
}

/// The complete nodes that the point has not taken. One of an older generation begins anew.
FilterRun PointScorer::first_run(GridPoint& point, const Nodes& nodes) const {
  if (point.generation != nodes.generation()) {
    point = make(*point.filter.arc(), point.filter.w());
    point.generation = nodes.generation();
  }
  const std::pmr::vector<Node>& complete = nodes.complete();
  return {&point, 1, &point.filter, complete.data() + point.taken, complete.data() + complete.size()};
}

bool PointScorer::next_run(FilterRun& run, const Nodes& nodes, const PendingNodes& pending) {
  GridPoint& point = *run.point;
  const std::pmr::vector<Node>& complete = nodes.complete();
  const Node* last = complete.data() + complete.size();
  // The complete nodes are over: `filter` stays as it is for the rows to come, and `now` goes on from it.
  if (run.filter == &point.filter) {
    point.taken = static_cast<std::size_t>(run.next - complete.data());
    point.now = point.filter;
    point.score = score_of(point.now);
    point.deviance = point.score.cost + point.score.log_volume;
    point.rows = static_cast<std::size_t>(-1);
    // It stopped beyond the limit: stale, with a deviance that is a bound.
    if (run.next != last) return false;
  }
  // What follows is few rows or a pass that must be whole to count.
  run.filter = &point.now;
  run.whole = true;
  // What is still filling is taken last, by `now` alone.
  if (!pending.empty() && run.end == last) {
    run.next = pending.data();
    run.end = run.next + pending.size();
    return true;
  }
  // Wide angles: all nodes once more, about what this pass has found.
  if (errors_.is_wide() && run.pass < kPassesOfWide && !point.now.is_settled(kSettledTurn, run.end[-1].seconds)) {
    ++run.pass;
    point.now = point.now.again(errors_.start(), memory_);
    run.next = complete.data();
    run.end = last;
    return true;
  }
  score(point, nodes);
  return false;
}

/// Brings a point's score up to date: its rows and the priors. The volume is the rows' alone.
void PointScorer::score(GridPoint& point, const Nodes& nodes) {
  point.rows = nodes.rows();
  point.score = score_of(point.now);
  const auto add = [&](const Score& prior) {
    point.score.cost += prior.cost;
    point.score.slope += prior.slope;
    point.score.information += prior.information;
    point.score.steepness += prior.information;
  };
  if (options_.prior) add(prior_at(point.now.place()));
  if (options_.pose) add(score_of(*options_.pose, point.now));
  lower_limit(point.score.cost + point.score.log_volume, nodes);
}

void PointScorer::lower_limit(double deviance, const Nodes& nodes) {
  // As if this were the best: its own noise, were it larger than is given, makes all others matter the more.
  // Taken as the deviance to expect: one for each node, and one for the rows of the node that is still filling.
  const auto freedom = static_cast<double>(nodes.complete().size() + 1);
  const double noisier = std::max(1.0, deviance / freedom);
  const double farthest = std::sqrt(std::max(0.0, deviance) + kMatters * noisier) + kBeyondMatter * std::sqrt(noisier);
  limit_ = std::min(limit_, square(farthest));
}

/// Runs a filter that keeps its innovations through the nodes, or on from where it was when the last time was asked. Of
/// wide angles always from the start, about what all rows found.
Trend PointScorer::trend(const GridPoint& point, const Nodes& nodes, std::optional<Traced>& traced) const {
  const bool goes_on = traced && !errors_.is_wide() && traced->filter.arc() == point.filter.arc() &&
                       traced->filter.w() == point.filter.w() && traced->generation == nodes.generation();
  if (!goes_on) {
    // About the offset of turn that the last pass was taken about, or one as good.
    const RollFilter& filter = point.filter;
    traced.emplace(
        Traced{errors_.is_wide() ? point.now.again(errors_.start(), memory_) : fresh_filter(*filter.arc(), filter.w()),
               0, nodes.generation(), Innovations{in(memory_), in(memory_), in(memory_)}});
    traced->filter.record_to(traced->innovations);
  }
  // One run, whole, by itself.
  const auto take = [&](RollFilter& filter, const Node* from, const Node* end) {
    bool is_begun = false;
    const auto once = [&](FilterRun& run) {
      run = {nullptr, 1, &filter, from, end, true};
      return !std::exchange(is_begun, true) && from != end;
    };
    run_filters(std::ref(once), equations(), limit_, outliers_);
  };
  const std::pmr::vector<Node>& complete = nodes.complete();
  take(traced->filter, complete.data() + traced->taken, complete.data() + complete.size());
  traced->taken = complete.size();
  const PendingNodes pending = nodes.pending();
  if (pending.empty()) return trend_of(traced->innovations, nodes.freedom());
  // It will change: what it adds is not kept.
  Innovations all{in(memory_, traced->innovations[0]), in(memory_, traced->innovations[1]),
                  in(memory_, traced->innovations[2])};
  RollFilter now = traced->filter;
  now.record_to(all);
  take(now, pending.data(), pending.data() + pending.size());
  return trend_of(all, nodes.freedom());
}

/// The cost (s - s_prior)^2 / sd^2, with the slope of -cost / 2 by w and the information; ds/dw is 0 in a corner.
Score PointScorer::prior_at(const TiltedPlace& place) const {
  const double precision = 1 / square(options_.prior->sd);
  const double off = places_.offset(options_.prior->s, place.s);
  return {square(off) * precision, 0, -off * place.slope * precision, square(place.slope) * precision};
}

bool PointScorer::has_narrow_prior() const {
  return options_.prior && options_.prior->sd <= kNarrowPrior * places_.perimeter;
}

Score PointScorer::narrow_prior(const GridPoint& point) const {
  return has_narrow_prior() ? prior_at(point.now.place()) : Score{};
}

double PointScorer::least_narrow_cost(const Interval& s) const {
  if (!has_narrow_prior()) return 0;
  // No place of the interval is nearer than its middle, less half of its width.
  const double off = std::abs(places_.offset(options_.prior->s, s.middle())) - 0.5 * s.width();
  return off > 0 ? square(off / options_.prior->sd) : 0;
}

double PointScorer::prior_sigmas(const GridPoint& point) const {
  double sigmas = 0;
  if (options_.prior) {
    sigmas = std::abs(places_.offset(options_.prior->s, point.now.place().s)) / options_.prior->sd;
  }
  if (options_.pose) sigmas = std::max(sigmas, std::sqrt(score_of(*options_.pose, point.now).cost));
  return sigmas;
}

}  // namespace rollfix::belief
