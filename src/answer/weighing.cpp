#include "weighing.hpp"

#include <algorithm>
#include <utility>

namespace rollfix {
namespace {

// A posterior of two fingers is complete when it leaves out no more than this.
constexpr double kMostRest = 0.01;

LogKind kind_of(const Problem& problem) { return problem.felt.is_log() ? problem.felt.log->kind : LogKind::travelled; }

/// What a finger felt at its first contact, where the log tells it.
std::optional<FeltContact> first_felt(const Problem& problem, std::size_t which) {
  if (problem.fingers.empty() || !problem.felt.is_log()) return std::nullopt;
  const FingerRows& rows = problem.felt.log->fingers[which];
  if (problem.felt.log->kind != LogKind::contact || rows.x.empty()) return std::nullopt;
  const Finger& finger = *finger_of(problem.fingers, which);
  const Contact first{rows.u.front(), rows.psi.front()};
  const Vec2 where = Vec2(rows.x.front(), rows.y.front()) - centre_of(finger, Vec2::Zero(), first);
  return FeltContact{where, facing(finger, first), finger.curvature(first.u)};
}

/// The curvature of finger 0 or 1 where it touches in a row; 0 where the finger is not known.
double curvature(const Problem& problem, std::size_t which, std::size_t row) {
  if (problem.fingers.empty()) return 0;
  // Where u is wrapped makes no difference to the curvature there.
  const double u = kind_of(problem) == LogKind::contact ? problem.felt.log->fingers[which].u[row] : 0;
  return finger_of(problem.fingers, which)->curvature(u);
}

void add_pose_spreads(const Problem& problem, Belief& belief, std::vector<Placement>& placements) {
  if (placements.empty()) return;
  PerFinger<FeltContact> felt = PerFinger<FeltContact>::of(placements.front().start.size());
  for (std::size_t which = 0; which < felt.size(); ++which) {
    const std::optional<FeltContact> first = first_felt(problem, which);
    if (!first) return;
    felt[which] = *first;
  }
  for (std::size_t k = 0; k < placements.size(); ++k) placements[k].pose_spread = belief.pose_spread(k, felt);
}

}  // namespace

std::optional<Belief> believe(const Problem& problem, const Observation& observed) {
  if (!problem.noise) return std::nullopt;
  const std::size_t fingers = observed.readings.front().fingers();
  Contacts contacts{PerFinger<double>::of(fingers), observed.facing};
  for (std::size_t which = 0; which < fingers; ++which) contacts.finger_curvature[which] = curvature(problem, which, 0);
  const BeliefOptions options{*problem.noise, problem.prior, problem.robust, !problem.felt.is_log()};
  Belief belief(problem.part, kind_of(problem), options, contacts);
  const std::vector<Reading>& readings = problem.felt.is_log() ? observed.rolls : observed.readings;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    Sample sample;
    sample.reading = readings[k];
    sample.finger_curvature = PerFinger<double>::of(fingers);
    for (std::size_t which = 0; which < fingers; ++which) sample.finger_curvature[which] = curvature(problem, which, k);
    belief.add(sample);
  }
  return belief;
}

void weigh(const Problem& problem, Belief& belief, Answer& answer) {
  Weighing weighing{*problem.noise, problem.prior, problem.robust};
  weighing.samples = belief.samples();
  weighing.excess = belief.excess();
  weighing.rest = belief.rest();
  weighing.diagnosis = belief.diagnosis();
  answer.verdict = belief.verdict();
  Search found;
  found.placements = std::move(answer.placements);
  Weighed weighed = weigh(answer.part, answer.readings, answer.facing, found, belief);
  weighing.improbable = std::move(weighed.improbable);
  add_pose_spreads(problem, belief, weighed.placements);
  if (weighing.diagnosis.cause != Cause::none) {
    for (Placement& placement : weighed.placements) weighing.improbable.push_back(std::move(placement));
    weighed.placements.clear();
  }
  answer.placements = std::move(weighed.placements);
  answer.dropped.improbable = weighing.improbable.size();
  if (answer.finger_count() == 2) {  // what is listed is the posterior's: the search only says what kinds they are
    answer.status = weighing.rest <= kMostRest ? Status::complete : Status::incomplete;
  }
  answer.weighing = std::move(weighing);
}

void conclude(Belief& belief, Answer& answer) {
  if (answer.impossible.empty()) return;
  double total = 0;
  for (const Placement& placement : answer.placements) total += placement.probability;
  for (Placement& placement : answer.placements) placement.probability /= total;
  answer.weighing->rest = std::min(1.0, answer.weighing->rest / std::max(total, 1e-300));
  answer.verdict = belief.verdict_on(answer.placements);
}

}  // namespace rollfix
