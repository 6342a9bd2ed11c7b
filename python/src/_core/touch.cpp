#include "rollfix/touch/touch.hpp"

#include <cmath>

#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/certify/certify.hpp"
#include "rollfix/files/documents.hpp"
#include "signals.hpp"
#include "touches.hpp"

namespace rollfix::python {
namespace {

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

}  // namespace

TouchProblem touch_problem_from(const Part& part, const Numbers& rows, const py::object& finger,
                                const py::object& noise, const std::optional<std::pair<double, double>>& tolerance,
                                const std::optional<std::vector<double>>& pose, bool mirrored,
                                const std::optional<std::size_t>& budget, const Numbers& clear) {
  TouchProblem problem{part, touches_from(rows)};
  if (!finger.is_none()) problem.finger = finger_from(finger);
  problem.noise = noise_from_optional(noise);
  if (tolerance) problem.tolerance = TouchTolerance{tolerance->first, tolerance->second};
  problem.pose = pose_from(pose);
  problem.mirrored = mirrored;
  problem.budget = budget;
  for (py::ssize_t k = 0; k < clear.shape(0); ++k) {
    problem.clear.push_back({{clear.at(k, 0), clear.at(k, 1)}, {clear.at(k, 2), clear.at(k, 3)}});
  }
  return problem;
}

namespace {

TouchAnswerHandle locate_touches(const PartHandle& part, const Numbers& rows, const py::object& finger,
                                 const py::object& noise, const std::optional<std::pair<double, double>>& tolerance,
                                 const std::optional<std::vector<double>>& pose, bool mirrored,
                                 const std::optional<std::size_t>& budget, const std::vector<LogHandle>& rolls,
                                 bool robust, const Numbers& clear, bool diagnose) {
  TouchProblem problem = touch_problem_from(part.part(), rows, finger, noise, tolerance, pose, mirrored, budget, clear);
  for (const LogHandle& roll : rolls) problem.rolls.push_back(*roll.log);
  problem.robust = robust;
  problem.diagnose = diagnose;
  const Unlocked others_may_run;
  return {std::make_shared<const TouchAnswer>(solve(problem))};
}

/// `approaches`, (n, 4): x, y and the direction's two components; none: all around.
std::string next_touch_document(const TouchAnswerHandle& handle, const Numbers& approaches) {
  std::vector<Approach> ways;
  for (py::ssize_t k = 0; k < approaches.shape(0); ++k) {
    ways.push_back({{approaches.at(k, 0), approaches.at(k, 1)}, std::atan2(approaches.at(k, 3), approaches.at(k, 2))});
  }
  const Unlocked others_may_run;
  return format_next_touch(*handle.answer, next_touch(*handle.answer, ways), Layout::line);
}

/// The document, and whether it proves everything.
std::pair<std::string, bool> certificate_of(const TouchAnswerHandle& handle, const std::optional<std::size_t>& budget) {
  const Unlocked others_may_run;
  const TouchCertificate certificate = certify_touches(*handle.answer, budget);
  return {format_certificate(certificate), certificate.is_complete()};
}

}  // namespace

void bind_touch(py::module_& module) {
  py::class_<TouchAnswerHandle>(module, "TouchAnswer")
      .def("document", [](const TouchAnswerHandle& handle) { return format_touches(*handle.answer, Layout::line); })
      .def("certificate", &certificate_of)
      .def("next_touch", &next_touch_document);
  module.def("locate_touches", &locate_touches);
}

}  // namespace rollfix::python
