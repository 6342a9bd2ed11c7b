// How does the cost grow with the readings of one roll?

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

constexpr std::size_t kMostReadings = 64;

struct Row {
  std::vector<Reading> readings;
  Search found;
  bench::Program::Job locate = 0;
};

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const Part part = bench::trusted_part(gallery("spline"));
  std::vector<Row> rows;
  for (std::size_t count = 1; count <= kMostReadings; count *= 2) {
    rows.push_back({bench::readings_of_one_roll(part, count), {}});
    rows.back().found = locate(part, rows.back().readings);
  }
  const auto unit = program.add("W", [&] { bench::keep(bench::perimeter_by_quadrature(part.outline())); });
  for (Row& row : rows) {
    row.locate =
        program.add(fmt::format("{} readings", row.readings.size()), [&] { bench::keep(locate(part, row.readings)); });
  }
  program.run();

  bench::Table table({"readings", "one finger [us]", "one finger/W", "placements", "evaluations"});
  std::vector<double> sizes;
  std::vector<bench::Timing> times;
  for (const Row& row : rows) {
    sizes.push_back(static_cast<double>(row.readings.size()));
    times.push_back(program.of(row.locate));
    table.add({std::to_string(row.readings.size()), bench::cell(1e6 * times.back(), 2),
               bench::cell(times.back() / program.of(unit), 2), std::to_string(row.found.placements.size()),
               std::to_string(row.found.counts.evaluations)});
  }
  table.print();
  fmt::print("it grows as readings^{}\n", bench::cell(bench::exponent(sizes, times), 2));
  program.figure("readings_64_us", 1e6 * times.back());
  program.write_figures();
}
