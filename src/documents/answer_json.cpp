#include <algorithm>
#include <cmath>
#include <cstddef>

#include "documents/documents.hpp"
#include "rollfix/files.hpp"
#include "rollfix/question.hpp"

namespace rollfix {
namespace {

Json intervals_json(const PerFinger<Interval>& intervals) { return json_list(intervals, json_interval); }
Json places_json(const PerFinger<double>& places) { return json_numbers(places); }

/// per_turn[finger][reading], per_length[finger][reading][which finger's length], of two per_facing[finger].
Json sensitivity_json(const Sensitivity& sensitivity, std::size_t fingers, bool facing) {
  const auto is_defined = [](double value) { return std::isfinite(value); };
  bool any = false;
  for (const auto& of_finger : sensitivity.per_turn) any |= std::any_of(of_finger.begin(), of_finger.end(), is_defined);
  for (const auto& of_finger : sensitivity.per_length) {
    for (const auto& lengths : of_finger) any |= std::any_of(lengths.begin(), lengths.end(), is_defined);
  }
  if (!any) return nullptr;
  Json json = {{"per_turn", json_list(sensitivity.per_turn, json_numbers<ShortList<double>>)},
               {"per_length", json_list(sensitivity.per_length,
                                        [](const auto& of_finger) { return json_list(of_finger, places_json); })}};
  if (fingers == 2) json["per_facing"] = facing ? json_numbers(sensitivity.per_facing) : Json(nullptr);
  return json;
}

/// [start, end] of the one finger, a list of those of two.
Json pivot_json(const std::optional<PerFinger<Pivot>>& pivots) {
  if (!pivots) return nullptr;
  const auto one = [](const Pivot& pivot) {
    return Json::array({json_interval(pivot.start), json_interval(pivot.end)});
  };
  return pivots->size() == 1 ? one((*pivots)[0]) : json_list(*pivots, one);
}

void add_weight(const Placement& placement, std::size_t fingers, Json& json) {
  json["mean"] = json_numbers(placement.mean);
  json["sd"] = json_numbers(placement.sd);
  if (fingers == 2) json["covariance"] = matrix_json(placement.covariance);
  json["interval"] = intervals_json(placement.interval);
  json["end_mean"] = json_numbers(placement.end_mean);
  json["end_sd"] = json_numbers(placement.end_sd);
  json["pose_mean"] = placement.pose_spread ? pose_json(placement.pose_spread->mean) : Json(nullptr);
  json["pose_covariance"] = placement.pose_spread ? matrix_json(placement.pose_spread->covariance) : Json(nullptr);
}

Json obstruction_json(const Obstruction& obstruction) {
  const Json point = point_json(obstruction.hit.point);
  if (obstruction.concave_corner) {
    return {{"at", json_number(obstruction.s)}, {"cause", "concave corner"}, {"point", point}};
  }
  return {{"at", json_number(obstruction.s)},
          {"cause", "hit"},
          {"hits", json_number(obstruction.hit.s)},
          {"point", point},
          {"depth", json_number(obstruction.hit.depth)}};
}

Json impossible_json(const Impossible& item) {
  const Placement& placement = item.placement;
  Json entry = {{"kind", name_of(placement.kind)},
                {"start", json_numbers(placement.start)},
                {"end", json_numbers(placement.end)},
                {"extent", intervals_json(placement.extent)}};
  if (item.reason == Impossible::Reason::reach) {
    entry["reason"] = "reach";
    entry["finger"] = item.finger;
    entry["obstruction"] = obstruction_json(item.obstruction);
  } else {
    entry["reason"] = "overlap";
    entry["instant"] = item.instant;
    entry["depth"] = json_number(item.depth);
  }
  return entry;
}

Json dropped_json(const Answer& answer) {
  Json dropped = Json::object();
  if (answer.has_reach) {
    dropped["reach"] = answer.dropped.reach;
    if (answer.finger_count() == 2) dropped["overlap"] = answer.dropped.overlap;
  }
  if (answer.weighing) dropped["improbable"] = answer.dropped.improbable;
  return dropped;
}

Json fit_json(const Fit& fit) {
  return {{"chi_square", json_number(fit.chi_square)},
          {"freedom", json_number(fit.freedom)},
          {"sigmas", json_number(fit.sigmas)},
          {"correlation", json_number(fit.correlation)},
          {"correlation_sigmas", json_number(fit.correlation_sigmas)},
          {"trend_sigmas", json_number(fit.trend_sigmas)},
          {"row_sigmas", json_number(fit.row_sigmas)},
          {"prior_sigmas", json_number(fit.prior_sigmas)},
          {"widened", json_number(fit.widened)},
          {"too_good", fit.is_too_good()},
          {"alike_over", fit.alike_over > 0 ? json_number(fit.alike_over) : Json(nullptr)},
          {"turn_gathered", json_number(fit.turn_gathered)},
          {"length_scale", json_numbers(fit.length_scale)},
          {"length_scale_sd", json_numbers(fit.length_scale_sd)},
          {"turn_scale", json_number(fit.turn_scale)},
          {"turn_scale_sd", json_number(fit.turn_scale_sd)},
          {"turn_bias", json_number(fit.turn_bias)},
          {"turn_bias_sd", json_number(fit.turn_bias_sd)}};
}

void add_weighing(const Weighing& weighing, Json& document) {
  document["noise"] = noise_json(weighing.noise);
  document["prior"] = prior_json(weighing.prior);
  document["pose_prior"] = pose_prior_json(weighing.pose);
  document["robust"] = weighing.robust;
  document["samples"] = weighing.samples;
  document["excess"] = json_number(weighing.fit.excess);
  document["rest"] = json_number(weighing.rest);
  document["fit"] = fit_json(weighing.fit);
}

Json diagnosis_json(const Diagnosis& diagnosis) {
  return {{"cause", name_of(diagnosis.cause)},
          {"what", about(diagnosis)},
          {"length_scale", json_number(diagnosis.length_scale)},
          {"length_scale_sd", json_number(diagnosis.length_scale_sd)},
          {"finger", diagnosis.finger ? Json(*diagnosis.finger) : Json(nullptr)},
          {"turn_scale", json_number(diagnosis.turn_scale)},
          {"turn_scale_sd", json_number(diagnosis.turn_scale_sd)},
          {"noise_scale", json_number(diagnosis.noise_scale)},
          {"excess", json_number(diagnosis.excess)},
          {"log_odds", json_number(diagnosis.log_odds)}};
}

}  // namespace

Json readings_json(const Answer& answer) {
  Json list = Json::array();
  for (std::size_t i = 0; i < answer.readings.size(); ++i) {
    const Reading& reading = answer.readings[i];
    Json entry = {{"length", json_numbers(reading.length)}, {"turn", json_number(reading.turn)}};
    if (!reading.is_exact()) {
      entry["pivot"] = {json_number(reading.turn - reading.pivot), json_number(reading.turn + reading.pivot)};
    }
    if (!answer.times.empty()) entry["time"] = json_number(answer.times[i]);
    list.push_back(entry);
  }
  return list;
}

Json placement_json(const Placement& placement, const Answer& answer) {
  const std::size_t fingers = answer.finger_count();
  const bool is_stretch = placement.kind == Kind::stretch;
  Json json = {{"kind", name_of(placement.kind)},
               {"start", json_numbers(placement.start)},
               {"end", json_numbers(placement.end)},
               {"extent", intervals_json(placement.extent)},
               {"whole_loop", placement.whole_loop[0]},
               {"roots", json_list(placement.roots, places_json)},
               {"error", json_number(placement.error)},
               {"point", json_list(placement.point, point_json)},
               {"tangent", json_numbers(placement.tangent)},
               {"residual", json_number(placement.residual)},
               {"sensitivity", sensitivity_json(placement.sensitivity, fingers, answer.facing.has_value())}};
  if (fingers == 2) {
    json["whole_loop"] = Json::array({placement.whole_loop[0], placement.whole_loop[1]});
    json["family"] = is_stretch ? json_list(placement.family, places_json) : Json(nullptr);
    json["family_error"] = is_stretch ? json_number(placement.family_error) : Json(nullptr);
  }
  if (answer.either_way) json["direction"] = placement.clockwise ? "cw" : "ccw";
  json["pivot"] = pivot_json(placement.pivot);
  json["probability"] = json_number(placement.probability);
  const std::optional<PoseResidual>& off = placement.pose_residual;
  json["pose"] = off ? json_list(placement.pose, pose_json) : Json(nullptr);
  json["pose_residual"] =
      off ? Json{{"length", json_number(off->length)}, {"turn", json_number(off->turn)}} : Json(nullptr);
  if (!answer.weighing) json["contradicted"] = placement.is_contradicted;
  if (answer.weighing) add_weight(placement, fingers, json);
  return json;
}

Json point_json(const Vec2& point) { return Json::array({json_number(point.x()), json_number(point.y())}); }

Json pose_json(const Pose& pose) {
  return Json::array({json_number(pose.x), json_number(pose.y), json_number(pose.heading)});
}

Json diagnoses_json(const std::vector<Diagnosis>& diagnoses, const std::vector<Finger>& fingers, const Noise& noise) {
  if (diagnoses.empty()) return nullptr;
  const auto one = [&](const Diagnosis& diagnosis) {
    Json json = diagnosis_json(diagnosis);
    json["cure"] = cure_of(diagnosis, fingers, noise);
    json["verdict"] = diagnosis.modes.empty() ? Json(nullptr) : Json(diagnosis.verdict.text());
    json["placements"] = json_list(diagnosis.modes, [](const Mode& mode) {
      return Json{{"start", json_numbers(mode.start)},
                  {"sd", json_numbers(mode.sd)},
                  {"interval", intervals_json(mode.interval)},
                  {"probability", json_number(mode.probability)}};
    });
    return json;
  };
  Json document = one(diagnoses.front());
  document["others"] = Json::array();
  for (std::size_t k = 1; k < diagnoses.size(); ++k) document["others"].push_back(one(diagnoses[k]));
  return document;
}

Json noise_json(const Noise& noise) {
  Json json = Json::object();
  for (const NoiseKind& kind : kNoiseKinds) json[kind.name] = json_number(noise.*kind.sd);
  return json;
}

Json prior_json(const std::optional<Prior>& prior) {
  return prior ? Json::array({json_number(prior->s), json_number(prior->sd)}) : Json(nullptr);
}

Json pose_prior_json(const std::optional<PosePrior>& prior) {
  if (!prior) return nullptr;
  const bool has_place = std::isfinite(prior->place_sd);
  return {{"x", has_place ? json_number(prior->mean.x) : Json(nullptr)},
          {"y", has_place ? json_number(prior->mean.y) : Json(nullptr)},
          {"heading", json_number(prior->mean.heading)},
          {"place_sd", has_place ? json_number(prior->place_sd) : Json(nullptr)},
          {"heading_sd", json_number(prior->heading_sd)}};
}

Json accuracy_json(const Accuracy& accuracy) {
  if (accuracy.is_exact()) return nullptr;
  return {{"length", json_number(accuracy.length)},
          {"turn", json_number(accuracy.turn)},
          {"alike", json_number(accuracy.alike)},
          {"walk", json_number(accuracy.walk)}};
}

Json part_json(const Part& part) {
  return {{"name", part.name()},
          {"perimeter", json_number(part.perimeter())},
          {"closed", part.closed()},
          {"reversed", part.reversed()},
          {"turns", part.turns()},
          {"inflections", part.inflections().size()},
          {"vertices", part.vertices().size()},
          {"corners", part.corners().size()},
          {"unit", part.unit().empty() ? Json(nullptr) : Json(part.unit())}};
}

Json answer_document(const Answer& answer, bool explain) {
  const std::size_t fingers = answer.finger_count();
  // One finger's open intervals are listed as such, two fingers' as boxes.
  const auto open = [&](const PerFinger<Interval>& box) {
    return fingers == 1 ? json_interval(box[0]) : intervals_json(box);
  };
  Json document = {{"schema", "rollfix/locate/1"},
                   {"status", name_of(answer.status)},
                   {"verdict", answer.verdict.text()},
                   {"part", part_json(answer.part)},
                   {"fingers", fingers},
                   {"readings", readings_json(answer)},
                   {"mirrored", answer.mirrored}};
  if (answer.corner_rows.count > 0) {
    document["corner_rows"] = {
        {"count", answer.corner_rows.count}, {"first", answer.corner_rows.first}, {"last", answer.corner_rows.last}};
  }
  if (fingers == 2) document["facing"] = answer.facing ? json_number(*answer.facing) : Json(nullptr);
  document["tolerance"] = json_number(answer.tolerance.value);
  document["placements"] =
      json_list(answer.placements, [&](const Placement& placement) { return placement_json(placement, answer); });
  document["pose_time"] = answer.pose_time.empty() ? Json(nullptr) : json_numbers(answer.pose_time);
  document["dropped"] = dropped_json(answer);
  if (answer.weighing) document["stray_lines"] = answer.strays;
  document["unresolved"] = json_list(answer.unresolved, open);
  document["counts"] = {{fingers == 1 ? "intervals" : "boxes", answer.counts.intervals},
                        {"evaluations", answer.counts.evaluations}};
  if (answer.weighing) add_weighing(*answer.weighing, document);
  document["diagnosis"] =
      diagnoses_json(answer.diagnoses, answer.fingers, answer.weighing ? answer.weighing->noise : Noise{});
  if (explain) document["impossible"] = json_list(answer.impossible, impossible_json);
  return document;
}

Json solution_document(const Solution& solution, bool explain) {
  if (solution.at_rest() != nullptr) return touches_document(*solution.at_rest());
  if (solution.moving() != nullptr) return hold_document(*solution.moving());
  return answer_document(*solution.roll(), explain);
}

std::string format_answer(const Answer& answer, Layout layout, bool explain) {
  return formatted(answer_document(answer, explain), layout);
}

std::string format_solution(const Solution& solution, Layout layout, bool explain) {
  return formatted(solution_document(solution, explain), layout);
}

}  // namespace rollfix
