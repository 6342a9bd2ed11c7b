// What one finger and two fingers cost, in units of W: one integration of the same outline's perimeter, timed in the
// same process. What saved parts, reach and a growing log cost, in microseconds. And how well noisy logs are localized.
//   rollfix_bench [ROUNDS [TABLE...]]     rounds of measurement (default 15); all tables, or those named:
//                                         one, two, files, watch, posterior, noisy,
//                                         advised
// 0 rounds: nothing is timed, "?" stands for it, and only what is the same every time is counted, within seconds, in
// the first four tables. tests/docs/compare_tables.py compares it with docs/performance.md.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tables.hpp"

namespace {

struct Table {
  const char* name;
  const char* title;
  void (*print)(int rounds);
  bool has_counts;  // some of its columns need no measuring
};

// Logs and cases on each part, for a round.
constexpr int kLogs = 7;

constexpr std::array<Table, 7> kTables = {{
    {"one", "one finger", bench::one_finger, true},
    {"two", "two fingers", bench::two_fingers, true},
    {"files", "saved parts and reach", bench::files, true},
    {"watch", "watching a growing log", bench::watch, true},
    {"posterior", "the posterior of one shape through few points and many", bench::posterior, false},
    {"noisy", "noisy logs", [](int rounds) { bench::noisy(kLogs * rounds); }, false},
    {"advised", "advised rolls", [](int rounds) { bench::advised(kLogs * rounds); }, false},
}};

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(0, std::atoi(argv[1])) : 15;
  for (const Table& table : kTables) {
    const bool is_named = std::any_of(argv + std::min(argc, 2), argv + argc,
                                      [&](const char* name) { return std::string_view(name) == table.name; });
    if (argc > 2 ? !is_named : rounds == 0 && !table.has_counts) continue;
    std::printf("%s\n", table.title);
    table.print(rounds);
    std::puts("");
  }
  return 0;
}
