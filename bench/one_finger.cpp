// What do all placements of one reading cost, and what does a part, in units of W: one integration of the same
// outline's perimeter?

#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "rollfix/locate.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kReadings = 500;

struct Row {
  bench::Family family;
  Part part;
  std::vector<Reading> readings;
  bench::Program::Job unit = 0;
  bench::Program::Job build = 0;
  bench::Program::Job locate = 0;
  double placements = 0;   // per reading
  double evaluations = 0;  // of the turning function, per reading
};

Row row_of(const bench::Family& family) {
  const Part part = bench::trusted_part(family.outline);
  Row row{family, part, bench::random_readings(part, kReadings)};
  for (const Reading& reading : row.readings) {
    const Search search = locate(part, reading);
    row.placements += static_cast<double>(search.placements.size()) / kReadings;
    row.evaluations += static_cast<double>(search.counts.evaluations) / kReadings;
  }
  return row;
}

void add_jobs(bench::Program& program, Row& row) {
  row.unit =
      program.add("W " + row.family.name, [&row] { bench::keep(bench::perimeter_by_quadrature(row.family.outline)); });
  row.build = program.add("build " + row.family.name, [&row] { bench::keep(bench::trusted_part(row.family.outline)); });
  const auto locate_all = [&row] {
    for (const Reading& reading : row.readings) bench::keep(locate(row.part, reading));
  };
  row.locate = program.add("locate " + row.family.name, locate_all, kReadings);
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) rows.push_back(row_of(family));
  for (Row& row : rows) add_jobs(program, row);
  program.run();

  bench::Mean build;
  bench::Mean found;
  bench::Table table({"outline", "W [us]", "build/W", "locate/W", "placements", "evaluations"});
  const auto add = [&](const Row& row) {
    const bench::Timing unit = program.of(row.unit);
    const bench::Timing in_build = program.of(row.build) / unit;
    const bench::Timing in_locate = program.of(row.locate) / unit;
    table.add({row.family.name, bench::cell(1e6 * unit, 2), bench::cell(in_build, 1), bench::cell(in_locate, 2),
               bench::cell(row.placements, 2), bench::cell(row.evaluations, 1)});
    if (!row.family.is_gallery || bench::is_trivial(row.part)) return;
    build.add(in_build);
    found.add(in_locate);
  };
  for (const Row& row : rows) {
    if (!bench::is_trivial(row.part)) add(row);
  }
  table.add({"gallery, mean", "-", bench::cell(build.value(), 1), bench::cell(found.value(), 2)});
  table.add({"lines and arcs alone, whose W is next to nothing:"});
  for (const Row& row : rows) {
    if (bench::is_trivial(row.part)) add(row);
  }
  table.print();
  program.figure("build_W", build.value());
  program.figure("one_finger_W", found.value());
  program.write_figures();
}
