// The tables of noise: how often the true place is found and how far off, beside particle filters on the same logs; and
// how often two advised rolls leave one place.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "belief_cases.hpp"
#include "outlines.hpp"
#include "particle_filter.hpp"
#include "rollfix/answer/part_facts.hpp"
#include "rollfix/belief/advise.hpp"
#include "rollfix/error.hpp"
#include "tables.hpp"

namespace bench {
namespace {

using belief_cases::distance;
using belief_cases::Robot;
using rollfix::Belief;
using rollfix::BeliefOptions;
using rollfix::DiskFinger;
using rollfix::Mode;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Sample;

constexpr double kLogContactShare = 1e-3;  // the noise of a contact's place, as a share of the perimeter
constexpr double kLogAngle = 5e-3;         // of an orientation, radians
constexpr double kLogSlip = 5e-3;
constexpr std::size_t kLogRows = 200;
constexpr double kRadiusShare = 0.03;  // of the finger, by the perimeter; less where it has to fit into a concavity
constexpr double kFound = 0.02;        // nearer than this share of the perimeter is the place

double radius_on(const Part& part) {
  // A concave corner takes no disk at all: there it is a small one that stays out of it.
  const double fits = rollfix::largest_disk(part);
  return std::min(kRadiusShare * part.perimeter(), fits > 0 ? 0.5 * fits : 0.2 * kRadiusShare * part.perimeter());
}

Noise noise_of(const Part& part) { return {kLogContactShare * part.perimeter(), kLogAngle, kLogSlip, 0}; }

/// What one way of localizing makes of many logs.
struct Record {
  int cases = 0;
  int listed = 0;
  int first = 0;
  double seconds = 0;
  std::vector<double> off;  // of the listed place, as a share of the perimeter

  void add(const Part& part, double truth, const std::vector<double>& starts) {
    ++cases;
    const double limit = kFound * part.perimeter();
    if (!starts.empty() && distance(part, starts.front(), truth) < limit) ++first;
    double least = part.perimeter();
    for (const double start : starts) least = std::min(least, distance(part, start, truth));
    if (least >= limit) return;
    ++listed;
    off.push_back(least / part.perimeter());
  }
  double median() {
    if (off.empty()) return 1;
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
    return off[off.size() / 2];
  }
};

template <class Job>
auto timed(Record& record, Job&& job) {
  const std::clock_t start = std::clock();
  auto result = job();
  record.seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

std::vector<double> starts_of(const std::vector<Cloud>& clouds) {
  std::vector<double> starts;
  for (const Cloud& cloud : clouds) starts.push_back(cloud.start);
  return starts;
}

struct Contest {
  Record ours;
  Record thousand;
  Record ten_thousand;
};

Contest contest_on(const Part& part, int count) {
  Contest contest;
  const Noise noise = noise_of(part);
  const double P = part.perimeter();
  const double radius = radius_on(part);
  std::mt19937_64 random(20010529);
  std::uniform_real_distribution<double> unit;
  for (int k = 0; k < count;) {
    rollfix::RollPlan plan;
    plan.start = unit(random) * P;
    plan.distance = (unit(random) < 0.5 ? -1 : 1) * (0.1 + 0.3 * unit(random)) * P;
    plan.rows = kLogRows;
    const std::uint64_t seed = random();
    if (!part.closed() && !(plan.start + *plan.distance > 0 && plan.start + *plan.distance < P)) continue;
    rollfix::NoisyRoll roll;
    try {
      roll = rollfix::noisy_roll(part, DiskFinger{radius}, plan, noise, seed);
    } catch (const rollfix::InputError&) {
      continue;  // the finger does not get along there
    }
    ++k;
    std::vector<Sample> samples;
    for (const rollfix::Reading& reading : rollfix::readings_as_given(roll.log, {DiskFinger{radius}})) {
      samples.emplace_back();
      samples.back().reading = reading;
      samples.back().finger_curvature = 1 / radius;
    }
    const std::vector<Mode> modes = timed(contest.ours, [&] {
      BeliefOptions options;
      options.noise = noise;
      Belief belief(part, rollfix::LogKind::contact, options);
      for (const Sample& sample : samples) belief.add(sample);
      return belief.modes();
    });
    std::vector<double> starts;
    for (const Mode& mode : modes) {
      if (mode.probability >= 0.01) starts.push_back(mode.start[0]);
    }
    contest.ours.add(part, plan.start, starts);
    contest.thousand.add(
        part, plan.start,
        starts_of(timed(contest.thousand, [&] { return filter_particles(part, samples, noise, 1000, seed); })));
    contest.ten_thousand.add(
        part, plan.start,
        starts_of(timed(contest.ten_thousand, [&] { return filter_particles(part, samples, noise, 10000, seed); })));
  }
  return contest;
}

void print(Record& record) {
  std::printf(" | %5.1f %5.1f %9.5f %7.2f", 100.0 * record.listed / record.cases, 100.0 * record.first / record.cases,
              100 * record.median(), 1e3 * record.seconds / record.cases);
}

void add(const Record& part, Record& sum) {
  sum.cases += part.cases;
  sum.listed += part.listed;
  sum.first += part.first;
  sum.seconds += part.seconds;
  sum.off.insert(sum.off.end(), part.off.begin(), part.off.end());
}

/// How a loop of locating and advised rolls ends.
struct Loop {
  int cases = 0;
  int resolved[3] = {0, 0, 0};  // after so many advised rolls: one place, and what looks just like it
  int open = 0;
  int wrong = 0;
  double rolled = 0;  // of all advised rolls, as a share of the perimeter
  int rolls = 0;
};

std::size_t remaining(const std::vector<Mode>& modes) {
  return static_cast<std::size_t>(
      std::count_if(modes.begin(), modes.end(), [](const Mode& mode) { return mode.probability >= 0.01; }));
}

bool lists(const Part& part, const std::vector<Mode>& modes, double truth) {
  return std::any_of(modes.begin(), modes.end(), [&](const Mode& mode) {
    return mode.probability >= 0.01 && distance(part, mode.start[0], truth) < 5 * mode.sd[0] + 1e-6 * part.perimeter();
  });
}

/// The finger's way from one start; false where it does not get along on the first roll.
bool close_loop(const Part& part, const rollfix::Reach& reach, const BeliefOptions& options, double start,
                std::mt19937_64& random, Loop& loop) {
  const double P = part.perimeter();
  const auto alike = static_cast<std::size_t>(std::max(1, rollfix::symmetry(part)));
  double length = (random() % 2 == 0 ? -1 : 1) * 0.05 * P;
  Robot robot(part, radius_on(part), start, options.noise, random());
  Belief belief(part, rollfix::LogKind::contact, options);
  for (int rolls = 0;; ++rolls) {
    try {
      robot.roll(length, belief);
    } catch (const rollfix::InputError&) {
      loop.open += rolls > 0 ? 1 : 0;
      return rolls > 0;
    }
    const std::vector<Mode>& modes = belief.modes();
    const rollfix::Verdict verdict = belief.verdict();
    const bool is_stretch = verdict.stretches > 0 || verdict.name == rollfix::Verdict::unobservable;
    if (!is_stretch && !modes.empty() && (remaining(modes) <= alike || modes.front().probability >= 0.95)) {
      ++loop.resolved[rolls];
      loop.wrong += lists(part, modes, start) ? 0 : 1;
      return true;
    }
    rollfix::AdviceOptions how;
    how.turn_sd = 2 * options.noise.angle;
    how.length_sd = 1.5 * options.noise.contact;
    how.length_share_sd = options.noise.slip;
    how.reach = &reach;
    if (rolls == 2 || modes.empty()) break;
    const rollfix::Advice advice = rollfix::advise(part, rollfix::contenders_of(part, modes), how);
    if (!advice.helps) break;
    length = advice.advised().length;
    loop.rolled += std::abs(length) / P;
    ++loop.rolls;
  }
  ++loop.open;
  return true;
}

Loop loop_on(const Part& part, int count) {
  const double P = part.perimeter();
  const rollfix::Reach reach = rollfix::reach_of_disk(part, radius_on(part));
  BeliefOptions options;
  options.noise = {1e-4 * P, 2e-3, 2e-3, 0};
  std::mt19937_64 random(20010529);
  std::uniform_real_distribution<double> unit;
  Loop loop;
  while (loop.cases < count) {
    const double start = (part.closed() ? unit(random) : 0.1 + 0.8 * unit(random)) * P;
    if (close_loop(part, reach, options, start, random, loop)) ++loop.cases;
  }
  return loop;
}

}  // namespace

void noisy(int count) {
  std::printf(
      "%d logs of %zu rows each; noise: contact %g P, angle %g rad, slip %g. Of each: true place listed, first\n"
      "(in %%, within %g P), median error of the listed one (%% of P), milliseconds per log\n",
      count, kLogRows, kLogContactShare, kLogAngle, kLogSlip, kFound);
  std::printf("%-18s |  all places at once          |  1,000 particles             |  10,000 particles\n", "");
  Contest sum;
  for (const Family& family : families()) {
    Contest contest = contest_on(Part(family.outline), count);
    std::printf("%-18s", family.name.c_str());
    for (Record* record : {&contest.ours, &contest.thousand, &contest.ten_thousand}) print(*record);
    std::puts("");
    add(contest.ours, sum.ours);
    add(contest.thousand, sum.thousand);
    add(contest.ten_thousand, sum.ten_thousand);
  }
  std::printf("%-18s", "all");
  for (Record* record : {&sum.ours, &sum.thousand, &sum.ten_thousand}) print(*record);
  std::puts("");
}

void advised(int count) {
  std::puts(
      "a first roll over 5 % of P, then as advised; cases that end in one place and those that look just like it: at\n"
      "once, after one advised roll, after two");
  int cases = 0;
  int resolved = 0;
  for (const Family& family : families()) {
    const Part part(family.outline);
    if (rollfix::symmetry(part) == 0) {
      std::printf("%-18s no roll will: it looks the same from everywhere\n", family.name.c_str());
      continue;
    }
    const Loop loop = loop_on(part, count);
    std::printf("%-18s %5d %5d %5d  open %4d  wrong %4d  mean advised roll %.3f P\n", family.name.c_str(),
                loop.resolved[0], loop.resolved[1], loop.resolved[2], loop.open, loop.wrong,
                loop.rolls > 0 ? loop.rolled / loop.rolls : 0);
    cases += loop.cases;
    resolved += loop.cases - loop.open - loop.wrong;
  }
  std::printf("resolved %d of %d cases: %.1f %%\n", resolved, cases, 100.0 * resolved / cases);
}

}  // namespace bench
