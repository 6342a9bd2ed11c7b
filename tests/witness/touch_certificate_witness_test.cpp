// Certificates of touches over random questions: all are proved, and no lie is. Sizes and times are printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "touch/touch_certificates.hpp"
#include "touch/touch_liar.hpp"

namespace touch_certificate_witness_test {
namespace {

using namespace touch_certificates;

/// Of questions about one kind of part; times in ms.
struct Measured {
  std::vector<double> bytes, boxes, search, drawn_up, checked;
  int open = 0;
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A row of the table in docs/certificates.md.
void print(const char* name, const Measured& of) {
  std::printf("| %s | %zu | %d | %.0f | %.0f | %.2g | %.2g | %.2g | %.2g |\n", name, of.bytes.size(), of.open,
              median_of(of.bytes), median_of(of.boxes), median_of(of.search), median_of(of.drawn_up),
              median_of(of.checked), *std::max_element(of.checked.begin(), of.checked.end()));
}

/// In ms, of what is called: of this thread's processor.
template <class Call>
double timed(const Call& call) {
  const std::clock_t start = std::clock();
  call();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void ask(const TouchProblem& problem, Measured& measured) {
  std::optional<TouchAnswer> answer;
  std::string text;
  Verdict verdict;
  measured.search.push_back(timed([&] { answer = rollfix::solve(problem); }));
  measured.drawn_up.push_back(timed([&] { text = rollfix::format_certificate(rollfix::certify_touches(*answer)); }));
  measured.checked.push_back(timed([&] { verdict = rollfix_verify::check(text); }));
  measured.bytes.push_back(static_cast<double>(text.size()));
  measured.boxes.push_back(static_cast<double>(verdict.cells));
  measured.open += verdict.is_complete() ? 0 : 1;
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_TRUE(verdict.is_complete() || answer->status == rollfix::Status::incomplete) << described(verdict);
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
  const std::vector<int> told = touch_liar::tell(test_count(14), {0, 1, 2, 3, 4, 5, 6}, generator,
                                                 [](const Json& lie, const std::string& name, int question) {
                                                   EXPECT_FALSE(is_proved(lie)) << question << ": " << name;
                                                 });
  EXPECT_LE(std::count(told.begin(), told.end(), 0), 2);
}

}  // namespace
}  // namespace touch_certificate_witness_test
