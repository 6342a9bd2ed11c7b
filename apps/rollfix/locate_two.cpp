#include <fmt/format.h>

#include <optional>

#include "rollfix/contact/pair_log.hpp"
#include "rollfix/draw/pair_figure.hpp"
#include "rollfix/drop.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_request.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/pair_outcome.hpp"
#include "rollfix/reading_argument.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

PairObservation observe(const LocateArguments& arguments, const Part& part, const std::optional<FingerPair>& fingers,
                        const std::optional<PairLog>& log) {
  if (!log) return observe_pair_readings(arguments.readings, arguments.facing);
  if (!arguments.facing.empty()) {
    throw InputError("--facing goes with --reading: a log of two fingers has it in u and psi");
  }
  return observe_pair_log(*log, part, fingers, read_instants(arguments.instants));
}

PairOutcome search(const LocateArguments& arguments, const Part& part, const PairObservation& observation) {
  PairOutcome outcome{part, observation.readings, observation.instants, observation.facing, {}, {},
                      {},   observation.times};
  outcome.tolerance = tolerance_of(arguments, part, observation.roundings);
  PairOptions options;
  options.tolerance = outcome.tolerance.value;
  options.facing = observation.facing;
  options.budget = budget_of(arguments, options.budget);
  outcome.found = locate(part, outcome.readings, options);
  return outcome;
}

std::optional<FingerPair> disks_of(const std::optional<std::array<FingerShape, 2>>& shapes) {
  if (!shapes || !(*shapes)[0].disk || !(*shapes)[1].disk) return std::nullopt;
  return FingerPair{*(*shapes)[0].disk, *(*shapes)[1].disk};
}

}  // namespace

Report locate_two(const LocateArguments& arguments, const std::vector<Log>& logs) {
  const auto shapes = read_shapes(arguments.fingers);
  const std::optional<FingerPair> fingers = logs.empty() ? disks_of(shapes) : read_fingers(arguments.fingers);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const std::optional<PairLog> log =
      logs.empty() ? std::nullopt : std::optional<PairLog>(paired(logs.front(), logs.back()));
  const PairObservation observation = observe(arguments, part, fingers, log);
  PairOutcome outcome = search(arguments, part, observation);
  if (shapes) drop(*shapes, observation, outcome);
  outcome.dropped.explain = arguments.explain;
  for (const PairPlacement& placement : outcome.found.placements) {
    const bool tells = fingers && log;
    outcome.poses.push_back(tells ? poses(part, *fingers, *log, placement.start, observation.rows) : std::nullopt);
  }

  report.exit_code = exit_code_of(outcome.found.status == Status::complete, !outcome.found.placements.empty());
  report.data = arguments.json ? json_text(pair_json(outcome)) : pair_text(outcome);
  add_direction_notes(part, observation.lengths_turned_round, report);
  if (!arguments.output.file.empty()) add_figure(arguments.output, draw_pairs(figure_of(outcome, fingers)), report);
  return report;
}

}  // namespace rollfix::app
