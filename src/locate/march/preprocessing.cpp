#include "rollfix/locate/march/preprocessing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "rollfix/locate/march/preconditions.hpp"
#include "rollfix/locate/march/refusal.hpp"
#include "rollfix/locate/march/samples.hpp"
#include "rollfix/locate/march/sign_changes.hpp"

namespace rollfix::march {

namespace {

/// The beginning of every step of the outline, in order: alive during preprocessing only.
std::vector<Position> walk_round(const Path& path) {
  std::vector<Position> steps{first_position(path)};
  while (steps.size() < path.steps_per_loop()) steps.push_back(next_position(path, steps.back()));
  return steps;
}

/// A place on the step that begins at `begin`.
Position place_on(const Path& path, const Position& begin, double u) {
  Position at = begin;
  at.u = u;
  at.here = begin.before + path.integrate(begin.curve, path.step(begin.curve, begin.index).lo, u);
  at.local = path.at(begin.curve, u);
  return at;
}

/// The step on which a zero lies: the last that begins at or before it.
const Position& step_of(const std::vector<Position>& steps, const Zero& zero) {
  const auto after = std::upper_bound(steps.begin(), steps.end(), zero, [](const Zero& place, const Position& step) {
    return place.curve != step.curve ? place.curve < step.curve : place.u < step.u;
  });
  return *(after - 1);
}

}  // namespace

Preprocessed preprocess(const Path& path) {
  const std::vector<Position> steps = walk_round(path);
  Preprocessed result;
  result.front = steps.front();
  result.loop = steps.back().before + steps.back().step;
  for (const Position& step : steps) {
    if (step.index == 0) result.curve_starts.push_back(step.before.length);
    result.variation += std::fabs(step.step.integral);
  }
  result.back = place_on(path, steps.back(), path.step(steps.back().curve, steps.back().index).hi);
  result.back.here = result.loop;

  const Samples samples = sample(path);
  check_preconditions(path, result, samples);

  const Zeros zeros = find_zeros(path, samples);
  result.first_sign = zeros.first_sign;
  for (const Zero& zero : zeros.list) {
    const Position at = place_on(path, step_of(steps, zero), zero.u);
    if (!zero.simple) {
      const Density& density = path.density();
      throw Refusal(Reason::degenerate_zero, at.here.length,
                    fmt::format("march: expected every {} to be simple, found {} and its slope zero at s = {:.17g}; "
                                "rollfix::locate handles it",
                                density.zero_name, density.name, at.here.length));
    }
    result.changes.push_back({at, zero.sign_after});
  }
  return result;
}

}  // namespace rollfix::march
