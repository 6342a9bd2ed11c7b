#include "rollfix/locate/touch_arguments.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/touch/touch_table.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

TouchTableOptions table_options(const RollArguments& arguments, const std::string& unit) {
  TouchTableOptions options;
  options.unit = unit;
  options.decimal_comma = has_decimal_comma(arguments.reading.decimal);
  if (!options.decimal_comma) options.decimal_comma = has_decimal_comma(arguments.part.decimal);
  return options;
}

/// The first rows of a file; nothing of a pipe, which can be read once only, or of what can't be read.
std::string beginning_of(const std::string& path) {
  constexpr std::size_t kEnoughForHeader = 65536;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return "";
  std::string text(kEnoughForHeader, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), open_text(path).get()));
  return text.substr(0, text.rfind('\n') + 1);
}

void require_touch_options(const RollArguments& arguments) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw InputError(fmt::format("{}: touches do not roll and have no use for it; leave it out", option));
  };
  refuse(!arguments.readings.empty(), "--reading");
  refuse(!arguments.roll.empty(), "--roll");
  refuse(!arguments.reading.columns.empty(), "--columns");
  refuse(!arguments.reading.wrapped.empty(), "--wrapped");
  refuse(arguments.reading.skip_bad, "--skip-bad");
  refuse(!arguments.facing.empty(), "--facing");
  refuse(!arguments.instants.empty(), "--at");
  refuse(!arguments.prior.empty(), "--prior");
  refuse(!arguments.direction.empty(), "--direction");
  refuse(arguments.robust, "--robust");
  refuse(arguments.may_overlap, "--may-overlap");
  if (!arguments.noise.empty() || !arguments.tolerance.empty()) return;
  throw InputError(
      "touches: expected how exact they are, found neither --noise nor --tolerance; standard deviations are given "
      "with --noise position=0.05,angle=1deg");
}

}  // namespace

MeasuredTouch read_touch(const std::string& text, const std::string& unit) {
  const std::string what = "--touch " + text;
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 2 && fields.size() != 3) {
    throw InputError(fmt::format(
        "{}: expected X,Y or X,Y,NORMAL, as in 12.5,3.1,73deg: where the finger's centre was, and the direction out of "
        "the part, found {}",
        what, counted(fields.size(), "number", "numbers")));
  }
  MeasuredTouch touch;
  touch.at = {read_length(fields[0], what, unit), read_length(fields[1], what, unit)};
  if (fields.size() == 3) touch.normal = read_angle(fields[2], what);
  return touch;
}

TouchTolerance read_touch_tolerance(const std::string& text, const std::string& unit) {
  const std::string what = "--tolerance " + text;
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() > 2) {
    throw InputError(
        fmt::format("{}: expected LENGTH or LENGTH,ANGLE, as in 0.1,2deg, found {} numbers", what, fields.size()));
  }
  return {read_length(fields[0], what, unit), fields.size() == 2 ? read_angle(fields[1], what) : 0};
}

bool are_touches(const std::vector<std::string>& touches, const RollArguments& arguments) {
  if (!touches.empty()) return true;
  if (!arguments.reading.columns.empty()) return false;  // they are of a roll
  return arguments.logs.size() == 1 &&
         is_touch_table(beginning_of(arguments.logs.front()), table_options(arguments, ""));
}

TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others) {
  require_touch_options(arguments);
  if (!touches.empty() && !arguments.logs.empty()) {
    const bool is_table = is_touch_table(beginning_of(arguments.logs.front()), table_options(arguments, ""));
    throw InputError(is_table ? "--touch and --log both give touches: leave one of them out"
                              : "--touch and a --log of rolls share a pose with --roll all: add it");
  }
  TouchProblem problem{load_part(arguments.part, notes, others), {}};
  const std::string unit = problem.part.unit();
  for (const std::string& text : touches) problem.touches.push_back(read_touch(text, unit));
  if (touches.empty()) {
    const std::string& file = arguments.logs.front();
    problem.touches = parse_touches(read_text(file), file, table_options(arguments, unit)).touches;
  }
  const std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, unit);
  require_disks(fingers, "--touch");
  if (!fingers.empty()) problem.finger = fingers.front();
  problem.noise = read_noise(arguments.noise, unit);
  if (!arguments.tolerance.empty()) {
    if (problem.noise) throw InputError("--tolerance: --noise already says how far touches are off; leave one out");
    problem.tolerance = read_touch_tolerance(arguments.tolerance, unit);
  }
  problem.pose = read_pose(arguments.pose, unit);
  problem.mirrored = arguments.mirror;
  if (!arguments.budget.empty()) problem.budget = read_count(arguments.budget, "--budget", 1);
  return problem;
}

}  // namespace rollfix::app
