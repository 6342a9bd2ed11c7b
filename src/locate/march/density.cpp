#include "rollfix/locate/march/density.hpp"

#include <utility>

namespace rollfix::march {

Density curvature_density() {
  return {Density::Kind::curvature, "the curvature", "inflection",
          [](const Site& site) { return curvature(site.jet); }};
}

Density curvature_rate_density() {
  return {Density::Kind::curvature_rate, "the curvature's derivative", "vertex",
          [](const Site& site) { return curvature_rate(site.jet) / site.jet.first.norm(); }};
}

Density density(DensityFunction f, std::string name) {
  return {Density::Kind::other, std::move(name), "sign change", std::move(f)};
}

}  // namespace rollfix::march
