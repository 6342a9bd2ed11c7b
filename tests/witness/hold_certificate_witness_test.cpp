// Certificates of holds and of the rig over random questions: all are proved, and no lie is. Sizes and times are
// printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "hold/hold_certificates.hpp"
#include "hold/hold_liar.hpp"
#include "random.hpp"

namespace hold_certificate_witness_test {
namespace {

using namespace hold_certificates;

/// Of questions of one kind; times in ms.
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
  if (of.bytes.empty()) return;
  std::printf("| %s | %zu | %d | %.0f | %.0f | %.3g | %.3g | %.3g | %.3g |\n", name, of.bytes.size(), of.open,
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

void ask(const HoldProblem& problem, Measured& measured) {
  std::optional<HoldAnswer> answer;
  std::string text;
  Verdict verdict;
  measured.search.push_back(timed([&] { answer = rollfix::solve(problem); }));
  measured.drawn_up.push_back(
      timed([&] { text = rollfix::format_certificate(rollfix::certify_holds(problem, *answer)); }));
  measured.checked.push_back(timed([&] { verdict = rollfix_verify::check(text); }));
  measured.bytes.push_back(static_cast<double>(text.size()));
  measured.boxes.push_back(static_cast<double>(verdict.cells));
  const bool is_decided = answer->status == rollfix::Status::complete;
  measured.open += verdict.is_complete() ? 0 : 1;
  EXPECT_TRUE(verdict.refusal.empty() || !is_decided) << verdict.refusal;
  EXPECT_TRUE(verdict.is_complete() || !is_decided) << described(verdict).substr(0, 200);
}

TEST(HoldCertificateWitness, random_rigs_are_proved) {
  Measured plain, encoder, noisy;
  for (int k = 0; k < test_count(8); ++k) {
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
  for (int k = 0; k < test_count(4); ++k) {
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
      hold_liar::tell(test_count(2), generator, [](const Json& lie, const std::string& name, int question) {
        EXPECT_FALSE(is_proved(lie)) << question << ": " << name;
      });
  EXPECT_LE(std::count(told.begin(), told.end(), 0), 2);
}

}  // namespace
}  // namespace hold_certificate_witness_test
