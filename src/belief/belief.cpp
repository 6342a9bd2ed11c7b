#include "rollfix/belief/belief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "belief/error_model.hpp"
#include "belief/grid.hpp"
#include "belief/modes.hpp"
#include "belief/nodes.hpp"
#include "belief/policy.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

namespace {

using namespace belief;

// Even the only place is not known where it holds more than this share of the boundary.
constexpr double kWide = 0.1;
void require_valid(const BeliefOptions& options) {
  const Noise& noise = options.noise;
  rollfix::require_valid(noise);
  if (noise.contact <= 0 && noise.angle <= 0) {
    throw InputError(
        "noise: expected a standard deviation of the contact or of the angle above 0, found neither; without noise "
        "there is nothing to be unsure of");
  }
  if (options.prior &&
      !(std::isfinite(options.prior->s) && std::isfinite(options.prior->sd) && options.prior->sd > 0)) {
    throw InputError(fmt::format("prior: expected a place and a standard deviation above 0, found {} and {}",
                                 options.prior->s, options.prior->sd));
  }
}

}  // namespace

struct Belief::State {
  Part part;
  LogKind kind;
  BeliefOptions options;
  // From the first sample on: the tilt is the finger's curvature.
  std::optional<belief::TiltedBoundary> boundary;
  std::optional<belief::ErrorModel> errors;
  std::optional<belief::Nodes> nodes;
  std::optional<belief::Grid> grid;
  Sample last;
  double first_curvature = 0;  // of the finger where it first touched
  std::size_t settled_at = 0;
  std::vector<Mode> modes;

  void begin(double finger_curvature);
  double corner_length() const;
  Diagnosis explain(Cause cause) const;
  void settle();
};

void Belief::State::begin(double finger_curvature) {
  const double P = part.perimeter();
  first_curvature = finger_curvature;
  errors.emplace(options, kind, finger_curvature, P);
  // The tilt: a disk's curvature; else what makes lengths and angles, as uncertain as they are, count alike.
  const belief::RowCovariance own = errors->row(finger_curvature);
  const double even = std::max(std::sqrt(own.turn / own.length), 8 * std::numbers::pi / P);
  const double tilt = finger_curvature > 0 ? finger_curvature : std::min(even, 1e6 / P);
  const double accuracy = std::max(kShareOfPerimeter * P, kShareOfNoise * std::sqrt(own.length));
  boundary.emplace(part, tilt, std::min(accuracy, 1e-4 * P));
  nodes.emplace(*errors, boundary->tilt(), options.robust);
  grid.emplace(*boundary, *errors, options, part.boundary(), corner_length());
}

// A finger's centre goes along the boundary and, about a corner, along an arc of the finger's radius: what comes to
// touch by chance touches there in proportion. A flat finger, or none that is known, stands for one as large as the
// part.
double Belief::State::corner_length() const {
  const double curvature = last.finger_curvature;
  return curvature > 0 ? 1 / curvature : part.perimeter() / (2 * std::numbers::pi);
}

// With other errors the samples' nodes stay what they are; what the rows gather is looked at by lengths alone.
Diagnosis Belief::State::explain(Cause cause) const {
  const belief::ErrorModel other(options, kind, first_curvature, part.perimeter(), cause);
  belief::Nodes again(other, boundary->tilt(), options.robust);
  Sample sample = last;
  for (const belief::Node& node : nodes->complete()) {
    sample.reading = {node.length, node.turn};
    again.add(sample);
  }
  belief::Grid grid_again(*boundary, other, options, part.boundary(), corner_length());
  grid_again.settle(again);
  return {cause, grid_again.excess(), 1 / (1 + grid_again.best().now.errors()[2])};
}

void Belief::State::settle() {
  if (!nodes || nodes->rows() == settled_at) return;
  grid->settle(*nodes);
  settled_at = nodes->rows();
  modes =
      modes_of(*grid, {&*boundary, last.reading, errors->row(last.finger_curvature), part.perimeter(), part.closed()});
}

Belief::Belief(const Part& part, LogKind kind, const BeliefOptions& options)
    : state_(std::make_unique<State>(State{part, kind, options, {}, {}, {}, {}, {}, 0, 0, {}})) {
  require_valid(options);
}
Belief::~Belief() = default;
Belief::Belief(Belief&&) noexcept = default;
Belief& Belief::operator=(Belief&&) noexcept = default;

void Belief::add(const Sample& sample) {
  const bool is_first = !state_->nodes;
  state_->last = sample;
  if (is_first) state_->begin(sample.finger_curvature);
  // Row 1 of a log of contacts is what all others are measured from: it says nothing by itself.
  if (is_first && state_->kind == LogKind::contact) return;
  state_->nodes->add(sample);
}

std::size_t Belief::samples() const { return state_->nodes ? state_->nodes->rows() : 0; }

const std::vector<Mode>& Belief::modes() {
  state_->settle();
  return state_->modes;
}

double Belief::rest() {
  state_->settle();
  double listed = 0;
  for (const Mode& mode : state_->modes) listed += mode.probability;
  return std::max(0.0, 1 - listed) + (state_->grid ? state_->grid->rest() : 0);
}

double Belief::excess() {
  state_->settle();
  return state_->grid ? state_->grid->excess() : 1;
}

std::vector<Mass> Belief::mass() {
  state_->settle();
  if (!state_->grid) return {};
  return belief::mass_of(*state_->grid, *state_->boundary, state_->part.perimeter());
}

double Belief::tolerance() {
  state_->settle();
  if (!state_->grid) return std::numbers::pi;
  const TurningFunction& turning = state_->part.turning();
  const belief::SharedCovariance& shared = state_->errors->start();
  const belief::RowCovariance own = state_->errors->row(state_->last.finger_curvature);
  const double length = state_->last.reading.length;
  double most = 0;
  for (const Mode& mode : state_->modes) {
    const double kappa = turning.curvature(mode.end);
    // f is off by the turn's error less kappa times the length's.
    const Eigen::Vector3d by_error(-kappa, 1, -kappa * length);
    const double variance =
        by_error.dot(shared * by_error) + own.turn - 2 * kappa * own.both + kappa * kappa * own.length;
    most = std::max(most, variance);
  }
  return kFarthest * std::min(excess(), kMostExcess) * std::sqrt(most);
}

Diagnosis Belief::diagnosis() {
  if (!(excess() > kMostExcess)) return {Cause::none, excess(), 1};
  return likelier(state_->explain(Cause::radius), state_->explain(Cause::slip), excess());
}

std::string Belief::verdict() { return verdict_on(modes()); }

std::string Belief::verdict_on(const std::vector<Mode>& modes) {
  state_->settle();
  if (!state_->grid) return "unobservable";
  if (excess() > kMostExcess || modes.empty()) return "inconsistent";
  if (state_->part.closed() && credible_length(*state_->grid) > 0.9 * kCertain * state_->part.perimeter()) {
    return "unobservable";
  }
  std::size_t count = 0;
  for (const Mode& mode : modes) count += mode.probability >= kCounts ? 1 : 0;
  if (count > 1 && modes.front().probability < kCertain) return fmt::format("ambiguous ({})", count);
  const bool is_wide = credible_length(*state_->grid) > kWide * state_->part.perimeter();
  return is_wide ? "ambiguous (1 stretch)" : "unique";
}

}  // namespace rollfix
