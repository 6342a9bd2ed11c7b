// Certificates of rolls and touches over random questions: all are proved, and no lie is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "touch/roll_certificates.hpp"

namespace roll_certificate_witness_test {

using namespace roll_certificates;
using touch_certificates::certificate;
using touch_certificates::checked;
using touch_certificates::is_proved;
using touch_certificates::Verdict;

TEST(RollCertificateWitness, RandomQuestionsAreProved) {
  int open = 0;
  int headings = 0;
  std::size_t left_out = 0;
  for (int k = 0; k < test_count(12); ++k) {
    SCOPED_TRACE(k);
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 9000);
    const TouchAnswer answer = rollfix::solve(random_question(k, generator));
    const Verdict verdict = checked(certificate(answer));
    EXPECT_EQ(verdict.refusal, "");
    open += verdict.is_complete() ? 0 : 1;
    left_out += verdict.left_out;
    headings += answer.place == rollfix::PlaceKnown::unknown ? 1 : 0;
  }
  std::printf("%d questions, %d of headings alone, %d left open, %zu sets left out\n", test_count(12), headings, open,
              left_out);
  EXPECT_LE(open, 1 + test_count(12) / 50);
}

TEST(RollCertificateWitness, NoLieIsProved) {
  std::vector<int> told;
  for (int k = 0; k < test_count(2); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 9500);
    Asking asking;
    asking.rolling.count = 2;
    asking.rolling.touches = static_cast<std::size_t>(k) % 2;
    asking.rolling.rows = 10;
    asking.some_centres = false;
    const int kind = k % 3 == 2 ? 1 : 0;
    const Json truth = certificate(question(touch_certificates::random_part(kind, generator), asking, generator));
    const auto has_pose = [](const Json& one) { return one.contains("pose"); };
    if (truth["poses"].empty() || !std::all_of(truth["poses"].begin(), truth["poses"].end(), has_pose)) continue;
    told_lies::tell_each(lies(), truth, generator, told, [&](const Json& lie, const std::string& name) {
      EXPECT_FALSE(is_proved(lie)) << k << ": " << name;
    });
  }
  const int all = std::accumulate(told.begin(), told.end(), 0);
  std::printf("%d lies of %zu kinds\n", all, told.size());
  EXPECT_GT(all, 10 * test_count(2));
}

}  // namespace roll_certificate_witness_test
