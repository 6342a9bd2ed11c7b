#include "capi/locator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "belief/posterior.hpp"
#include "locate/remaining.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger.hpp"

// Idea: belief/one keeps all that grows in a memory resource. Here that is a block which is taken once, large enough
// for as many first contacts on trial as the grid may hold, and for two of them each where it is laid out anew.
namespace rollfix::capi {

namespace {

using namespace belief;

// Grids are refined to so many points, besides twice those that they begin with, where they are not told otherwise: a
// few hundred are usual.
constexpr std::size_t kUsualPoints = 1500;

Noise checked(const Part& part, const Noise& noise) {
  require_weighable(noise);
  return noise_on(part, noise);
}

std::size_t points_of(std::size_t given, const TiltedBoundary& boundary, const Part& part) {
  const std::size_t first = most_first_points(boundary);
  if (given == 0) return kUsualPoints + 2 * first;
  if (given >= first) return given;
  throw InputError(fmt::format("points: {} begins with {}, expected at least as many, found {}; 0 takes {}",
                               part.name(), first, given, kUsualPoints + 2 * first));
}

}  // namespace

Locator::LogBelief::LogBelief(Locator& locator)
    : nodes(locator.errors_, locator.boundary_.tilt(), false, most_nodes(locator.part_), true,
            turns_either_way(locator.part_), &locator.pool_),
      grid(locator.boundary_, locator.errors_, locator.options_, locator.part_.boundary(),
           corner_length(0, locator.part_), nullptr, &locator.pool_, locator.points_),
      modes(&locator.pool_) {}

Locator::Locator(const Part& part, const Noise& noise, std::size_t points)
    : part_(part),
      options_{checked(part, noise)},
      errors_(options_, LogKind::increments, 0, part.perimeter()),
      boundary_(tilted(part, errors_, 0)),
      points_(points_of(points, boundary_, part)),
      pool_(bytes_for(points_)) {
  belief_.emplace(*this);
}

// Blocks are up to a quarter larger than what is asked for, and a vector that grows leaves as much behind as it has.
std::size_t Locator::bytes_for(std::size_t points) const {
  constexpr std::size_t kFound = 64 + sizeof(double) * kRolling * (kRolling + 1);  // see RollFilter::again
  constexpr std::size_t kOfPoint = sizeof(GridPoint) + kFound + 8 * sizeof(void*);
  constexpr std::size_t kOfCell = 3 * sizeof(GridCell) + 16 * sizeof(double);  // in cells, runs, and what is credible
  constexpr std::size_t kOfNode = sizeof(Node) + sizeof(JoinedRows) + sizeof(Travel::Mark) + 4 * sizeof(double);
  constexpr std::size_t kOther = std::size_t{1024} * 1024;  // parts of what is credible, of 1e-4 each, and the rest
  const std::size_t cells = points * boundary_.folds();
  const std::size_t nodes = most_nodes(part_) + 2;
  const std::size_t first = most_first_points(boundary_) * sizeof(RollFilter);
  return kOther + 5 * (2 * points * kOfPoint + first) / 4 + 2 * cells * kOfCell + 4 * nodes * kOfNode;
}

template <class Work>
void Locator::use_memory(const Work& work) {
  try {
    work();
  } catch (...) {
    is_used_up_ = true;
    throw;
  }
}

const char* Locator::refusal(double seconds, double distance, double turn) const {
  if (!std::isfinite(distance) || !std::isfinite(turn)) return "expected a finite distance and turn";
  if (!has_times()) return nullptr;
  if (!std::isfinite(seconds)) return "expected a finite time";
  const bool is_later = !belief_->start_time || seconds > *belief_->start_time + belief_->last.seconds;
  return is_later ? nullptr : "expected a time after that of the row before";
}

void Locator::push(double seconds, double distance, double turn) {
  if (!has_times()) seconds = 0;
  const Increment row{seconds, distance, turn};
  if (!belief_->start_time) {
    belief_->start_time = seconds;
    if (has_times() && has_way_to_first(LogKind::increments, distance, turn)) belief_->first = row;
  } else if (belief_->first) {
    const Increment first = *belief_->first;
    restart();
    belief_->start_time = start_before(first.seconds, seconds);
    add(first);
  }
  add(row);
}

void Locator::add(const Increment& row) {
  LogBelief& log = *belief_;
  const Reading sum = in_stored_direction(log.odometer.add({{row.distance, 0}, {row.turn, 0}}), part_);
  log.last = {sum, 0, row.seconds - *log.start_time, sum.turn, {}};
  use_memory([&] { log.nodes.add(log.last); });
}

void Locator::locate() {
  LogBelief& log = *belief_;
  use_memory([&] {
    log.grid.settle(log.nodes);
    log.modes = modes_of(log.grid, {&boundary_, log.last, errors_.row(0), part_.boundary()});
    Remaining remaining;
    remaining.places = how_many_remain(log.modes, &Mode::probability);
    remaining.credible_length = credible_length(log.grid);
    remaining.unresolved = log.grid.rest();
    verdict_ = verdict_of(log.grid.fit(), remaining, part_.boundary());
  });
}

double Locator::rest() const {
  double listed = 0;
  for (const Mode& mode : modes()) listed += mode.probability;
  return std::min(1.0, std::max(0.0, 1 - listed) + belief_->grid.rest());
}

void Locator::restart() {
  belief_.reset();
  pool_.clear();
  is_used_up_ = false;
  verdict_ = {Verdict::unobservable};
  belief_.emplace(*this);
}

}  // namespace rollfix::capi
