#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

/// How many cases a randomised test runs: `default_count`, or what the test program was told:
/// --count=N for N cases in every test, --count=Fx for F times each test's default, at least one.
int test_count(int default_count);

/// The same for a test that needs so many cases to say anything: never fewer.
inline int full_count(int default_count) { return std::max(default_count, test_count(default_count)); }

/// The seed of a randomised test: fixed, or --seed=N. A failing test prints it.
std::uint64_t test_seed();

/// A generator seeded with test_seed(); `stream` gives independent ones.
inline std::mt19937_64 test_generator(std::uint64_t stream = 0) {
  return std::mt19937_64(test_seed() + 0x9e3779b97f4a7c15U * stream);
}
