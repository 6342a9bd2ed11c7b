#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "physics.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"

/// Rolls whose start is known, located from nothing but their logs.
namespace physics {

// Shares of the part's perimeter.
inline constexpr double kRadius = 0.05;    // of the finger
inline constexpr double kDistance = 0.35;  // of a roll
inline constexpr double kDrag = 1;         // 1/s: the arm's, so that the friction has something to hold

/// What the simulation is good for when the finger grips, and what its logs are located with: above what every roll of
/// the table measures. No other noise is added.
inline constexpr double kGrippingSlip = 5e-4;
inline rollfix::Noise noise_of(const Part& part, double slip = kGrippingSlip) {
  return {5e-5 * part.perimeter(), 1.5e-3, slip, 0};
}
/// The search without noise lets f be off by this, radians: the polyline's edges, twice over, and slip.
inline constexpr double kTolerance = 0.01;
inline constexpr double kNear = 1e-3;  // of the perimeter: and its lengths are off by up to this

/// What came of one roll.
struct Trial {
  std::vector<Row> rows;  // with contact
  std::string log;
  double start = 0;          // the truth
  double slip = 0;           // (L - what was really travelled) / what was really travelled, at the end
  double contact_error = 0;  // rms of L but for that, length
  double angle_error = 0;    // rms of theta, radians; at corners none
  // Belief
  std::string verdict;
  double excess = 1;
  std::size_t modes = 0;            // with a probability of 1 % or more
  double nearest = 0;               // how far the nearest mode's mean is from the truth, length
  std::optional<std::size_t> rank;  // of the mode that holds the truth: 0 for the likeliest
  double error = 0;                 // of that mode's mean, length
  double sd = 0;                    // as it says
  double probability = 0;           // as it says
  bool in_interval = false;         // its 95 % hold the truth
  double end_error = 0;             // of where the contact is now in the likeliest mode that has it
  double end_sd = 0;
  // The search, with four of the readings and kTolerance
  std::size_t placements = 0;
  bool is_placed = false;  // one of them holds the truth

  bool is_inconsistent() const { return verdict == "inconsistent"; }
  bool is_among() const { return !is_inconsistent() && rank; }
  /// It claims to know, and the finger started elsewhere.
  bool is_elsewhere() const { return !is_inconsistent() && !rank; }
};

/// Whether s is in there, give or take.
inline bool holds(const Interval& interval, double s, double period, double slack = 0) {
  return rollfix::wrap(s - interval.lo + slack, period).base <= interval.width() + 2 * slack;
}

/// What the sensors made of where the finger really was.
inline void measure(const Part& part, double radius, Trial& trial) {
  const Row& first = trial.rows.front();
  const Row& last = trial.rows.back();
  const auto length = [&](const Row& row) { return -radius * (row.u - first.u); };
  trial.start = rollfix::wrap(first.s, part.perimeter()).base;
  trial.slip = length(last) / (last.s - first.s) - 1;
  double lengths = 0;
  double angles = 0;
  std::size_t count = 0;
  const auto angle = [&](const Row& row) { return row.u + row.psi - part.turning().angle(row.s); };
  const auto is_at_corner = [&](const Row& row) {
    return std::any_of(part.corners().begin(), part.corners().end(), [&](const rollfix::Corner& corner) {
      return rollfix::periodic_distance(row.s, corner.s, part.perimeter()) < 1e-3 * part.perimeter();
    });
  };
  std::vector<double> off;  // of the tangent
  for (const Row& row : trial.rows) {
    const double error = length(row) - (1 + trial.slip) * (row.s - first.s);
    lengths += error * error;
    if (!is_at_corner(row)) off.push_back(angle(row));
    ++count;
  }
  double mean = 0;
  for (const double a : off)
    mean += std::remainder(a - off.front(), 2 * std::numbers::pi) / static_cast<double>(off.size());
  for (const double a : off) angles += std::pow(std::remainder(a - off.front() - mean, 2 * std::numbers::pi), 2);
  trial.contact_error = std::sqrt(lengths / static_cast<double>(count));
  trial.angle_error = std::sqrt(angles / static_cast<double>(off.size()));
}

/// The log's samples, as a robot's program would read them.
inline std::vector<rollfix::Sample> samples_of(const Part& part, double radius, const std::string& log) {
  rollfix::LogStream stream("physics.csv", part, {rollfix::DiskFinger{radius}});
  std::vector<rollfix::Sample> samples;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const rollfix::LogLine said = stream.push(line);
    if (said.kind == rollfix::LineKind::first || said.kind == rollfix::LineKind::sample) samples.push_back(said.sample);
  }
  return samples;
}

inline void believe(const Part& part, const std::vector<rollfix::Sample>& samples, const rollfix::Noise& noise,
                    Trial& trial) {
  rollfix::BeliefOptions options;
  options.noise = noise;
  rollfix::Belief belief(part, rollfix::LogKind::contact, options);
  for (const rollfix::Sample& sample : samples) belief.add(sample);
  trial.verdict = belief.verdict().text();
  trial.excess = belief.excess();
  trial.nearest = part.perimeter();
  const double P = part.perimeter();
  const std::vector<rollfix::Mode>& modes = belief.modes();
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (modes[k].probability >= 0.01) ++trial.modes;
    trial.nearest = std::min(trial.nearest, rollfix::periodic_distance(modes[k].mean[0], trial.start, P));
    if (trial.rank || !holds(modes[k].region[0], trial.start, P)) continue;
    trial.rank = k;
    trial.end_error = std::remainder(modes[k].end_mean[0] - trial.rows.back().s, P);
    trial.end_sd = modes[k].end_sd[0];
    trial.error = std::remainder(modes[k].mean[0] - trial.start, P);
    trial.sd = modes[k].sd[0];
    trial.probability = modes[k].probability;
    trial.in_interval = holds(modes[k].interval[0], trial.start, P);
  }
}

inline void search(const Part& part, const std::vector<rollfix::Sample>& samples, Trial& trial) {
  std::vector<rollfix::Reading> readings;
  for (std::size_t k = 1; k <= 4; ++k) readings.push_back(samples[k * (samples.size() - 1) / 4].reading);
  rollfix::LocateOptions options;
  options.tolerance = kTolerance;
  const rollfix::Search found = locate(part, readings, options);
  trial.placements = found.placements.size();
  for (const rollfix::Placement& placement : found.placements) {
    if (holds(placement.extent[0], trial.start, part.perimeter(), kNear * part.perimeter())) trial.is_placed = true;
  }
}

/// How well the finger grips.
struct Surface {
  double friction = 1;
  double oiled_after = 0;  // an oily stretch begins after this share of the roll's distance ...
  double oiled_for = 0;    // ... and is so long, a share of it as well, with ...
  double oily = 0;         // ... this friction
};

/// A part to roll on, and the rolls.
class Stand {
 public:
  explicit Stand(const std::string& name) : part_(rollfix::gallery(name)), polyline_(polyline_of(part_)) {}

  const Part& part() const { return part_; }
  rollfix::Pose pose() const { return {0.3, -0.2, 0.7}; }  // of the part in the engine's world
  double radius() const { return kRadius * part_.perimeter(); }

  Trial run(double start, const Surface& surface, const rollfix::Noise& noise) const {
    Rolling rolling;
    rolling.radius = radius();
    rolling.start = start;
    rolling.distance = kDistance * part_.perimeter();
    rolling.friction = surface.friction;
    rolling.oiled_from = start + surface.oiled_after * rolling.distance;
    rolling.oiled_for = surface.oiled_for * rolling.distance;
    rolling.oily = surface.oily;
    rolling.drag = kDrag;
    rolling.pose = pose();
    Trial trial;
    trial.rows = roll(part_, polyline_, rolling);
    trial.log = csv(trial.rows);
    std::erase_if(trial.rows, [](const Row& row) { return !row.contact; });
    measure(part_, radius(), trial);
    const std::vector<rollfix::Sample> samples = samples_of(part_, radius(), trial.log);
    believe(part_, samples, noise, trial);
    search(part_, samples, trial);
    return trial;
  }

  std::vector<Trial> run_many(std::size_t count, const Surface& surface, const rollfix::Noise& noise) const {
    std::mt19937_64 generator(7);
    std::vector<Trial> trials;
    for (std::size_t k = 0; k < count; ++k) {
      // Evenly around, and then anywhere.
      const double share =
          (static_cast<double>(k) + static_cast<double>(generator() >> 11) * 0x1p-53) / static_cast<double>(count);
      trials.push_back(run(share * part_.perimeter(), surface, noise));
    }
    return trials;
  }

 private:
  Part part_;
  Polyline polyline_;
};

}  // namespace physics
