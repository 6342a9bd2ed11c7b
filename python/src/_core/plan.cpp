#include "rollfix/plan.hpp"

#include <array>

#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "handles.hpp"
#include "rollfix/files.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

using OfFingers = std::vector<std::optional<double>>;

/// psi of a disk whose first contact is at s, with the contact at this angle in its frame; the rest have u.
void place_contact(const Part& part, double heading, bool mirrored, double contact, PlanFinger& finger) {
  if (finger.finger.is_disk()) {
    const double tangent = part.tangent(finger.start.value_or(0));
    finger.psi = contact_at(finger.finger, heading + (mirrored ? -tangent : tangent), contact).psi;
  } else {
    finger.u = contact;
  }
}

Staying staying_named(const std::string& name) {
  return name == "a" ? Staying::a : name == "b" ? Staying::b : name == "part" ? Staying::part : Staying::middle;
}

PlanLimits limits_from(const py::dict& given) {
  const auto limit = [&](const char* name) {
    return given.contains(name) ? std::optional<double>(given[name].cast<double>()) : std::nullopt;
  };
  return {limit("speed"), limit("turn"), limit("travel"), limit("rotation")};
}

PlanHandle plan_roll(const PartHandle& handle, const py::iterable& fingers_given, bool wheel, const OfFingers& starts,
                     const OfFingers& lengths, const OfFingers& frictions, const OfFingers& contacts,
                     const std::array<double, 3>& pose, const std::optional<double>& part_rotation,
                     const std::string& stays, const std::optional<double>& duration, const py::dict& limits,
                     double margin, double clearance, std::size_t rows, bool may_overlap, bool mirrored) {
  const std::vector<Finger> shapes = fingers_from(fingers_given);
  PlanProblem problem{handle.part(), PerFinger<PlanFinger>::of(starts.size())};
  problem.pose = {pose[0], pose[1], pose[2]};
  for (std::size_t which = 0; which < starts.size(); ++which) {
    PlanFinger& finger = problem.fingers[which];
    finger.finger = *finger_of(shapes, which);
    finger.start = starts[which];
    finger.length = lengths[which];
    finger.friction = frictions[which];
    finger.wheel = wheel && which == 1;
    if (contacts[which] || finger.finger.is_disk()) {
      place_contact(problem.part, problem.pose.heading, mirrored, contacts[which].value_or(0), finger);
    }
  }
  problem.part_rotation = part_rotation;
  problem.staying = staying_named(stays);
  problem.duration = duration;
  problem.limits = limits_from(limits);
  problem.margin = margin;
  problem.clearance = clearance;
  problem.rows = rows;
  problem.may_overlap = may_overlap;
  problem.mirrored = mirrored;
  const Unlocked others_may_run;
  auto plan = std::make_shared<const Plan>(solve(problem));
  return {std::make_shared<const PlanProblem>(std::move(problem)), std::move(plan)};
}

}  // namespace

void bind_plan(py::module_& module) {
  py::class_<PlanHandle>(module, "Plan")
      .def("document",
           [](const PlanHandle& one) { return format_plan_document(*one.plan, *one.problem, Layout::line); })
      .def("table", [](const PlanHandle& one,
                       const std::optional<std::size_t>& finger) { return format_plan(*one.plan, finger); })
      .def_property_readonly(
          "log", [](const PlanHandle& one) { return LogHandle{std::make_shared<const Log>(one.plan->roll.log)}; });
  module.def("plan_roll", &plan_roll);
}

}  // namespace rollfix::python
