// Simulated rolls, a part from a roll, the next roll.
#include <algorithm>

#include "archive.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "fingers.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/files.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/teach.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

RollHandle handle_of(NoisyRoll roll) { return {std::make_shared<const NoisyRoll>(std::move(roll))}; }

/// psi of a finger whose first contact is at s, with a disk's contact at this angle in its frame.
double orientation_at(const Part& part, const Finger& finger, double s, double contact_angle) {
  if (!finger.is_disk()) return 0;
  return contact_at(finger, part.tangent(s), contact_angle).psi;
}

RollHandle simulate_one(const PartHandle& handle, const py::object& finger_given, double start,
                        const std::optional<double>& length, const std::optional<double>& rotation, std::size_t rows,
                        double contact, const py::object& noise_given, std::uint64_t seed) {
  const Part part = handle.part();
  const Finger finger = finger_from(finger_given);
  const std::optional<Noise> noise = noise_from_optional(noise_given);
  RollPlan plan;
  plan.start = start;
  plan.distance = length;
  plan.rotation = rotation;
  plan.rows = rows;
  if (finger.is_disk()) {
    plan.psi = orientation_at(part, finger, start, contact);
  } else {
    plan.u = contact;
  }
  const Unlocked others_may_run;
  if (noise) return handle_of(noisy_roll(part, finger, plan, *noise, seed));
  NoisyRoll exact;
  exact.truth = roll(part, finger, plan);
  exact.log = exact.truth.log;
  return handle_of(std::move(exact));
}

RollHandle simulate_two(const PartHandle& handle, const py::iterable& fingers_given,
                        const std::array<double, 2>& starts, const std::array<double, 2>& lengths, double part_rotation,
                        std::size_t rows, const std::array<double, 2>& contacts, const py::object& noise_given,
                        std::uint64_t seed) {
  const Part part = handle.part();
  const std::vector<Finger> fingers = fingers_from(fingers_given);
  const std::optional<Noise> noise = noise_from_optional(noise_given);
  FreePlan plan;
  for (const std::size_t which : {0U, 1U}) {
    const Finger& finger = *finger_of(fingers, which);
    plan.fingers[which] = {finger, starts[which], orientation_at(part, finger, starts[which], contacts[which]),
                           lengths[which]};
    if (!finger.is_disk()) plan.fingers[which].u = contacts[which];
  }
  plan.part_rotation = part_rotation;
  plan.rows = rows;
  const Unlocked others_may_run;
  if (noise) return handle_of(noisy_roll_free(part, plan, *noise, seed));
  NoisyRoll exact;
  exact.truth = roll_free(part, plan);
  exact.log = exact.truth.log;
  exact.error = {RollError{}, RollError{}};
  return handle_of(std::move(exact));
}

/// A jaw and a wheel on a pin.
RollHandle simulate_rig(const PartHandle& handle, double radius, const std::array<double, 2>& starts,
                        const std::array<double, 2>& pin, bool squeezed, double jaw_rotation, std::size_t rows,
                        const std::array<double, 2>& contacts, const std::string& sensors,
                        const py::object& noise_given, std::uint64_t seed) {
  const Part part = handle.part();
  const std::optional<Noise> noise = noise_from_optional(noise_given);
  RigPlan plan;
  plan.radius = radius;
  plan.start = starts;
  plan.u = contacts[0];
  plan.psi = orientation_at(part, disk(radius), starts[1], contacts[1]);
  plan.pin = [=](double time) { return Vec2(time * pin[0], time * pin[1]); };
  plan.jaw = [=](double time) { return Pose{0, 0, time * jaw_rotation}; };
  plan.squeezed = squeezed;
  plan.rows = rows;
  const Unlocked others_may_run;
  NoisyRoll roll;
  if (noise) {
    roll = noisy_roll_rig(part, plan, *noise, seed);
  } else {
    roll.truth = roll_rig(part, plan);
    roll.log = roll.truth.log;
    roll.error = {RollError{}, RollError{}};
  }
  roll.log = sensed_by(sensors == "pin"       ? WheelSensors::pin
                       : sensors == "encoder" ? WheelSensors::encoder
                                              : WheelSensors::skin,
                       std::move(roll.log));
  return handle_of(std::move(roll));
}

RollHandle simulate_drive(const PartHandle& handle, double start, double length, std::size_t rows,
                          const py::object& noise_given, std::uint64_t seed, double seconds) {
  const Part part = handle.part();
  const Noise noise = noise_from_optional(noise_given).value_or(Noise{});
  const Unlocked others_may_run;
  NoisyIncrements drive = noisy_increments(part, start, length, rows, noise, seed, seconds);
  NoisyRoll result;
  result.log = std::move(drive.log);
  result.truth.s = PerFinger<std::vector<double>>(std::move(drive.s));
  result.error = PerFinger<RollError>(drive.error);
  return handle_of(std::move(result));
}

/// Of two fingers: the row in which they are deepest in one another, and how deep.
std::optional<std::pair<std::size_t, double>> overlap_in(const RollHandle& handle, const py::iterable& given) {
  const std::vector<Finger> fingers = fingers_from(given);
  const auto overlap = overlap_of(handle.roll->truth, *finger_of(fingers, 0), *finger_of(fingers, 1));
  if (!overlap) return std::nullopt;
  return std::pair(overlap->row, overlap->depth);
}

/// Where a finger, of two one of them, would have to leave its reach on its way, and how deep it would enter the part
/// there; over a concave corner: 0.
std::optional<std::pair<double, double>> obstruction_in(const RollHandle& handle, const PartHandle& part_handle,
                                                        const Reach& reach, std::size_t which) {
  const Part part = part_handle.part();
  const std::vector<double>& s = handle.roll->truth.s[which];
  const auto [least, most] = std::minmax_element(s.begin(), s.end());
  const auto met = obstruction_of(part, reach, s.front(), {*least - s.front(), *most - s.front()});
  if (!met) return std::nullopt;
  return std::pair(met->s, met->concave_corner ? 0.0 : met->hit.depth);
}

py::tuple truth_of(const RollHandle& handle) {
  py::list places;
  for (const std::vector<double>& s : handle.roll->truth.s) places.append(array_of(s));
  return py::tuple(places);
}

TeachOptions teach_options(const py::object& finger, const py::object& noise, bool bridge, bool open,
                           const std::optional<double>& corner_angle) {
  TeachOptions options;
  if (!finger.is_none()) options.finger = finger_from(finger);
  options.noise = noise_from_optional(noise);
  options.bridge = bridge;
  options.open = open;
  if (corner_angle) options.corner_angle = *corner_angle;
  return options;
}

/// The part, its document, the notes.
py::tuple teach_part(const LogHandle& log, const py::object& finger, const py::object& noise, bool bridge, bool open,
                     const std::optional<double>& corner_angle, bool allow_crossing) {
  const TeachOptions options = teach_options(finger, noise, bridge, open, corner_angle);
  std::optional<LoadedPart> loaded;
  std::string document;
  {
    const Unlocked others_may_run;
    const Taught taught = teach(*log.log, options);
    const Part part(taught.outline, {allow_crossing});
    loaded = LoadedPart{part, taught.outline.unit, {}, 0, taught.notes};
    document = format_taught(inspect(part), taught, Layout::line);
  }
  return py::make_tuple(PartHandle(std::move(*loaded)), document);
}

AnswerHandle before_any_contact(const Question& asked) {
  const Unlocked others_may_run;
  return {std::make_shared<const Answer>(before_contact(asked.part, asked.fingers, asked.noise, asked.may_overlap))};
}

NextRollHandle next_roll_of(const AnswerHandle& answer, const std::optional<std::pair<double, double>>& travel,
                            bool may_overlap, const std::optional<std::pair<double, double>>& friction) {
  const Unlocked others_may_run;
  const std::optional<Interval> range =
      travel ? std::optional<Interval>(Interval{travel->first, travel->second}) : std::nullopt;
  std::optional<PerFinger<double>> each;
  if (friction) each = PerFinger<double>(friction->first, friction->second);
  return {std::make_shared<const NextRoll>(next_roll(*answer.answer, range, may_overlap, each))};
}

}  // namespace

void bind_rolls(py::module_& module) {
  py::class_<RollHandle>(module, "Roll")
      .def_property_readonly(
          "log", [](const RollHandle& handle) { return LogHandle{std::make_shared<const Log>(handle.roll->log)}; })
      .def_property_readonly("s", &truth_of)
      .def_property_readonly("pose", [](const RollHandle& handle) { return array_of(handle.roll->truth.pose); })
      .def("overlap", &overlap_in)
      .def("obstruction", &obstruction_in)
      .def_property_readonly("slip",
                             [](const RollHandle& handle) {
                               std::vector<double> slips;
                               for (const RollError& one : handle.roll->error) slips.push_back(one.slip);
                               return array_of(std::move(slips));
                             })
      .def_property_readonly("radius_error",
                             [](const RollHandle& handle) {
                               std::vector<double> errors;
                               for (const RollError& one : handle.roll->error) errors.push_back(one.radius);
                               return array_of(std::move(errors));
                             })
      .def(py::pickle([](const RollHandle& handle) { return py::bytes(bytes_of(*handle.roll)); },
                      [](const py::bytes& bytes) {
                        NoisyRoll roll;
                        read_bytes(std::string(bytes), roll);
                        return handle_of(std::move(roll));
                      }));
  py::class_<NextRollHandle>(module, "NextRoll").def("document", [](const NextRollHandle& handle) {
    return format_next_roll(*handle.next, Layout::line);
  });
  module.def("simulate_one", &simulate_one);
  module.def("simulate_two", &simulate_two);
  module.def("simulate_rig", &simulate_rig);
  module.def("squeezed_places", [](const PartHandle& handle, double radius, double s) {
    return squeezed_places(handle.part(), radius, s);
  });
  module.def("simulate_drive", &simulate_drive);
  module.def("teach", &teach_part);
  module.def("next_roll", &next_roll_of);
  module.def("before_contact", &before_any_contact);
}

}  // namespace rollfix::python
