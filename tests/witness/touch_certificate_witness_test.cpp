// Certificates of touches over random questions: all are proved, and no lie is. Sizes and times are printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "touch/touch_certificates.hpp"
#include "touch/touch_liar.hpp"
#include "witness/certificate_measures.hpp"

namespace touch_certificate_witness_test {
namespace {

using namespace touch_certificates;
using namespace certificate_measures;

void ask(const TouchProblem& problem, Measured& measured) {
  measure(
      problem, [](const TouchAnswer& answer) { return rollfix::certify_touches(answer); }, measured);
}

TEST(TouchCertificateWitness, random_questions_are_proved) {
  constexpr std::array kNames{"splines, 9 knots",     "splines, 30 knots", "airfoil",       "polygons, 7 to 11 corners",
                              "a bracket of 8 lines", "`bracket.dxf`",     "lines and arcs"};
  std::array<Measured, kNames.size()> all;
  int open = 0;
  for (int k = 0; k < test_count(70); ++k) {
    SCOPED_TRACE("question " + std::to_string(k));
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 7000);
    ask(random_question(k, generator), all[static_cast<std::size_t>(k) % all.size()]);
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].bytes.empty()) print(kNames[k], all[k]);
    open += all[k].open;
  }
  EXPECT_LE(open, 1 + test_count(70) / 50);
}

TEST(TouchCertificateWitness, no_lie_is_proved) {
  std::mt19937_64 generator = test_generator(8000);
  const std::vector<int> told = touch_liar::tell(full_count(4), {0, 1, 2, 3, 4, 5, 6}, generator,
                                                 [](const Json& lie, const std::string& name, int question) {
                                                   EXPECT_FALSE(is_proved(lie)) << question << ": " << name;
                                                 });
  EXPECT_LE(std::count(told.begin(), told.end(), 0), 2);
}

}  // namespace
}  // namespace touch_certificate_witness_test
