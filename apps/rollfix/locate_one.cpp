#include <optional>

#include "rollfix/draw/locate_figure.hpp"
#include "rollfix/drop.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/locate_request.hpp"
#include "rollfix/observation.hpp"

namespace rollfix::app {
namespace {

Observation observe(const LocateArguments& arguments, const Part& part, const std::optional<DiskFinger>& finger,
                    const std::vector<Log>& logs) {
  if (logs.empty()) return observe_readings(arguments.readings);
  return observe_log(logs.front(), part, finger, read_instants(arguments.instants));
}

LocateOutcome search(const LocateArguments& arguments, const Part& part, const Observation& observation) {
  LocateOutcome outcome{part, observation.readings, observation.instants, {}, {}, {}, observation.times};
  outcome.tolerance = tolerance_of(arguments, part, observation.roundings);
  LocateOptions options;
  options.tolerance = outcome.tolerance.value;
  options.budget = budget_of(arguments, options.budget);
  outcome.found = locate(part, outcome.readings, options);
  return outcome;
}

std::optional<DiskFinger> disk_of(const std::optional<FingerShape>& shape) {
  return shape ? shape->disk : std::nullopt;
}

}  // namespace

Report locate_one(const LocateArguments& arguments, const std::vector<Log>& logs) {
  const std::optional<FingerShape> shape = read_shape(arguments.fingers);
  const std::optional<DiskFinger> finger = logs.empty() ? disk_of(shape) : read_finger(arguments.fingers);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const Observation observation = observe(arguments, part, finger, logs);
  LocateOutcome outcome = search(arguments, part, observation);
  if (shape) drop(*shape, observation, outcome);
  outcome.dropped.explain = arguments.explain;
  for (const Placement& placement : outcome.found.placements) {
    const bool tells = finger && !logs.empty();
    outcome.poses.push_back(tells ? poses(part, *finger, logs.front(), placement.start, observation.rows)
                                  : std::nullopt);
  }

  report.exit_code = exit_code_of(outcome.found.status == Status::complete, !outcome.found.placements.empty());
  report.data = arguments.json ? json_text(locate_json(outcome)) : locate_text(outcome);
  add_direction_notes(part, observation.lengths_turned_round, report);
  if (!arguments.output.file.empty()) {
    LocateFigure figure;
    figure.part = &part;
    figure.readings = outcome.readings;
    figure.found = outcome.found;
    if (finger) figure.finger_radius = finger->radius;
    add_figure(arguments.output, draw_placements(figure), report);
  }
  return report;
}

}  // namespace rollfix::app
