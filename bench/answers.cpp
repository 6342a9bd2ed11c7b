// How does the cost grow with the number of answers? Gears, on which a roll fits on every tooth, and rolls of two
// fingers on every pair of teeth: gears with teeth of one height, which are the steeper the more they are, and gears
// with teeth of one shape, where nothing but the number changes.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "rollfix/outline.hpp"
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

constexpr double kDepth = 0.1;  // half the height of a tooth, of radius 1
constexpr int kTeethOfThatShape = 12;

struct Row {
  int teeth = 0;
  double depth = 0;
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

Row row_of(int teeth, double depth) {
  const Part part = bench::trusted_part(gallery(fmt::format("gear,teeth={},depth={}", teeth, depth)));
  const double pitch = part.perimeter() / teeth;
  const double s = kStartA * pitch;
  const double t = kStartB * pitch;
  Row row{teeth, depth, part, {kFirstA * pitch, turn(part, s, kFirstA * pitch)}, {}, {}, {}};
  for (const auto& [a, b] :
       {std::pair(kFirstA * pitch, kFirstB * pitch), std::pair(kSecondA * pitch, kSecondB * pitch)}) {
    row.two.readings.push_back({a, b, turn(part, s, a) - turn(part, t, b)});
  }
  row.found_one = locate(part, row.one);
  row.found_two = bench::find(part, row.two);
  return row;
}

/// How the cost grows on some of the gears.
class Growth {
 public:
  void add(const Row& row, const bench::Program& program) {
    answers_.push_back(static_cast<double>(row.found_one.placements.size()));
    pairs_.push_back(static_cast<double>(row.found_two.placements.size()));
    one_.push_back(program.of(row.locate_one));
    two_.push_back(program.of(row.locate_two));
  }
  void print(const char* which) const {
    fmt::print("{}: one finger grows as answers^{}, two fingers as pairs^{}\n", which,
               bench::cell(bench::exponent(answers_, one_), 2), bench::cell(bench::exponent(pairs_, two_), 2));
  }

 private:
  std::vector<double> answers_;
  std::vector<double> pairs_;
  std::vector<bench::Timing> one_;
  std::vector<bench::Timing> two_;
};

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const int teeth : {6, 12, 24, 48}) rows.push_back(row_of(teeth, kDepth));
  for (const int teeth : {6, 24, 48}) rows.push_back(row_of(teeth, kDepth * kTeethOfThatShape / teeth));
  for (Row& row : rows) {
    const auto name = [&](const char* what) { return fmt::format("{} {} {}", what, row.teeth, row.depth); };
    row.unit = program.add(name("W"), [&row] { bench::keep(bench::perimeter_by_quadrature(row.part.outline())); });
    row.locate_one = program.add(name("one finger"), [&row] { bench::keep(locate(row.part, row.one)); });
    row.locate_two = program.add(name("two fingers"), [&row] { bench::keep(bench::find(row.part, row.two)); });
  }
  program.run();

  bench::Table table({"teeth", "depth", "W [us]", "answers", "one finger [us]", "one finger/W", "pairs", "boxes",
                      "two fingers [ms]", "two fingers/W", "a pair [us]"});
  Growth of_one_height;
  Growth of_one_shape;
  for (const Row& row : rows) {
    const std::size_t pairs = row.found_two.placements.size();
    const bench::Timing unit = program.of(row.unit);
    const bench::Timing one = program.of(row.locate_one);
    const bench::Timing two = program.of(row.locate_two);
    table.add({std::to_string(row.teeth), fmt::format("{:.3g}", row.depth), bench::cell(1e6 * unit, 1),
               std::to_string(row.found_one.placements.size()), bench::cell(1e6 * one, 1),
               bench::cell((one / unit).median, 2), std::to_string(pairs),
               std::to_string(row.found_two.counts.intervals), bench::cell(1e3 * two, 2),
               bench::cell((two / unit).median, 1), bench::cell(1e6 * two.median / static_cast<double>(pairs), 2)});
    if (row.depth == kDepth) of_one_height.add(row, program);
    if (row.depth != kDepth || row.teeth == kTeethOfThatShape) of_one_shape.add(row, program);
    if (row.depth == kDepth && row.teeth == 48) program.figure("pairs_9216_ms", 1e3 * two);
  }
  table.print();
  of_one_height.print("teeth of one height");
  of_one_shape.print("teeth of one shape");
  program.write_figures();
}
