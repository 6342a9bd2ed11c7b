// Certificates that are false, with all that belongs together changed together: none is proved.
#include "certificate_lies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "random.hpp"

namespace certificate_lies_test {
namespace {

TEST(CertificateLies, of_one_finger_are_none_of_them_proved) {
  std::mt19937_64 generator = test_generator();
  const std::vector<int> told = certificate_lies::tell(test_count(12), generator);
  EXPECT_GT(std::count_if(told.begin(), told.end(), [](int times) { return times > 0; }), 30);
}

TEST(CertificateLies, of_two_fingers_are_none_of_them_proved) {
  std::mt19937_64 generator = test_generator(2);
  const std::vector<int> told = certificate_lies::tell_of_two(full_count(3), generator);
  EXPECT_GT(std::count_if(told.begin(), told.end(), [](int times) { return times > 0; }), 25);
}

}  // namespace
}  // namespace certificate_lies_test
