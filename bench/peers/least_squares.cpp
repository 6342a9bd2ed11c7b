#include "least_squares.hpp"

#include <ceres/tiny_solver.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include "rollfix/turning_function.hpp"
#include "same_pair.hpp"

namespace bench {
namespace {

using namespace rollfix;

constexpr double kVanishes = 1e-9;   // rad: a minimum with residuals up to here is an answer
constexpr double kSamePlace = 1e-7;  // of the perimeter

/// The residuals and their analytic derivatives, as Ceres asks for them.
class Residuals {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = 2, NUM_PARAMETERS = 2 };  // NOLINT(readability-identifier-naming): Ceres' names

  Residuals(const TurningFunction& turning, const std::vector<Reading>& readings)
      : turning_(turning), readings_(readings) {}

  bool operator()(const double* at, double* residuals, double* jacobian) const {
    const Turning s0 = turning_.at(at[0]);
    const Turning t0 = turning_.at(at[1]);
    for (std::size_t k = 0; k < NUM_RESIDUALS; ++k) {
      const Turning s = turning_.at(at[0] + readings_[k].length[0]);
      const Turning t = turning_.at(at[1] + readings_[k].length[1]);
      residuals[k] = (s.angle - s0.angle) - (t.angle - t0.angle) - readings_[k].turn;
      if (jacobian == nullptr) continue;
      jacobian[k] = s.curvature - s0.curvature;
      jacobian[NUM_RESIDUALS + k] = t0.curvature - t.curvature;
    }
    return true;
  }

 private:
  const TurningFunction& turning_;
  const std::vector<Reading>& readings_;
};

/// Where a first contact may be: on an open part the whole roll has to fit on it.
std::array<Interval, 2> ranges(const Part& part, const std::vector<Reading>& readings) {
  std::array<Interval, 2> ranges{Interval{0, part.perimeter()}, Interval{0, part.perimeter()}};
  if (part.closed()) return ranges;
  for (const Reading& reading : readings) {
    const std::array<double, 2> lengths{reading.length[0], reading.length[1]};
    for (std::size_t finger = 0; finger < 2; ++finger) {
      ranges[finger].lo = std::max(ranges[finger].lo, -lengths[finger]);
      ranges[finger].hi = std::min(ranges[finger].hi, part.perimeter() - lengths[finger]);
    }
  }
  return ranges;
}

}  // namespace

std::vector<PerFinger<double>> locate_by_least_squares(const Part& part, const std::vector<Reading>& readings,
                                                       int starts) {
  const Residuals residuals(part.turning(), readings);
  const std::array<Interval, 2> where = ranges(part, readings);
  ceres::TinySolver<Residuals> solver;
  // Down to rounding: its own thresholds would stop at residuals of 1e-3.
  solver.options.function_tolerance = 1e-25;
  solver.options.cost_threshold = 1e-25;
  solver.options.gradient_tolerance = 1e-16;
  solver.options.parameter_tolerance = 1e-14;
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<PerFinger<double>> found;
  for (int k = 0; k < starts; ++k) {
    Eigen::Vector2d at;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      at[static_cast<int>(finger)] = where[finger].lo + unit(generator) * where[finger].width();
    }
    if (!(std::sqrt(2 * solver.Solve(residuals, &at).final_cost) <= kVanishes)) continue;
    PerFinger<double> pair{at[0], at[1]};
    if (part.closed()) {
      for (double& place : pair) place = part.boundary().base(place);
    } else if (!where[0].contains(pair[0]) || !where[1].contains(pair[1])) {
      continue;
    }
    const bool known = std::any_of(found.begin(), found.end(), [&](const PerFinger<double>& other) {
      return same_pair(part, pair, other, kSamePlace);
    });
    if (!known) found.push_back(pair);
  }
  return found;
}

}  // namespace bench
