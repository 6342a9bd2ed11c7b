#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "documents/documents.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/program.hpp"
#include "rollfix/solve.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr std::size_t kMostPlaces = 8;  // of one sort on the screen
constexpr std::size_t kMostLoops = 20;  // on the screen

std::string kind_of(const Loop& loop) {
  if (!loop.outline.closed) return "open chain";
  if (loop.outline.hole) return "hole";
  return loop.depth == 0 ? "outer loop" : "island";
}

std::string loops_text(const LoadedPart& loaded) {
  if (loaded.loops.empty()) return "";
  std::string text;
  std::string title = "loops";
  const std::size_t shown = std::min(loaded.loops.size(), kMostLoops);
  for (std::size_t k = 0; k < shown; ++k) {
    const Loop& loop = loaded.loops[k];
    const std::string area = loop.outline.closed ? fmt::format(", area {:.8g}", loop.area) : "";
    const std::string gap = loop.has_gap() ? fmt::format(", gaps up to {:.2g}", loop.gap) : "";
    text += fmt::format("{:<12} {}: {}, {}, length {:.8g}{}{}{}\n", title, k + 1, kind_of(loop),
                        counted(loop.outline.curves.size(), "curve", "curves"), loop.length, area, gap,
                        k + 1 == loaded.loop ? "  <- this one" : "");
    title = "";
  }
  if (shown < loaded.loops.size()) {
    text += fmt::format("{:<12} ... {} more (--json lists them all)\n", "", loaded.loops.size() - shown);
  }
  return text;
}

/// "4, at 0, 2.42, 4.84, 7.27"
std::string list(const std::vector<std::string>& places) {
  if (places.empty()) return "none";
  const std::vector<std::string> shown(
      places.begin(), places.begin() + static_cast<std::ptrdiff_t>(std::min(places.size(), kMostPlaces)));
  const std::string more = places.size() > kMostPlaces ? ", ... (--json lists them all)" : "";
  return fmt::format("{}, at {}{}", places.size(), fmt::join(shown, ", "), more);
}

std::string list(const std::vector<double>& places, int decimals) {
  std::vector<std::string> texts;
  texts.reserve(places.size());
  for (const double s : places) texts.push_back(fixed(s, decimals));
  return list(texts);
}

bool is_joint(const Corner& corner) { return std::abs(corner.turn) < kJointTurn; }

/// Those that are meant.
std::string corners_text(const Part& part, int decimals) {
  std::vector<std::string> texts;
  for (const Corner& corner : part.corners()) {
    if (!is_joint(corner)) texts.push_back(fmt::format("{} ({} deg)", fixed(corner.s, decimals), degrees(corner.turn)));
  }
  return list(texts);
}

/// What the rounded digits of a drawing leave where its curves meet; empty where there are none.
std::string joints_text(const Part& part) {
  std::size_t count = 0;
  double most = 0;
  for (const Corner& corner : part.corners()) {
    if (!is_joint(corner)) continue;
    ++count;
    most = std::max(most, std::abs(corner.turn));
  }
  if (count == 0) return "";
  return fmt::format("{}, of at most {:.2g} deg: smooth but for rounded digits, and rolled over", count,
                     most * 180 / std::numbers::pi);
}

std::string shape_text(const Part& part) {
  if (part.outline().hole) {
    return fmt::format("a hole, stored clockwise; its tangent turns by {} deg", degrees(part.total_turn()));
  }
  if (!part.closed()) return fmt::format("open; its tangent turns by {} deg", degrees(part.total_turn()));
  return fmt::format("closed; its tangent turns by {} deg{}", degrees(part.total_turn()),
                     part.reversed() ? "; given clockwise, stored counter-clockwise" : "");
}

std::string disk_text(const Part& part, double radius) {
  if (std::isinf(radius)) return "of any size rolls all around: nothing is concave";
  if (radius == 0) {
    const auto sharpest = std::min_element(part.corners().begin(), part.corners().end(),
                                           [](const Corner& a, const Corner& b) { return a.turn < b.turn; });
    return fmt::format("of no size rolls all around: the corner at {} is concave, {} deg",
                       fixed(sharpest->s, decimals_for(part.perimeter())), degrees(sharpest->turn));
  }
  return fmt::format("of a radius below {:.6g} rolls all around, by the curvature (a narrow neck may stop it)", radius);
}

std::string reach_text(const Inspection& outcome) {
  const Reach& reach = *outcome.reach;
  const int decimals = decimals_for(outcome.part.perimeter());
  const std::string finger = name_of(*outcome.finger);
  if (reach.is_whole()) return fmt::format("{} reaches all of the boundary", finger);
  std::vector<std::string> arcs;
  for (std::size_t k = 0; k < std::min(reach.arcs.size(), kMostPlaces); ++k) {
    arcs.push_back(fmt::format("{} to {}", fixed(reach.arcs[k].lo, decimals), fixed(reach.arcs[k].hi, decimals)));
  }
  if (reach.arcs.size() > kMostPlaces) arcs.emplace_back("... (--json lists them all)");
  std::string text = fmt::format("{} reaches {:.4g} % of the boundary", finger, 100 * reach.share());
  if (!arcs.empty()) text += fmt::format(": {}", fmt::join(arcs, ", "));
  const auto cut = std::count_if(reach.pivots.begin(), reach.pivots.end(),
                                 [](const PivotReach& pivot) { return !pivot.is_whole(); });
  if (cut > 0) text += fmt::format("; at {} corners it can't pivot all the way", cut);
  if (!reach.decided) text += " (not decided everywhere)";
  return text;
}

std::string symmetry_text(int symmetry) {
  if (symmetry == 0) return "every place looks like every other: no roll can tell them apart";
  if (symmetry == 1) return "none";
  return fmt::format("{}-fold: no roll can tell {} places apart", symmetry, symmetry);
}

std::string ambiguity_text(const std::vector<Ambiguity>& entries) {
  std::string text;
  std::string title = "ambiguity";
  for (const Ambiguity& entry : entries) {
    const std::string stretches = entry.with_stretch == 0 ? ""
                                                          : fmt::format("; {} of {} rolls fit a continuum of places",
                                                                        entry.with_stretch, entry.rolls);
    text += fmt::format("{:<12} a roll of perimeter/{:<2} has {:.1f} placements on average, at most {}{}\n", title,
                        entry.share, entry.mean_placements, entry.most_placements, stretches);
    title = "";
  }
  return text;
}

}  // namespace

std::string inspect_text(const Inspection& outcome, const LoadedPart& loaded) {
  const Part& part = outcome.part;
  const int decimals = decimals_for(part.perimeter());
  const Vec2 size = outcome.box.hi - outcome.box.lo;
  std::string text = plain(part.name()) + '\n';
  const auto line = [&text](const char* title, const std::string& value) {
    text += fmt::format("{:<12} {}\n", title, value);
  };
  text += loops_text(loaded);
  if (!part.unit().empty()) line("unit", plain(part.unit()));
  line("shape", shape_text(part));
  if (const Accuracy& accuracy = part.outline().accuracy; !accuracy.is_exact()) {
    line("accuracy", accuracy_text(accuracy));
  }
  line("perimeter", fixed(part.perimeter(), decimals));
  if (part.closed()) line("area", fmt::format("{:.8g}", enclosed_area(part.outline())));
  line("size", fmt::format("{} x {}, from ({}, {}) to ({}, {})", fixed(size.x(), decimals), fixed(size.y(), decimals),
                           fixed(outcome.box.lo.x(), decimals), fixed(outcome.box.lo.y(), decimals),
                           fixed(outcome.box.hi.x(), decimals), fixed(outcome.box.hi.y(), decimals)));
  line("start", fmt::format("({}, {}), tangent {} deg", fixed(part.point(0).x(), decimals),
                            fixed(part.point(0).y(), decimals), degrees(part.tangent(0))));
  line("inflections", list(part.inflections(), decimals));
  line("vertices", list(part.vertices(), decimals));
  line("corners", corners_text(part, decimals));
  if (const std::string joints = joints_text(part); !joints.empty()) line("joints", joints);
  line("spirals", fmt::format("{}", part.turning().spirals().size()));
  line("curvature", fmt::format("{:.6g} to {:.6g}", outcome.curvature.lo, outcome.curvature.hi));
  line("disk", disk_text(part, outcome.largest_disk));
  if (outcome.reach) line("reach", reach_text(outcome));
  line("symmetry", symmetry_text(outcome.symmetry));
  return text + ambiguity_text(outcome.ambiguity);
}

namespace {

constexpr const char* kInspectExamples = R"(Examples:
  rollfix inspect gallery:ellipse,a=2,b=1
  rollfix inspect wing.csv -o inspected.svg    # wing.csv: from rollfix demo
  rollfix inspect gallery:spline,seed=7 --json
  rollfix inspect plate.dxf                    # from rollfix demo; lists its loops, --loop 2 takes the hole
  rollfix inspect wing.csv --smooth 0.05 -o wing.json    # as a scan; saved, and taken by every command
  rollfix inspect wing.csv -o outline.csv    # as numbers: s, x, y, the tangent's direction and the curvature
  rollfix inspect gallery:gear --finger disk,r=0.1 -o reach.svg    # where can that finger touch at all?
)";

struct InspectArguments {
  PartArgument part;
  std::vector<std::string> fingers;
  OutputArgument output;
  bool json = false;
};

Report inspect_report(const InspectArguments& arguments) {
  require_part_output(arguments.output, arguments.json);
  const LoadedPart loaded = load(arguments.part);
  const std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, loaded.part.unit());
  const std::optional<Finger> finger = fingers.empty() ? std::nullopt : std::optional<Finger>(fingers.front());
  if (finger && !has_reach(*finger)) {
    throw InputError(
        fmt::format("--finger {}: where a finger can touch is known of disks and jaws only", finger->name()));
  }
  const Part& part = loaded.part;
  const Inspection outcome = inspect(part, finger);
  Report report;
  report.notes = loaded.notes;
  report.data = arguments.json ? format_inspection(outcome, loaded) : inspect_text(outcome, loaded);
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  add_part_output(
      arguments.output, part,
      [&] {
        return draw_part({&part, "", 640, outcome.reach, other_loops(loaded)});
      },
      report);
  return report;
}

}  // namespace

void add_inspect_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = program.add_subcommand(
      "inspect", "What a part is: size, inflections, vertices, corners, and how ambiguous rolls on it are.");
  command->footer(kInspectExamples);
  add_part_argument(*command, arguments->part);
  add_finger_argument(*command, arguments->fingers);
  add_output_argument(*command, arguments->output,
                      "a figure of the part: .svg, .png or .pdf, - for SVG on stdout; .json: its outline, which every "
                      "command takes as PART; .csv: the outline as numbers, s,x,y,tangent,curvature");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/inspect/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return inspect_report(*arguments); }; });
}

}  // namespace rollfix::app
