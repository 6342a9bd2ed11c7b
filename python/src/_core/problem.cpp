#include <fmt/format.h>

#include "archive.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/answer/solve.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

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

std::optional<Prior> prior_from(const std::optional<std::pair<double, double>>& given) {
  if (!given) return std::nullopt;
  return Prior{given->first, given->second};
}

/// What goes to another process: its fingers, and all else but the part as bytes.
py::tuple problem_state(const Problem& problem) {
  return py::make_tuple(fingers_to(problem.fingers), py::bytes(bytes_of(problem)));
}

Problem problem_from_state(const PartHandle& part, const py::tuple& fingers, const py::bytes& bytes) {
  Problem problem{part.part(), std::vector<Reading>{}};
  read_bytes(std::string(bytes), problem);
  problem.fingers = fingers_from(fingers);
  return problem;
}

AnswerHandle solve_without_lock(const Problem& problem) {
  const Problem own = problem;  // another thread may change the original meanwhile
  const Unlocked others_may_run;
  return {std::make_shared<const Answer>(solve(own))};
}

/// One reading of one finger, and nothing else: the shortest way to an answer.
AnswerHandle locate_one(const PartHandle& handle, double length, double turn) {
  const Problem problem{handle.part(), Reading(length, turn)};
  const Unlocked others_may_run;
  return {std::make_shared<const Answer>(solve(problem))};
}

}  // namespace

void bind_problem(py::module_& module) {
  py::class_<Problem>(module, "Problem")
      .def(py::init([](const PartHandle& part) {
        return Problem{part.part(), std::vector<Reading>{}};
      }))
      .def("set_readings", [](Problem& problem, const Numbers& rows) { problem.felt = readings_from(rows); })
      .def("set_roundings",
           [](Problem& problem, const std::vector<std::pair<double, double>>& given) {
             problem.felt.roundings.clear();
             for (const auto& [length, turn] : given) problem.felt.roundings.push_back({length, turn});
           })
      .def("set_log", [](Problem& problem, const LogHandle& log) { problem.felt = Felt(*log.log); })
      .def("set_fingers",
           [](Problem& problem, const py::iterable& fingers) { problem.fingers = fingers_from(fingers); })
      .def("set_noise", [](Problem& problem, const py::object& noise) { problem.noise = noise_from_optional(noise); })
      .def("set_prior",
           [](Problem& problem, const std::optional<std::pair<double, double>>& prior) {
             problem.prior = prior_from(prior);
           })
      .def("set_pose",
           [](Problem& problem, const std::optional<std::vector<double>>& pose) { problem.pose = pose_from(pose); })
      .def_readwrite("tolerance", &Problem::tolerance)
      .def_readwrite("budget", &Problem::budget)
      .def_readwrite("facing", &Problem::facing)
      .def_readwrite("at", &Problem::at)
      .def_readwrite("mirrored", &Problem::mirrored)
      .def_readwrite("either_way", &Problem::either_way)
      .def_readwrite("robust", &Problem::robust)
      .def_readwrite("may_overlap", &Problem::may_overlap)
      .def("solve", &solve_without_lock)
      .def("state", &problem_state);
  module.def("problem_from_state", &problem_from_state);
  module.def("locate_one", &locate_one);
  module.def("finger_name", [](const py::object& finger) { return finger_from(finger).name(); });
  module.def("check_noise", [](const py::dict& noise) { noise_from(noise); });
}

}  // namespace rollfix::python
