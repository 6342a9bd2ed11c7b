#include "rollfix/locate/locate_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "outline/point_table.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/part.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

namespace rollfix::app {
namespace {

/// A certificate is of readings that are exact but for the tolerance.
void require_plain(const Problem& problem) {
  const auto refuse = [](bool found, const char* what) {
    if (!found) return;
    throw InputError(fmt::format("--certify: a certificate is of one way round without noise, found {}", what));
  };
  refuse(problem.noise.has_value(), "--noise");
  refuse(problem.either_way, "--direction either");
  refuse(problem.mirrored, "--mirror");
}

void add_written(const std::string& file, bool force, CertificateText certificate, Report& report) {
  if (file == "-") {
    report.notes.push_back(report.data.substr(0, report.data.find('\n')));
    report.data = std::move(certificate.text);
  } else {
    report.files.push_back({file, std::move(certificate.text), force});
    report.notes.push_back(fmt::format("wrote {}", file));
  }
  if (certificate.complete) return;
  report.notes.push_back(fmt::format("the certificate leaves something unproved: {}", certificate.where));
  report.exit_code = ExitCode::incomplete;
}

}  // namespace

void require_certificate(const std::string& file, bool force, bool json, const std::string& output) {
  if (file.empty()) return;
  if (file != "-") {
    require_writable(file, force);
  } else if (json || output == "-") {
    throw InputError("--certify - writes to standard output, as another option does: give it the name of a file");
  }
}

void add_certificate(const std::string& file, bool force, const Problem& problem, const Answer& answer,
                     Report& report) {
  require_plain(problem);
  add_written(file, force, certificate_of(answer, problem.budget), report);
}

void add_certificate(const std::string& file, bool force, const TouchProblem& problem, const TouchAnswer& answer,
                     Report& report) {
  add_written(file, force, certificate_of(answer, problem.budget), report);
}

void add_certificate(const std::string& file, bool force, const HoldProblem& problem, const HoldAnswer& answer,
                     Report& report) {
  add_written(file, force, certificate_of(problem, answer), report);
}

namespace {

constexpr const char* kLoops = "loops";

/// Points of the part's frame, and what they are called in the table.
struct PointSet {
  std::string name;
  std::vector<Vec2> points;
};

PointSet read_set(const std::string& file, const std::string& unit) {
  NumberedPoints table = read_point_table(read_text(file), file, false);
  if (table.points.empty())
    throw InputError(fmt::format("--map {}: holds no points, expected one 'x y' per line", file));
  if (!table.unit.empty() && !unit.empty() && table.unit != unit) {
    const Conversion convert = length_conversion(table.unit, unit, "--map " + file);
    for (Vec2& point : table.points) point = Vec2(convert(point.x()), convert(point.y()));
  }
  return {file, std::move(table.points)};
}

std::vector<PointSet> sets_of(const std::vector<std::string>& maps, const std::vector<Outline>& others,
                              const std::string& unit) {
  std::vector<PointSet> sets;
  for (const std::string& map : maps) {
    if (map != kLoops) {
      sets.push_back(read_set(map, unit));
      continue;
    }
    if (others.empty())
      throw InputError("--map loops: the part comes from no drawing with other loops, expected a file");
    for (std::size_t k = 0; k < others.size(); ++k) {
      PointSet set{fmt::format("loop {}", k + 1), {}};
      const PartOptions as_it_is{true};
      for (const BoundarySample& sample : samples_of(Part(others[k], as_it_is))) set.points.push_back(sample.point);
      sets.push_back(std::move(set));
    }
  }
  return sets;
}

/// A name as a cell: quoted where it has to be.
std::string as_cell(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

const Pose& pose_of(const Placement& placement) {
  const bool rests = placement.start.size() == 1;
  return rests && placement.pose_spread ? placement.pose_spread->mean : placement.pose.back();
}

}  // namespace

void add_map_argument(CLI::App& command, std::vector<std::string>& maps) {
  command
      .add_option("--map", maps,
                  "points of the part's frame, a file of x and y, or the word loops, the other loops of its drawing: "
                  "where they are in the world, by each placement, as a table in -o FILE.csv or, with -o -, on stdout")
      ->type_name("FILE|loops")
      ->allow_extra_args(false);
}

void require_map_output(const std::vector<std::string>& maps, const std::string& file, bool force, bool json,
                        bool has_log, bool has_finger) {
  if (maps.empty()) return;
  if (!has_log || !has_finger) {
    throw InputError(
        "--map: where points are in the world follows from the part's pose, which takes a --log of u, psi, x and y, "
        "and the --finger");
  }
  if (file.empty()) throw InputError("--map writes a table: expected -o FILE.csv, or -o - for stdout");
  if (file == "-") {
    if (json) throw InputError("-o - and --json both go to standard output: give the table the name of a file");
    return;
  }
  if (ending_of(file) != ".csv") {
    throw InputError(fmt::format("-o {}: with --map a table is written, expected a name that ends in .csv", file));
  }
  require_writable(file, force);
}

std::string mapped_points(const Answer& answer, const std::vector<std::string>& maps,
                          const std::vector<Outline>& others, std::vector<std::string>& notes) {
  const std::vector<PointSet> sets = sets_of(maps, others, answer.part.unit());
  std::string text = "placement,set,x,y\n";
  for (std::size_t k = 0; k < answer.placements.size(); ++k) {
    const Placement& placement = answer.placements[k];
    if (placement.kind == Kind::stretch) {
      notes.push_back(fmt::format("--map: placement {} is a stretch, which leaves the pose open: left out", k));
      continue;
    }
    if (placement.pose.empty()) {
      throw InputError("--map: expected a log that says where the fingers are, in columns x and y, found none");
    }
    const Pose& pose = pose_of(placement);
    for (const PointSet& set : sets) {
      const std::string name = as_cell(set.name);
      for (const Vec2& point : set.points) {
        const Vec2 there = pose.world(answer.mirrored ? Vec2(-point.x(), point.y()) : point);
        fmt::format_to(std::back_inserter(text), "{},{},{:.12g},{:.12g}\n", k, name, there.x(), there.y());
      }
    }
  }
  return text;
}

}  // namespace rollfix::app
