#include "steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"

// Readings of whatever was given, and how exact they are.
// Notation:
//   L_0 = 0, L_1, L_2, ...   one finger's lengths: at its first contact and at each reading
//   L_k - L_j       what it has rolled in between: a way from corner to corner, but for digits
//   h               how far rounding may have moved a length: Rounding::length
//   kappa           the largest curvature that lasts for h: what turns in less is a corner; h kappa of turn is the
//                   tolerance
// Follows docs/cli.md, "Tolerance".
// Idea: where two contacts of one finger are at corners, digits must not say that one of them has left its own.
namespace rollfix {
namespace {

/// The corners at which a finger can pivot, in order.
std::vector<double> pivots_of(const Part& part) {
  std::vector<double> places;
  for (const Corner& corner : part.corners()) {
    if (!corner.is_concave()) places.push_back(corner.s);
  }
  return places;
}

/// How far a length is from the nearest way between two corners: what is missing of it.
/// With sign: what has to be added to the length. Of each corner as start the two corners next to the end are compared,
/// O(n log n).
double to_way_between(const std::vector<double>& corners, const Boundary& boundary, double length) {
  double least = std::numeric_limits<double>::infinity();
  // Where a roll of that length from this corner ends, and the corners on both sides of it.
  for (const double from : corners) {
    const double end = boundary.on_first_lap(from + length);
    const auto next = std::lower_bound(corners.begin(), corners.end(), end);
    const double above = next != corners.end() ? *next : corners.front();
    const double below = next != corners.begin() ? *(next - 1) : corners.back();
    for (const double corner : {below, above}) {
      const double off = boundary.offset(end, corner);
      if (std::abs(off) < std::abs(least)) least = off;
    }
  }
  return least;
}

}  // namespace

/// Of each finger in the order of the readings: a length that is moved is what the next ones are compared with.
void put_on_corners(const Part& part, double within, std::vector<Reading>& readings) {
  const std::vector<double> corners = pivots_of(part);
  if (corners.empty() || readings.empty() || !(within > 0)) return;
  for (std::size_t finger = 0; finger < readings.front().fingers(); ++finger) {
    std::vector<double> lengths{0};
    for (Reading& reading : readings) {
      double& length = reading.length[finger];
      double least = std::numeric_limits<double>::infinity();
      // Any two contacts of the finger may both be at corners, the first one included.
      for (const double before : lengths) {
        const double off = to_way_between(corners, part.boundary(), length - before);
        if (std::abs(off) < std::abs(least)) least = off;
      }
      // Within what digits can have moved it.
      if (std::abs(least) <= within) length += least;
      lengths.push_back(length);
    }
  }
}

namespace {

/// Seconds; empty without times.
std::vector<double> times_of(const Log& log, const std::vector<std::size_t>& rows) {
  std::vector<double> times;
  if (log.time.empty()) return times;
  for (const std::size_t row : rows) times.push_back(log.time[row]);
  return times;
}

/// Typed readings are searched with as they are.
Observation observe_readings(const Problem& problem) {
  if (!problem.at.empty()) throw InputError("`at` picks instants of a log: give a `log` as well");
  Observation observed;
  observed.readings = problem.measured.readings;
  observed.facing = problem.facing;
  observed.roundings = problem.measured.roundings;
  return observed;
}

/// A log's rows: a few to search with, all of them to weigh or to compare, and what u and psi tell of each contact.
Observation observe_log(const Problem& problem) {
  Observation observed;
  const Log& log = *problem.measured.log;
  // u and psi know the direction of the stored outline; lengths were counted along the outline as drawn.
  observed.lengths_reversed = problem.part.reversed() && log.kind != LogKind::contact;
  const Noise noise = problem.noise.value_or(Noise{});
  observed.readings = readings(log, problem.part, problem.fingers, problem.at, noise);
  observed.roundings = {rounding_of(log, problem.fingers)};
  observed.facing = facing(log, problem.fingers);
  observed.rolls = readings_as_given(log, problem.fingers, noise);
  observed.on_corners = rows_on_corners(log, problem.fingers, noise);
  const std::vector<std::size_t> rows = answer::rows_to_search(problem, observed.on_corners);
  observed.times = times_of(log, rows);
  // A finger with corners: the rows to search with were chosen by them, and have pivots.
  if (!observed.on_corners.empty()) {
    observed.readings.clear();
    for (const std::size_t row : rows) observed.readings.push_back(observed.rolls[row]);
  }
  if (observed.lengths_reversed) {
    for (Reading& reading : observed.rolls) reading = in_stored_direction(reading, problem.part);
  }
  observed.pose_time = log.time;
  if (log.kind != LogKind::contact) return observed;
  observed.contacts = PerFinger<std::vector<Contact>>::of(log.fingers.size());
  for (std::size_t which = 0; which < log.fingers.size(); ++which) {
    (*observed.contacts)[which] = contacts_of(log.fingers[which], *finger_of(problem.fingers, which));
  }
  return observed;
}

}  // namespace

double Observation::length_error() const {
  double most = 0;
  for (const Rounding& rounding : roundings) most = std::max(most, rounding.length);
  return most;
}

Observation observe(const Problem& problem) {
  // Facing is of readings alone.
  if (problem.measured.is_log() && problem.facing) {
    throw InputError("`facing` goes with `reading`: a log of two fingers has it in u and psi");
  }
  Observation observed = problem.measured.is_log() ? observe_log(problem) : observe_readings(problem);
  if (!problem.noise) put_on_corners(problem.part, observed.length_error(), observed.readings);
  return observed;
}

namespace {

/// A curvature that grows by more than this factor within half the rounding of a length is a spike.
constexpr double kSpike = 2;
/// A part that was measured may be off by so many standard deviations: what noise is let pass as well.
constexpr double kFarthestPart = 4.5;

/// The largest curvature that lasts for at least `length`, or a little more than it. What turns in less than that, a
/// sharp rounding or the end of a curve that starts at rest, is a corner to whoever measures lengths to that accuracy.
class LastingCurvature {
 public:
  LastingCurvature(const TurningFunction& turning, double length)
      : turning_(turning), spirals_(turning.spirals()), length_(length) {}

  double value() const {
    double most = 0;
    double run_length = 0;  // of short spirals in a row
    double run_most = 0;
    const std::size_t laps = turning_.closed() ? 2 : 1;  // a run may pass the seam
    for (std::size_t k = 0; k < laps * spirals_.size(); ++k) {
      const Spiral& spiral = spirals_[k % spirals_.size()];
      if (is_long(spiral)) {
        most = std::max(most, on_long(k % spirals_.size()));
        run_length = run_most = 0;
        continue;
      }
      // Short spirals in a row last together as long as they are together; the sharpest one counts for all of them.
      run_length += spiral.hi - spiral.lo;
      run_most = std::max({run_most, std::abs(spiral.start.curvature), std::abs(spiral.end.curvature)});
      if (run_length >= length_) most = std::max(most, run_most);
    }
    return most;
  }

 private:
  /// Long enough for a stretch of that length to reach half of it into the spiral.
  bool is_long(const Spiral& spiral) const { return spiral.hi - spiral.lo >= 0.5 * length_; }

  /// A stretch of that length around the sharper end reaches at least half of it into this spiral or the next long one.
  double on_long(std::size_t index) const {
    const Spiral& spiral = spirals_[index];
    const std::size_t count = spirals_.size();
    // kappa is monotone on a spiral, so that its peak is at one end.
    const bool at_end = std::abs(spiral.end.curvature) > std::abs(spiral.start.curvature);
    const Spiral& beside = spirals_[at_end ? (index + 1) % count : (index + count - 1) % count];
    const double peak = std::abs(at_end ? spiral.end.curvature : spiral.start.curvature);
    // The run of short spirals beside it counts the rest: no spike can be told here.
    if (!is_long(beside)) return peak;
    const double place = at_end ? spiral.hi - 0.5 * length_ : spiral.lo + 0.5 * length_;
    const double inside = std::abs(turning_.on_spiral(spiral, place).curvature);
    // Half a length inside: if kappa has fallen to less than half there, the peak does not last.
    return peak > kSpike * inside ? inside : peak;
  }

  const TurningFunction& turning_;
  const std::vector<Spiral>& spirals_;
  double length_;
};

/// What the outline's accuracy can make of the turn over any of these rolls, at worst.
/// Radians: 4.5 standard deviations of both ends' tangents, of what gathers in between, and of the length times kappa.
double off_on(const Part& part, const std::vector<Reading>& readings) {
  const Accuracy& accuracy = part.outline().accuracy;
  double most = 0;
  for (const Reading& reading : readings) {
    double variance = 0;
    for (const double length : reading.length) {
      const double by_length = LastingCurvature(part.turning(), accuracy.length * std::abs(length)).value();
      variance += 2 * accuracy.turn * accuracy.turn + accuracy.walk * accuracy.walk * std::abs(length) +
                  std::pow(by_length * accuracy.length * length, 2);
    }
    most = std::max(most, kFarthestPart * std::sqrt(variance));
  }
  return most;
}

}  // namespace

/// The larger of the smallest and what the rounding of a reading can make of the total curvature: a length that is off
/// by h changes it by at most h times the largest curvature, but for stretches shorter than h, which count as corners.
/// A part that was measured is off as well.
Tolerance tolerance_from_digits(const Part& part, const std::vector<Rounding>& roundings,
                                const std::vector<Reading>& readings) {
  const double smallest = LocateOptions().tolerance;
  double value = 0;
  for (const Rounding& rounding : roundings) {
    value =
        std::max(value, rounding.turn + rounding.length * LastingCurvature(part.turning(), rounding.length).value());
  }
  if (!part.outline().accuracy.is_exact()) {
    return {std::max(smallest, value + off_on(part, readings)), Tolerance::Source::part};
  }
  if (value <= smallest) return {smallest, Tolerance::Source::smallest};
  return {value, Tolerance::Source::digits};
}

/// No less than the search's own default.
Tolerance tolerance_from_noise(double value) {
  return {std::max(value, LocateOptions().tolerance), Tolerance::Source::noise};
}

Tolerance tolerance_given(double value) {
  if (!(value >= 0))
    throw InputError(fmt::format("`tolerance`: {} is negative, expected an angle of at least 0", value));
  // Below it rounding decides; the answer says which was used.
  if (value < kLeastTolerance) return {kLeastTolerance, Tolerance::Source::least};
  return {value, Tolerance::Source::given};
}

}  // namespace rollfix
