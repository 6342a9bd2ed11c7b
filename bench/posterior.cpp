// The table of posteriors: what one log's probabilities cost where one and the same shape is given by few points and by
// many.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <vector>

#include "belief_cases.hpp"
#include "outlines.hpp"
#include "rollfix/outline/points.hpp"
#include "stopwatch.hpp"
#include "tables.hpp"

namespace bench {
namespace {

constexpr std::size_t kEggRows = 500;
constexpr double kEggRolled = 0.3;         // of the perimeter
constexpr double kEggContactShare = 1e-3;  // the noise of a contact's place, as a share of the perimeter
constexpr double kEggAngle = 5e-3;         // of an orientation, radians
constexpr double kEggSlip = 5e-3;
constexpr double kEggRadiusShare = 0.03;  // of the finger, by the perimeter

rollfix::Part egg_through(int count) {
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < count; ++k) {
    const double t = 2 * std::numbers::pi * k / count;
    const double bulge = 1 + 0.15 * std::cos(t);
    points.push_back({3 * bulge * std::cos(t), 2 * bulge * std::sin(t)});
  }
  return rollfix::Part(rollfix::Outline{"egg", rollfix::spline_through(points, true), true});
}

}  // namespace

void posterior(int rounds) {
  std::puts("points        ms  of that with 60");
  double first = std::nan("");
  for (const int count : {60, 400, 2000}) {
    const rollfix::Part part = egg_through(count);
    const double P = part.perimeter();
    rollfix::BeliefOptions options;
    options.noise = belief_cases::noise_on(part, kEggContactShare, kEggAngle, kEggSlip);
    const rollfix::NoisyRoll roll =
        belief_cases::roll_on(part, kEggRadiusShare * P, 0.21 * P, kEggRolled * P, kEggRows, options.noise, 7);
    std::vector<double> seconds;
    for (int round = 0; round < rounds; ++round) {
      const std::clock_t start = std::clock();
      rollfix::Belief belief = belief_cases::belief_in(part, roll.log, kEggRadiusShare * P, options);
      keep(belief.modes());
      seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    if (std::isnan(first)) first = least(seconds);
    std::printf("%6d  %8s  %15s\n", count, cell(1e3 * least(seconds), 2).c_str(),
                cell(least(seconds) / first, 2).c_str());
  }
}

}  // namespace bench
