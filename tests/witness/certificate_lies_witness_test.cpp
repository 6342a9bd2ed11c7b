// Certificates that are false and certificates that are true, by the hundred.
#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

#include "certificate_lies.hpp"
#include "honest_certificates.hpp"
#include "random.hpp"

namespace certificate_lies_witness_test {
namespace {

TEST(CertificateLiesWitness, of_every_kind_are_told_and_none_is_proved) {
  std::mt19937_64 generator = test_generator(3);
  const int count = test_count(200);
  const std::vector<int> told = certificate_lies::tell(count, generator);
  for (std::size_t k = 0; k < told.size(); ++k) EXPECT_GE(told[k], count / 50) << liar::Liar::all()[k].name;
}

TEST(HonestCertificateWitness, of_one_finger_on_lines_and_arcs_are_not_refused) {
  const int count = test_count(4000);
  const honest_certificates::Tally all = honest_certificates::of_one_finger(count, 4);
  EXPECT_GE(all.proved, 0.99 * count);
}

}  // namespace
}  // namespace certificate_lies_witness_test
