#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/posterior.hpp"

// Notation:
//   e_i             innovations of one equation, in standard deviations, i = 0, ..., n - 1: `each`
//   c_k             sqrt(2 / n) sum of e_i cos(pi k (i + 1/2) / n), for k = 0 by sqrt(1 / n): `component`
//   m               `kComponents`, of few innovations a quarter as many: `most`
//   slow            c_0^2 + ... + c_(m-1)^2, less what all innovations are larger by: a chi-square of m degrees
// Follows docs/belief.md, "When the rows fit badly": J. Neyman, "Smooth test for goodness of fit" (1937), with the
// orthonormal cosine transform (DCT-II).
// Idea: white innovations have slow components as large as any other. A gyroscope's drift, an eccentric finger or a
// part that turns a little are in the slow ones alone.
namespace rollfix::belief {

namespace {

// So many components, the mean among them: what drifts, and what goes to and fro up to five times during the roll. More
// would hide the slowest.
constexpr double kComponents = 10;
// ... of fewer innovations fewer, so that the others tell how large innovations are.
constexpr double kInnovationsEach = 4;
constexpr double kFewestComponents = 2;

/// The orthonormal cosine transform (DCT-II), one number of it.
double component(const std::pmr::vector<double>& values, std::size_t k) {
  const auto count = static_cast<double>(values.size());
  const double step = std::numbers::pi * static_cast<double>(k) / count;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * std::cos(step * (static_cast<double>(i) + 0.5));
  return std::sqrt((k == 0 ? 1 : 2) / count) * sum;
}

}  // namespace

Trend trend_of(const Innovations& innovations, double freedom) {
  const auto equations = static_cast<double>(
      std::count_if(innovations.begin(), innovations.end(), [](const auto& each) { return !each.empty(); }));
  double slow = 0;
  double components = 0;
  double differences = 0;
  double neighbours = 0;
  for (const std::pmr::vector<double>& each : innovations) {
    if (each.empty()) continue;
    const auto count = static_cast<double>(each.size());
    for (std::size_t i = 1; i < each.size(); ++i) differences += square(each[i] - each[i - 1]);
    neighbours += count - 1;
    // Equations share the freedom evenly.
    const double independent = std::min(count, freedom / equations);
    const double most = std::floor(std::min(kComponents, independent / kInnovationsEach));
    if (most < kFewestComponents) continue;
    double of_slow = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(most); ++k) of_slow += square(component(each, k));
    double squares = 0;
    for (const double innovation : each) squares += square(innovation);
    // Where all are larger than said, that is told already. Errors far smaller than said are not told apart: then the
    // answer is not surer than they allow.
    const double larger = std::max(1.0, (squares - of_slow) / (count - most));
    slow += of_slow / larger;
    components += most;
  }
  Trend trend;
  trend.count = equations > 0 ? neighbours / equations : 0;
  if (neighbours > 0) trend.jitter = 0.5 * differences / neighbours;
  if (components == 0) return trend;
  trend.sigmas = normal_deviate(slow, components);
  trend.widened = std::max(1.0, std::sqrt(slow / components));
  return trend;
}

}  // namespace rollfix::belief
