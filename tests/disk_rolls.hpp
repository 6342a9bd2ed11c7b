#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

/// Small words for tests about a disk that rolls on a part.
namespace rollfix::disk_rolls {

inline Part part_of(const std::string& shape) { return Part(gallery(shape)); }

inline RollPlan by_distance(double start, double distance, std::size_t rows = 201) {
  RollPlan plan;
  plan.start = start;
  plan.distance = distance;
  plan.rows = rows;
  return plan;
}

inline RollPlan by_rotation(double start, double rotation, std::size_t rows = 201) {
  RollPlan plan;
  plan.start = start;
  plan.rotation = rotation;
  plan.rows = rows;
  return plan;
}

inline RollPlan by_profile(double start, double duration, std::function<double(double)> omega, std::size_t rows = 201) {
  RollPlan plan;
  plan.start = start;
  plan.duration = duration;
  plan.omega = std::move(omega);
  plan.rows = rows;
  return plan;
}

inline Contact contact_at(const Roll& roll, std::size_t row) {
  return {roll.log.fingers[0].u[row], roll.log.fingers[0].psi[row]};
}
inline Vec2 centre_at(const Roll& roll, std::size_t row) {
  return {roll.log.fingers[0].x[row], roll.log.fingers[0].y[row]};
}
inline Reading reading_at(const Roll& roll, const DiskFinger& finger, std::size_t row) {
  return reading_between(finger, contact_at(roll, 0), contact_at(roll, row));
}

/// The largest difference between two rolls in what the sensors read and where the contact is.
inline double difference(const Roll& a, const Roll& b, const DiskFinger& finger) {
  double most = a.s[0].size() == b.s[0].size() ? 0 : 1e300;
  for (std::size_t k = 0; k < a.s[0].size() && most < 1e300; ++k) {
    const Reading reading_a = reading_at(a, finger, k);
    const Reading reading_b = reading_at(b, finger, k);
    most = std::max({most, std::abs(a.s[0][k] - b.s[0][k]), std::abs(reading_a.length[0] - reading_b.length[0]),
                     std::abs(reading_a.turn - reading_b.turn), (centre_at(a, k) - centre_at(b, k)).norm(),
                     std::abs(a.angle[0][k] - b.angle[0][k])});
  }
  return most;
}

}  // namespace rollfix::disk_rolls
