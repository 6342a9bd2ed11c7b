#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "part/part_data.hpp"
#include "rollfix/error.hpp"
#include "steps.hpp"

// A belief of what was observed: what it is told of the fingers and the noise, and a sample a row.
// Follows docs/belief.md.
namespace rollfix {
namespace {

/// Of one row: where each contact is on its finger, and with `has_centres` where the finger is in the world.
void add_contacts(const Problem& problem, const Observation& observed, std::size_t row, bool has_centres,
                  Sample& sample) {
  const std::vector<FingerRows>& fingers = problem.measured.log->fingers;
  sample.contact = PerFinger<Contact>::of(fingers.size());
  if (has_centres) sample.centre = PerFinger<Vec2>::of(fingers.size(), Vec2::Zero());
  for (std::size_t which = 0; which < fingers.size(); ++which) {
    (*sample.contact)[which] = (*observed.contacts)[which][row];
    if (has_centres) (*sample.centre)[which] = Vec2(fingers[which].x[row], fingers[which].y[row]);
  }
}

/// Throws InputError: the rows do not tell how the part lies, or not as finely as `pose` says it.
void require_pose(const Problem& problem, const Observation& observed, bool has_centres) {
  const PosePrior& pose = *problem.pose;
  if (!observed.contacts || problem.fingers.empty()) {
    const char* const found = !problem.measured.is_log() ? "readings"
                              : !observed.contacts       ? "one of lengths and turns"
                                                         : "no finger";
    throw InputError(fmt::format(
        "`{}`: a finger tells how the part lies by u and psi, expected a log of them, found {}", name_of(pose), found));
  }
  if (std::isfinite(pose.place_sd) && !has_centres) {
    throw InputError(
        "`pose`: the fingers tell where the part is by their centres, expected a log with columns x and y");
  }
  // A standard deviation below the accuracy of arc lengths would be lost in rounding.
  require_not_lost(problem.part, pose.place_sd, "a pose with a standard deviation", "");
}

}  // namespace

/// Checks that log and noise go together, then hands the rows to the belief, one sample each. Throws InputError:
/// position noise or a pose without centres, a pose without u and psi, drift without times.
std::optional<Belief> believe(const Problem& problem, const Observation& observed, const Supposed& supposed) {
  if (!problem.noise) return std::nullopt;
  const std::size_t fingers = observed.readings.front().fingers();
  FingerGeometry contacts{PerFinger<double>::of(fingers), observed.facing, problem.fingers};
  const bool has_centres =
      observed.contacts && problem.measured.log->fingers.front().x.size() == problem.measured.log->rows();
  if (problem.noise->position > 0 && !has_centres) {
    throw InputError(
        "`noise`: position is of the fingers' centres, expected a log of u and psi with their columns x and y");
  }
  // At the first contact, which all rows have in common.
  for (std::size_t which = 0; which < fingers; ++which)
    contacts.finger_curvature[which] = finger_curvature(problem, which, 0);
  BeliefOptions options;
  options.noise = *problem.noise;
  options.prior = problem.prior;
  options.pose = problem.pose;
  options.robust = problem.robust;
  options.scale_sd = supposed.scale_sd;
  options.scale_of = supposed.scale_of;
  options.glance = supposed.glance;
  options.nodes = supposed.nodes;
  options.by_rows = supposed.by_rows;
  options.within = supposed.within;
  // The first contact of typed readings has no error of its own.
  options.bare = !problem.measured.is_log();
  if (problem.pose) require_pose(problem, observed, has_centres);
  Belief belief(problem.part, kind_of(problem), options, contacts);
  const bool has_times = problem.measured.is_log() && !problem.measured.log->time.empty();
  require_times(*problem.noise, has_times, problem.measured.is_log() ? problem.measured.log->name : "`readings`");
  // All rows of a log, not only those of the search.
  const std::vector<Reading>& readings = rows_felt(problem, observed);
  // Evenly thinned to about `supposed.rows`.
  const std::size_t stride = std::max<std::size_t>(1, readings.size() / std::max<std::size_t>(1, supposed.rows));
  for (std::size_t k = 0; k < readings.size(); k += stride) {
    // On a corner of a finger a row leaves open how its normal is turned.
    if (!observed.on_corners.empty() && observed.on_corners[k]) continue;
    Sample sample;
    sample.reading = readings[k];
    if (has_times) sample.time = problem.measured.log->time[k];
    sample.finger_curvature = PerFinger<double>::of(fingers);
    for (std::size_t which = 0; which < fingers; ++which)
      sample.finger_curvature[which] = finger_curvature(problem, which, k);
    if (observed.contacts) add_contacts(problem, observed, k, has_centres, sample);
    belief.add(sample);
  }
  return belief;
}

}  // namespace rollfix
