#include <array>
#include <cmath>

#include "documents/documents.hpp"
#include "rollfix/documents.hpp"

namespace rollfix {
namespace {

/// x and y are null where nothing tells them.
Json held_pose(const Pose& pose, PlaceKnown place) {
  if (place == PlaceKnown::unknown) return Json::array({nullptr, nullptr, json_number(pose.heading)});
  return json_numbers(std::array<double, 3>{pose.x, pose.y, pose.heading});
}

Json covariance_json(const Eigen::Matrix3d& covariance, PlaceKnown place) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) {
    Json row = Json::array();
    for (int j = 0; j < 3; ++j) {
      const bool is_known = place == PlaceKnown::measured || (i == 2 && j == 2);
      row.push_back(is_known ? json_number(covariance(i, j)) : Json(nullptr));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json held_json(const HoldPlacement& one, const HoldAnswer& answer) {
  const auto each = [&](const auto& value) { return json_list(one.contacts, value); };
  Json json = {
      {"kind", one.continuum ? "continuum" : "place"},
      {"start", each([](const HoldContact& contact) { return json_number(contact.start); })},
      {"end", each([](const HoldContact& contact) { return json_number(contact.end); })},
      {"extent", each([](const HoldContact& contact) { return json_interval(contact.extent); })},
      {"point", each([](const HoldContact& contact) { return point_json(contact.point); })},
      {"tangent", each([](const HoldContact& contact) { return json_number(contact.tangent); })},
      {"pose", Json::array({held_pose(one.first, answer.place), held_pose(one.last, answer.place)})},
      {"distance", each([](const HoldContact& contact) { return json_number(contact.distance); })},
      {"turn", each([](const HoldContact& contact) { return json_number(contact.turn); })},
      {"pose_residual", {{"length", json_number(one.residual.length)}, {"turn", json_number(one.residual.turn)}}},
      {"worst", answer.noise ? Json(nullptr) : json_number(one.worst)},
      {"probability", json_number(one.probability)}};
  if (!answer.noise) return json;
  json["chi_square"] = json_number(one.chi_square);
  json["mean"] = each([](const HoldContact& contact) { return json_number(contact.mean); });
  json["sd"] = each([](const HoldContact& contact) { return json_number(contact.sd); });
  json["interval"] = each([](const HoldContact& contact) { return json_interval(contact.interval); });
  json["end_mean"] = each([](const HoldContact& contact) { return json_number(contact.end_mean); });
  json["length_scale"] = each([](const HoldContact& contact) { return json_number(contact.length_scale); });
  json["length_scale_sd"] = each([](const HoldContact& contact) { return json_number(contact.length_scale_sd); });
  json["end_sd"] = each([](const HoldContact& contact) { return json_number(contact.end_sd); });
  json["pose_mean"] = held_pose(one.first_spread.mean, answer.place);
  json["pose_covariance"] = covariance_json(one.first_spread.covariance, answer.place);
  json["end_pose_mean"] = held_pose(one.last_spread.mean, answer.place);
  json["end_pose_covariance"] = covariance_json(one.last_spread.covariance, answer.place);
  return json;
}

Json fit_json(const TouchFit& fit) {
  return {{"chi_square", json_number(fit.chi_square)}, {"freedom", fit.freedom}, {"p", json_number(fit.p)}};
}

/// What would be the answer without a mistake is said in short.
Json held_diagnosis_json(const HoldDiagnosis& one, const HoldAnswer& answer) {
  Json json = {{"cause", name_of(one.cause)},
               {"what", words_of(one, answer)},
               {"cure", cure_of(one, answer)},
               {"finger", one.finger ? Json(*one.finger) : Json(nullptr)},
               {"log_odds", json_number(one.log_odds)},
               {"fit", fit_json(one.fit)},
               {"verdict", one.verdict.text()},
               {"placements", json_list(one.placements, [](const HoldPlacement& placement) {
                  return Json{
                      {"start", json_list(placement.contacts,
                                          [](const HoldContact& contact) { return json_number(contact.start); })},
                      {"probability", json_number(placement.probability)}};
                })}};
  if (one.cause == HoldCause::radius || one.cause == HoldCause::unit || one.cause == HoldCause::noise) {
    json["factor"] = json_number(one.factor);
  }
  if (one.cause == HoldCause::radius) json["factor_sd"] = json_number(one.factor_sd);
  if (one.cause == HoldCause::fingers_swapped) json["other"] = *one.other;
  if (one.cause == HoldCause::late) json["rows"] = one.rows;
  if (one.cause == HoldCause::stray) json["stray"] = one.strays;
  if (one.cause == HoldCause::noise || one.cause == HoldCause::slip) json["noise"] = noise_json(one.noise);
  return json;
}

Json held_roll_json(const HoldRoll& roll) {
  return {{"name", roll.name},
          {"lines", roll.lines.empty() ? Json(nullptr) : Json(roll.lines)},
          {"length", roll.is_wheel ? Json(nullptr) : json_number(roll.length)},
          {"centres", roll.has_centre},
          {"wheel", roll.is_wheel},
          {"encoder", roll.has_encoder}};
}

}  // namespace

std::string format_hold(const HoldAnswer& answer, Layout layout) {
  const char* const place = answer.place == PlaceKnown::measured    ? "measured"
                            : answer.place == PlaceKnown::reference ? "reference"
                                                                    : "unknown";
  Json document = {{"schema", "rollfix/locate/1"},
                   {"status", name_of(answer.status)},
                   {"verdict", answer.verdict_text()},
                   {"part", part_json(answer.part)},
                   {"fingers", answer.rolls.size()},
                   {"mirrored", answer.mirrored},
                   {"rolls", json_list(answer.rolls, held_roll_json)},
                   {"rows", answer.rows},
                   {"instants", json_numbers(answer.instants)},
                   {"place", place}};
  document["placements"] =
      json_list(answer.placements, [&](const HoldPlacement& one) { return held_json(one, answer); });
  document["dropped"] = {{"overlap", answer.overlap}};
  if (answer.noise) document["dropped"]["improbable"] = answer.improbable;
  document["robust"] = answer.robust;
  document["stray"] = answer.strays;
  document["left_out"] = answer.jumps;
  document["prior"] =
      answer.prior ? json_numbers(std::array<double, 2>{answer.prior->s, answer.prior->sd}) : Json(nullptr);
  document["pose_prior"] =
      answer.pose
          ? json_numbers(std::array<double, 5>{answer.pose->mean.x, answer.pose->mean.y, answer.pose->mean.heading,
                                               answer.pose->place_sd, answer.pose->heading_sd})
          : Json(nullptr);
  document["prior_p"] = answer.prior || answer.pose ? json_number(answer.prior_p) : Json(nullptr);
  document["diagnosis"] =
      answer.was_diagnosed
          ? json_list(answer.diagnoses, [&](const HoldDiagnosis& one) { return held_diagnosis_json(one, answer); })
          : Json(nullptr);
  document["unresolved"] =
      json_list(answer.unresolved, [](const auto& arcs) { return json_list(arcs, json_interval); });
  document["counts"] = {{"comparisons", answer.comparisons}};
  document["noise"] = answer.noise ? noise_json(*answer.noise) : Json(nullptr);
  if (answer.noise) document["rest"] = json_number(answer.rest);
  if (!answer.noise) {
    document["tolerance"] =
        Json::array({answer.place == PlaceKnown::measured ? json_number(answer.tolerance.length) : Json(nullptr),
                     json_number(answer.tolerance.angle)});
  }
  document["squeezed"] = answer.squeezed ? json_number(*answer.squeezed) : Json(nullptr);
  document["fit"] = answer.fit ? fit_json(*answer.fit) : Json(nullptr);
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

}  // namespace rollfix
