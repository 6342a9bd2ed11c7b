#include "rollfix/arguments/question_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/measured_arguments.hpp"
#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/arguments/pose_arguments.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/arguments/typed_readings.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// Throws InputError before anything is read: standard input can't be two things.
void require_one_from_stdin(const std::vector<std::string>& touches, const RollArguments& arguments) {
  const auto count = std::count(arguments.logs.begin(), arguments.logs.end(), "-");
  if (count == 0 || (count == 1 && arguments.part.part != "-")) return;
  if (arguments.logs.size() > 1) {
    throw InputError("more than one thing can't come from standard input: give the others as files");
  }
  throw InputError(fmt::format("the part and the {} can't both come from standard input: give one of them as a file",
                               are_touches(touches, arguments) ? "touches" : "log"));
}

std::vector<double> read_instants(const std::string& text) {
  std::vector<double> instants;
  if (text.empty()) return instants;
  for (const std::string_view field : split(text, ',')) {
    instants.push_back(read_number(field, fmt::format("--at {}", text)));
  }
  return instants;
}

std::optional<Direction> read_direction(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "either") return Direction::either;
  return counts_clockwise(text) ? Direction::clockwise : Direction::counterclockwise;
}

/// Those with skin: wheels are among the measurements.
std::vector<Finger> read_skins(const RollArguments& arguments, const Question& question) {
  const Measurements& measured = question.measured;
  const std::string unit = question.part.unit();
  switch (kind_of(question)) {
    case QuestionKind::moving: {
      std::vector<std::string> skins;
      std::copy_if(arguments.fingers.begin(), arguments.fingers.end(), std::back_inserter(skins),
                   [](const std::string& text) { return !names_wheel(text); });
      return read_fingers(skins, measured.rolls.size(), unit);
    }
    case QuestionKind::at_rest: {
      std::vector<Finger> fingers = read_fingers(arguments.fingers, 1, unit);
      if (!measured.touches.empty()) require_disks(fingers, "--touch");
      return fingers;
    }
    default: {
      const bool is_log = !measured.rolls.empty();
      const bool of_two = is_log ? measured.rolls.front().fingers.size() == 2
                                 : !measured.readings.empty() && measured.readings.front().fingers() == 2;
      return read_fingers(arguments.fingers, of_two ? 2 : 1, unit);
    }
  }
}

/// An angle of one roll; of touches LENGTH or LENGTH,ANGLE, of what else shares a pose an angle or both.
std::optional<TouchTolerance> read_tolerance(const std::string& text, const Question& question) {
  if (text.empty()) return std::nullopt;
  const bool is_roll = kind_of(question) == QuestionKind::roll;
  const bool is_angle = question.measured.touches.empty() && text.find(',') == std::string::npos;
  if (!is_roll && !is_angle) return read_touch_tolerance(text, question.part.unit());
  const double angle = read_angle(text, "--tolerance");
  if (is_roll && angle < 0) {
    throw InputError(fmt::format("--tolerance: '{}' is negative, expected an angle of at least 0", text));
  }
  return TouchTolerance{0, angle};
}

Question question_of(Part part, Measurements measured, const RollArguments& arguments) {
  const std::string unit = part.unit();
  Question question(std::move(part), std::move(measured));
  question.fingers = read_skins(arguments, question);
  question.noise = read_noise(arguments.noise, unit);
  question.prior = read_prior(arguments.prior, unit);
  question.pose = read_pose(arguments.pose, unit);
  question.at = read_instants(arguments.instants);
  question.direction = read_direction(arguments.direction);
  question.mirrored = arguments.mirror;
  question.robust = arguments.robust;
  question.may_overlap = arguments.may_overlap;
  if (!arguments.facing.empty()) {
    question.facing = read_angle(arguments.facing, "--facing");
    question.measured.roundings.push_back({0, half_unit_of_angle(arguments.facing)});
  }
  if (!arguments.squeezed.empty()) question.squeezed = read_angle(arguments.squeezed, "--squeezed");
  question.tolerance = read_tolerance(arguments.tolerance, question);
  if (!arguments.budget.empty()) question.budget = read_count(arguments.budget, "--budget", 1);
  return question;
}

}  // namespace

Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                       std::vector<std::string>& notes) {
  Measurements measured = read_measurements(touches, arguments, part, notes);
  return question_of(std::move(part), std::move(measured), arguments);
}

Question read_question(const std::vector<std::string>& touches, const RollArguments& arguments,
                       std::vector<std::string>& notes, std::vector<Outline>* others) {
  require_one_from_stdin(touches, arguments);
  std::vector<std::string> of_part;
  Part part = load_part(arguments.part, of_part, others);
  Question question = read_question(touches, arguments, std::move(part), notes);
  notes.insert(notes.end(), of_part.begin(), of_part.end());
  return question;
}

Problem read_problem(const RollArguments& arguments, Part part, std::vector<std::string>& notes) {
  Measurements measured = read_one_roll(arguments, part, notes);
  return roll_problem(question_of(std::move(part), std::move(measured), arguments));
}

Problem read_problem(const RollArguments& arguments, std::vector<std::string>& notes, std::vector<Outline>* others) {
  require_one_from_stdin({}, arguments);
  std::vector<std::string> of_part;
  Part part = load_part(arguments.part, of_part, others);
  Problem problem = read_problem(arguments, std::move(part), notes);
  notes.insert(notes.end(), of_part.begin(), of_part.end());
  return problem;
}

TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments,
                                std::vector<std::string>& notes, std::vector<Outline>* others) {
  return rest_problem(read_question(touches, arguments, notes, others));
}

TouchProblem read_touch_problem(const std::vector<std::string>& touches, const RollArguments& arguments, Part part,
                                std::vector<std::string>& notes) {
  return rest_problem(read_question(touches, arguments, std::move(part), notes));
}

}  // namespace rollfix::app
