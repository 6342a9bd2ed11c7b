#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/program.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {
namespace {

/// A points file of an airfoil section as a designer would hand it over: NACA 2412, chord 200, computed by the
/// gallery, from the trailing edge over the top, with four decimals.
std::string wing_points() {
  constexpr int kPointsPerCurve = 20;
  std::string text = "# NACA 2412 with a closed trailing edge, chord 200\nx,y\n";
  for (const Curve& curve : gallery("naca,digits=2412,chord=200").curves) {
    const Interval domain = curve.domain();
    for (int i = 0; i < kPointsPerCurve; ++i) {
      const Vec2 point = curve.position(domain.lo + domain.width() * i / kPointsPerCurve);
      text += fmt::format("{:.4f},{:.4f}\n", point.x(), point.y());
    }
  }
  return text;
}

/// A DXF drawing of a plate, 70 x 40 mm, three of its corners rounded, with a round hole.
std::string plate_drawing() {
  struct Vertex {
    double x;
    double y;
    double bulge;  // of the side that starts here: the tangent of a quarter of the angle that it sweeps
  };
  constexpr double kQuarterTurn = 0.41421356237309503;
  constexpr std::array<Vertex, 7> kVertices = {{{0, 0, 0},
                                                {60, 0, kQuarterTurn},
                                                {70, 10, 0},
                                                {70, 25, kQuarterTurn},
                                                {55, 40, 0},
                                                {10, 40, kQuarterTurn},
                                                {0, 30, 0}}};
  std::string text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  text += fmt::format("0\nLWPOLYLINE\n8\nplate\n90\n{}\n70\n1\n", kVertices.size());
  for (const Vertex& vertex : kVertices) {
    text += fmt::format("10\n{}\n20\n{}\n42\n{}\n", vertex.x, vertex.y, vertex.bulge);
  }
  text += "0\nCIRCLE\n8\nplate\n10\n22\n20\n20\n40\n9\n";
  return text + "0\nENDSEC\n0\nEOF\n";
}

namespace fs = std::filesystem;

constexpr const char* kDemoExamples = R"(Examples:
  rollfix demo               # writes its figures and logs here
  rollfix demo -o figures    # writes them to this folder
)";

using Words = std::vector<std::string>;

/// A folder that is gone when the demo is over, so that nothing half-written stays behind.
class Scratch {
 public:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "rollfix-demo-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw InputError(fmt::format("{}: can't be made", name));
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// Plays the demo: runs commands as a user would type them and tells what they say.
class Stage {
 public:
  explicit Stage(std::string folder) : folder_(std::move(folder)) {}

  void title(const std::string& title) {
    report.data +=
        fmt::format("{}{}\n{}\n\n", report.data.empty() ? "" : "\n\n", title, std::string(title.size(), '-'));
  }

  /// Words that begin with @ are files of the demo's own.
  void run(const Words& words) {
    Words arguments;
    std::string typed = "  rollfix";
    for (const std::string& word : words) {
      const bool is_file = !word.empty() && word.front() == '@';
      arguments.push_back(is_file ? scratch_.file(word.substr(1)) : word);
      typed += ' ' + (is_file ? shown(word.substr(1)) : word);
    }
    const Report said = command_of(arguments)();
    for (const OutputFile& file : said.files) keep(fs::path(file.path).filename().string(), file.bytes);
    report.data += fmt::format("{}\n{}\n", typed, with_shown_files(said.data));
  }

  void say(const std::string& text) { report.data += text; }

  void keep(const std::string& name, const std::string& bytes) {
    write_files({{scratch_.file(name), bytes}});
    report.files.push_back({shown(name), bytes});
  }
  void keep(const std::string& stem, const Svg& figure) {
    keep(stem + ".svg", encode(figure, FigureFormat::svg));
    keep(stem + ".png", encode(figure, FigureFormat::png));
  }

  /// The file's name while the demo goes on.
  std::string file(const std::string& name) const { return scratch_.file(name); }

  Report report;

 private:
  std::string shown(const std::string& name) const {
    return folder_.empty() ? name : (fs::path(folder_) / name).string();
  }
  std::string with_shown_files(std::string text) const {
    const std::string from = scratch_.file("");
    const std::string to = shown("");
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
      text.replace(at, from.size(), to);
    }
    return text;
  }

  Scratch scratch_;
  std::string folder_;
};

/// The paper's Figure 7: a disk rolls from its first contact a over to b, where several placements fit, and on to c,
/// where one is left.
struct OneFinger {
  std::string title;
  std::string part;  // as a user types it
  std::string finger;
  std::string start;         // s of the first contact
  std::string whole_length;  // how far c is
  std::string b;             // instants, seconds
  std::string c;
  std::string stem;  // of the files' names
};

/// The same with two fingers, Figure 8: two readings leave several pairs of first contacts, a third leaves one. Then
/// the same fingers' log, which says more than such readings.
struct TwoFingers {
  std::string title;
  std::string part;
  std::string finger;
  Words readings;
  Words starts;
  Words lengths;
  std::string part_rotation;
  std::string stem;
};

const char* const kSpline = "gallery:spline,n=9,seed=7,wobble=0.2";
const char* const kRows = "201";
// The simulation knows the answer, to this share of the perimeter; readings with six decimals leave less.
constexpr double kSamePlace = 1e-6;
constexpr double kSamePlaceByReadings = 1e-4;

/// The placement that holds the true starts, if one does.
std::optional<std::size_t> true_placement(const Answer& answer, const PerFinger<double>& starts, double share) {
  const double period = answer.part.perimeter();
  for (std::size_t k = 0; k < answer.placements.size(); ++k) {
    bool is_true = true;
    for (std::size_t finger = 0; finger < starts.size(); ++finger) {
      const double off = periodic_distance(answer.placements[k].start[finger], starts[finger], period);
      is_true = is_true && off <= share * period;
    }
    if (is_true) return k;
  }
  return std::nullopt;
}

void require_true(const Answer& answer, const PerFinger<double>& starts, double share) {
  if (answer.placements.size() == 1 && true_placement(answer, starts, share)) return;
  throw InternalError(fmt::format("the demo started at s = {}, which is not what was found", starts[0]));
}

Problem problem_of(const RollArguments& arguments) {
  std::vector<std::string> notes;
  return read_problem(arguments, notes);
}

void perform(const OneFinger& story, Stage& stage) {
  stage.title(story.title);
  const std::string log = story.stem + "-roll.csv";
  const bool is_file = story.part.front() == '@';
  stage.run({"simulate", story.part, "--finger", story.finger, "--start", story.start, "--length", story.whole_length,
             "--samples", kRows, "-o", "@" + log});
  RollArguments arguments;
  arguments.part.part = is_file ? stage.file(story.part.substr(1)) : story.part;
  arguments.fingers = {story.finger};
  arguments.logs = {stage.file(log)};
  Problem problem = problem_of(arguments);
  std::vector<Answer> answers;
  for (const std::string& instant : {story.b, story.c}) {
    problem.at.push_back(std::stod(instant));
    answers.push_back(solve(problem));
    stage.run({"locate", story.part, "--finger", story.finger, "--log", "@" + log, "--at",
               problem.at.size() == 1 ? story.b : story.b + "," + story.c});
  }
  const double start = std::stod(story.start);
  require_true(answers[1], start, kSamePlace);
  const std::optional<std::size_t> truth = true_placement(answers[0], start, kSamePlace);
  AnswerFigure before{&answers[0]};
  before.title = story.title + ": rolled to b";
  before.highlight = truth;
  AnswerFigure after{&answers[1]};
  after.title = "rolled on to c";
  after.highlight = 0;
  after.numbers = numbers_of(answers[1], answers[0]);
  stage.keep(story.stem, side_by_side({before, after}));
  stage.say(
      fmt::format("The one that is left is a{} of the roll to b. The simulated finger did start there, "
                  "at s = {}.\n",
                  truth.value(), story.start));
}

void perform(const TwoFingers& story, Stage& stage) {
  stage.title(story.title);
  const PerFinger<double> starts(std::stod(story.starts[0]), std::stod(story.starts[1]));
  RollArguments arguments;
  arguments.part.part = story.part;
  // The paper's readings know nothing of the fingers' size: without it all of its pairs are there.
  for (const std::ptrdiff_t count : {2, 3}) {
    Words words{"locate", story.part};
    arguments.readings.assign(story.readings.begin(), story.readings.begin() + count);
    for (const std::string& reading : arguments.readings) words.insert(words.end(), {"--reading", reading});
    const std::string stem = count == 2 ? story.stem : story.stem + "-rolled-on";
    words.insert(words.end(), {"-o", "@" + stem + ".svg"});
    stage.run(words);
    const Answer answer = solve(problem_of(arguments));
    if (count == 3) require_true(answer, starts, kSamePlaceByReadings);
    stage.keep(stem + ".png", encode(draw_answer(answer), FigureFormat::png));
  }
  const std::string log = story.stem + "-rolls.csv";
  stage.run({"simulate", story.part, "--finger", story.finger, "--start", story.starts[0], "--start", story.starts[1],
             "--length", story.lengths[0], "--length", story.lengths[1], "--part-rotation", story.part_rotation,
             "--samples", kRows, "-o", "@" + log});
  stage.run({"locate", story.part, "--finger", story.finger, "--log", "@" + log});
  arguments.readings.clear();
  arguments.fingers = {story.finger};
  arguments.logs = {stage.file(log)};
  require_true(solve(problem_of(arguments)), starts, kSamePlaceByReadings);
  stage.say(fmt::format("A log also says how the fingers face each other. The simulated ones did start at {} and {}.\n",
                        story.starts[0], story.starts[1]));
}

/// What is there already and would be the same is no obstacle: the demo can be run twice.
void require_room(const std::string& folder, const Report& report, bool force) {
  std::error_code error;
  if (!folder.empty() && fs::exists(folder, error) && !fs::is_directory(folder, error)) {
    throw InputError(fmt::format("{}: is not a folder, expected one for the demo's files", folder));
  }
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: can't be made: {}", folder, error.message()));
  for (const OutputFile& file : report.files) {
    if (!holds(file)) require_writable(file.path, force);
  }
}

Report demo(const OutputArgument& output) {
  if (output.file == "-") throw InputError("demo: -o takes a folder, and the demo writes several files");
  Stage stage(output.file);
  stage.keep("wing.csv", wing_points());
  stage.keep("plate.dxf", plate_drawing());
  // Found by a search over seeds and starts: six placements at b, also with a tolerance of a degree, and one at c.
  perform(OneFinger{"A cubic spline", kSpline, "disk,r=0.15", "6.2", "1.95", "7.64", "15.29", "figure7"}, stage);
  perform(OneFinger{"A wing section", "@wing.csv", "disk,r=10", "55", "120", "6.10", "12.32", "wing"}, stage);
  // Found by examples/studies/figure8_search.cpp: the paper's turns, 16 intervals for each finger, and 16 pairs.
  perform(TwoFingers{"Two fingers on a spline that is free to move",
                     kSpline,
                     "disk,r=0.15",
                     {"0.58,0.94,-0.725248", "1.01,1.92,-1.99849", "1.25,2.37,-1.966238"},
                     {"0.81813", "4.084821"},
                     {"1.25", "2.37"},
                     "20deg",
                     "figure8"},
          stage);
  require_room(output.file, stage.report, output.force);
  std::string wrote = "wrote";
  for (const OutputFile& file : stage.report.files) wrote += " " + file.path;
  stage.report.notes.push_back(wrote);
  return std::move(stage.report);
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
  command->get_option("-o")->type_name("FOLDER");
  command->callback([output, &chosen] { chosen = [output] { return demo(*output); }; });
}

}  // namespace rollfix::app
