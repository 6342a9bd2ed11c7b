#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "check.hpp"
#include "rollfix/solve.hpp"

// What certificates cost: how large they are, how long they take to draw up and to check.
namespace certificate_measures {

/// Of questions of one kind; times in ms.
struct Measured {
  std::vector<double> bytes, boxes, search, drawn_up, checked;
  int open = 0;
};

inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A row of the tables in docs/certificates.md, where anything was measured.
inline void print(const char* name, const Measured& of) {
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

/// Solves a problem, draws up its certificate by `certify` of the answer, and has it checked: nothing that is complete
/// may be left open.
template <class Problem, class Certify>
void measure(const Problem& problem, const Certify& certify, Measured& measured) {
  std::optional<decltype(rollfix::solve(problem))> answer;
  std::string text;
  rollfix_verify::Verdict verdict;
  measured.search.push_back(timed([&] { answer = rollfix::solve(problem); }));
  measured.drawn_up.push_back(timed([&] { text = rollfix::format_certificate(certify(*answer)); }));
  measured.checked.push_back(timed([&] { verdict = rollfix_verify::check(text); }));
  measured.bytes.push_back(static_cast<double>(text.size()));
  measured.boxes.push_back(static_cast<double>(verdict.cells));
  measured.open += verdict.is_complete() ? 0 : 1;
  const bool is_decided = answer->status == rollfix::Status::complete;
  EXPECT_TRUE(verdict.refusal.empty() || !is_decided) << verdict.refusal;
  EXPECT_TRUE(verdict.is_complete() || !is_decided) << rollfix_verify::described(verdict).substr(0, 200);
}

}  // namespace certificate_measures
