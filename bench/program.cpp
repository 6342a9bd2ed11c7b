// What does one call of the program cost, from its start to its end?

#include <string>
#include <vector>

#include "child.hpp"
#include "program.hpp"
#include "rollfix/files/saved_part.hpp"
#include "rollfix/outline/gallery.hpp"
#include "table.hpp"

#include <fstream>

namespace {

const std::string kSpline = "gallery:spline,n=9,seed=7,wobble=0.2";

struct Row {
  std::string name;
  std::vector<std::string> arguments;
  bench::Program::Job job = 0;
};

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const bench::ScratchFolder folder;
  const std::string saved = folder.path("part.json");
  std::ofstream(saved) << rollfix::format_part(rollfix::Part(rollfix::gallery(kSpline.substr(kSpline.find(':') + 1))));
  std::vector<Row> rows = {
      {"--version", {"--version"}},
      {"locate, a spline of the gallery", {"locate", kSpline, "--reading", "0.9977,56.93deg"}},
      {"locate, the same part saved", {"locate", saved, "--reading", "0.9977,56.93deg"}},
      {"locate --json", {"locate", kSpline, "--reading", "0.9977,56.93deg", "--json"}},
      {"locate, two fingers",
       {"locate", kSpline, "--reading", "0.58,0.94,-0.725248", "--reading", "1.01,1.92,-1.99849"}},
      {"locate with a figure in SVG",
       {"locate", kSpline, "--reading", "0.9977,56.93deg", "--force", "-o", folder.path("figure.svg")}},
      {"inspect", {"inspect", kSpline}},
  };
  for (Row& row : rows) {
    std::vector<std::string> command = {ROLLFIX_PROGRAM};
    command.insert(command.end(), row.arguments.begin(), row.arguments.end());
    row.job = program.add_stopped(row.name, [command] { return bench::seconds_of_child(command); });
  }
  program.run();

  bench::Table table({"rollfix ...", "processor [ms]"});
  for (const Row& row : rows) table.add({row.name, bench::cell(1e3 * program.of(row.job), 2)});
  table.print();
  program.figure("program_ms", 1e3 * program.of(rows[1].job));
  program.write_figures();
}
