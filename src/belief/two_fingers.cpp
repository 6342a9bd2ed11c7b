#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "belief/pair_density.hpp"
#include "belief/posterior.hpp"

namespace rollfix::belief {

namespace {

// The tangent where a contact is felt is known to this share of the angles' noise.
constexpr double kShareOfAngle = 1e-3;
// Where errors of kFarthest leave nothing good, larger ones are let pass, up to this many standard deviations.
constexpr double kFarthestOfAll = 40;
constexpr double kWider = 3;
// Squares of the search are as long as so many standard deviations of a contact's place.
constexpr double kSquareSigmas = 3;
constexpr double kLargestSquareShare = 1.0 / 128;

/// The peaks that some errors leave.
struct Peaks {
  std::vector<PairPeak> peaks;  // the likeliest first
  double excess = std::numeric_limits<double>::infinity();
  double missed = 1;  // the chance that the true one is not among them
};

class TwoFingersPosterior : public Posterior {
 public:
  TwoFingersPosterior(const Part& part, LogKind kind, const BeliefOptions& options, const Contacts& contacts)
      : part_(part),
        kind_(kind),
        options_(options),
        contacts_(contacts),
        errors_(errors_supposing(Cause::none)),
        boundary_{boundary(0), boundary(1)},
        range_(part_.turning(), kRangeCells) {}

  void add(const Sample& sample) override {
    const Reading& row = sample.reading;
    const bool is_first = rows_.empty() && row.length[0] == 0 && row.length[1] == 0 && row.turn == 0;
    // The first contacts are what the others are measured from; their facing is a row of its own.
    if (is_first && kind_ == LogKind::contact) return;
    rows_.push_back(row);
  }

  std::size_t samples() const override { return rows_.size(); }
  bool has_begun() const override { return !rows_.empty() || contacts_.facing.has_value(); }

  Outcome settle() override {
    const Question question(*this, errors_);
    const Peaks found = peaks_of(question);
    Outcome outcome;
    outcome.excess = found.excess;
    pieces_.clear();
    if (found.peaks.empty()) return outcome;
    const PairDensity density =
        pair_density(question.model, found.peaks, question.nodes, found.excess, {corner(0), corner(1)});
    PairModes modes = modes_of(density, question.model, rows_.empty() ? Reading(0, 0, 0) : rows_.back());
    outcome.modes = std::move(modes.modes);
    pieces_ = std::move(modes.pieces);
    outcome.unresolved = density.rest + found.missed;
    return outcome;
  }

  /// The widest: where one mode goes all the way round, no such roll can tell.
  double credible_length(const std::vector<PerFinger<Interval>>& intervals) const override {
    double most = 0;
    for (const PerFinger<Interval>& each : intervals) most = std::max({most, each[0].width(), each[1].width()});
    return most;
  }

  double variance_of_miss(const std::vector<Reading>& readings, const std::vector<Mode>& modes) const override {
    const TurningFunction& turning = part_.turning();
    double most = contacts_.facing ? errors_.facing_variance() : 0;
    for (const Mode& mode : modes) {
      for (const Reading& reading : readings) {
        double variance = errors_.turn_variance() + errors_.facing_variance();
        for (const std::size_t finger : {0U, 1U}) {
          const auto i = static_cast<Eigen::Index>(finger);
          const double length = reading.length[finger];
          const double kappa = turning.curvature(mode.start[finger] + length);
          const double gain = std::abs(kappa) + errors_.normal_turn(finger);
          variance += gain * gain * (errors_.contact_variance() + errors_.start()(i, i)) +
                      kappa * kappa * errors_.start()(2 + i, 2 + i) * length * length;
        }
        most = std::max(most, variance);
      }
    }
    return most;
  }

  Diagnosis supposing(Cause cause) const override {
    const PairErrors other = errors_supposing(cause);
    const Peaks again = peaks_of(Question(*this, other));
    const PairShared errors = again.peaks.empty() ? PairShared::Zero() : again.peaks.front().score.errors;
    // Of both fingers the one whose lengths are further off.
    const double a = 1 / (1 + errors[2]);
    const double b = 1 / (1 + errors[3]);
    return {cause, again.excess, std::abs(a - 1) >= std::abs(b - 1) ? a : b};
  }

  std::vector<Piece> pieces(std::size_t index, const Mode& /*mode*/) const override {
    std::vector<Piece> pieces = pieces_[index];
    const auto best = std::max_element(pieces.begin(), pieces.end(),
                                       [](const Piece& a, const Piece& b) { return a.share < b.share; });
    if (best == pieces.end()) return pieces;
    const Piece reference = *best;
    pieces.insert(pieces.begin(), reference);
    pieces.front().share = 0;
    return pieces;
  }

 private:
  /// All that hypotheses are held against, with some errors.
  struct Question {
    Question(const TwoFingersPosterior& of, const PairErrors& errors)
        : nodes(pair_nodes(of.rows_, of.contacts_.facing, errors.absolute(), of.options_.robust)) {
      const double accuracy = kShareOfAngle * std::sqrt(errors.turn_variance());
      const PerFinger<double>& curvature = of.contacts_.finger_curvature;
      const bool alike = curvature[0] == curvature[1];
      for (const std::size_t finger : {0U, 1U}) {
        if (finger == 1 && alike) break;
        felt[finger].emplace(of.part_.turning(), errors.contact_sd(), of.corner(finger), errors.normal_turn(finger),
                             accuracy);
      }
      model.errors = &errors;
      model.boundary = {&of.boundary_[0], &of.boundary_[1]};
      model.felt = {&*felt[0], alike ? &*felt[0] : &*felt[1]};
      model.outlier_share = of.options_.robust ? kOutlierShare : 0;
      model.prior = of.options_.prior;
      model.places = of.part_.boundary();
    }
    Question(const Question&) = delete;
    Question& operator=(const Question&) = delete;

    std::vector<PairNode> nodes;
    std::array<std::optional<FeltTurning>, 2> felt;
    PairModel model;
  };

  Peaks peaks_of(const Question& question) const;

  PairErrors errors_supposing(Cause cause) const {
    const PerFinger<double>& curvature = contacts_.finger_curvature;
    return {options_, kind_, {curvature[0], curvature[1]}, contacts_.facing.has_value(), part_.perimeter(), cause};
  }

  TiltedBoundary boundary(std::size_t finger) const {
    const double even = std::sqrt(0.5 * errors_.turn_variance() / errors_.contact_variance());
    return {part_, tilt_of(contacts_.finger_curvature[finger], even, part_), accuracy_of(errors_.contact_sd(), part_)};
  }

  double corner(std::size_t finger) const { return corner_length(contacts_.finger_curvature[finger], part_); }

  Part part_;
  LogKind kind_;
  BeliefOptions options_;
  Contacts contacts_;
  PairErrors errors_;
  std::array<TiltedBoundary, 2> boundary_;
  TurningRange range_;
  std::vector<Reading> rows_;
  std::vector<std::vector<Piece>> pieces_;  // of each mode
};

/// Where the noise is larger than said, what it allows is wider.
Peaks TwoFingersPosterior::peaks_of(const Question& question) const {
  const PairErrors& errors = *question.model.errors;
  const auto freedom = static_cast<double>(question.nodes.size());
  const auto excess = [&](const PairPeak& best) { return excess_of(best.score.cost, freedom, options_.robust); };
  const double resolution =
      std::clamp(kSquareSigmas * errors.contact_sd(), 0.0, kLargestSquareShare * part_.perimeter());
  Peaks found;
  std::vector<PairPeak>& peaks = found.peaks;
  double sigmas = kFarthest;
  while (true) {
    const PairCandidates candidates = pair_candidates(question.model, range_, question.nodes, sigmas, resolution);
    const std::vector<PairPeak> again = pair_peaks(question.model, candidates, question.nodes);
    if (!again.empty() &&
        (peaks.empty() || again.front().score.log_likelihood() >= peaks.front().score.log_likelihood())) {
      peaks = again;
    }
    found.missed = candidates.missed;
    const double needed = peaks.empty() ? kWider * sigmas : kFarthest * excess(peaks.front());
    if (needed <= 1.2 * sigmas || sigmas >= kFarthestOfAll) break;
    sigmas = std::min(kFarthestOfAll, std::max(needed, kWider * sigmas));
  }
  if (peaks.empty()) peaks = pair_peaks(question.model, all_squares(), question.nodes);
  if (!peaks.empty()) found.excess = excess(peaks.front());
  return found;
}

}  // namespace

std::unique_ptr<Posterior> posterior_of_two(const Part& part, LogKind kind, const BeliefOptions& options,
                                            const Contacts& contacts) {
  return std::make_unique<TwoFingersPosterior>(part, kind, options, contacts);
}

}  // namespace rollfix::belief
