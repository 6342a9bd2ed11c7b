#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <string>
#include <vector>

namespace bench {

/// Keeps a result alive, so that the compiler does not leave out the work for it.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(&value) : "memory");
}

/// Seconds of processor time that one call takes: as many calls in a row as fill `batch_seconds`. Not by the clock on
/// the wall, which other programs hold up.
template <class Job>
double seconds_per_call(Job&& job, double batch_seconds = 0.001) {
  std::size_t calls = 1;
  for (;;) {
    const std::clock_t start = std::clock();
    for (std::size_t k = 0; k < calls; ++k) job();
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (seconds >= batch_seconds) return seconds / static_cast<double>(calls);
    calls *= seconds > 0.1 * batch_seconds ? 2 : 10;
  }
}

/// Not a number where nothing was measured.
inline double least(const std::vector<double>& values) {
  return values.empty() ? std::nan("") : *std::min_element(values.begin(), values.end());
}

/// What was timed as text, with so many digits after the point; "?" where it was not.
inline std::string cell(double value, int digits) {
  return std::isnan(value) ? "?" : fmt::format("{:.{}f}", value, digits);
}

}  // namespace bench
