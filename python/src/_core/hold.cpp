#include "rollfix/hold/hold.hpp"

#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/certify/certify.hpp"
#include "rollfix/files/documents.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

HoldAnswerHandle locate_hold(const PartHandle& part, const std::vector<LogHandle>& logs, const py::iterable& fingers,
                             const py::object& noise, const std::optional<std::pair<double, double>>& tolerance,
                             const std::vector<double>& at, bool mirrored, const std::optional<std::size_t>& budget,
                             const std::vector<std::pair<LogHandle, double>>& wheels,
                             const std::optional<double>& squeezed,
                             const std::optional<std::pair<double, double>>& prior,
                             const std::optional<std::vector<double>>& pose, bool robust, bool may_overlap) {
  HoldProblem problem{part.part(), {}, fingers_from(fingers)};
  for (const LogHandle& log : logs) problem.logs.push_back(*log.log);
  problem.noise = noise_from_optional(noise);
  if (tolerance) problem.tolerance = TouchTolerance{tolerance->first, tolerance->second};
  problem.at = at;
  problem.mirrored = mirrored;
  problem.budget = budget;
  for (const auto& [pin, radius] : wheels) problem.wheels.push_back({{*pin.log}, radius});
  problem.squeezed = squeezed;
  if (prior) problem.prior = Prior{prior->first, prior->second};
  problem.pose = pose_from(pose);
  problem.robust = robust;
  problem.may_overlap = may_overlap;
  const Unlocked others_may_run;
  auto answer = std::make_shared<const HoldAnswer>(solve(problem));
  return {std::move(answer), std::make_shared<const HoldProblem>(std::move(problem))};
}

/// The document, and whether it proves everything.
std::pair<std::string, bool> hold_certificate_of(const HoldAnswerHandle& handle,
                                                 const std::optional<std::size_t>& budget) {
  const Unlocked others_may_run;
  HoldProblem problem = *handle.problem;
  if (budget) problem.budget = budget;
  const HoldCertificate certificate = certify_holds(problem, *handle.answer);
  return {format_certificate(certificate), certificate.is_complete()};
}

/// How the wheel's pin moves next, as a document.
std::string next_pin_of(const HoldAnswerHandle& handle, const std::optional<std::pair<double, double>>& travel) {
  const Unlocked others_may_run;
  std::optional<Interval> range;
  if (travel) range = Interval{travel->first, travel->second};
  return format_next_pin(*handle.answer, next_pin(*handle.answer, range), Layout::line);
}

}  // namespace

void bind_hold(py::module_& module) {
  py::class_<HoldAnswerHandle>(module, "HoldAnswer")
      .def("document", [](const HoldAnswerHandle& handle) { return format_hold(*handle.answer, Layout::line); })
      .def("next_pin", &next_pin_of)
      .def("certificate", &hold_certificate_of);
  module.def("locate_hold", &locate_hold);
}

}  // namespace rollfix::python
