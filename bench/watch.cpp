// What does a sample of a growing log cost, from its line to what it means? The program is run as a user runs it:
// nothing of it is part of this one.

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "child.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/files.hpp"
#include "rollfix/log.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr double kContactShare = 2e-4;  // the noise of a contact's place, as a share of the perimeter
constexpr double kAngle = 0.003;        // of a turn, radians
constexpr std::size_t kFewRows = 1000;
constexpr std::size_t kManyRows = 10000;
constexpr int kRepetitions = 5;     // of the shorter roll
constexpr int kFewRepetitions = 2;  // of the longer one, which takes a second

Noise noise_on_part(const Part& part) { return {kContactShare * part.perimeter(), kAngle, 0, 0}; }

/// The lines of a roll over one and a half perimeters, of an open part over half of it.
std::vector<std::string> noisy_roll(const Part& part, std::size_t rows) {
  const double P = part.perimeter();
  const double start = 0.21 * P;
  const double length = (part.closed() ? 1.5 : 0.5) * P;
  const Noise noise = noise_on_part(part);
  std::mt19937_64 random(20010529);
  std::normal_distribution<double> off;
  std::vector<std::string> lines = {"time,length,turn"};
  for (std::size_t k = 1; k <= rows; ++k) {
    const double L = length * static_cast<double>(k) / static_cast<double>(rows);
    const double theta = part.turning().angle(start + L) - part.turning().angle(start);
    lines.push_back(fmt::format("{:.3f},{:.9g},{:.6f}", 0.01 * static_cast<double>(k), L + noise.contact * off(random),
                                theta + kAngle * off(random)));
  }
  return lines;
}

/// A part and its rolls, in files.
struct Row {
  Row(const bench::ScratchFolder& folder, const bench::Family& family)
      : name(family.name), part(family.outline), few(noisy_roll(part, kFewRows)), file(folder.path(family.name)) {
    std::ofstream(file + ".json") << format_part(part);
    const std::vector<std::string> many = noisy_roll(part, kManyRows);
    write("one", {many.begin(), many.begin() + 2});
    write("few", few);
    write("many", many);
  }

  /// `rollfix watch --once`, as a user starts it.
  double watch(const std::string& roll, const std::string& output = "/dev/null") const {
    const Noise noise = noise_on_part(part);
    return bench::seconds_of_child(
        {ROLLFIX_PROGRAM, "watch", file + ".json", "--once", "--jsonl", "--noise",
         fmt::format("contact={:.17g},angle={:.17g}", noise.contact, noise.angle), "--log", roll_file(roll)},
        output);
  }
  double read_lines() const {
    LogStream stream("bench", part, std::vector<Finger>{}, noise_on_part(part));
    double rows = 0;
    for (const std::string& line : few) {
      bench::keep(stream.push(line));
      ++rows;
    }
    return rows;
  }
  /// How often there was news in the longer roll, and its verdict.
  void count() {
    watch("many", file + ".told");
    std::ifstream lines(file + ".told");
    for (std::string line; std::getline(lines, line);) {
      const nlohmann::json event = nlohmann::json::parse(line);
      if (event["event"] == "placements") ++told;
      if (event.contains("verdict")) verdict = event["verdict"];
    }
  }

  std::string roll_file(const std::string& roll) const { return fmt::format("{}.{}.csv", file, roll); }
  void write(const std::string& roll, const std::vector<std::string>& lines) const {
    std::ofstream(roll_file(roll)) << fmt::format("{}\n", fmt::join(lines, "\n"));
  }

  std::string name;
  Part part;
  std::vector<std::string> few;
  std::string file;  // without its ending
  int told = 0;
  std::string verdict;
  bench::Program::Job start = 0;  // of the program: what it takes for a single row
  bench::Program::Job on_few = 0;
  bench::Program::Job on_many = 0;
  bench::Program::Job reading = 0;
};

void add_jobs(bench::Program& program, Row& row) {
  row.start = program.add_stopped("start " + row.name, [&row] { return row.watch("one"); });
  row.on_few = program.add_stopped(
      "few " + row.name, [&row] { return row.watch("few"); }, 1, kRepetitions);
  row.on_many = program.add_stopped(
      "many " + row.name, [&row] { return row.watch("many"); }, 1, kFewRepetitions);
  row.reading = program.add(
      "read " + row.name, [&row] { bench::keep(row.read_lines()); }, kFewRows);
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const bench::ScratchFolder folder;
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) {
    rows.emplace_back(folder, family);
    rows.back().count();
  }
  for (Row& row : rows) add_jobs(program, row);
  program.run();

  bench::Mean few;
  bench::Mean many;
  bench::Table table({"outline", "of 1,000 [us]", "of 10,000 [us]", "reading alone [us]", "told", "verdict"});
  for (const Row& row : rows) {
    const bench::Timing of_few = (1.0 / kFewRows) * (program.of(row.on_few) - program.of(row.start));
    const bench::Timing of_many = (1.0 / kManyRows) * (program.of(row.on_many) - program.of(row.start));
    if (row.name != "wing, 160 points") {
      few.add(of_few);
      many.add(of_many);
    }
    table.add({row.name, bench::cell(1e6 * of_few, 1), bench::cell(1e6 * of_many, 1),
               bench::cell(1e6 * program.of(row.reading), 2), std::to_string(row.told), row.verdict});
  }
  table.add({"gallery, mean", bench::cell(1e6 * few.value(), 1), bench::cell(1e6 * many.value(), 1)});
  table.print();
  program.figure("watch_us", 1e6 * few.value());
  program.write_figures();
}
