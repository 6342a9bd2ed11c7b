#include <cmath>

#include "rollfix/locate_outcome.hpp"
#include "rollfix/pair_outcome.hpp"
#include "rollfix/pose_json.hpp"

namespace rollfix::app {
namespace {

Json points_json(const std::vector<PairPoint>& points) {
  Json list = Json::array();
  for (const PairPoint& point : points) list.push_back(json_numbers(point));
  return list;
}

Json box_json(const PairBox& box) { return Json::array({json_interval(box[0]), json_interval(box[1])}); }

/// per_turn[finger][reading], per_length[finger][reading][which finger's length], per_facing[finger].
Json sensitivity_json(const PairSensitivity& sensitivity, bool facing) {
  if (sensitivity.per_turn[0].empty()) return nullptr;
  Json per_turn = Json::array();
  Json per_length = Json::array();
  for (const std::size_t finger : {0U, 1U}) {
    per_turn.push_back(json_numbers(sensitivity.per_turn[finger]));
    Json of_finger = Json::array();
    for (const std::array<double, 2>& lengths : sensitivity.per_length[finger])
      of_finger.push_back(json_numbers(lengths));
    per_length.push_back(of_finger);
  }
  return {{"per_turn", per_turn},
          {"per_length", per_length},
          {"per_facing", facing ? json_numbers(sensitivity.per_facing) : Json(nullptr)}};
}

Json pivot_json(const std::optional<std::array<Pivot, 2>>& pivot) {
  if (!pivot) return nullptr;
  Json list = Json::array();
  for (const Pivot& finger : *pivot) {
    list.push_back(Json::array({json_interval(finger.start), json_interval(finger.end)}));
  }
  return list;
}

Json placement_json(const PairPlacement& placement, const std::optional<Poses>& poses, bool facing) {
  Json points = Json::array();
  for (const Vec2& point : placement.point) {
    points.push_back(Json::array({json_number(point.x()), json_number(point.y())}));
  }
  const bool is_stretch = placement.kind == Kind::stretch;
  return {{"kind", name_of(placement.kind)},
          {"start", json_numbers(placement.start)},
          {"end", json_numbers(placement.end)},
          {"extent", box_json(placement.extent)},
          {"whole_loop", Json::array({placement.whole_loop[0], placement.whole_loop[1]})},
          {"roots", points_json(placement.roots)},
          {"error", json_number(placement.error)},
          {"point", points},
          {"tangent", json_numbers(placement.tangent)},
          {"residual", json_number(placement.residual)},
          {"sensitivity", sensitivity_json(placement.sensitivity, facing)},
          {"family", is_stretch ? points_json(placement.family) : Json(nullptr)},
          {"family_error", is_stretch ? json_number(placement.family_error) : Json(nullptr)},
          {"pivot", pivot_json(placement.pivot)},
          {"probability", nullptr},
          {"pose", pose_json(poses)},
          {"pose_residual", pose_residual_json(poses)}};
}

Json readings_json(const PairOutcome& outcome) {
  Json list = Json::array();
  for (std::size_t i = 0; i < outcome.readings.size(); ++i) {
    const PairReading& reading = outcome.readings[i];
    Json entry = {{"length", Json::array({json_number(reading.length_a), json_number(reading.length_b)})},
                  {"turn", json_number(reading.turn)}};
    if (!outcome.instants.empty()) entry["time"] = json_number(outcome.instants[i]);
    list.push_back(entry);
  }
  return list;
}

}  // namespace

Json pair_json(const PairOutcome& outcome) {
  const PairSearch& found = outcome.found;
  Json placements = Json::array();
  for (std::size_t k = 0; k < found.placements.size(); ++k) {
    placements.push_back(placement_json(found.placements[k], outcome.poses[k], outcome.facing.has_value()));
    if (outcome.weighing) add_weight(*outcome.weighing, k, placements.back());
  }
  Json unresolved = Json::array();
  for (const PairBox& box : found.unresolved) unresolved.push_back(box_json(box));
  Json document = {{"schema", "rollfix/locate/1"},
                   {"status", found.status == Status::complete ? "complete" : "incomplete"},
                   {"verdict", outcome.weighing ? outcome.weighing->common.verdict : found.verdict()},
                   {"part", part_json(outcome.part)},
                   {"fingers", 2},
                   {"readings", readings_json(outcome)},
                   {"facing", outcome.facing ? json_number(*outcome.facing) : Json(nullptr)},
                   {"tolerance", json_number(outcome.tolerance.value)},
                   {"placements", placements},
                   {"pose_time", outcome.times.empty() ? Json(nullptr) : json_numbers(outcome.times)},
                   {"dropped", dropped_json(outcome.dropped)},
                   {"unresolved", unresolved},
                   {"counts", {{"boxes", found.counts.intervals}, {"evaluations", found.counts.evaluations}}}};
  if (outcome.weighing) add_weighing(*outcome.weighing, document);
  if (outcome.dropped.explain) document["impossible"] = impossible_json(outcome.dropped);
  return document;
}

}  // namespace rollfix::app
