// What does a saved part cost to load, beside building the part anew with the look for self-crossings, and what does a
// part's reach cost?

#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr double kRadiusShare = 0.05;  // of the finger, by the perimeter

struct Row {
  bench::Family family;
  Part part;
  std::string text;
  bench::Program::Job load = 0;
  bench::Program::Job build = 0;
  bench::Program::Job reach = 0;
};

void add_jobs(bench::Program& program, Row& row) {
  const std::string& name = row.family.name;
  row.load = program.add("load " + name, [&row] { bench::keep(parse_part(row.text, row.family.name)); });
  row.build = program.add("build " + name, [&row] { bench::keep(Part(row.family.outline)); });
  row.reach = program.add("reach " + name,
                          [&row] { bench::keep(reach_of_disk(row.part, kRadiusShare * row.part.perimeter())); });
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<bench::Family> families = bench::families();
  families.push_back({"gear, 25 teeth", gallery("gear,teeth=25")});
  std::vector<Row> rows;
  for (const bench::Family& family : families) {
    const Part part(family.outline);
    rows.push_back({family, part, format_part(part)});
  }
  for (Row& row : rows) add_jobs(program, row);
  program.run();

  bench::Table table({"outline", "spirals", "panels", "bytes", "load [us]", "build [us]", "reach [us]"});
  for (const Row& row : rows) {
    table.add({row.family.name, std::to_string(row.part.turning().spirals().size()),
               std::to_string(row.part.turning().panels().size()), std::to_string(row.text.size()),
               bench::cell(1e6 * program.of(row.load), 1), bench::cell(1e6 * program.of(row.build), 1),
               bench::cell(1e6 * program.of(row.reach), 1)});
  }
  table.print();
  program.write_figures();
}
