#include "corner_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "part/turning_range.hpp"
#include "rollfix/reading.hpp"

// Notation:
//   theta -+ J      what a row on a corner leaves open: its turn and `pivot`
//   Theta(s + L) - Theta(s)   how far the tangent has turned, for all first contacts of a box and all that L may be off
//   z               how far theta -+ J is from that, in standard deviations of two orientations; of the worst row, less
//                   what the farthest of so many is off by chance (Bonferroni)
// Follows docs/rolling.md, "Fingers with corners".
// Idea: the likelihood of a turn that is known to an interval is flat where some of the interval is possible, and falls
// outside as that of any other turn. Rows of one pivot share their errors, so that only the worst of all counts.
namespace rollfix {
namespace {

// A length is off by no more than so many standard deviations.
constexpr double kFarthestLength = 4.5;
// Nor is a place, of which the interval has two.
constexpr double kBeyondInterval = kFarthestLength - 2;
// An interval is looked at in so many pieces, so that what is known of a turn is not lost in how far it is open.
constexpr std::size_t kPieces = 8;
// A place with less probability than this is not listed.
constexpr double kLeastListed = 1e-4;

class RowsOnCorners {
 public:
  RowsOnCorners(const Problem& problem, const LeadingRows& leading, const Observation& observed)
      : turning_(problem.part.turning()), rows_(leading.readings) {
    for (std::size_t k = 0; k < observed.on_corners.size(); ++k) {
      if (observed.on_corners[k]) rows_.push_back(observed.rolls[k]);
    }
    const Noise noise = noise_on(problem.part, *problem.noise);
    contact_ = std::numbers::sqrt2 * noise.contact;
    turn_ = std::hypot(std::numbers::sqrt2 * noise.angle, noise.part.turn);
    scale_ = std::hypot(noise.slip, noise.part.length);
    for (const Finger& finger : problem.fingers) scale_ = std::hypot(scale_, noise.radius * finger.curvature(0));
    // A contact that is felt beside where it is has another normal on a disk.
    for (const Finger& finger : problem.fingers) turn_ = std::hypot(turn_, contact_ * finger.curvature(0));
  }

  bool empty() const { return rows_.empty(); }

  /// z, where the placement may be it is least.
  double sigmas(const Placement& placement) const {
    const std::size_t fingers = placement.interval.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < (fingers == 1 ? kPieces : kPieces * kPieces) && least > 0; ++k) {
      PerFinger<Interval> box = placement.interval;
      std::size_t piece = k;
      for (const std::size_t finger : {0U, 1U}) {
        if (finger == fingers) break;
        Interval& side = box[finger];
        const double beyond = kBeyondInterval * placement.sd[finger];
        side = {side.lo - beyond, side.hi + beyond};
        const double width = side.width() / kPieces;
        side.lo += width * static_cast<double>(piece % kPieces);
        side.hi = side.lo + width;
        piece /= kPieces;
      }
      least = std::min(least, worst(box));
    }
    return least;
  }

 private:
  double worst(const PerFinger<Interval>& box) const {
    double most = 0;
    for (const Reading& row : rows_) most = std::max(most, gap(row, box) / turn_);
    return std::sqrt(std::max(0.0, most * most - 2 * std::log(static_cast<double>(rows_.size()))));
  }

  /// From the turns that a row leaves open to those from this box.
  double gap(const Reading& row, const PerFinger<Interval>& box) const {
    Interval turn = turns(row, box, 0);
    if (box.size() == 2) {
      const Interval of_b = turns(row, box, 1);
      turn = {turn.lo - of_b.hi, turn.hi - of_b.lo};
    }
    return std::max({0.0, row.turn - row.pivot - turn.hi, turn.lo - row.turn - row.pivot});
  }

  Interval turns(const Reading& row, const PerFinger<Interval>& box, std::size_t finger) const {
    const double length = row.length[finger];
    const double off = kFarthestLength * std::hypot(contact_, scale_ * length);
    const Interval from = angles_over(turning_, on_part(box[finger]));
    const Interval to = angles_over(turning_, on_part({box[finger].lo + length - off, box[finger].hi + length + off}));
    return {to.lo - from.hi, to.hi - from.lo};
  }

  /// Beyond the ends of an open boundary there is nothing.
  Interval on_part(const Interval& arc) const {
    const Boundary& boundary = turning_.boundary();
    const auto on = [&](double s) { return boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter); };
    return {on(arc.lo), on(arc.hi)};
  }

  const TurningFunction& turning_;
  std::vector<Reading> rows_;
  double contact_ = 0;
  double turn_ = 0;
  double scale_ = 0;
};

/// Rows may be anything, or what turns are off by gathers on the way: that is the posterior's matter.
bool is_beyond(const Problem& problem) {
  const Noise& noise = *problem.noise;
  return problem.robust || noise.drift > 0 || noise.walk > 0 || noise.gyro > 0;
}

}  // namespace

CornerRowsSay weigh_corner_rows(const Problem& problem, const LeadingRows& leading, const Observation& observed,
                                Answer& answer) {
  const RowsOnCorners rows(problem, leading, observed);
  if (rows.empty() || is_beyond(problem) || answer.placements.empty()) return {};
  std::vector<double> squares;
  for (const Placement& placement : answer.placements) squares.push_back(std::pow(rows.sigmas(placement), 2));
  const double least = *std::min_element(squares.begin(), squares.end());
  if (*std::max_element(squares.begin(), squares.end()) == 0) return {};
  answer.weighing->evidence.volume -= 0.5 * least;
  std::vector<Placement> listed;
  for (std::size_t k = 0; k < squares.size(); ++k) {
    Placement& placement = answer.placements[k];
    placement.probability *= std::exp(-0.5 * (squares[k] - least));
    (placement.probability < kLeastListed ? answer.weighing->improbable : listed).push_back(std::move(placement));
  }
  std::stable_sort(listed.begin(), listed.end(),
                   [](const Placement& a, const Placement& b) { return a.probability > b.probability; });
  answer.placements = std::move(listed);
  answer.dropped.improbable = answer.weighing->improbable.size();
  return {true, least > Fit::kMostSigmas * Fit::kMostSigmas};
}

}  // namespace rollfix
