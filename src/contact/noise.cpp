#include "rollfix/contact/noise.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rollfix/error.hpp"

namespace rollfix {

void require_valid(const Noise& noise) {
  for (const double sd : {noise.contact, noise.angle, noise.slip, noise.radius}) {
    if (sd >= 0 && std::isfinite(sd)) continue;
    throw InputError(fmt::format("noise of {}: expected finite standard deviations of at least 0", sd));
  }
}

}  // namespace rollfix
