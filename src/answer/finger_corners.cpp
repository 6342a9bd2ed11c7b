#include "steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "belief/error_model.hpp"
#include "locate/remaining.hpp"
#include "locate/searches.hpp"
#include "outline/turn.hpp"
#include "part/turning_range.hpp"
#include "rollfix/error.hpp"
#include "rollfix/reading.hpp"

// Notation:
//   N, u, psi       normal of the finger in its frame, contact on it, orientation; at a corner N is in [N-, N+]
//   leading         the rows at the beginning that are on a corner; `leading.way`: from the first contact to the first
//                   row behind them, the base
//   s_base          the contact of the base: the first contact is at s_base - L
//   theta -+ J      what a row on a corner leaves open: its turn and `pivot`
//   Theta(s + L) - Theta(s)   how far the tangent has turned, for all first contacts of a box and all that L may be off
//   z               how far theta -+ J is from that, in standard deviations of two orientations; of the worst row, less
//                   what the farthest of so many is off by chance (Bonferroni)
// Follows docs/rolling.md, "Fingers with corners".
// Idea: theta between two rows off the corners is exact whatever lay between them. So everything is measured from the
// first such row, and the rows before it say only that the first contact was L before it. With noise the likelihood of
// a turn that is known to an interval is flat where some of the interval is possible, and falls outside as that of any
// other turn. Rows of one pivot share their errors, so that only the worst of all counts.
namespace rollfix::answer {
namespace {

// 95 % of a normal distribution are within so many standard deviations.
constexpr double kWithin = 1.96;

/// Leads places of the base back to the first contacts: s = s_base - L, of each finger. With noise standard deviations
/// and intervals grow by what the way itself is off.
class WayBack {
 public:
  WayBack(const PerFinger<double>& length, const Part& part, const Noise& noise)
      : part_(part), length_(length), noise_(noise) {}

  /// First contacts of a place of the base, reduced to the outline.
  PerFinger<double> place(PerFinger<double> at) const {
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = part_.boundary().canonical(at[k] - length_[k]);
    return at;
  }

  /// Likewise an arc; the whole outline stays whole.
  Interval arc(const Interval& there, std::size_t finger) const {
    const Boundary boundary = part_.boundary();
    return boundary.is_full(there) ? there : boundary.arc(there.lo - length_[finger], there.hi - length_[finger]);
  }

  /// All places of a placement; points and tangents are those of the new places.
  void move(Placement& placement) const {
    placement.start = place(placement.start);
    for (PerFinger<double>& root : placement.roots) root = place(root);
    for (PerFinger<double>& pair : placement.family) {  // unwrapped
      for (std::size_t k = 0; k < pair.size(); ++k) pair[k] -= length_[k];
    }
    // It was the angle at the base's contact; that of the first contact is another one.
    placement.pivot.reset();
    for (std::size_t k = 0; k < placement.start.size(); ++k) {
      placement.extent[k] = arc(placement.extent[k], k);
      placement.point[k] = part_.point(placement.start[k]);
      placement.tangent[k] = part_.tangent(placement.start[k]);
    }
    // Probabilities are NaN without noise.
    if (!std::isnan(placement.probability)) move_belief(placement);
  }

  void move(Mode& mode) const {
    mode.start = place(mode.start);
    for (std::size_t k = 0; k < mode.start.size(); ++k) {
      mode.region[k] = arc(mode.region[k], k);
      mode.tangent[k] = part_.tangent(mode.start[k]);
    }
    move_belief(mode);
  }

 private:
  /// Mean, standard deviation, covariance and 95 % interval; the errors of the way are independent of those of the
  /// base.
  template <class Remaining>
  void move_belief(Remaining& one) const {
    one.mean = place(one.mean);
    for (std::size_t k = 0; k < one.start.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double of_way = sd(k);
      one.sd[k] = std::hypot(one.sd[k], of_way);
      if (one.start.size() == 2) one.covariance(i, i) += of_way * of_way;
      const Interval there = one.interval[k];
      if (part_.boundary().is_full(there)) continue;
      // The half width grows as the root of the sum of squares, as a standard deviation does.
      const double beyond = std::hypot(0.5 * there.width(), kWithin * of_way) - 0.5 * there.width();
      one.interval[k] = arc({there.lo - beyond, there.hi + beyond}, k);
    }
  }

  /// The way back is as uncertain as both rows' contacts, and slips, here and there as well.
  double sd(std::size_t finger) const {
    BeliefOptions options;
    options.noise = noise_;
    const belief::SensorErrors sensor(options, LogKind::contact, part_.perimeter());
    return std::hypot(std::numbers::sqrt2 * noise_.contact, noise_.slip * length_[finger],
                      std::sqrt(sensor.slipped(length_[finger])));
  }

  const Part& part_;
  PerFinger<double> length_;  // from the first contacts to the base
  Noise noise_;
};

/// The last contacts lie that much further on.
template <class Remaining>
void go_on(const PerFinger<double>& further, const Part& part, const Noise& noise, Remaining& one) {
  for (std::size_t k = 0; k < one.end.size(); ++k) {
    one.end[k] = part.boundary().canonical(one.end[k] + further[k]);
    one.end_mean[k] = part.boundary().canonical(one.end_mean[k] + further[k]);
    one.end_sd[k] = std::hypot(one.end_sd[k], noise.contact, noise.contact);  // both rows'
  }
}

/// Without what belongs to the last entries, which the answer does not list.
template <class Entry>
void drop_last(std::size_t count, ShortList<Entry>& list) {
  ShortList<Entry> kept;
  for (std::size_t k = 0; k + count < list.size(); ++k) kept.push_back(list[k]);
  list = kept;
}

void drop_last(std::size_t count, Sensitivity& sensitivity) {
  for (auto& readings : sensitivity.per_turn) drop_last(count, readings);
  for (auto& readings : sensitivity.per_length) drop_last(count, readings);
}

/// Throws InputError: no row is off all corners.
[[noreturn]] void refuse_all(const Log& log, bool has_noise) {
  throw InputError(
      fmt::format("{}: in every row, or in all but the first, a finger may be on a corner of its own, where u does not "
                  "tell how its normal is turned{}: expected rows beside the corners; roll on",
                  log.name, has_noise ? " (within five standard deviations of the contact's noise)" : ""));
}

/// The last row before this one, or itself, that is off all corners; 0: there is none behind the first.
std::size_t last_exact(const std::vector<bool>& on_corners, std::size_t row) {
  while (row > 0 && on_corners[row]) --row;
  return row;
}

}  // namespace

/// Linear in the number of rows.
std::optional<LeadingRows> leading_rows(const Problem& problem) {
  if (!problem.measured.is_log() || problem.fingers.empty()) return std::nullopt;
  const Log& log = *problem.measured.log;
  const Noise noise = problem.noise.value_or(Noise{});
  const std::vector<bool> on_corners = rows_on_corners(log, problem.fingers, noise);
  if (on_corners.empty() || !on_corners.front()) return std::nullopt;
  LeadingRows leading;
  const auto first = std::find(on_corners.begin(), on_corners.end(), false);
  leading.count = static_cast<std::size_t>(first - on_corners.begin());
  // A log ends with a reading: at least one more row.
  if (leading.count + 1 >= log.rows()) {
    // Without noise the search of one finger takes rows with pivots, so that nothing has to be led over.
    if (problem.noise || log.fingers.size() > 1) refuse_all(log, problem.noise.has_value());
    return std::nullopt;
  }
  // Places are led back by L alone; turn and pivot are for the readings of the answer.
  const std::vector<Reading> rolls = readings_as_given(log, problem.fingers, noise);
  leading.way = rolls[leading.count];
  for (const double instant : problem.at) {
    if (log.time.empty() || instant >= log.time[leading.count]) continue;
    throw InputError(fmt::format(
        "{}: the instant {} lies before the first row off the finger's corner, at {}, from which turns are measured: "
        "expected a later one (`at`)",
        log.name, instant, log.time[leading.count]));
  }
  if (log.fingers.size() == 1) {
    // The base as start, the first contact as end: L and theta change their signs, what is left open stays.
    Reading back{-leading.way.length[0], -leading.way.turn};
    back.pivot = leading.way.pivot;
    leading.readings.push_back(back);
  }
  return leading;
}

/// Priors are of the first contact: at the base the same place is L further on.
Problem without(const LeadingRows& leading, const Problem& problem) {
  Problem result = problem;
  result.measured.log = from_row(*problem.measured.log, leading.count);
  if (result.prior) result.prior->s += leading.way.length[0];
  return result;
}

/// `sensitivity` loses the entries of the leading readings, which `answer.readings` does not contain.
void to_first_contacts(const LeadingRows& leading, const Problem& problem, Answer& answer) {
  const WayBack way(leading.way.length, problem.part, problem.noise.value_or(Noise{}));
  const auto move_all = [&](std::vector<Placement>& placements) {
    for (Placement& placement : placements) {
      way.move(placement);
      drop_last(leading.readings.size(), placement.sensitivity);
    }
  };
  move_all(answer.placements);
  for (Impossible& item : answer.impossible) way.move(item.placement);
  // What the search left open is led back as well.
  for (PerFinger<Interval>& box : answer.unresolved) {
    for (std::size_t k = 0; k < box.size(); ++k) box[k] = way.arc(box[k], k);
  }
  answer.facing.reset();  // it was the base's
  // Measured from the first contact again.
  for (Reading& reading : answer.readings) {
    for (std::size_t k = 0; k < reading.length.size(); ++k) reading.length[k] += leading.way.length[k];
    reading.turn += leading.way.turn;
    reading.pivot += leading.way.pivot;
  }
  // Without noise placements are listed by s, contradicted ones last; a first contact may be on the lap before.
  if (!answer.weighing) {
    const auto earlier = [](const Placement& one, const Placement& two) {
      return std::pair(one.is_contradicted, one.start[0]) < std::pair(two.is_contradicted, two.start[0]);
    };
    std::sort(answer.placements.begin(), answer.placements.end(), earlier);
    return;
  }
  answer.weighing->prior = problem.prior;
  move_all(answer.weighing->improbable);
  for (std::size_t k = 0; k < answer.weighing->density.size(); ++k) {
    for (DensityPiece& piece : answer.weighing->density[k]) piece.s = way.arc(piece.s, k);
  }
}

/// Rows that are asked for (`at`) are taken as they are.
std::vector<std::size_t> rows_to_search(const Problem& problem, const std::vector<bool>& on_corners) {
  const Log& log = *problem.measured.log;
  std::vector<std::size_t> rows = rows_at(log, problem.at);
  if (problem.noise && !on_corners.empty() && last_exact(on_corners, log.rows() - 1) == 0) refuse_all(log, true);
  if (!problem.at.empty() || on_corners.empty()) return rows;
  if (log.fingers.size() == 1) {
    // The last row on a corner says a turn within its pivot; the exact row before it says one number.
    const std::size_t exact = last_exact(on_corners, rows.back());
    if (exact > 0 && exact < rows.back()) rows.insert(rows.end() - 1, exact);
    return rows;
  }
  // Rows may coincide after that, and the first contact itself says nothing.
  for (std::size_t& row : rows) row = last_exact(on_corners, row);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  rows.erase(std::remove(rows.begin(), rows.end(), std::size_t{0}), rows.end());
  if (rows.empty()) refuse_all(log, problem.noise.has_value());
  return rows;
}

/// Only where the last row is on a corner.
void to_last_contacts(const Observation& observed, const Noise& noise, Answer& answer) {
  if (observed.on_corners.empty() || !observed.on_corners.back()) return;
  const Reading& last = observed.rolls.back();
  const Reading& weighed = observed.rolls[last_exact(observed.on_corners, observed.rolls.size() - 1)];
  PerFinger<double> further = last.length;
  for (std::size_t k = 0; k < further.size(); ++k) further[k] -= weighed.length[k];
  for (std::vector<Placement>* placements : {&answer.placements, &answer.weighing->improbable}) {
    for (Placement& placement : *placements) go_on(further, answer.part, noise, placement);
  }
}

namespace {

// A length is off by no more than so many standard deviations.
constexpr double kFarthestLength = 4.5;
// Nor is a place, of which the interval has two.
constexpr double kBeyondInterval = kFarthestLength - 2;
// An interval is looked at in so many pieces, so that what is known of a turn is not lost in how far it is open.
constexpr std::size_t kPieces = 8;

/// What rows on corners say against a box of first contacts, with noise: each allows turns in theta -+ J.
class RowsOnCorners {
 public:
  RowsOnCorners(const Problem& problem, const LeadingRows& leading, const Observation& observed)
      : turning_(problem.part.turning()) {
    // Noise of the part included.
    const Noise noise = noise_on(problem.part, *problem.noise);
    const auto errors = [&](const std::vector<Reading>& rows) {
      return errors_of(problem, noise, rows, problem.part.perimeter());
    };
    const std::vector<RowErrors> of_leading = errors(leading.readings);
    for (std::size_t k = 0; k < of_leading.size(); ++k) add(leading.readings[k], of_leading[k]);
    const std::vector<RowErrors> of_rolls = errors(observed.rolls);
    for (std::size_t k = 0; k < observed.on_corners.size(); ++k) {
      // Only rows that were not weighed.
      if (observed.on_corners[k]) add(observed.rolls[k], of_rolls[k]);
    }
    const double contact = std::numbers::sqrt2 * noise.contact;
    // The standard deviation of a turn: two orientations, the part's own error, and two contacts times curvature.
    turn_ = std::hypot(std::numbers::sqrt2 * noise.angle, noise.part.turn);
    // A contact that is measured beside where it is has another normal on a disk.
    for (const Finger& finger : problem.fingers) turn_ = std::hypot(turn_, contact * finger.curvature(0));
  }

  bool empty() const { return rows_.empty(); }

  /// z, where the placement may be it is least.
  double sigmas(const Placement& placement) const {
    const std::size_t fingers = placement.interval.size();
    double least = std::numeric_limits<double>::infinity();
    // Pieces of the interval, of two fingers of the product of both; 0 can't be undercut.
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
  /// z of the worst row from this box. 2 ln n is what the worst of n squares is about by chance.
  double worst(const PerFinger<Interval>& box) const {
    double most = 0;
    for (std::size_t k = 0; k < rows_.size(); ++k) most = std::max(most, gap(k, box) / turn_);
    return std::sqrt(std::max(0.0, most * most - 2 * std::log(static_cast<double>(rows_.size()))));
  }

  /// From the turns that a row leaves open to those from this box.
  double gap(std::size_t which, const PerFinger<Interval>& box) const {
    const Reading& row = rows_[which];
    Interval turn = turns(which, box, 0);
    if (box.size() == 2) {
      const Interval of_b = turns(which, box, 1);
      turn = {turn.lo - of_b.hi, turn.hi - of_b.lo};
    }
    return std::max({0.0, row.turn - row.pivot - turn.hi, turn.lo - row.turn - row.pivot});
  }

  /// All Theta(s + L) - Theta(s), for s in the box and L within `kFarthestLength` standard deviations. Theta at both
  /// ends is bounded on its own, so that the interval is rather too wide: then a row excludes less.
  Interval turns(std::size_t which, const PerFinger<Interval>& box, std::size_t finger) const {
    const double length = rows_[which].length[finger];
    const double off = kFarthestLength * length_sd_[which];
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

  void add(const Reading& row, const RowErrors& errors) {
    rows_.push_back(row);
    length_sd_.push_back(std::sqrt(errors.length));
  }

  const TurningFunction& turning_;
  std::vector<Reading> rows_;
  std::vector<double> length_sd_;  // of each of them
  double turn_ = 0;
};

/// Rows may be anything, or what turns are off by gathers on the way: that is the posterior's matter.
bool is_beyond(const Problem& problem) {
  const Noise& noise = *problem.noise;
  return problem.robust || noise.drift > 0 || noise.walk > 0 || noise.gyro > 0;
}

}  // namespace

/// Each placement's probability is multiplied by exp(-z^2 / 2), relative to that of the least z; the rest of it goes to
/// the evidence.
CornerRowsSay weigh_corner_rows(const Problem& problem, const LeadingRows& leading, const Observation& observed,
                                Answer& answer) {
  const RowsOnCorners rows(problem, leading, observed);
  // With robust weighing or a gyroscope's drift a turn may be anything here.
  if (rows.empty() || is_beyond(problem) || answer.placements.empty()) return {};
  std::vector<double> squares;
  for (const Placement& placement : answer.placements) squares.push_back(std::pow(rows.sigmas(placement), 2));
  // What even the best place is off by lowers the evidence of the whole problem.
  const double least = *std::min_element(squares.begin(), squares.end());
  if (*std::max_element(squares.begin(), squares.end()) == 0) return {};
  answer.weighing->evidence.volume -= 0.5 * least;
  double likeliest = 0;
  for (std::size_t k = 0; k < squares.size(); ++k) {
    double& probability = answer.placements[k].probability;
    probability *= std::exp(-0.5 * (squares[k] - least));
    likeliest = std::max(likeliest, probability);
  }
  std::vector<Placement> listed;
  for (Placement& placement : answer.placements) {
    const bool is_left = is_listed(placement.probability, likeliest);
    (is_left ? listed : answer.weighing->improbable).push_back(std::move(placement));
  }
  std::stable_sort(listed.begin(), listed.end(),
                   [](const Placement& a, const Placement& b) { return a.probability > b.probability; });
  answer.placements = std::move(listed);
  answer.dropped.improbable = answer.weighing->improbable.size();
  return {true, least > Fit::kMostSigmas * Fit::kMostSigmas};
}

}  // namespace rollfix::answer

namespace rollfix {

void to_first_contacts(const Reading& way, const Part& part, const Noise& noise, Mode& mode) {
  answer::WayBack(way.length, part, noise).move(mode);
}

void to_last_contacts(const Reading& further, const Part& part, const Noise& noise, Mode& mode) {
  answer::go_on(further.length, part, noise, mode);
}

}  // namespace rollfix
