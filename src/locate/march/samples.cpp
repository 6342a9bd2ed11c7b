#include "rollfix/locate/march/samples.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::march {

namespace {

/// As dense as the quadrature's nodes: what lies between them is searched by its local minima.
constexpr std::size_t kSamplesPerStep = 6;

}  // namespace

Samples sample(const Path& path) {
  Samples samples;
  for (std::size_t curve = 0; curve < path.curves(); ++curve) {
    std::vector<Sample> values;
    const auto add = [&](double u) {
      values.push_back({u, path.at(curve, u).density});
      samples.scale = std::max(samples.scale, std::fabs(values.back().density));
    };
    for (std::size_t index = 0; index < path.steps(curve); ++index) {
      const Interval step = path.step(curve, index);
      for (std::size_t k = 0; k < kSamplesPerStep; ++k) {
        add(step.lo + step.width() * (static_cast<double>(k) / static_cast<double>(kSamplesPerStep)));
      }
    }
    add(path.step(curve, path.steps(curve) - 1).hi);
    samples.curves.push_back(std::move(values));
  }
  return samples;
}

}  // namespace rollfix::march
