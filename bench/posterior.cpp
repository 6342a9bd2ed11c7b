// What do the probabilities of a noisy log cost: of 200 rows over the gallery, and of one shape through few points and
// through many?

#include <fmt/format.h>

#include <string>
#include <vector>

#include "belief_cases.hpp"
#include "logs.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kLogs = 5;

constexpr std::size_t kEggRows = 500;
constexpr double kEggRolled = 0.3;        // of the perimeter
constexpr double kEggRadiusShare = 0.03;  // of the finger, by the perimeter

struct Row {
  std::string name;
  bool is_gallery = true;
  Part part;
  std::vector<bench::NoisyLog> logs;
  bench::Program::Job job = 0;
};

std::vector<Mode> modes_of(const Part& part, const std::vector<Sample>& samples) {
  BeliefOptions options;
  options.noise = bench::log_noise(part);
  Belief belief(part, LogKind::contact, options);
  for (const Sample& sample : samples) belief.add(sample);
  return belief.modes();
}

struct EggRow {
  int points = 0;
  Part part;
  Log log;
  bench::Program::Job job = 0;
};

EggRow egg_row(int points) {
  const Part part(bench::egg_through_points(points));
  const double P = part.perimeter();
  const NoisyRoll roll =
      belief_cases::roll_on(part, kEggRadiusShare * P, 0.21 * P, kEggRolled * P, kEggRows, bench::log_noise(part), 7);
  return {points, part, roll.log};
}

void print_gallery(bench::Program& program, const std::vector<Row>& rows) {
  bench::Table table({"outline", "200 rows [ms]"});
  double sum = 0;
  int count = 0;
  for (const Row& row : rows) {
    const bench::Timing timing = 1e3 * program.of(row.job);
    table.add({row.name, bench::cell(timing, 2)});
    if (!row.is_gallery) continue;
    sum += timing.median;
    ++count;
  }
  table.add({"gallery, plain mean", bench::cell(sum / count, 2)});
  table.print();
  program.figure("posterior_200_ms", sum / count);
}

void print_eggs(bench::Program& program, const std::vector<EggRow>& eggs) {
  bench::Table table({"egg through points", "500 rows [ms]", "of that through 60"});
  const bench::Timing first = program.of(eggs.front().job);
  for (const EggRow& egg : eggs) {
    const bench::Timing timing = program.of(egg.job);
    table.add({std::to_string(egg.points), bench::cell(1e3 * timing, 2), bench::cell(timing / first, 2)});
    if (egg.points == 2000) program.figure("posterior_points_ratio", timing / first);
  }
  table.print();
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) {
    const Part part(family.outline);
    rows.push_back({family.name, family.is_gallery, part, bench::noisy_logs(part, kLogs)});
  }
  std::vector<EggRow> eggs;
  for (const int points : {60, 400, 2000}) eggs.push_back(egg_row(points));
  for (Row& row : rows) {
    const auto weigh_all = [&row] {
      for (const bench::NoisyLog& log : row.logs) bench::keep(modes_of(row.part, log.samples));
    };
    row.job = program.add(row.name, weigh_all, kLogs, 7);
  }
  for (EggRow& egg : eggs) {
    egg.job = program.add(fmt::format("egg {}", egg.points), [&egg] {
      BeliefOptions options;
      options.noise = bench::log_noise(egg.part);
      Belief belief = belief_cases::belief_in(egg.part, egg.log, kEggRadiusShare * egg.part.perimeter(), options);
      bench::keep(belief.modes());
    });
  }
  program.run();
  print_gallery(program, rows);
  print_eggs(program, eggs);
  program.write_figures();
}
