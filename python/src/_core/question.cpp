#include "rollfix/question.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include "archive.hpp"
#include "belief/posterior.hpp"
#include "bindings.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

using Pair = std::pair<double, double>;

/// (n, 2) or (n, 3), checked by Python.
std::vector<Reading> readings_from(const Numbers& rows) {
  std::vector<Reading> readings;
  const bool of_two = rows.shape(1) == 3;
  for (py::ssize_t k = 0; k < rows.shape(0); ++k) {
    readings.push_back(of_two ? Reading(rows.at(k, 0), rows.at(k, 1), rows.at(k, 2))
                              : Reading(rows.at(k, 0), rows.at(k, 1)));
  }
  return readings;
}

std::vector<Rounding> roundings_from(const std::vector<Pair>& given) {
  std::vector<Rounding> roundings;
  for (const auto& [length, turn] : given) roundings.push_back({length, turn});
  return roundings;
}

std::vector<Log> rolls_from(const std::vector<LogHandle>& given) {
  std::vector<Log> rolls;
  for (const LogHandle& one : given) rolls.push_back(*one.log);
  return rolls;
}

std::vector<PassiveWheel> wheels_from(const std::vector<std::pair<LogHandle, double>>& given) {
  std::vector<PassiveWheel> wheels;
  for (const auto& [pin, radius] : given) wheels.push_back({{*pin.log}, radius});
  return wheels;
}

/// NaN: it was not measured, or is not known.
std::optional<double> known(double value) { return std::isnan(value) ? std::nullopt : std::optional<double>(value); }

/// (n, 5), checked by Python: x, y, normal, and the standard deviations of both.
std::vector<MeasuredTouch> touches_from(const Numbers& rows) {
  std::vector<MeasuredTouch> touches;
  for (py::ssize_t k = 0; k < rows.shape(0); ++k) {
    touches.push_back(
        {{rows.at(k, 0), rows.at(k, 1)}, known(rows.at(k, 2)), known(rows.at(k, 3)), known(rows.at(k, 4))});
  }
  return touches;
}

/// (n, 4): from x, y to x, y.
std::vector<Clear> clear_from(const Numbers& rows) {
  std::vector<Clear> clear;
  for (py::ssize_t k = 0; k < rows.shape(0); ++k) {
    clear.push_back({{rows.at(k, 0), rows.at(k, 1)}, {rows.at(k, 2), rows.at(k, 3)}});
  }
  return clear;
}

TouchTolerance tolerance_from(const Pair& given) { return {given.first, given.second}; }
Prior prior_from(const Pair& given) { return {given.first, given.second}; }

/// x, y, heading, sd, sd of the heading.
PosePrior pose_from(const std::array<double, 5>& given) {
  return PosePrior{{given[0], given[1], given[2]}, given[4], given[3]};
}

Direction direction_from(const std::string& name) {
  if (name == "either") return Direction::either;
  return name == "cw" ? Direction::clockwise : Direction::counterclockwise;
}

template <class Out, class In>
Out converted(Out (*convert)(const In&), const py::handle& given) {
  return convert(given.cast<In>());
}

template <auto field, auto convert>
void measured(const py::handle& given, Question& to) {
  to.measured.*field = converted(convert, given);
}
template <auto field, auto convert>
void made(const py::handle& given, Question& to) {
  to.*field = converted(convert, given);
}
template <auto field>
void as_it_is(const py::handle& given, Question& to) {
  to.*field = given.cast<std::remove_reference_t<decltype(to.*field)>>();
}

/// What a keyword argument sets.
struct Field {
  std::string_view name;
  void (*set)(const py::handle& given, Question& to);
};
constexpr std::array<Field, 21> kFields = {{
    {"readings", measured<&Measurements::readings, readings_from>},
    {"roundings", measured<&Measurements::roundings, roundings_from>},
    {"rolls", measured<&Measurements::rolls, rolls_from>},
    {"wheels", measured<&Measurements::wheels, wheels_from>},
    {"touches", measured<&Measurements::touches, touches_from>},
    {"clear", measured<&Measurements::clear, clear_from>},
    {"at_rest", [](const py::handle& given, Question& to) { to.measured.at_rest = given.cast<bool>(); }},
    {"fingers", made<&Question::fingers, fingers_from>},
    {"noise", made<&Question::noise, noise_from>},
    {"tolerance", made<&Question::tolerance, tolerance_from>},
    {"budget", as_it_is<&Question::budget>},
    {"facing", as_it_is<&Question::facing>},
    {"at", as_it_is<&Question::at>},
    {"prior", made<&Question::prior, prior_from>},
    {"pose", made<&Question::pose, pose_from>},
    {"squeezed", as_it_is<&Question::squeezed>},
    {"direction", made<&Question::direction, direction_from>},
    {"mirrored", as_it_is<&Question::mirrored>},
    {"robust", as_it_is<&Question::robust>},
    {"may_overlap", as_it_is<&Question::may_overlap>},
    {"diagnose", as_it_is<&Question::diagnose>},
}};

void set_field(const std::string& name, const py::handle& given, Question& question) {
  for (const Field& field : kFields) {
    if (field.name == name) return field.set(given, question);
  }
  throw py::type_error("Question: there is no " + name);
}

Question question_from(const PartHandle& part, const py::kwargs& given) {
  Question question(part.part(), {});
  for (const auto& [name, value] : given) {
    if (!value.is_none()) set_field(name.cast<std::string>(), value, question);  // None: not said
  }
  return question;
}

/// What goes to another process: its fingers, and all else but the part as bytes.
py::tuple question_state(const Question& question) {
  return py::make_tuple(fingers_to(question.fingers), py::bytes(bytes_of(question)));
}

Question question_from_state(const PartHandle& part, const py::tuple& fingers, const py::bytes& bytes) {
  Question question(part.part(), {});
  read_bytes(std::string(bytes), question);
  question.fingers = fingers_from(fingers);
  return question;
}

/// The same of another part, on which no mistake is looked for.
Question about(const Question& question, const PartHandle& part) {
  Question other = question;
  other.part = part.part();
  other.diagnose = false;
  return other;
}

/// Throws InputError: what no roll, whatever it is, could be asked with.
void require_roll(const Question& question) {
  roll_problem(question);
  if (question.noise) belief::require_weighable(*question.noise);
}

py::object solve_without_lock(const Question& question) {
  std::optional<Solution> solution;
  {
    const Unlocked others_may_run;
    solution.emplace(solve(question));
  }
  return handle_of(std::move(*solution), question);
}

/// One reading of one finger, and nothing else: the shortest way to an answer.
AnswerHandle locate_one(const PartHandle& handle, double length, double turn) {
  const Problem problem{handle.part(), Reading(length, turn)};
  const Unlocked others_may_run;
  return {std::make_shared<const Answer>(solve(problem))};
}

}  // namespace

py::object handle_of(Solution solution, const Question& question) {
  const auto shared = std::make_shared<const Solution>(std::move(solution));
  if (const Answer* const roll = shared->roll()) return py::cast(AnswerHandle{{shared, roll}});
  if (const TouchAnswer* const at_rest = shared->at_rest()) return py::cast(TouchAnswerHandle{{shared, at_rest}});
  return py::cast(
      HoldAnswerHandle{{shared, shared->moving()}, std::make_shared<const HoldProblem>(moving_problem(question))});
}

void bind_question(py::module_& module) {
  py::class_<Question>(module, "Question")  // nothing changes it, and so any thread can ask
      .def(py::init(&question_from))
      .def("solve", &solve_without_lock)
      .def("about", &about)
      .def("require_roll", &require_roll)
      .def("state", &question_state);
  module.def("question_from_state", &question_from_state);
  module.def("locate_one", &locate_one);
  module.def("finger_name", [](const py::object& finger) { return finger_from(finger).name(); });
}

}  // namespace rollfix::python
