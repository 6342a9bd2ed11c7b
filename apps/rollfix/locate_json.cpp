#include <algorithm>
#include <cmath>

#include "rollfix/locate_outcome.hpp"
#include "rollfix/pose_json.hpp"

namespace rollfix::app {
namespace {

/// One finger: a list of one.
Json per_finger(Json value) { return Json::array({std::move(value)}); }

/// per_turn[finger][reading] and per_length[finger][reading][which finger's length].
Json sensitivity_json(const Sensitivity& sensitivity) {
  const auto defined = [](double value) { return std::isfinite(value); };
  const bool any = std::any_of(sensitivity.per_turn.begin(), sensitivity.per_turn.end(), defined) ||
                   std::any_of(sensitivity.per_length.begin(), sensitivity.per_length.end(), defined);
  if (!any) return nullptr;
  Json per_length = Json::array();
  for (const double value : sensitivity.per_length) per_length.push_back(per_finger(json_number(value)));
  return {{"per_turn", per_finger(json_numbers(sensitivity.per_turn))}, {"per_length", per_finger(per_length)}};
}

Json placement_json(const Placement& placement, const std::optional<Poses>& poses) {
  Json roots = Json::array();
  for (const double root : placement.roots) roots.push_back(per_finger(json_number(root)));
  Json pivot = nullptr;
  if (placement.pivot) {
    pivot = Json::array({json_interval(placement.pivot->start), json_interval(placement.pivot->end)});
  }
  return {{"kind", name_of(placement.kind)},
          {"start", per_finger(json_number(placement.start))},
          {"end", per_finger(json_number(placement.end))},
          {"extent", per_finger(json_interval(placement.extent))},
          {"whole_loop", placement.whole_loop},
          {"roots", roots},
          {"error", json_number(placement.error)},
          {"point", per_finger(Json::array({json_number(placement.point.x()), json_number(placement.point.y())}))},
          {"tangent", per_finger(json_number(placement.tangent))},
          {"residual", json_number(placement.residual)},
          {"sensitivity", sensitivity_json(placement.sensitivity)},
          {"pivot", pivot},
          {"probability", nullptr},
          {"pose", pose_json(poses)},
          {"pose_residual", pose_residual_json(poses)}};
}

Json readings_json(const LocateOutcome& outcome) {
  Json list = Json::array();
  for (std::size_t i = 0; i < outcome.readings.size(); ++i) {
    const Reading& reading = outcome.readings[i];
    Json entry = {{"length", per_finger(json_number(reading.length))}, {"turn", json_number(reading.turn)}};
    if (!outcome.instants.empty()) entry["time"] = json_number(outcome.instants[i]);
    list.push_back(entry);
  }
  return list;
}

}  // namespace

std::string name_of(Kind kind) {
  switch (kind) {
    case Kind::crossing:
      return "crossing";
    case Kind::touching:
      return "touching";
    case Kind::stretch:
      return "stretch";
    case Kind::corner:
      break;
  }
  return "corner";
}

Json part_json(const Part& part) {
  return {{"name", part.name()},
          {"perimeter", json_number(part.perimeter())},
          {"closed", part.closed()},
          {"reversed", part.reversed()},
          {"turns", part.turns()},
          {"inflections", part.inflections().size()},
          {"vertices", part.vertices().size()},
          {"corners", part.corners().size()}};
}

Json locate_json(const LocateOutcome& outcome) {
  const Search& found = outcome.found;
  Json placements = Json::array();
  for (std::size_t k = 0; k < found.placements.size(); ++k) {
    placements.push_back(
        placement_json(found.placements[k], k < outcome.poses.size() ? outcome.poses[k] : std::nullopt));
    if (outcome.weighing) add_weight(*outcome.weighing, k, placements.back());
  }
  Json unresolved = Json::array();
  for (const Interval& interval : found.unresolved) unresolved.push_back(json_interval(interval));
  Json document = {{"schema", "rollfix/locate/1"},
                   {"status", found.status == Status::complete ? "complete" : "incomplete"},
                   {"verdict", outcome.weighing ? outcome.weighing->verdict : found.verdict()},
                   {"part", part_json(outcome.part)},
                   {"fingers", 1},
                   {"readings", readings_json(outcome)},
                   {"tolerance", json_number(outcome.tolerance.value)},
                   {"placements", placements},
                   {"pose_time", outcome.times.empty() ? Json(nullptr) : json_numbers(outcome.times)},
                   {"dropped", dropped_json(outcome.dropped)},
                   {"unresolved", unresolved},
                   {"counts", {{"intervals", found.counts.intervals}, {"evaluations", found.counts.evaluations}}}};
  if (outcome.weighing) {
    document["dropped"]["improbable"] = outcome.weighing->improbable.size();
    add_weighing(*outcome.weighing, document);
  }
  if (outcome.dropped.explain) document["impossible"] = impossible_json(outcome.dropped);
  return document;
}

}  // namespace rollfix::app
