#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "rollfix/belief/pair_weigh.hpp"
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

// With noise the search only says what kinds there are; a wide tolerance is not worth more boxes than this.
constexpr std::size_t kBudgetWithNoise = 30000;
constexpr double kWidestSearch = 0.5;  // radians
// A posterior is complete when it leaves out no more than this.
constexpr double kMostRest = 0.01;

PairObservation observe(const LocateArguments& arguments, const Part& part, const std::optional<FingerPair>& fingers,
                        const std::optional<PairLog>& log) {
  if (!log) return observe_pair_readings(arguments.readings, arguments.facing);
  if (!arguments.facing.empty()) {
    throw InputError("--facing goes with --reading: a log of two fingers has it in u and psi");
  }
  return observe_pair_log(*log, part, fingers, read_instants(arguments.instants));
}

/// With noise: what all rows say, or the readings where there is no log.
std::optional<PairBelief> believe(const LocateArguments& arguments, const Part& part,
                                  const PairObservation& observation, const std::optional<FingerPair>& fingers,
                                  const std::optional<PairLog>& log) {
  std::optional<BeliefOptions> options = read_belief_options(arguments.noise);
  if (!options) return std::nullopt;
  options->bare = !log;
  PairContacts contacts;
  contacts.facing = observation.facing;
  for (const std::size_t which : {0U, 1U}) {
    if (!fingers) break;
    const bool has_place = log && log->a.kind == LogKind::contact;
    const double u = has_place ? (which == 0 ? log->a : log->b).u.front() : 0;
    contacts.finger_curvature[which] = (*fingers)[which].curvature(u);
  }
  PairBelief belief(part, log ? log->a.kind : LogKind::travelled, *options, contacts);
  for (const PairReading& reading : log ? observation.rolls : observation.readings) belief.add(reading);
  return belief;
}

PairOutcome search(const LocateArguments& arguments, const Part& part, const PairObservation& observation,
                   std::optional<PairBelief>& belief) {
  PairOutcome outcome{part, observation.readings, observation.instants, observation.facing, {}, {},
                      {},   observation.times};
  const bool from_noise = belief && arguments.tolerance.empty();
  outcome.tolerance = from_noise ? tolerance_from_noise(belief->tolerance(observation.readings))
                                 : tolerance_of(arguments, part, observation.roundings);
  PairOptions options;
  options.tolerance = outcome.tolerance.value;
  options.facing = observation.facing;
  options.budget = budget_of(arguments, from_noise ? kBudgetWithNoise : options.budget);
  // Where nearly any direction would do, a search has nothing to say of kinds.
  if (from_noise && options.tolerance > kWidestSearch) return outcome;
  outcome.found = locate(part, outcome.readings, options);
  return outcome;
}

/// Drops what the fingers can't do, where that is known of both.
void drop_impossible(const FingerPair& fingers, const PairObservation& observation, PairOutcome& outcome,
                     Report& report) {
  for (const Finger& finger : fingers) {
    if (has_reach(finger)) continue;
    report.notes.push_back(no_reach_note(finger));
    return;
  }
  drop(fingers, observation, outcome);
}

/// Puts what the samples leave in place of what the search found. What nothing explains is not listed.
void weigh(const LocateArguments& arguments, PairBelief& belief, PairOutcome& outcome) {
  WeighedPairs weighed = weigh(outcome.part, outcome.readings, outcome.facing, outcome.found, belief);
  PairWeighing weighing;
  weighing.common.options = *read_belief_options(arguments.noise);
  weighing.common.samples = belief.samples();
  weighing.common.excess = belief.excess();
  weighing.common.rest = belief.rest();
  weighing.common.verdict = belief.verdict();
  weighing.common.diagnosis = belief.diagnosis();
  weighing.improbable = std::move(weighed.improbable);
  if (weighing.common.diagnosis.cause != Cause::none) {
    for (PairPlacement& placement : weighed.placements) weighing.improbable.push_back(std::move(placement));
    weighed.placements.clear();
    weighed.modes.clear();
  }
  outcome.found.placements = std::move(weighed.placements);
  weighing.modes = std::move(weighed.modes);
  // What is listed is the posterior's: the search only says what kinds they are.
  outcome.found.status = weighing.common.rest <= kMostRest ? Status::complete : Status::incomplete;
  outcome.weighing = std::move(weighing);
}

/// What the fingers felt at their first contacts, where the logs tell it.
std::optional<std::array<FeltContact, 2>> first_felt(const std::optional<FingerPair>& fingers,
                                                     const std::optional<PairLog>& log) {
  if (!fingers || !log || log->a.kind != LogKind::contact || log->a.x.empty() || log->b.x.empty()) return std::nullopt;
  std::array<FeltContact, 2> felt;
  for (const std::size_t which : {0U, 1U}) {
    const Log& one = which == 0 ? log->a : log->b;
    const Finger& finger = (*fingers)[which];
    const Contact first{one.u.front(), one.psi.front()};
    const Vec2 where = Vec2(one.x.front(), one.y.front()) - centre_of(finger, Vec2::Zero(), first);
    felt[which] = {where, facing(finger, first), finger.curvature(first.u)};
  }
  return felt;
}

/// After the fingers dropped some: the modes of those that are left, as if there were no others, and their poses.
void finish_weighing(const std::optional<FingerPair>& fingers, const std::optional<PairLog>& log, PairBelief& belief,
                     PairOutcome& outcome) {
  PairWeighing& weighing = *outcome.weighing;
  const std::optional<std::array<FeltContact, 2>> felt = first_felt(fingers, log);
  const std::vector<PairMass> mass = felt ? belief.mass() : std::vector<PairMass>{};
  std::vector<PairMode> kept;
  std::size_t next = 0;
  double total = 0;
  for (const PairPlacement& placement : outcome.found.placements) {
    while (weighing.modes[next].start != placement.start) ++next;
    weighing.common.poses.push_back(
        felt ? std::optional(pose_spread(outcome.part, next, mass, *felt, weighing.common.options.noise))
             : std::nullopt);
    kept.push_back(weighing.modes[next++]);
    total += kept.back().probability;
  }
  const bool any_dropped = kept.size() < weighing.modes.size();
  weighing.modes = std::move(kept);
  if (!any_dropped) return;
  for (PairMode& mode : weighing.modes) mode.probability /= total;
  weighing.common.rest = std::min(1.0, weighing.common.rest / std::max(total, 1e-300));
  weighing.common.verdict = belief.verdict_on(weighing.modes);
}

}  // namespace

Report locate_two(const LocateArguments& arguments, const std::vector<Log>& logs) {
  const std::optional<FingerPair> fingers = read_fingers(arguments.fingers);
  Report report;
  const Part part = load_part(arguments.part, report.notes);
  const std::optional<PairLog> log =
      logs.empty() ? std::nullopt : std::optional<PairLog>(paired(logs.front(), logs.back()));
  const PairObservation observation = observe(arguments, part, fingers, log);
  std::optional<PairBelief> belief = believe(arguments, part, observation, fingers, log);
  PairOutcome outcome = search(arguments, part, observation, belief);
  if (belief) weigh(arguments, *belief, outcome);
  if (fingers) drop_impossible(*fingers, observation, outcome, report);
  if (belief) finish_weighing(fingers, log, *belief, outcome);
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
