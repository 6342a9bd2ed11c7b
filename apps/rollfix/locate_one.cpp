#include "rollfix/locate_one.hpp"

#include <cmath>
#include <optional>

#include "rollfix/belief/weigh.hpp"
#include "rollfix/draw/locate_figure.hpp"
#include "rollfix/drop.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/locate_request.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/part/period.hpp"

namespace rollfix::app {
namespace {

Observation observe(const LocateArguments& arguments, const Part& part, const std::optional<Finger>& finger,
                    const std::vector<Log>& logs) {
  if (logs.empty()) return observe_readings(arguments.readings);
  return observe_log(logs.front(), part, finger, read_instants(arguments.instants));
}

/// With noise: what all rows say, or the readings where there is no log.
std::optional<Belief> believe(const LocateArguments& arguments, const Part& part, const Observation& observation,
                              const std::optional<Finger>& finger, const std::vector<Log>& logs) {
  std::optional<BeliefOptions> options = read_belief_options(arguments.noise);
  if (!options) return std::nullopt;
  options->bare = logs.empty();
  Belief belief(part, logs.empty() ? LogKind::travelled : logs.front().kind, *options);
  const std::vector<Reading>& readings = logs.empty() ? observation.readings : observation.rolls;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    Sample sample;
    sample.reading = readings[k];
    const bool has_place = !logs.empty() && logs.front().kind == LogKind::contact;
    // Where u is wrapped makes no difference to the curvature there.
    if (finger) sample.finger_curvature = finger->curvature(has_place ? logs.front().u[k] : 0);
    belief.add(sample);
  }
  return belief;
}

LocateOutcome search(const LocateArguments& arguments, const Part& part, const Observation& observation,
                     std::optional<Belief>& belief) {
  LocateOutcome outcome{part, observation.readings, observation.instants, {}, {}, {}, observation.times};
  const bool from_noise = belief && arguments.tolerance.empty();
  outcome.tolerance =
      from_noise ? tolerance_from_noise(belief->tolerance()) : tolerance_of(arguments, part, observation.roundings);
  LocateOptions options;
  options.tolerance = outcome.tolerance.value;
  options.budget = budget_of(arguments, options.budget);
  outcome.found = locate(part, outcome.readings, options);
  return outcome;
}

/// Puts what the samples leave in place of what the search found. What nothing explains is not listed.
void weigh(const LocateArguments& arguments, Belief& belief, LocateOutcome& outcome) {
  Weighed weighed = weigh(outcome.part, outcome.readings, outcome.found, belief);
  Weighing weighing;
  weighing.options = *read_belief_options(arguments.noise);
  weighing.samples = belief.samples();
  weighing.excess = belief.excess();
  weighing.rest = belief.rest();
  weighing.verdict = belief.verdict();
  weighing.diagnosis = belief.diagnosis();
  weighing.improbable = std::move(weighed.improbable);
  if (weighing.diagnosis.cause != Cause::none) {
    for (Placement& placement : weighed.placements) weighing.improbable.push_back(std::move(placement));
    weighed.placements.clear();
    weighed.modes.clear();
  }
  outcome.found.placements = std::move(weighed.placements);
  weighing.modes = std::move(weighed.modes);
  outcome.weighing = std::move(weighing);
}

/// After some were dropped: the modes of those that are left, as if there were no others.
void keep_modes_of_placements(Belief& belief, LocateOutcome& outcome) {
  std::vector<Mode> kept;
  std::size_t next = 0;
  double total = 0;
  for (const Placement& placement : outcome.found.placements) {
    while (outcome.weighing->modes[next].start != placement.start) ++next;
    kept.push_back(outcome.weighing->modes[next++]);
    total += kept.back().probability;
  }
  const bool any_dropped = kept.size() < outcome.weighing->modes.size();
  outcome.weighing->modes = std::move(kept);
  if (!any_dropped) return;
  for (Mode& mode : outcome.weighing->modes) mode.probability /= total;
  outcome.weighing->rest = std::min(1.0, outcome.weighing->rest / std::max(total, 1e-300));
  outcome.weighing->verdict = belief.verdict_on(outcome.weighing->modes);
}

void add_pose_spreads(const std::optional<Finger>& finger, const std::vector<Log>& logs, Belief& belief,
                      LocateOutcome& outcome) {
  Weighing& weighing = *outcome.weighing;
  weighing.poses.resize(weighing.modes.size());
  if (!finger || logs.empty() || logs.front().kind != LogKind::contact || logs.front().x.empty()) return;
  const Log& log = logs.front();
  const Contact first{log.u.front(), log.psi.front()};
  const double towards = facing(*finger, first);
  const Vec2 where = Vec2(log.x.front(), log.y.front()) - centre_of(*finger, Vec2::Zero(), first);
  const std::vector<Mass> mass = belief.mass();
  for (std::size_t k = 0; k < weighing.modes.size(); ++k) {
    weighing.poses[k] = pose_spread(outcome.part, weighing.modes[k], mass, where, towards, finger->curvature(first.u),
                                    weighing.options.noise);
  }
}

}  // namespace

LocateOutcome solve_one(const LocateArguments& arguments, const std::vector<Log>& logs, Report& report) {
  const std::optional<Finger> finger = read_finger(arguments.fingers);
  const Part part = load_part(arguments.part, report.notes);
  const Observation observation = observe(arguments, part, finger, logs);
  std::optional<Belief> belief = believe(arguments, part, observation, finger, logs);
  LocateOutcome outcome = search(arguments, part, observation, belief);
  if (belief) weigh(arguments, *belief, outcome);
  if (finger && has_reach(*finger)) drop(*finger, observation, outcome);
  if (finger && !has_reach(*finger)) report.notes.push_back(no_reach_note(*finger));
  if (belief) {
    keep_modes_of_placements(*belief, outcome);
    add_pose_spreads(finger, logs, *belief, outcome);
  }
  outcome.dropped.explain = arguments.explain;
  for (const Placement& placement : outcome.found.placements) {
    const bool tells = finger && !logs.empty();
    outcome.poses.push_back(tells ? poses(part, *finger, logs.front(), placement.start, observation.rows)
                                  : std::nullopt);
  }
  outcome.finger = finger;
  add_direction_notes(part, observation.lengths_turned_round, report);
  return outcome;
}

Report locate_one(const LocateArguments& arguments, const std::vector<Log>& logs) {
  Report report;
  const LocateOutcome outcome = solve_one(arguments, logs, report);
  report.exit_code = exit_code_of(outcome.found.status == Status::complete, !outcome.found.placements.empty());
  report.data = arguments.json ? json_text(locate_json(outcome)) : locate_text(outcome);
  if (!arguments.output.file.empty()) {
    LocateFigure figure;
    figure.part = &outcome.part;
    figure.readings = outcome.readings;
    figure.found = outcome.found;
    if (outcome.finger && outcome.finger->is_disk()) figure.finger_radius = outcome.finger->disk()->radius;
    if (outcome.weighing) figure.verdict = outcome.weighing->verdict;
    add_figure(arguments.output, draw_placements(figure), report);
  }
  return report;
}

}  // namespace rollfix::app
