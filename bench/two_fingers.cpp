// The table of two fingers: all placements of two readings, of one with the facing, and the least-squares method that
// came before at several numbers of starts, with the share of all placements that it finds.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "least_squares.hpp"
#include "outlines.hpp"
#include "pair_oracle.hpp"
#include "rollfix/locate/locate.hpp"
#include "same_pair.hpp"
#include "stopwatch.hpp"
#include "tables.hpp"

namespace bench {
namespace {

using namespace rollfix;

constexpr std::size_t kCases = 50;
constexpr std::size_t kBaselineCases = 20;  // of them: a thousand starts take long
constexpr std::array<int, 3> kStarts = {10, 100, 1000};
constexpr int kManyStarts = 1000;  // take long: no more than a few rounds of them
constexpr int kFewRounds = 3;
constexpr double kSamePair = 1e-6;  // of the perimeter

struct Case {
  std::vector<Reading> readings;
  double facing = 0;
};

/// Rolls of up to a lap from two places drawn at random.
std::vector<Case> random_cases(const Part& part) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const TurningFunction& turning = part.turning();
  const double period = part.perimeter();
  const auto length = [&](double from) {
    return part.closed() ? (2 * unit(generator) - 1) * period : unit(generator) * period - from;
  };
  const auto turn = [&](double from, double roll) { return turning.angle(from + roll) - turning.angle(from); };
  std::vector<Case> cases(kCases);
  for (Case& drawn : cases) {
    const double s = unit(generator) * period;
    const double t = unit(generator) * period;
    for (int k = 0; k < 2; ++k) {
      const double a = length(s);
      const double b = length(t);
      drawn.readings.push_back({a, b, turn(s, a) - turn(t, b)});
    }
    drawn.facing = turning.angle(s) - turning.angle(t);
  }
  return cases;
}

Search find(const Part& part, const Case& given) { return locate(part, given.readings); }

Search find_with_facing(const Part& part, const Case& given) {
  LocateOptions options;
  options.facing = given.facing;
  return locate(part, {given.readings.front()}, options);
}

/// Time and recall of the earlier method.
struct Baseline {
  double cost = 0;    // in W, per case
  double recall = 0;  // share of the placements found
};

struct PairRow {
  std::string name;
  double unit = 0;        // W in seconds
  double locate = 0;      // in W, per case
  double facing = 0;      // likewise
  double placements = 0;  // per case
  double boxes = 0;       // per case
  int incomplete = 0;     // cases
  std::array<Baseline, kStarts.size()> baseline;
  int lost = 0;  // placements that only the baseline or the exhaustive check knows
};

/// Whether this pair is the placement's start, or one of the others that the tolerance does not tell from it.
bool answers(const Part& part, const Placement& placement, const PerFinger<double>& pair) {
  if (same_pair(part, pair, placement.start, kSamePair)) return true;
  const auto inside = [&](std::size_t finger) {
    const Interval& extent = placement.extent[finger];
    return placement.whole_loop[finger] || part.boundary().contains(extent, pair[finger]);
  };
  return inside(0) && inside(1);
}

/// All isolated placements of a case: the search's, and what only the exhaustive check (where the part is smooth) or
/// the baseline knows.
std::vector<Placement> known_placements(const Part& part, const pair_oracle::Exhaustive* oracle, const Case& given,
                                        std::vector<PerFinger<double>> others, int& lost) {
  std::vector<Placement> all = find(part, given).placements;
  if (oracle != nullptr) {
    for (const pair_oracle::Root& root : oracle->scan(given.readings).roots) others.push_back({root.s, root.t});
  }
  for (const PerFinger<double>& pair : others) {
    const auto known = [&](const Placement& placement) { return answers(part, placement, pair); };
    if (std::any_of(all.begin(), all.end(), known)) continue;
    Placement placement;
    placement.start = pair;
    placement.extent = {Interval{pair[0], pair[0]}, Interval{pair[1], pair[1]}};
    all.push_back(placement);
    ++lost;
  }
  const auto is_other = [](const Placement& placement) {
    return placement.kind == Kind::stretch || placement.kind == Kind::corner;
  };
  all.erase(std::remove_if(all.begin(), all.end(), is_other), all.end());
  return all;
}

template <class Job>
double seconds_per_case(const std::vector<Case>& cases, Job&& job) {
  return seconds_per_call([&] {
           for (const Case& given : cases) keep(job(given));
         }) /
         static_cast<double>(cases.size());
}

void measure_baseline(const Part& part, const pair_oracle::Exhaustive* oracle, const std::vector<Case>& cases,
                      int rounds, PairRow& row) {
  std::array<double, kStarts.size()> found{};
  double all = 0;
  for (const Case& given : cases) {
    const std::vector<PerFinger<double>> most = locate_by_least_squares(part, given.readings, kStarts.back());
    const std::vector<Placement> known = known_placements(part, oracle, given, most, row.lost);
    all += static_cast<double>(known.size());
    for (std::size_t i = 0; i < kStarts.size(); ++i) {
      const std::vector<PerFinger<double>> some = locate_by_least_squares(part, given.readings, kStarts[i]);
      found[i] += static_cast<double>(std::count_if(known.begin(), known.end(), [&](const Placement& placement) {
        return std::any_of(some.begin(), some.end(),
                           [&](const PerFinger<double>& pair) { return answers(part, placement, pair); });
      }));
    }
  }
  for (std::size_t i = 0; i < kStarts.size(); ++i) {
    row.baseline[i].recall = all > 0 ? found[i] / all : 0;
    std::vector<double> seconds;
    for (int round = 0; round < (kStarts[i] < kManyStarts ? rounds : std::min(rounds, kFewRounds)); ++round) {
      seconds.push_back(seconds_per_case(
          cases, [&](const Case& given) { return locate_by_least_squares(part, given.readings, kStarts[i]); }));
    }
    row.baseline[i].cost = least(seconds) / row.unit;
  }
}

PairRow measure_pairs(const Family& family, int rounds) {
  const Part part(family.outline);
  const std::vector<Case> cases = random_cases(part);
  PairRow row;
  row.name = family.name;
  for (const Case& given : cases) {
    const Search search = find(part, given);
    row.placements += static_cast<double>(search.placements.size()) / kCases;
    row.boxes += static_cast<double>(search.counts.intervals) / kCases;
    row.incomplete += search.status == Status::complete ? 0 : 1;
  }
  std::vector<double> unit;
  std::vector<double> locate;
  std::vector<double> facing;
  for (int round = 0; round < rounds; ++round) {
    unit.push_back(seconds_per_call([&] { keep(perimeter_by_quadrature(family.outline)); }));
    locate.push_back(seconds_per_case(cases, [&](const Case& given) { return find(part, given); }));
    facing.push_back(seconds_per_case(cases, [&](const Case& given) { return find_with_facing(part, given); }));
  }
  row.unit = least(unit);
  row.locate = least(locate) / row.unit;
  row.facing = least(facing) / row.unit;
  if (is_trivial(part)) return row;  // continua of pairs, of which no share can be told
  if (rounds == 0) {                 // the shares are counts, but take long
    row.baseline.fill({std::nan(""), std::nan("")});
    return row;
  }
  const pair_oracle::Exhaustive oracle(part.outline());
  const std::vector<Case> few(cases.begin(), cases.begin() + kBaselineCases);
  measure_baseline(part, part.corners().empty() ? &oracle : nullptr, few, rounds, row);
  return row;
}

void print(double cost, double recall) { fmt::print("{:>8} ({:>3}%)", cell(cost, 0), cell(100 * recall, 0)); }

void print(const PairRow& row) {
  fmt::print("{:<18}{:>8}{:>10}{:>9}{:>10}{:>11.1f}{:>10.0f}", row.name, cell(1e6 * row.unit, 2), cell(row.locate, 1),
             cell(row.placements > 0 ? row.locate / row.placements : 0, 2), cell(row.facing, 1), row.placements,
             row.boxes);
  for (const Baseline& baseline : row.baseline) {
    if (baseline.cost != 0) print(baseline.cost, baseline.recall);
  }
  if (row.incomplete > 0) fmt::print("  incomplete: {}", row.incomplete);
  if (row.lost > 0) fmt::print("  lost: {}", row.lost);
  fmt::print("\n");
}

}  // namespace

void two_fingers(int rounds) {  // means: geometric of costs, plain of shares
  fmt::print("{:<18}{:>8}{:>10}{:>9}{:>10}{:>11}{:>10}", "outline", "W [us]", "locate/W", "each/W", "facing/W",
             "placements", "boxes");
  for (const int starts : kStarts) fmt::print("{:>15}", fmt::format("LSQ {}/W", starts));
  fmt::print("\n");
  Mean locate;
  Mean each;
  Mean facing;
  std::array<Mean, kStarts.size()> cost;
  std::array<double, kStarts.size()> recall{};
  int rows = 0;
  std::vector<PairRow> trivial;
  for (const Family& family : families()) {
    const PairRow row = measure_pairs(family, rounds);
    if (is_trivial(Part(family.outline))) {
      trivial.push_back(row);
      continue;
    }
    print(row);
    locate.add(row.locate);
    each.add(row.placements > 0 ? row.locate / row.placements : 0);
    facing.add(row.facing);
    ++rows;
    for (std::size_t i = 0; i < kStarts.size(); ++i) {
      cost[i].add(row.baseline[i].cost);
      recall[i] += row.baseline[i].recall;
    }
  }
  fmt::print("{:<18}{:>8}{:>10}{:>9}{:>10}{:>11}{:>10}", "mean", "", cell(locate.value(), 1), cell(each.value(), 2),
             cell(facing.value(), 1), "", "");
  for (std::size_t i = 0; i < kStarts.size(); ++i) {
    print(cost[i].value(), recall[i] / rows);
  }
  fmt::print("\n");
  if (!trivial.empty()) fmt::print("\noutlines whose W is next to nothing, lines and arcs alone:\n");
  for (const PairRow& row : trivial) print(row);
}

}  // namespace bench
