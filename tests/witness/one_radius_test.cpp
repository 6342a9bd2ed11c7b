// Two fingers, one of whose radii is wrong: which, and what it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "noisy_pairs.hpp"
#include "random.hpp"
#include "rollfix/solve.hpp"

namespace one_radius_test {
namespace {

using namespace noisy_pairs;
using rollfix::Cause;
using rollfix::Diagnosis;

/// What may be wrong, where the radius of one finger is said to be so many times what it is.
std::vector<Diagnosis> with_wrong_radius(const std::string& shape, std::size_t finger, double times) {
  const Part part = free_rolls::part_of(shape);
  const double P = part.perimeter();
  const Noise noise{0.0005 * P, 0.005, 0, 0};
  std::mt19937_64 generator = test_generator(31);
  const Case drawn =
      noisy_case(part, {0.15 * P, 0.6 * P}, 0.45 * P, 0.4 * P, 200, 0.02 * P, 0.016 * P, noise, generator);
  std::array<rollfix::DiskFinger, 2> said = drawn.fingers;
  said[finger].radius *= times;
  return rollfix::solve({part, drawn.log, {said[0], said[1]}, noise}).diagnoses;
}

bool tells(const Diagnosis& found, std::size_t finger, double times) {
  return found.cause == Cause::radius && found.finger == finger && std::abs(found.length_scale * times - 1) < 0.03 &&
         std::abs(found.length_scale * times - 1) < 4 * found.length_scale_sd * times;
}

}  // namespace

TEST(OneRadius, that_is_wrong_is_told_with_its_finger_and_its_size) {
  for (const char* shape : {"limacon", "spline,seed=3", "rounded-rectangle"}) {
    for (const std::size_t finger : {0U, 1U}) {
      for (const double times : {0.8, 1.2}) {
        const std::vector<Diagnosis> found = with_wrong_radius(shape, finger, times);
        ASSERT_FALSE(found.empty()) << shape << ", finger " << finger << ", times " << times;
        EXPECT_TRUE(tells(found.front(), finger, times)) << shape << ", finger " << finger << ", times " << times;
      }
    }
  }
}

TEST(OneRadius, that_is_wrong_is_among_those_told_where_the_others_could_be_as_well) {
  // On the cam's arcs a finger's length and the other's tell the same.
  for (const std::size_t finger : {0U, 1U}) {
    const std::vector<Diagnosis> found = with_wrong_radius("cam", finger, 0.8);
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const Diagnosis& one) { return tells(one, finger, 0.8); }));
  }
}

}  // namespace one_radius_test
