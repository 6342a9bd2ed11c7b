#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string_view>

#include "rollfix/reading.hpp"

namespace rollfix::rolling {

/// Normal numbers from a seed, the same on all platforms, which std::normal_distribution's are not: the polar method
/// (Marsaglia 1964) on a generator that the standard fixes.
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : generator_(seed) {}

  /// With mean 0 and this standard deviation.
  double next(double deviation) {
    // The polar method gives two numbers at once; the second one waits.
    if (has_spare_) {
      has_spare_ = false;
      return deviation * spare_;
    }
    double x = 0;
    double y = 0;
    double square = 0;
    // A point in the unit disk, evenly: x / sqrt(square) and the square are then independent. On average 4 / pi tries.
    do {
      x = uniform();
      y = uniform();
      square = x * x + y * y;
    } while (square >= 1 || square == 0);
    const double stretch = std::sqrt(-2 * std::log(square) / square);
    spare_ = y * stretch;
    has_spare_ = true;
    return deviation * (x * stretch);
  }

 private:
  /// In [-1, 1).
  /// Of the generator's 64 bits the upper 53, as many as a double holds.
  double uniform() { return std::ldexp(static_cast<double>(generator_() >> 11U), -52) - 1; }

  std::mt19937_64 generator_;
  /// with standard deviation 1
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace rollfix::rolling

namespace rollfix {

/// What a problem knows of noise: every kind that it does not is 0. So a new kind is refused until a problem names it.
/// Throws InputError: "noise of touches is position and angle, found slip=0.01; leave it out".
void require_kinds(const Noise& noise, std::initializer_list<double Noise::*> known, std::string_view of_what);

/// The same sensors, `times` as noisy as stated: what each row has on its own, its contact, its orientation and its
/// centre.
Noise with_rows_as_noisy(const Noise& noise, double times);

}  // namespace rollfix
