#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <system_error>

#include "rollfix/commands.hpp"
#include "rollfix/demo_pair_story.hpp"
#include "rollfix/demo_parts.hpp"
#include "rollfix/demo_story.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/load.hpp"
#include "rollfix/outline/points.hpp"
#include "rollfix/output_argument.hpp"

namespace rollfix::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDemoExamples = R"(Examples:
  rollfix demo --force       # writes its figures and logs here, over older ones
  rollfix demo -o figures    # writes them to this folder
)";

std::string in_folder(const std::string& folder, const std::string& name) {
  return folder.empty() ? name : (fs::path(folder) / name).string();
}

DemoStory spline_story(const std::string& folder) {
  // Found by a search over seeds and starts: six placements at b, also with a tolerance of a degree, and one at c.
  return {"A cubic spline",
          "gallery:spline,n=9,seed=7,wobble=0.2",
          {0.15},
          "6.2",
          1.0,
          "1.95",
          in_folder(folder, "figure7")};
}

DemoStory wing_story(const std::string& folder) {
  return {"A wing section", in_folder(folder, "wing.csv"), {10}, "55", 60, "120", in_folder(folder, "wing")};
}

DemoPairStory pair_story(const std::string& folder) {
  // Found by examples/figure8_search.cpp: the paper's turns, 16 intervals for each finger, and 16 pairs.
  return {"Two fingers on a spline that is free to move",
          "gallery:spline,n=9,seed=7,wobble=0.2",
          {0.15},
          {"0.58,0.94,-0.725248", "1.01,1.92,-1.99849", "1.25,2.37,-1.966238"},
          {"0.81813", "4.084821"},
          {"1.25", "2.37"},
          "20deg",
          in_folder(folder, "figure8")};
}

void require_room(const std::string& folder, const std::vector<std::string>& names, bool force) {
  std::error_code ignored;
  if (!folder.empty() && !fs::exists(folder, ignored)) return;  // it is made when all is ready
  if (!folder.empty() && !fs::is_directory(folder, ignored)) {
    throw InputError(fmt::format("{}: is not a folder, expected one for the demo's files", folder));
  }
  for (const std::string& name : names) require_writable(name, force);
}

void make_folder(const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: can't be made: {}", folder, error.message()));
}

void add(DemoAct act, Report& report) {
  report.data += (report.data.empty() ? "" : "\n\n") + act.text;
  for (OutputFile& file : act.files) report.files.push_back(std::move(file));
}

Report demo(const OutputArgument& output) {
  if (output.file == "-") throw InputError("demo: -o takes a folder, and the demo writes several files");
  const DemoStory spline = spline_story(output.file);
  const DemoStory wing = wing_story(output.file);
  const DemoPairStory pair = pair_story(output.file);
  std::vector<std::string> names = file_names(spline);
  for (const std::string& name : file_names(wing)) names.push_back(name);
  names.push_back(wing.argument);
  names.push_back(in_folder(output.file, "plate.dxf"));
  for (const std::string& name : file_names(pair)) names.push_back(name);
  require_room(output.file, names, output.force);

  const std::string points = wing_points();
  const Part spline_part(load_outline(spline.argument));
  const Part wing_part(outline_through(parse_points(points, wing.argument), wing.argument));
  Report report;
  add(perform(spline, spline_part), report);
  add(perform(wing, wing_part), report);
  report.files.push_back({wing.argument, points});
  report.files.push_back({in_folder(output.file, "plate.dxf"), plate_drawing()});
  add(perform(pair, Part(load_outline(pair.argument))), report);
  make_folder(output.file);
  report.notes.emplace_back("wrote");
  for (const OutputFile& file : report.files) report.notes.back() += " " + file.path;
  return report;
}

}  // namespace

void add_demo_command(CLI::App& program, Command& chosen) {
  const auto output = std::make_shared<OutputArgument>();
  CLI::App* command = program.add_subcommand(
      "demo",
      "The main job on shipped input: six placements of a roll on a spline, then one; the same on a wing; and two "
      "fingers, 16 pairs of placements, then one.");
  command->footer(kDemoExamples);
  add_output_argument(*command, *output, "the folder to write to; default the current one");
  command->callback([output, &chosen] { chosen = [output] { return demo(*output); }; });
}

}  // namespace rollfix::app
