#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace bench {

/// Keeps a result alive, so that the compiler does not leave out the work for it.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(&value) : "memory");
}

/// Seconds that one call takes: as many calls in a row as fill `batch_seconds`.
template <class Job>
double seconds_per_call(Job&& job, double batch_seconds = 0.001) {
  using Clock = std::chrono::steady_clock;
  std::size_t calls = 1;
  for (;;) {
    const auto start = Clock::now();
    for (std::size_t k = 0; k < calls; ++k) job();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (seconds >= batch_seconds) return seconds / static_cast<double>(calls);
    calls *= seconds > 0.1 * batch_seconds ? 2 : 10;
  }
}

inline double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

}  // namespace bench
