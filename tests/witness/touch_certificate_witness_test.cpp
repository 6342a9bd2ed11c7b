// Certificates of touches over random questions: all are proved, and no lie is. Sizes and times are printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "touch/touch_certificates.hpp"
#include "touch/touch_liar.hpp"

namespace touch_certificate_witness_test {
namespace {

using namespace touch_certificates;

struct Measured {
  std::vector<double> bytes, boxes, search, drawn_up, checked;  // times in ms
};

double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void print(const char* name, const std::vector<double>& values) {
  std::printf("%-28s median %10.3g, most %10.3g\n", name, median_of(values),
              *std::max_element(values.begin(), values.end()));
}

/// In ms, of what is called.
template <class Call>
double timed(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

TEST(TouchCertificateWitness, random_questions_are_proved) {
  Measured measured;
  int open = 0;
  for (int k = 0; k < test_count(70); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 7000);
    const TouchProblem problem = random_question(k, generator);
    std::optional<TouchAnswer> answer;
    std::string text;
    Verdict verdict;
    measured.search.push_back(timed([&] { answer = rollfix::solve(problem); }));
    measured.drawn_up.push_back(timed([&] { text = rollfix::format_certificate(rollfix::certify_touches(*answer)); }));
    measured.checked.push_back(timed([&] { verdict = rollfix_verify::check(text); }));
    measured.bytes.push_back(static_cast<double>(text.size()));
    measured.boxes.push_back(static_cast<double>(verdict.cells));
    EXPECT_EQ(verdict.refusal, "") << "question " << k;
    EXPECT_TRUE(verdict.is_complete() || answer->status == rollfix::Status::incomplete || verdict.open > 0)
        << "question " << k;
    open += verdict.is_complete() ? 0 : 1;
  }
  std::printf("%zu questions, %d of them left open\n", measured.bytes.size(), open);
  print("bytes", measured.bytes);
  print("boxes of poses", measured.boxes);
  print("search, ms", measured.search);
  print("drawing up, ms", measured.drawn_up);
  print("checking, ms", measured.checked);
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
