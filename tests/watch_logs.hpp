#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/rolling.hpp"

namespace watching {

/// Rolls on the cam, felt by a finger that is off by kNoise.
inline const rollfix::DiskFinger kFinger{0.2};
inline const rollfix::Noise kNoise{0.002, 0.003, 0, 0};
inline const std::string kOptions = "gallery:cam --finger disk,r=0.2 --noise contact=0.002,angle=0.003 ";
inline const std::string kHeader = "time,u,psi,contact";

inline const rollfix::Part& cam() {
  static const rollfix::Part part(rollfix::gallery("cam"));
  return part;
}

/// The rows of a roll from s = start, with the noise that the options above speak of.
inline std::vector<std::string> noisy_rows(double start, double length, std::size_t count, double from_time = 0) {
  rollfix::RollPlan plan;
  plan.start = start;
  plan.distance = length;
  plan.rows = count;
  const rollfix::Log log = rollfix::roll(cam(), kFinger, plan).log;
  std::mt19937_64 random = test_generator(static_cast<std::uint64_t>(1000 * start));
  std::normal_distribution<double> off;
  std::vector<std::string> rows;
  for (std::size_t k = 0; k < count; ++k) {
    const double u = log.fingers[0].u[k] + kNoise.contact / kFinger.radius * off(random);
    const double psi = log.fingers[0].psi[k] + kNoise.angle * off(random);
    rows.push_back(fmt::format("{:.4f},{:.6f},{:.6f},1", from_time + log.time[k], u, psi));
  }
  return rows;
}

inline std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// A whole log.
inline std::string noisy_log(double start, double length, std::size_t count) {
  return kHeader + "\n" + text_of(noisy_rows(start, length, count));
}

}  // namespace watching
