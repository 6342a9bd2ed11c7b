// Certificates of random outlines of lines and arcs: none that the program writes is refused.
#include <gtest/gtest.h>

#include "honest_certificates.hpp"
#include "random.hpp"

namespace honest_certificate_test {
namespace {

TEST(HonestCertificate, of_one_finger_on_lines_and_arcs_is_not_refused) {
  const int count = test_count(40);
  EXPECT_GE(honest_certificates::of_one_finger(count, 1).proved, 0.9 * count);
}

TEST(HonestCertificate, of_two_fingers_on_lines_and_arcs_is_not_refused) {
  const int count = test_count(3);
  const honest_certificates::Tally all = honest_certificates::of_two_fingers(count, 2);
  EXPECT_EQ(all.proved + all.open, count);
}

}  // namespace
}  // namespace honest_certificate_test
