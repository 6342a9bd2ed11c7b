#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "belief/one/grid.hpp"
#include "belief/posterior.hpp"
#include "rollfix/turning_function.hpp"

// One finger's posterior: the facade of the grid, its modes and its density.
// Notation:
//   w, s            tilted turning of the first contact, the grid's coordinate, and its place: GridPoint, GridCell
//   c               the tilt of w = Theta + c s: `even`
// Follows docs/belief.md, "The computation".
namespace rollfix::belief {

/// The sum of |turn| of all spirals over 2 pi: 1 of a convex loop without corners. Corners are left out.
double turns_either_way(const Part& part) {
  double turned = 0;
  for (const Spiral& spiral : part.turning().spirals()) turned += std::abs(spiral.end.angle - spiral.start.angle);
  return turned / (2 * std::numbers::pi);
}

/// kMostNodes, times how often the boundary turns, up to kMostFiner.
std::size_t most_nodes(const Part& part) {
  const double finer = std::clamp(turns_either_way(part), 1.0, kMostFiner);
  return static_cast<std::size_t>(finer * static_cast<double>(kMostNodes));
}

TiltedBoundary tilted(const Part& part, const ErrorModel& errors, double curvature) {
  const RowCovariance own = errors.row(curvature);
  // The tilt c at which an error of length counts as much in w as one of angle: c sd_L = sd_theta.
  const double even = std::sqrt(own.turn / own.length);
  return {part, tilt_of(curvature, even, part), accuracy_of(std::sqrt(own.length), part)};
}

namespace {

/// Where a finger's centre was felt at the first contact, if it was, and where that contact's normal points: N(u) +
/// psi.
struct FirstCentre {
  FeltCentre felt;
  bool has_place = false;
  double normal = 0;
};

/// What decides how a finger's samples are weighed; from the first one on.
struct OneFingersGrid {
  /// `first`: where the finger's centre was felt at the first contact, with the contact's normal; nothing where centres
  /// are not looked at.
  OneFingersGrid(const Part& part, LogKind kind, const BeliefOptions& options, double curvature,
                 const std::optional<FirstCentre>& first)
      : finger_curvature(curvature),
        errors(options, kind, curvature, part.perimeter()),
        path(first && first->has_place && options.noise.position > 0 ? std::make_unique<BoundaryPath>(part) : nullptr),
        has_first(first.has_value()),
        centres(model(part, first)),
        boundary(tilted(part, errors, curvature)),
        nodes(errors, boundary.tilt(), options.robust, options.nodes.value_or(most_nodes(part)), !options.by_rows,
              turns_either_way(part)),
        grid(boundary, errors, options, part.boundary(), corner_length(curvature, part), has_first ? &centres : nullptr,
             std::pmr::get_default_resource(), options.by_rows ? kMostPointsToWeigh : kMostPoints) {}
  OneFingersGrid(const OneFingersGrid&) = delete;
  OneFingersGrid& operator=(const OneFingersGrid&) = delete;

  /// Empty where no first contact is known. `path` is null where centres are no evidence.
  CentreModel model(const Part& part, const std::optional<FirstCentre>& first) const {
    if (!first) return {};
    return {&part,
            path.get(),
            first->has_place,
            first->felt,
            first->normal,
            errors.centre_variance(),
            errors.radius_share(finger_curvature)};
  }

  double finger_curvature;  // at the first contact
  ErrorModel errors;
  std::unique_ptr<BoundaryPath> path;  // where centres are evidence
  bool has_first;
  CentreModel centres;
  TiltedBoundary boundary;
  Nodes nodes;
  Grid grid;
};

/// The facade: samples become rows, and the grid exists from the first sample on, which tells the finger's curvature.
class OneFingersPosterior : public Posterior {
 public:
  OneFingersPosterior(const Part& part, LogKind kind, const BeliefOptions& options, const FingerGeometry& contacts)
      : part_(part), kind_(kind), options_(options), contacts_(contacts) {}

  void add(const Sample& sample) override {
    require_times(options_.noise, sample.time.has_value(), "the samples");
    if (!state_) {
      begin(sample, sample.time.value_or(0));
      // Row 1 of a log of contacts is what all others are measured from: it says nothing by itself.
      if (kind_ != LogKind::contact) take(sample);
      // A first row that is not the start took some time, which only the second row tells.
      if (gathers_by_time() && has_way_to_first(kind_, sample.reading.length[0], sample.reading.turn)) first_ = sample;
      return;
    }
    // Now it is known how long the first row took: all begins once more, with that.
    if (first_) {
      begin(*first_, start_before(*first_->time, *sample.time));
      take(*first_);
      first_.reset();
    }
    take(sample);
  }

  std::size_t samples() const override { return state_ ? state_->nodes.rows() : 0; }
  bool has_begun() const override { return samples() > 0; }

  Outcome settle() override {
    if (!has_begun()) return {};
    state_->grid.settle(state_->nodes);
    const ModeQuestion question{&state_->boundary, last_, state_->errors.row(last_.finger_curvature), part_.boundary()};
    const auto modes = modes_of(state_->grid, question);
    return {{modes.begin(), modes.end()}, state_->grid.fit(), state_->grid.evidence(), state_->grid.rest()};
  }

  bool is_hopeless(const Rival& rival) override {
    return has_begun() && state_->grid.is_hopeless(state_->nodes, rival);
  }

  double credible_length(const std::vector<PerFinger<Interval>>& /*intervals*/) const override {
    return belief::credible_length(state_->grid);
  }

  /// Of the last sample, at the ends of the modes: f = Theta(s + L) - Theta(s) - theta is off by kappa dL - dtheta.
  double variance_of_miss(const std::vector<Reading>& /*readings*/, const std::vector<Mode>& modes) const override {
    const SharedCovariance& shared = state_->errors.start();
    const RowCovariance own = state_->errors.row(last_.finger_curvature);
    double most = 0;
    for (const Mode& mode : modes) {
      const double kappa = part_.turning().curvature(mode.end[0]);
      // f is off by the turn's error less kappa times the length's.
      Shared by_error = Shared::Zero();
      by_error.head<kRolling>() << -kappa, 1, -kappa * last_.reading.length[0], last_.sensed, last_.seconds;
      // What a taught part's outline is off by over that length.
      const double gathered = square(options_.noise.part.walk) * std::abs(last_.reading.length[0]);
      const double variance =
          by_error.dot(shared * by_error) + gathered + own.turn - 2 * kappa * own.both + kappa * kappa * own.length;
      most = std::max(most, variance);
    }
    return most;
  }

  std::vector<MassPiece> pieces(std::size_t /*index*/, const Mode& mode) const override {
    std::vector<MassPiece> pieces;
    // First the mode's own start, with no share: poses are compared with its pose.
    pieces.push_back({mode.start, mode.tangent});
    for (MassPiece& piece : pieces_of(state_->grid, state_->boundary)) {
      if (part_.boundary().contains(mode.region[0], piece.s[0])) pieces.push_back(std::move(piece));
    }
    if (pieces.size() > 1) pieces.front().pose = pieces[1].pose;
    return pieces;
  }

  std::vector<PosePiece> pose_pieces() const override {
    return state_->has_first ? pose_pieces_of(state_->grid, state_->boundary) : std::vector<PosePiece>{};
  }

  PerFinger<Density> density(const std::vector<Mode>& /*modes*/) const override {
    return has_begun() ? density_of(state_->grid, part_.boundary()) : Density{};
  }

 private:
  /// Errors of turns grow with time: then `add` requires that every sample has a time.
  bool gathers_by_time() const { return options_.noise.drift > 0 || options_.noise.walk > 0; }
  /// Makes the grid anew for a roll that starts at this time.
  void begin(const Sample& first, double time) {
    std::optional<FirstCentre> centre;
    if (const auto felt = felt_centre(first)) {
      centre = FirstCentre{*felt, first.centre.has_value(),
                           normal_direction(contacts_.fingers.front(), (*first.contact)[0])};
    }
    state_.emplace(part_, kind_, options_, first.finger_curvature[0], centre);
    first_time_ = time;
    if (first.contact) first_psi_ = (*first.contact)[0].psi;
    last_ = row_of(first);
  }
  void take(const Sample& sample) {
    last_ = row_of(sample);
    state_->nodes.add(last_);
  }
  Row row_of(const Sample& sample) const {
    return {sample.reading, sample.finger_curvature[0], sample.time.value_or(0) - first_time_, sensed(sample),
            felt_centre(sample).value_or(FeltCentre{})};
  }
  /// Nothing where the finger is not known, or what it felt.
  std::optional<FeltCentre> felt_centre(const Sample& sample) const {
    if (kind_ != LogKind::contact || !sample.contact || contacts_.fingers.empty()) return std::nullopt;
    const Vec2 centre = sample.centre ? (*sample.centre)[0] : Vec2(0, 0);
    return FeltCentre{centre, arm_of(contacts_.fingers.front(), (*sample.contact)[0].u)};
  }
  /// Of a log of u and psi psi alone is a gyroscope's, else the turn.
  double sensed(const Sample& sample) const {
    if (kind_ != LogKind::contact) return sample.reading.turn;
    return sample.contact ? (*sample.contact)[0].psi - first_psi_ : 0;
  }

  Part part_;
  LogKind kind_;
  BeliefOptions options_;
  FingerGeometry contacts_;
  std::optional<OneFingersGrid> state_;
  std::optional<Sample> first_;  // until it is known how long it took
  Row last_;                     // the last sample, as a row
  double first_time_ = 0;        // of the roll's start
  double first_psi_ = 0;         // psi of the first sample, radians
};

}  // namespace

std::unique_ptr<Posterior> posterior_of_one(const Part& part, LogKind kind, const BeliefOptions& options,
                                            const FingerGeometry& contacts) {
  return std::make_unique<OneFingersPosterior>(part, kind, options, contacts);
}

}  // namespace rollfix::belief
