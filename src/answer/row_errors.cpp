#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/posterior.hpp"
#include "steps.hpp"

// How far the rows of a roll may be off, all errors together: what a belief weighs them by, for those who rule out what
// no row allows.
// Notation:
//   sensor          variances of a contact, of an angle, of slip and drift over a step: belief::SensorErrors
//   bare            readings, whose first contact is exact and whose errors do not gather from one to the next
// Follows docs/belief.md, "What the noise is".
// Idea: one pass over the rows adds up what gathers, `slipped` and `drifted`; the rest belongs to each row alone.
namespace rollfix {

/// One entry for each row: variances, in length^2 and radians^2.
std::vector<RowErrors> errors_of(const Problem& problem, const Noise& noise, const std::vector<Reading>& rows,
                                 double perimeter) {
  BeliefOptions options;
  options.noise = noise;
  options.bare = !problem.measured.is_log();
  const LogKind kind = kind_of(problem);
  const belief::SensorErrors sensor(options, kind, perimeter);
  const std::size_t fingers = rows.empty() ? 0 : rows.front().fingers();
  std::vector<RowErrors> errors;
  double slipped = 0;
  double drifted = 0;
  Reading before = fingers < 2 ? Reading(0, 0) : Reading(0, 0, 0);
  double time = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const bool has_times = problem.measured.is_log() && !problem.measured.log->time.empty();
    // Seconds since the first row; 0 without times.
    const double now = has_times ? problem.measured.log->time[k] - problem.measured.log->time[0] : 0;
    RowErrors row;
    double longest_step = 0;
    double longest_slip = 0;
    for (std::size_t which = 0; which < fingers; ++which) {
      const double curvature = finger_curvature(problem, which, problem.measured.is_log() ? k : 0);
      const double contact = kind == LogKind::contact ? belief::square(curvature) * sensor.contact_variance : 0;
      // A contact that is measured beside where it is has another normal: on a finger with curvature kappa_f by kappa_f
      // times that.
      row.own += sensor.angle_variance + contact;
      // The contacts of this row and of the first one, and a factor of all lengths.
      row.length = std::max(row.length, 2 * sensor.contact_variance +
                                            sensor.scale_variance(curvature) * belief::square(rows[k].length[which]));
      const double step = rows[k].length[which] - before.length[which];
      longest_step = std::max(longest_step, std::abs(step));
      longest_slip = std::max(longest_slip, sensor.slipped(options.bare ? rows[k].length[which] : step));
    }
    // Errors of steps are independent: their variances add up. The finger that moved most counts.
    slipped = (options.bare ? 0 : slipped) + longest_slip;
    drifted += static_cast<double>(fingers) * sensor.drifted(longest_step, {time, now});
    // Increments: each row's own errors stay in all that follow.
    if (sensor.gathers_rows()) {
      slipped += sensor.contact_variance;
      drifted += static_cast<double>(fingers) * sensor.angle_variance;
    }
    // The first contact has the same errors as a row, and is in every row.
    row.shared = row.own;
    row.length += slipped;
    row.gathered = drifted + belief::square(sensor.noise.gyro * rows[k].turn);
    errors.push_back(row);
    before = rows[k];
    time = now;
  }
  return errors;
}

}  // namespace rollfix
