// How does the cost of an answer grow with the points of an outline? One smooth shape as a spline through few points
// and through many.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kReadings = 50;
constexpr std::size_t kPairQuestions = 10;
constexpr int kFewRepetitions = 3;         // of what takes a second
constexpr int kManyPoints = 100'000;       // from here on building takes one ...
constexpr int kFewestThatGrow = 64;        // ... and up to here a shape is not yet what it will be
constexpr int kMostForTwoFingers = 20000;  // pairs of spirals take memory

struct Row {
  int points = 0;
  Part part;
  std::vector<Reading> readings;
  std::vector<bench::PairQuestion> questions;  // none: not asked
  bench::Program::Job unit = 0;
  bench::Program::Job build = 0;
  bench::Program::Job locate = 0;
  bench::Program::Job two = 0;
  double placements = 0;
  double pairs = 0;
};

Row row_of(int points) {
  const Part part = bench::trusted_part(bench::egg_through_points(points));
  Row row{points, part, bench::random_readings(part, kReadings), {}};
  if (points <= kMostForTwoFingers) row.questions = bench::random_pair_questions(part, kPairQuestions);
  for (const Reading& reading : row.readings) {
    row.placements += static_cast<double>(locate(part, reading).placements.size()) / kReadings;
  }
  for (const bench::PairQuestion& question : row.questions) {
    row.pairs += static_cast<double>(bench::find(part, question).placements.size()) / kPairQuestions;
  }
  return row;
}

void add_jobs(bench::Program& program, Row& row) {
  const int repetitions = row.points >= kManyPoints ? kFewRepetitions : 0;
  const auto name = [&](const char* what) { return fmt::format("{} {}", what, row.points); };
  row.unit = program.add(
      name("W"), [&row] { bench::keep(bench::perimeter_by_quadrature(row.part.outline())); }, 1, repetitions);
  row.build = program.add(
      name("build"), [&row] { bench::keep(bench::trusted_part(row.part.outline())); }, 1, repetitions);
  const auto locate_all = [&row] {
    for (const Reading& reading : row.readings) bench::keep(locate(row.part, reading));
  };
  row.locate = program.add(name("locate"), locate_all, kReadings);
  const auto ask_all = [&row] {
    for (const bench::PairQuestion& question : row.questions) bench::keep(bench::find(row.part, question));
  };
  if (!row.questions.empty()) row.two = program.add(name("two fingers"), ask_all, kPairQuestions);
}

void print_growth(const bench::Program& program, const std::vector<Row>& rows) {
  std::vector<double> sizes;
  std::vector<double> sizes_of_two;
  std::vector<bench::Timing> build;
  std::vector<bench::Timing> one;
  std::vector<bench::Timing> two;
  for (const Row& row : rows) {
    if (row.points < kFewestThatGrow) continue;
    sizes.push_back(row.points);
    build.push_back(program.of(row.build));
    one.push_back(program.of(row.locate));
    if (row.questions.empty()) continue;
    sizes_of_two.push_back(row.points);
    two.push_back(program.of(row.two));
  }
  fmt::print("from {} points on: build grows as points^{}, one finger as points^{}, two fingers as points^{}\n",
             kFewestThatGrow, bench::cell(bench::exponent(sizes, build), 2),
             bench::cell(bench::exponent(sizes, one), 2), bench::cell(bench::exponent(sizes_of_two, two), 2));
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const int points : {8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 5000, 20000, 1'000'000}) {
    rows.push_back(row_of(points));
  }
  for (Row& row : rows) add_jobs(program, row);
  program.run();

  bench::Table table({"points", "W [us]", "build [ms]", "build/W", "one finger [us]", "one finger/W", "placements",
                      "two fingers [ms]", "pairs"});
  for (const Row& row : rows) {
    const bench::Timing unit = program.of(row.unit);
    const bench::Timing build = program.of(row.build);
    const bench::Timing one = program.of(row.locate);
    const bool has_two = !row.questions.empty();
    table.add({std::to_string(row.points), bench::cell(1e6 * unit, 1), bench::cell(1e3 * build, 3),
               bench::cell((build / unit).median, 1), bench::cell(1e6 * one, 2), bench::cell((one / unit).median, 4),
               bench::cell(row.placements, 2), has_two ? bench::cell(1e3 * program.of(row.two), 3) : "-",
               has_two ? bench::cell(row.pairs, 1) : "-"});
    if (row.points == 20000) program.figure("one_finger_20000_W", one / unit);
    if (row.points == 5000) program.figure("two_fingers_5000_ms", 1e3 * program.of(row.two));
  }
  table.print();
  print_growth(program, rows);
  program.write_figures();
}
