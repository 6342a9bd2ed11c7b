// Certificates of holds and of the rig over random questions: all are proved, and no lie is. Sizes and times are
// printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "hold/hold_certificates.hpp"
#include "hold/hold_liar.hpp"
#include "random.hpp"
#include "witness/certificate_measures.hpp"

namespace hold_certificate_witness_test {
namespace {

using namespace hold_certificates;
using namespace certificate_measures;

void ask(const HoldProblem& problem, Measured& measured) {
  measure(
      problem, [&](const HoldAnswer& answer) { return rollfix::certify_holds(problem, answer); }, measured);
}

TEST(HoldCertificateWitness, random_rigs_are_proved) {
  Measured plain, encoder, noisy;
  for (int k = 0; k < test_count(5); ++k) {
    SCOPED_TRACE("question " + std::to_string(k));
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 9000);
    const HoldProblem problem = random_rig_question(k, generator);
    ask(problem, problem.noise ? noisy : problem.wheels[0].log.has_encoder() ? encoder : plain);
  }
  print("jaw and wheel", plain);
  print("with an encoder", encoder);
  print("with noise", noisy);
}

TEST(HoldCertificateWitness, random_holds_are_proved) {
  Measured placed, headings, noisy;
  for (int k = 0; k < test_count(2); ++k) {
    SCOPED_TRACE("question " + std::to_string(k));
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 9500);
    const HoldProblem problem = random_hold_question(k, generator);
    ask(problem, problem.noise ? noisy : problem.logs[0].fingers[0].x.empty() ? headings : placed);
  }
  print("3 and 4 disks", placed);
  print("without `x` and `y`", headings);
  print("with noise", noisy);
}

TEST(HoldCertificateWitness, no_lie_is_proved) {
  std::mt19937_64 generator = test_generator(9900);
  const std::vector<int> told =
      hold_liar::tell(full_count(2), generator, [](const Json& lie, const std::string& name, int question) {
        EXPECT_FALSE(is_proved(lie)) << question << ": " << name;
      });
  EXPECT_LE(std::count(told.begin(), told.end(), 0), 2);
}

}  // namespace
}  // namespace hold_certificate_witness_test
