#include "rollfix/hold/hold.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/files/hold_document.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

HoldAnswerHandle locate_hold(const PartHandle& part, const std::vector<LogHandle>& logs, const py::iterable& fingers,
                             const py::object& noise, const std::optional<std::pair<double, double>>& tolerance,
                             const std::vector<double>& at, bool mirrored, const std::optional<std::size_t>& budget,
                             const std::vector<std::pair<LogHandle, double>>& wheels,
                             const std::optional<double>& squeezed) {
  HoldProblem problem{part.part(), {}, fingers_from(fingers)};
  for (const LogHandle& log : logs) problem.logs.push_back(*log.log);
  problem.noise = noise_from_optional(noise);
  if (tolerance) problem.tolerance = TouchTolerance{tolerance->first, tolerance->second};
  problem.at = at;
  problem.mirrored = mirrored;
  problem.budget = budget;
  for (const auto& [pin, radius] : wheels) problem.wheels.push_back({{*pin.log}, radius});
  problem.squeezed = squeezed;
  const Unlocked others_may_run;
  return {std::make_shared<const HoldAnswer>(solve(problem))};
}

}  // namespace

void bind_hold(py::module_& module) {
  py::class_<HoldAnswerHandle>(module, "HoldAnswer").def("document", [](const HoldAnswerHandle& handle) {
    return format_hold(*handle.answer, Layout::line);
  });
  module.def("locate_hold", &locate_hold);
}

}  // namespace rollfix::python
