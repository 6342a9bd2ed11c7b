#include "rollfix/output/scale_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace rollfix::app {
namespace {

/// In degrees per hour, as data sheets have it.
std::string bias_text(const Fit& fit) {
  constexpr double kDegreesPerHour = 3600 * 180 / std::numbers::pi;
  return fmt::format("{:.4g} +- {:.2g} deg/h: the rate of the gyroscope at rest", fit.turn_bias * kDegreesPerHour,
                     fit.turn_bias_sd * kDegreesPerHour);
}

}  // namespace

std::string scale_text(double scale, double sd, const char* more, const char* less) {
  std::string text = fmt::format("{:.4f} +- {:.2g} times what was measured", scale, sd);
  const double off = 100 * (scale - 1);
  if (std::abs(scale - 1) > 2 * sd) text += fmt::format(": they are {:.2g} % {}", std::abs(off), off > 0 ? more : less);
  return text;
}

std::string scale_lines(const Fit& fit, std::size_t fingers) {
  std::string text;
  for (std::size_t finger = 0; finger < fingers; ++finger) {
    const double sd = fit.length_scale_sd[finger];
    if (!(sd > 0)) continue;
    const char* whose = fingers == 1 ? "" : finger == 0 ? "of finger a " : "of finger b ";
    text += fmt::format("lengths    {}{}\n", whose, scale_text(fit.length_scale[finger], sd, "longer", "shorter"));
  }
  if (const double sd = fit.turn_scale_sd; sd > 0) {
    text += fmt::format("turns      {}\n", scale_text(fit.turn_scale, sd, "larger", "smaller"));
  }
  if (fit.turn_bias_sd > 0) text += fmt::format("bias       {}\n", bias_text(fit));
  return text;
}

}  // namespace rollfix::app
