// The table of watch: what a sample of a growing log costs, from its line to what it means.

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "rollfix/watch/watcher.hpp"
#include "stopwatch.hpp"
#include "tables.hpp"

namespace bench {
namespace {

constexpr double kContactShare = 2e-4;  // the noise of a contact's place, as a share of the perimeter
constexpr double kAngle = 0.003;        // of a turn, radians

rollfix::Noise noise_on(const rollfix::Part& part) { return {kContactShare * part.perimeter(), kAngle, 0, 0}; }

/// The lines of a roll over one and a half perimeters, of an open part over half of it.
std::vector<std::string> noisy_roll(const rollfix::Part& part, int rows) {
  const double P = part.perimeter();
  const double start = 0.21 * P;
  const double length = (part.closed() ? 1.5 : 0.5) * P;
  const rollfix::Noise noise = noise_on(part);
  std::mt19937_64 random(20010529);
  std::normal_distribution<double> off;
  std::vector<std::string> lines = {"time,length,turn"};
  for (int k = 1; k <= rows; ++k) {
    const double L = length * k / rows;
    const double theta = part.turning().angle(start + L) - part.turning().angle(start);
    lines.push_back(
        fmt::format("{:.3f},{:.9g},{:.6f}", 0.01 * k, L + noise.contact * off(random), theta + kAngle * off(random)));
  }
  return lines;
}

/// Somebody who only counts what is told.
class Counter : public rollfix::app::WatchListener {
 public:
  void found(const rollfix::app::WatchAnswer& /*answer*/) override {}
  void changed(const rollfix::app::WatchAnswer& /*answer*/) override { ++changes; }
  void over(const rollfix::app::WatchAnswer& /*answer*/, rollfix::app::RollEnd /*why*/) override {}
  void note(const std::string& /*message*/) override {}
  bool is_ready() override { return true; }

  int changes = 0;
};

struct Watched {
  double microseconds = 0;  // per sample
  int changes = 0;
  std::string verdict;
};

Watched watch(const rollfix::Part& part, const std::vector<std::string>& lines) {
  rollfix::app::WatchOptions options;
  options.name = "bench";
  options.belief.noise = noise_on(part);
  Counter counter;
  const std::clock_t start = std::clock();
  rollfix::app::Watcher watcher(part, options, counter);
  for (const std::string& line : lines) watcher.push(line);
  watcher.finish();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return {1e6 * seconds / static_cast<double>(watcher.counts().samples), counter.changes,
          watcher.last_answer().verdict.text()};
}

double parsing(const rollfix::Part& part, const std::vector<std::string>& lines) {
  const double seconds = seconds_per_call([&] {
    rollfix::LogStream stream("bench", part, std::vector<rollfix::Finger>{}, noise_on(part));
    for (const std::string& line : lines) keep(stream.push(line));
  });
  return 1e6 * seconds / static_cast<double>(lines.size());
}

}  // namespace

void watch(int rounds) {
  fmt::print("outline          1000 rows [us]  10000 rows [us]  reading alone [us]  told  verdict\n");
  Mean short_rolls;
  Mean long_rolls;
  for (const Family& family : families()) {
    const rollfix::Part part(family.outline);
    const std::vector<std::string> few = noisy_roll(part, 1000);
    const std::vector<std::string> many = noisy_roll(part, 10000);
    std::vector<double> of_few;
    std::vector<double> of_many;
    Watched last;
    for (int round = 0; round < std::max(1, rounds / 5); ++round) {
      of_few.push_back(watch(part, few).microseconds);
      last = watch(part, many);
      of_many.push_back(last.microseconds);
    }
    short_rolls.add(least(of_few));
    long_rolls.add(least(of_many));
    fmt::print("{:<16} {:14.1f}  {:15.1f}  {:18.2f}  {:4}  {}\n", family.name, least(of_few), least(of_many),
               parsing(part, few), last.changes, last.verdict);
  }
  fmt::print("{:<16} {:14.1f}  {:15.1f}\n", "geometric mean", short_rolls.value(), long_rolls.value());
}

}  // namespace bench
