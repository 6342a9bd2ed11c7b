#include "rollfix/arguments/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/program.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

// Who knows a heading no better than that in radians does not write it so.
constexpr double kMostBareSd = 1.6;

/// A number without a unit that is beyond what anyone means in radians. Throws InputError.
void require_no_bare_degrees(const std::string& what, std::string_view typed, double angle, double most) {
  const bool says_unit = take_degrees(typed);
  if (says_unit || std::abs(angle) <= most) return;
  throw InputError(
      fmt::format("{}: {} rad is {:.3g} deg, expected an angle of at most {:.3g} rad where no unit is typed; "
                  "degrees are written {}deg",
                  what, angle, angle / kDegree, most, typed));
}

}  // namespace

void add_pose_arguments(CLI::App& command, PoseArguments& arguments) {
  command
      .add_option(
          "--heading", arguments.heading,
          "with --noise, and touches or a log of u and psi: what is known of the part's heading in the world at "
          "the first contact, and its standard deviation")
      ->type_name("ANGLE,SD");
  command
      .add_option("--pose", arguments.pose,
                  "the same with the part's position, for touches or a log with x and y: X,Y,HEADING, and the standard "
                  "deviations of x and y and of the heading")
      ->type_name("X,Y,HEADING,SD,SD_HEADING");
}

std::optional<PosePrior> read_pose(const PoseArguments& arguments, const std::string& unit) {
  if (arguments.heading.empty() && arguments.pose.empty()) return std::nullopt;
  if (!arguments.heading.empty() && !arguments.pose.empty()) {
    throw InputError("--heading and --pose both say how the part is turned: leave one out");
  }
  const bool is_pose = !arguments.pose.empty();
  const std::string what = is_pose ? "--pose " + arguments.pose : "--heading " + arguments.heading;
  const std::vector<std::string_view> fields =
      is_pose ? fields_of(arguments.pose, what, 5, 5,
                          "expected X,Y,HEADING,SD,SD_HEADING as in 100,40,12deg,0.5,2deg: where the part lies in the "
                          "world at the first contact, and the standard deviations of x and y and of the heading")
              : fields_of(arguments.heading, what, 2, 2,
                          "expected ANGLE,SD as in 12deg,2deg: how the part is turned in the world at the first "
                          "contact, and its standard deviation");
  PosePrior prior;
  const std::string_view heading = fields[is_pose ? 2 : 0];
  prior.mean.heading = written_angle(heading, what);
  prior.heading_sd = written_angle(fields.back(), what);
  require_no_bare_degrees(what, heading, prior.mean.heading, kFullTurn);
  require_no_bare_degrees(what, fields.back(), prior.heading_sd, kMostBareSd);
  if (is_pose) {
    prior.mean.x = read_length(fields[0], what, unit);
    prior.mean.y = read_length(fields[1], what, unit);
    prior.place_sd = read_length(fields[3], what, unit);
  }
  if (!(prior.heading_sd > 0) || !(prior.place_sd > 0)) {
    throw InputError(what + ": expected standard deviations above 0");
  }
  return prior;
}

namespace {

Log read_both_logs(const std::vector<std::string>& paths, const LogOptions& options) {
  if (paths.size() == 2) return read_log(paths.front(), paths.back(), options);
  throw InputError(fmt::format(
      "--log is given {} times, expected one log, or one of each of two fingers; three and more fingers are "
      "taken by `rollfix locate` alone",
      paths.size()));
}

double read_sd(std::string_view value, NoiseKind::Unit unit, const std::string& what) {
  switch (unit) {
    case NoiseKind::Unit::angle:
      return written_angle(value, what);
    case NoiseKind::Unit::rate:
      return read_rate(value, what);
    case NoiseKind::Unit::walk:
      return read_walk(value, what);
    // Lengths have the outline's unit, which is read with them.
    case NoiseKind::Unit::length:
    case NoiseKind::Unit::share:
      break;
  }
  return read_number(value, what);
}

/// How one is typed.
const char* form_of(NoiseKind::Unit unit) {
  switch (unit) {
    case NoiseKind::Unit::length:
      return "LENGTH";
    case NoiseKind::Unit::angle:
      return "ANGLE";
    case NoiseKind::Unit::share:
      return "SHARE";
    case NoiseKind::Unit::rate:
      return "10deg/h";
    case NoiseKind::Unit::walk:
      return "0.3deg/sqrt(h)";
  }
  return "";
}

/// "contact=LENGTH,angle=ANGLE,...".
std::string noise_form(const char* separator) {
  std::vector<std::string> fields;
  for (const NoiseKind& kind : kNoiseKinds) fields.push_back(fmt::format("{}={}", kind.name, form_of(kind.unit)));
  return fmt::format("{}", fmt::join(fields, separator));
}

}  // namespace

void add_reading_arguments(CLI::App& command, LogArguments& reading) {
  command
      .add_option("--columns", reading.columns,
                  "names and units of the log's columns, where its header does not say them: "
                  "u=contact_deg:deg,psi=yaw_deg:deg,time=stamp:ms; behind u or psi also :unwrapped or :wrapped; of a "
                  "table of touches x=px:mm,y=py:mm,normal=n:deg")
      ->type_name("COLUMN=NAME:UNIT,...");
  command
      .add_option("--wrapped", reading.wrapped,
                  "whether the log's u and psi jump back after a full turn, if its rows are too far apart to show it: "
                  "yes or no")
      ->type_name("yes|no");
  add_decimal_argument(command, reading.decimal);
}

void add_skip_argument(CLI::App& command, LogArguments& reading) {
  add_switch(command, "--skip-bad", reading.skip_bad,
             "leave out rows that can't be read: an empty cell, no number, a time that does not grow");
}

void add_log_notes(const Log& log, std::vector<std::string>& notes) {
  notes.insert(notes.end(), log.notes.begin(), log.notes.end());
  if (log.skipped.empty()) return;
  notes.push_back(fmt::format("{}: {} left out, the first: {}", log.name, counted(log.skipped.size(), "row", "rows"),
                              log.skipped.front()));
}

void add_log_arguments(CLI::App& command, std::vector<std::string>& logs, std::string& roll, LogArguments& reading) {
  command
      .add_option("--log", logs,
                  "a tactile log, - for stdin; for two fingers one file or two; `locate` takes one of each of three to "
                  "eight, and of a wheel, which has x and y of its pin, and psi where it has an encoder")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--roll", roll,
                  "which roll of the log, from 1, if contact is lost and found again; default the last. `locate` takes "
                  "`all`: the part does not move in between; the rolls of all logs, with --touch, share its pose")
      ->type_name("N|all");
  add_reading_arguments(command, reading);
  add_skip_argument(command, reading);
}

void add_squeezed_argument(CLI::App& command, std::string& squeezed) {
  command
      .add_option("--squeezed", squeezed,
                  "a finger with skin and a wheel squeeze the part, and the floor's and the pin's friction are small: "
                  "the wheel's normal points through the finger's contact, to this standard deviation; default 5deg")
      ->type_name("SD")
      ->expected(0, 1)
      ->default_str("5deg");
}

void add_noise_argument(CLI::App& command, std::string& noise) {
  command
      .add_option("--noise", noise,
                  "errors of the sensors, as standard deviations, any of these, separated by commas: " +
                      noise_form(", ") + "; of touches position, of each coordinate of a centre, and angle, of normals")
      ->type_name("NOISE");
}

void add_noise_arguments(CLI::App& command, std::string& noise, std::string& prior, bool& robust) {
  add_noise_argument(command, noise);
  command
      .add_option(
          "--prior", prior,
          "with --noise: what is known of the finger's start, along the stored outline, and its standard deviation")
      ->type_name("S,SD");
  add_switch(command, "--robust", robust, "with --noise: outliers don't count");
}

void add_side_arguments(CLI::App& command, bool& mirror, std::string& direction, bool takes_either) {
  add_switch(command, "--mirror", mirror,
             "the part lies face down: the finger rolls on the mirror image of the outline; places in the answer are "
             "along the outline as it was drawn");
  command
      .add_option(
          "--direction", direction,
          std::string(
              "the direction around the part, as the robot sees it, in which lengths and distances are positive: "
              "ccw, the default, ") +
              (takes_either ? "cw, or either, if it is not known" : "or cw") + "; logs of u and psi contain it")
      ->type_name(takes_either ? "ccw|cw|either" : "ccw|cw");
}

bool counts_clockwise(const std::string& direction) {
  if (direction.empty() || direction == "ccw") return false;
  if (direction == "cw") return true;
  if (direction == "either") {
    throw InputError(
        "--direction either: both ways round are tried by locate alone, which says ccw or cw; expected one of these");
  }
  throw InputError(fmt::format("--direction {}: expected ccw, cw or either", direction));
}

void add_roll_arguments(CLI::App& command, RollArguments& arguments, bool takes_either) {
  add_part_argument(command, arguments.part);
  add_felt_arguments(command, arguments, takes_either);
}

void add_felt_arguments(CLI::App& command, RollArguments& arguments, bool takes_either) {
  command
      .add_option("--reading", arguments.readings,
                  "from the first contact: arc length travelled, along the stored outline, and turn of the tangent; "
                  "for two fingers both lengths, and finger a's turn minus finger b's: LA,LB,THETA")
      ->type_name("L,THETA")
      ->allow_extra_args(false);
  add_log_arguments(command, arguments.logs, arguments.roll, arguments.reading);
  add_finger_argument(command, arguments.fingers);
  add_switch(command, "--may-overlap", arguments.may_overlap,
             "two fingers at different heights: keep places where their disks would overlap");
  command
      .add_option("--tolerance", arguments.tolerance,
                  "the largest error of the turn; default 1e-9, or from the rounding of the digits given, "
                  "or from --noise; of touches LENGTH,ANGLE: the largest errors of centres and of normals")
      ->type_name("ANGLE");
  add_noise_arguments(command, arguments.noise, arguments.prior, arguments.robust);
  add_pose_arguments(command, arguments.pose);
  add_side_arguments(command, arguments.mirror, arguments.direction, takes_either);
}

std::optional<Noise> read_noise(const std::string& text, const std::string& unit) {
  if (text.empty()) return std::nullopt;
  Noise noise;
  std::set<std::string, std::less<>> seen;
  for (const std::string_view field : split(text, ',')) {
    const std::size_t mark = field.find('=');
    const std::string name(field.substr(0, mark));
    const auto kind =
        std::find_if(kNoiseKinds.begin(), kNoiseKinds.end(), [&](const NoiseKind& one) { return name == one.name; });
    if (kind == kNoiseKinds.end()) {
      std::vector<std::string> names;
      for (const NoiseKind& one : kNoiseKinds) names.emplace_back(one.name);
      const bool may_be_decimals = !seen.empty() && parse_angle(field).has_value();  // "contact=0,1"
      throw InputError(fmt::format("--noise {}: {}{}", text,
                                   may_be_decimals
                                       ? fmt::format("'{}' is not NAME=SD; numbers take a decimal point, as "
                                                     "in 0.5, not a comma; ",
                                                     field)
                                       : fmt::format("there is no noise '{}'; ", name),
                                   known_names(name, names)));
    }
    if (mark == std::string_view::npos) {
      throw InputError(fmt::format("--noise {0}: {1} has no value, expected {1}={2}", text, name, form_of(kind->unit)));
    }
    if (!seen.insert(name).second) throw InputError(fmt::format("--noise {}: {} is given twice", text, name));
    const std::string what = fmt::format("--noise {}", text);
    const std::string_view value = field.substr(mark + 1);
    double& sd = noise.*kind->sd;
    sd = kind->unit == NoiseKind::Unit::length ? read_length(value, what, unit) : read_sd(value, kind->unit, what);
    if (sd < 0) throw InputError(fmt::format("--noise {}: {} is below 0, expected a standard deviation", text, name));
  }
  return noise;
}

std::optional<Prior> read_prior(const std::string& text, const std::string& unit) {
  if (text.empty()) return std::nullopt;
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 2) {
    throw InputError(
        fmt::format("--prior {}: expected S,SD: about where the finger started, along the stored outline, "
                    "and its standard deviation{}",
                    text, fields.size() > 2 ? "; numbers take a decimal point, as in 0.5, not a comma" : ""));
  }
  const std::string what = "--prior " + text;
  const Prior prior{read_length(fields[0], what, unit), read_length(fields[1], what, unit)};
  if (!(prior.sd > 0))
    throw InputError(fmt::format("{}: '{}' is not above 0, expected a standard deviation", what, fields[1]));
  return prior;
}

LogOptions read_log_options(const LogArguments& reading, const std::string& unit) {
  LogOptions options;
  if (!reading.columns.empty()) options.columns = parse_columns(reading.columns);
  options.unit = unit;
  options.skip_bad = reading.skip_bad;
  options.decimal_comma = has_decimal_comma(reading.decimal);
  if (reading.wrapped.empty()) return options;
  if (reading.wrapped != "yes" && reading.wrapped != "no") {
    throw InputError(fmt::format("--wrapped {}: expected yes or no", shown(reading.wrapped)));
  }
  options.wrapped = reading.wrapped == "yes";
  return options;
}

Log read_roll(const std::vector<std::string>& paths, const std::string& roll, const LogOptions& options,
              std::vector<std::string>& notes) {
  if (roll == "all") throw InputError("--roll all is of `rollfix locate` alone; choose one roll with --roll N");
  const std::size_t number = roll.empty() ? 0 : read_count(roll, "--roll", 1);
  if (paths.size() != 1) {
    if (number > 0) throw InputError("--roll chooses from one log, and --log is given more than once; split the logs");
    Log log = read_both_logs(paths, options);
    add_log_notes(log, notes);
    return log;
  }
  std::vector<Log> rolls = read_rolls(paths.front(), options);
  const std::size_t count = rolls.size();
  if (number > count) {
    throw InputError(fmt::format("--roll {}: {} holds {}, expected a number from 1 to {}", number, paths.front(),
                                 counted(count, "roll", "rolls"), count));
  }
  const std::size_t chosen = number > 0 ? number : count;
  Log log = std::move(rolls[chosen - 1]);
  add_log_notes(log, notes);
  if (count > 1) {
    notes.push_back(
        fmt::format("{}: roll {} of {}{}", log.name, chosen, count, number > 0 ? "" : "; --roll N takes another"));
  }
  return log;
}

}  // namespace rollfix::app
