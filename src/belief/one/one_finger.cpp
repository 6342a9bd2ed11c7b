#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "belief/one/grid.hpp"
#include "belief/posterior.hpp"
#include "rollfix/turning_function.hpp"

// One finger's posterior: how well the rows fit the likeliest point of the grid, and what they tell of the errors that
// the roll shares; the density along the boundary; and the facade of all of it.
// Notation:
//   w, s            tilted turning of the first contact, the grid's coordinate, and its place: GridPoint, GridCell
//   share           of the mass: in a cell, in a small piece of a mode (MassPiece), or in a DensityPiece
//   cost, volume    -2 log L = cost + log_volume at a point: Score
//   widened         by how much the rows are further off than the noise says: `fit_.widened`
//   eps, gamma, b   scales of lengths and of turns and a gyroscope's bias: `shared_error` 2, 3 and 4
// Follows docs/belief.md, "The computation" and "When the rows fit badly".
// Idea: cells are cut into parts of about the same mass (one finger), or little pieces are counted by steps (two): both
// give a density that is constant on each piece. The fit is that of the likeliest point.
namespace rollfix::belief {
namespace {

// A piece of one finger's density changes by no more than this within it, of a logarithm.
constexpr double kRiseOfPart = 0.05;
// Of two fingers the density along one boundary is told by steps of this many standard deviations of a mode ...
constexpr double kDensityStep = 1.0 / 3;
// ... which are no more than this many.
constexpr double kMostDensitySteps = 300;

// The pieces stand for little squares on a lattice that lies askew to the boundary: counted as points they would make
// ripples with the steps. So each is spread over so many steps on both sides; of too few steps none is.
constexpr double kSpread = 2;
constexpr double kFewestSmoothed = 6;

/// What is held by steps from `lo` on, `inner` of them and those that the spread reaches.
std::vector<double> spread_out(const std::vector<MassPiece>& pieces, std::size_t finger, double lo, double step,
                               std::size_t inner) {
  std::vector<double> held(inner + 2 * static_cast<std::size_t>(kSpread), 0.0);
  // The hat's integral up to x, 0 to 1. A step's share of a piece is the difference between its ends.
  const auto below = [](double x) {  // of a hat over kSpread steps on both sides of 0
    const double at = std::clamp(x / kSpread, -1.0, 1.0);
    return at < 0 ? 0.5 * (1 + at) * (1 + at) : 1 - 0.5 * (1 - at) * (1 - at);
  };
  for (const MassPiece& piece : pieces) {
    const double at = (piece.s[finger] - lo) / step;
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(at - kSpread)));
    for (std::size_t k = begin; k < held.size() && static_cast<double>(k) < at + kSpread; ++k) {
      const double left = static_cast<double>(k) - at;
      held[k] += piece.share * (below(left + 1) - below(left));
    }
  }
  return held;
}

/// With its lower end on the first lap.
DensityPiece piece_on(const Boundary& places, double lo, double hi, double probability) {
  const double at = places.on_first_lap(lo);
  return {{at, at + (hi - lo)}, probability};
}

void sort_by_place(Density& density) {
  std::stable_sort(density.begin(), density.end(),
                   [](const DensityPiece& a, const DensityPiece& b) { return a.s.lo < b.s.lo; });
}

}  // namespace

/// Resolved cells, cut into parts of equal mass: as many as keep the density even within each.
Density density_of(const Grid& grid, const Boundary& places) {
  Density density;
  for (const GridCell& cell : grid.cells()) {
    if (!(cell.share > kLeastShare)) continue;
    // The density changes within a cell: parts of the same mass are even enough.
    const auto parts = static_cast<int>(std::ceil(std::max(1.0, std::abs(cell.rise) / kRiseOfPart)));
    double lo = cell.s.lo;
    for (int k = 1; k <= parts; ++k) {
      const double hi =
          k < parts ? cell.s.lo + cell.s.width() * cell.quantile(static_cast<double>(k) / parts) : cell.s.hi;
      density.push_back(piece_on(places, lo, hi, cell.share / parts));
      lo = hi;
    }
  }
  sort_by_place(density);
  return density;
}

/// Steps of equal width over the range of the pieces, with what each step holds. A range of width 0 is one step.
void add_density(const std::vector<MassPiece>& pieces, const Mode& mode, std::size_t finger, const Boundary& places,
                 Density& density) {
  if (pieces.empty()) return;
  const auto [first, last] = std::minmax_element(
      pieces.begin(), pieces.end(), [&](const MassPiece& a, const MassPiece& b) { return a.s[finger] < b.s[finger]; });
  Interval range{first->s[finger], last->s[finger]};
  const double wanted = range.width() / std::max(kDensityStep * mode.sd[finger], 1e-300);
  const double inner = range.width() > 0 ? std::clamp(std::ceil(wanted), 1.0, kMostDensitySteps) : 1;
  const double step = range.width() / inner;
  std::vector<double> held(static_cast<std::size_t>(inner), 0.0);
  if (step > 0 && inner >= kFewestSmoothed) {
    // The hats of the outermost pieces reach over both ends of the range.
    range.lo -= kSpread * step;
    held = spread_out(pieces, finger, range.lo, step, held.size());
  } else {
    for (const MassPiece& piece : pieces) {
      const double at = step > 0 ? std::floor((piece.s[finger] - range.lo) / step) : 0;
      held[static_cast<std::size_t>(std::clamp(at, 0.0, inner - 1))] += piece.share;
    }
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double lo = range.lo + static_cast<double>(k) * step;
    if (held[k] > 0) density.push_back(piece_on(places, lo, lo + step, held[k]));
  }
  sort_by_place(density);
}

/// The likeliest of those that have taken all rows.
const GridPoint& Grid::best_point(const Nodes& nodes) const {
  const GridPoint* best = nullptr;
  for (const GridPoints& arc : points_) {
    for (const GridPointer& point : arc) {
      if (PointScorer::is_stale(*point, nodes)) continue;
      if (best != nullptr && point->score.log_likelihood() <= best->score.log_likelihood()) continue;
      best = point.get();
    }
  }
  return *best;
}

/// Rows of increments and rows with `correlation` are not looked at for being alike.
double Grid::step_between(const Nodes& nodes) const {
  if (!can_be_alike_) return 0;
  double travelled = 0;
  double last = 0;
  double count = 0;
  const auto pass = [&](const Node& node) {
    travelled += std::abs(node.length - last);
    last = node.length;
    count += 1;
  };
  for (const Node& node : nodes.complete()) pass(node);
  if (const std::optional<Node> pending = nodes.pending()) pass(*pending);
  return count > 0 ? travelled / count : 0;
}

/// The fit at the likeliest point, and with it what cells are compared by: `best_`, `farthest_`, `best_mass_`.
void Grid::measure_fit(const Nodes& nodes) {
  const GridPoint* best = &best_point(nodes);
  best_ = best->score.log_likelihood();
  gathered_ = -0.5 * best->now.log_gathered();
  farthest_ = scorer_.limit() - best->score.log_volume;
  const double freedom = nodes.freedom();
  // Of robust rows by those that are no outliers: their part of the cost, and their number.
  fit_ = options_.robust ? robust_fit_of(best->now.right_cost(), best->now.right_rows(), freedom, best->now.whiteness())
                         : fit_of(best->now.cost(), freedom, best->now.whiteness());
  add_trend(trend_, step_between(nodes), fit_);
  fit_.widened *= scorer_.for_large_slip();
  fit_.prior_sigmas = scorer_.prior_sigmas(*best);
  fit_.turn_gathered = nodes.turn_gathered();
  best_mass_ = log_mass(*best);
}

/// Mean and standard deviation over the whole posterior: the variance at one place, and that of the estimates between
/// places. Each cell counts as the mean of its ends.
Grid::Error Grid::shared_error(int which) const {
  double own = 0;  // for one place
  double mean = 0;
  double square_of = 0;
  for (const GridCell& cell : cells_) {
    if (!cell.fine) continue;
    for (const std::size_t end : {cell.first, cell.first + 1}) {
      const RollFilter& filter = points_[cell.arc][end]->now;
      const double error = filter.errors()[which];
      own += 0.5 * cell.share * filter.covariance()(which, which);
      mean += 0.5 * cell.share * error;
      square_of += 0.5 * cell.share * error * error;
    }
  }
  return {mean, std::sqrt(square(fit_.widened) * own + std::max(0.0, square_of - mean * mean))};
}

/// True lengths are the measured ones divided by 1 + x_2; true turns are the measured ones less x_3 times what a
/// gyroscope measured.
void Grid::measure_scale() {
  const Error of_lengths = shared_error(2);
  const Error of_turns = shared_error(3);
  fit_.length_scale = 1 / (1 + of_lengths.mean);
  fit_.length_scale_sd = of_lengths.sd;
  // Turns are taken off, lengths divided: see RollFilter::corrected.
  fit_.turn_scale = 1 - of_turns.mean;
  fit_.turn_scale_sd = of_turns.sd;
  const Error of_rate = shared_error(4);
  fit_.turn_bias = of_rate.mean;
  fit_.turn_bias_sd = of_rate.sd;
}

/// The sum of |turn| of all spirals over 2 pi: 1 of a convex loop without corners. Corners are left out.
double turns_to_and_fro(const Part& part) {
  double turned = 0;
  for (const Spiral& spiral : part.turning().spirals()) turned += std::abs(spiral.end.angle - spiral.start.angle);
  return turned / (2 * std::numbers::pi);
}

/// kMostNodes, times how often the boundary turns, up to kMostFiner.
std::size_t most_nodes(const Part& part) {
  const double finer = std::clamp(turns_to_and_fro(part), 1.0, kMostFiner);
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
              turns_to_and_fro(part)),
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
