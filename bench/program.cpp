// What does one call of the program cost, from its start to its end?

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <vector>

#include "child.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "table.hpp"

namespace {

const std::string kSpline = "gallery:spline,n=9,seed=7,wobble=0.2";

constexpr int kScanPoints = 100000;
const std::vector<std::string> kRolled = {"--finger", "disk,r=0.4", "--noise", "contact=0.015,angle=0.005,slip=0.005"};

/// A command of the program about that part, and what else it is told.
std::vector<std::string> command_on(const std::string& name, const std::string& part,
                                    const std::vector<std::string>& options) {
  std::vector<std::string> command = {name, part};
  command.insert(command.end(), kRolled.begin(), kRolled.end());
  command.insert(command.end(), options.begin(), options.end());
  return command;
}

void write_scan(const std::string& file) {
  std::ofstream points(file);
  for (const rollfix::Curve& curve : bench::egg_through_points(kScanPoints).curves) {
    const rollfix::Vec2 point = curve.front();
    points << fmt::format("{:.9f},{:.9f}\n", point.x(), point.y());
  }
}

std::vector<std::string> run_by(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ROLLFIX_PROGRAM);
  return arguments;
}

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
  const std::string scan = folder.path("scan.csv");
  const std::string roll = folder.path("roll.csv");
  write_scan(scan);
  const std::vector<std::string> plan = {"--start", "3", "--length", "5", "--samples", "501", "-o", roll};
  bench::seconds_of_child(run_by(command_on("simulate", scan, plan)));
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
      {"locate, 501 noisy rows on a scan of 100,000 points", command_on("locate", scan, {"--log", roll})},
  };
  for (Row& row : rows) {
    const std::vector<std::string> command = run_by(row.arguments);
    row.job = program.add_stopped(row.name, [command] { return bench::seconds_of_child(command); });
  }
  program.run();

  bench::Table table({"rollfix ...", "processor [ms]"});
  for (const Row& row : rows) table.add({row.name, bench::cell(1e3 * program.of(row.job), 2)});
  table.print();
  program.figure("program_ms", 1e3 * program.of(rows[1].job));
  program.write_figures();
}
