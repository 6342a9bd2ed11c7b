#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "rollfix/error.hpp"
#include "steps.hpp"

// What a problem says by itself, before anything is computed.
namespace rollfix {

/// Readings count as lengths and turns from the first contact.
LogKind kind_of(const Problem& problem) {
  return problem.measured.is_log() ? problem.measured.log->kind : LogKind::travelled;
}

const char* name_of(const PosePrior& pose) { return std::isinf(pose.place_sd) ? "heading" : "pose"; }

void require_noise(const Problem& problem) {
  if (problem.noise) return;
  if (problem.prior) throw InputError("`prior` weighs places against noisy readings: give `noise` as well");
  if (problem.pose) {
    throw InputError(fmt::format("`{}` is weighed against noisy rows: give `noise` as well", name_of(*problem.pose)));
  }
  if (problem.robust) throw InputError("`robust` is about noise: give `noise` as well");
}

/// 1 / r of a disk, 0 of a jaw; of an outline at the contact, or at u = 0 where the log has no u.
double finger_curvature(const Problem& problem, std::size_t which, std::size_t row) {
  if (problem.fingers.empty()) return 0;
  // Where u is wrapped makes no difference to the curvature there.
  const double u = kind_of(problem) == LogKind::contact ? problem.measured.log->fingers[which].u[row] : 0;
  return finger_of(problem.fingers, which)->curvature(u);
}

}  // namespace rollfix
