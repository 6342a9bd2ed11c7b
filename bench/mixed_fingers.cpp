// What do a jaw and a disk cost, by what two disks cost that roll the same stretches of the same part? Of logs with
// noise and without, from the log to the answer, in one process.

#include <fmt/format.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kQuestions = 12;
constexpr std::size_t kFewQuestions = 2;
constexpr int kRepetitions = 5;
constexpr std::size_t kRows = 100;
constexpr double kDisk = 0.04;     // radius, of the perimeter
constexpr double kContact = 1e-3;  // noise of a contact, of the perimeter
constexpr double kAngle = 5e-3;

// Parts on which a jaw can roll anywhere.
std::vector<bench::Family> convex_parts() {
  std::vector<bench::Family> parts;
  for (const char* const shape : {"ellipse", "cam", "superellipse", "reuleaux", "limacon,a=2,b=0.9", "naca,digits=0012",
                                  "spline,n=9,seed=7,wobble=0.05"}) {
    parts.push_back({shape, gallery(shape)});
  }
  parts.push_back({"egg, 40 points", bench::egg_through_points(40), false});
  return parts;
}

/// The same roll by two disks, and by a jaw and a disk.
struct Pair {
  std::array<Problem, 2> problems;
};

Problem rolled(const Part& part, const FreePlan& plan, const std::optional<Noise>& noise, std::uint64_t seed) {
  const std::vector<Finger> fingers{plan.fingers[0].finger, plan.fingers[1].finger};
  const Log log = noise ? noisy_roll_free(part, plan, *noise, seed).log : roll_free(part, plan).log;
  Problem problem{part, log, fingers};
  problem.noise = noise;
  problem.may_overlap = true;
  problem.diagnose = false;  // that some logs fit badly by chance is not asked here
  return problem;
}

std::vector<Pair> random_pairs(const Part& part, const std::optional<Noise>& noise, std::size_t count) {
  const double P = part.perimeter();
  std::mt19937_64 random(20010529);
  std::uniform_real_distribution<double> unit;
  std::vector<Pair> pairs;
  while (pairs.size() < count) {
    FreePlan plan;
    for (std::size_t k = 0; k < 2; ++k) {
      plan.fingers[k].finger = disk(kDisk * P);
      plan.fingers[k].start = (0.5 * static_cast<double>(k) + 0.4 * unit(random)) * P;
      plan.fingers[k].distance = (unit(random) < 0.5 ? -1 : 1) * (0.1 + 0.2 * unit(random)) * P;
    }
    plan.part_rotation = 0.4;
    plan.rows = kRows;
    const std::uint64_t seed = random();
    FreePlan with_jaw = plan;
    with_jaw.fingers[0].finger = jaw();
    try {
      pairs.push_back({{rolled(part, plan, noise, seed), rolled(part, with_jaw, noise, seed)}});
    } catch (const InputError&) {  // a finger does not get along there
    }
  }
  return pairs;
}

struct Row {
  std::string name;
  std::vector<Pair> exact;
  std::vector<Pair> noisy;
  std::array<std::array<bench::Program::Job, 2>, 2> jobs{};  // exact, noisy; disks, jaw and disk
};

bench::Program::Job add_job(bench::Program& program, const std::string& name, const std::vector<Pair>& pairs,
                            std::size_t which) {
  const auto solve_all = [&pairs, which] {
    for (const Pair& pair : pairs) bench::keep(solve(pair.problems[which]));
  };
  return program.add(name, solve_all, pairs.size(), kRepetitions);
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const bench::Family& family : convex_parts()) {
    const Part part = bench::trusted_part(family.outline);
    const Noise noise{kContact * part.perimeter(), kAngle, 0, 0};
    const std::size_t count = program.effort(kQuestions, kFewQuestions);
    rows.push_back({family.name, random_pairs(part, std::nullopt, count), random_pairs(part, noise, count)});
  }
  for (Row& row : rows) {
    for (std::size_t which = 0; which < 2; ++which) {
      const char* const pair = which == 0 ? "disks" : "jaw and disk";
      row.jobs[0][which] = add_job(program, fmt::format("{} {}", pair, row.name), row.exact, which);
      row.jobs[1][which] = add_job(program, fmt::format("noisy {} {}", pair, row.name), row.noisy, which);
    }
  }
  program.run();

  std::array<bench::Mean, 2> means;
  bench::Table table(
      {"part", "two disks [ms]", "jaw and disk", "times", "noisy: two disks [ms]", "jaw and disk", "times"});
  for (const Row& row : rows) {
    std::vector<std::string> line = {row.name};
    for (std::size_t noisy = 0; noisy < 2; ++noisy) {
      const bench::Timing disks = program.of(row.jobs[noisy][0]);
      const bench::Timing mixed = program.of(row.jobs[noisy][1]);
      means[noisy].add(mixed / disks);
      for (const bench::Timing& timing : {1e3 * disks, 1e3 * mixed, mixed / disks}) {
        line.push_back(bench::cell(timing, 2));
      }
    }
    table.add(line);
  }
  table.add({"mean", "-", "-", bench::cell(means[0].value(), 2), "-", "-", bench::cell(means[1].value(), 2)});
  table.print();
  program.figure("mixed_times", means[0].value());
  program.figure("mixed_noisy_times", means[1].value());
  program.write_figures();
}
