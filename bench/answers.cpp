// How does the cost grow with the number of answers? Gears, on which a roll fits on every tooth, and rolls of two
// fingers on every pair of teeth.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "rollfix/outline/gallery.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

// First contacts and rolls in teeth: of those tried one with four pairs of placements on each pair of teeth.
constexpr double kStartA = 0.288;
constexpr double kStartB = 0.410;
constexpr double kFirstA = 0.718;
constexpr double kFirstB = 0.648;
constexpr double kSecondA = 0.591;
constexpr double kSecondB = 0.094;

struct Row {
  int teeth = 0;
  Part part;
  Reading one;
  bench::PairQuestion two;
  Search found_one;
  Search found_two;
  bench::Program::Job unit = 0;
  bench::Program::Job locate_one = 0;
  bench::Program::Job locate_two = 0;
};

double turn(const Part& part, double from, double roll) {
  return part.turning().angle(from + roll) - part.turning().angle(from);
}

Row row_of(int teeth) {
  const Part part = bench::trusted_part(gallery(fmt::format("gear,teeth={}", teeth)));
  const double pitch = part.perimeter() / teeth;
  const double s = kStartA * pitch;
  const double t = kStartB * pitch;
  Row row{teeth, part, {kFirstA * pitch, turn(part, s, kFirstA * pitch)}, {}, {}, {}};
  for (const auto& [a, b] :
       {std::pair(kFirstA * pitch, kFirstB * pitch), std::pair(kSecondA * pitch, kSecondB * pitch)}) {
    row.two.readings.push_back({a, b, turn(part, s, a) - turn(part, t, b)});
  }
  row.found_one = locate(part, row.one);
  row.found_two = bench::find(part, row.two);
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const int teeth : {6, 12, 24, 48}) rows.push_back(row_of(teeth));
  for (Row& row : rows) {
    const auto name = [&](const char* what) { return fmt::format("{} {}", what, row.teeth); };
    row.unit = program.add(name("W"), [&row] { bench::keep(bench::perimeter_by_quadrature(row.part.outline())); });
    row.locate_one = program.add(name("one finger"), [&row] { bench::keep(locate(row.part, row.one)); });
    row.locate_two = program.add(name("two fingers"), [&row] { bench::keep(bench::find(row.part, row.two)); });
  }
  program.run();

  bench::Table table({"teeth", "W [us]", "answers", "one finger [us]", "one finger/W", "pairs", "boxes",
                      "two fingers [ms]", "two fingers/W", "a pair [us]"});
  std::vector<double> answers;
  std::vector<double> pairs;
  std::vector<bench::Timing> one;
  std::vector<bench::Timing> two;
  for (const Row& row : rows) {
    answers.push_back(static_cast<double>(row.found_one.placements.size()));
    pairs.push_back(static_cast<double>(row.found_two.placements.size()));
    one.push_back(program.of(row.locate_one));
    two.push_back(program.of(row.locate_two));
    const bench::Timing unit = program.of(row.unit);
    table.add({std::to_string(row.teeth), bench::cell(1e6 * unit, 1), bench::cell(answers.back(), 0),
               bench::cell(1e6 * one.back(), 1), bench::cell((one.back() / unit).median, 2),
               bench::cell(pairs.back(), 0), std::to_string(row.found_two.counts.intervals),
               bench::cell(1e3 * two.back(), 2), bench::cell((two.back() / unit).median, 1),
               bench::cell(1e6 * two.back().median / pairs.back(), 2)});
    if (row.teeth == 48) program.figure("pairs_9216_ms", 1e3 * two.back());
  }
  table.print();
  fmt::print("one finger grows as answers^{}, two fingers as pairs^{}\n", bench::cell(bench::exponent(answers, one), 2),
             bench::cell(bench::exponent(pairs, two), 2));
  program.write_figures();
}
