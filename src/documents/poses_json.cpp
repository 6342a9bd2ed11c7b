#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "documents/documents.hpp"
#include "outline/turn.hpp"
#include "rollfix/files.hpp"
#include "rollfix/touch.hpp"

namespace rollfix {
namespace {

const char* name_of(PlaceKnown place) {
  constexpr std::array<const char*, 3> kNames = {"measured", "reference", "unknown"};
  return kNames[static_cast<std::size_t>(place)];
}

/// x and y are null where nothing tells them.
Json held_pose(const Pose& pose, PlaceKnown place) {
  if (place == PlaceKnown::unknown) return Json::array({nullptr, nullptr, json_number(pose.heading)});
  return pose_json(pose);
}

/// Null but for the heading's variance, unless the place was measured.
Json covariance_json(const Eigen::Matrix3d& covariance, PlaceKnown place) {
  if (place == PlaceKnown::measured) return matrix_json(covariance);
  Eigen::Matrix3d known = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  known(2, 2) = covariance(2, 2);
  return matrix_json(known);
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

Json hold_document(const HoldAnswer& answer) {
  Json document = {{"schema", "rollfix/locate/1"},
                   {"status", name_of(answer.status)},
                   {"verdict", answer.verdict_text()},
                   {"part", part_json(answer.part)},
                   {"fingers", answer.rolls.size()},
                   {"mirrored", answer.mirrored},
                   {"rolls", json_list(answer.rolls, held_roll_json)},
                   {"rows", answer.rows},
                   {"instants", json_numbers(answer.instants)},
                   {"place", name_of(answer.place)}};
  document["placements"] =
      json_list(answer.placements, [&](const HoldPlacement& one) { return held_json(one, answer); });
  document["dropped"] = {{"overlap", answer.overlap}};
  if (answer.noise) document["dropped"]["improbable"] = answer.improbable;
  document["robust"] = answer.robust;
  document["stray"] = answer.strays;
  document["left_out"] = answer.jumps;
  document["prior"] = prior_json(answer.prior);
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
  return document;
}

std::string format_hold(const HoldAnswer& answer, Layout layout) { return formatted(hold_document(answer), layout); }

// ---- touches and rolls of a part at rest

namespace {

Json number_or_null(const std::optional<double>& value) { return value ? json_number(*value) : Json(nullptr); }

Json measured_json(const MeasuredTouch& touch, const TouchTolerance& tolerance) {
  return {{"at", touch.has_place() ? point_json(touch.at) : Json(nullptr)},
          {"normal", number_or_null(touch.normal)},
          {"position_sd", number_or_null(touch.position_sd)},
          {"normal_sd", number_or_null(touch.normal_sd)},
          {"tolerance", Json::array({touch.has_place() ? json_number(tolerance.length) : Json(nullptr),
                                     touch.normal ? json_number(tolerance.angle) : Json(nullptr)})}};
}

Json slide_json(const std::optional<Slide>& slide) {
  if (!slide) return nullptr;
  return {{"direction", json_number(slide->direction)}, {"length", json_number(slide->length)}};
}

Json pose_set_json(const TouchAnswer& answer, const TouchPose& set) {
  const auto numbers = [&](auto value) { return json_list(set.contacts, value); };
  Json json = {
      {"kind", set.continuum ? "continuum" : "place"},
      {"pose", Json::array({pose_json(set.pose)})},
      {"any_heading", set.any_heading},
      {"slide", slide_json(slide_of(answer, set))},
      {"pose_extent", json_list(set.extent, json_interval)},
      {"start", numbers([](const TouchContact& contact) { return json_number(contact.s); })},
      {"point", numbers([](const TouchContact& contact) { return point_json(contact.point); })},
      {"tangent", numbers([](const TouchContact& contact) { return json_number(contact.tangent); })},
      {"distance", numbers([](const TouchContact& contact) { return json_number(contact.distance); })},
      {"turn", numbers([](const TouchContact& contact) { return number_or_null(contact.turn); })},
      {"pose_residual", {{"length", json_number(set.residual.length)}, {"turn", json_number(set.residual.turn)}}},
      {"worst", json_number(set.worst)},
      {"probability", json_number(set.probability)}};
  if (std::any_of(set.contacts.begin(), set.contacts.end(), [](const auto& contact) { return contact.end; })) {
    json["end"] = numbers([](const TouchContact& contact) { return number_or_null(contact.end); });
    json["extent"] = numbers(
        [](const TouchContact& contact) { return contact.extent ? json_interval(*contact.extent) : Json(nullptr); });
  }
  if (answer.robust && !answer.touches.empty()) json["outliers"] = set.outliers;
  if (!answer.noise) return json;
  json["chi_square"] = json_number(set.chi_square);
  json["pose_mean"] = pose_json(set.spread.mean);
  json["pose_covariance"] = matrix_json(set.spread.covariance);
  json["pose_interval"] = json_list(set.interval, json_interval);
  return json;
}

Json mistake_json(const TouchDiagnosis& diagnosis, const TouchAnswer& answer) {
  Json json = {{"cause", name_of(diagnosis.cause)},
               {"what", words_of(diagnosis, answer)},
               {"places", diagnosis.poses},
               {"pose", pose_json(diagnosis.pose)},
               {"fit", fit_json(diagnosis.fit)}};
  if (diagnosis.cause == TouchCause::unit || diagnosis.cause == TouchCause::noise) json["factor"] = diagnosis.factor;
  if (diagnosis.cause == TouchCause::unit) json["unit"] = diagnosis.unit;
  if (diagnosis.cause == TouchCause::outlier) json["touch"] = diagnosis.touch;
  if (diagnosis.cause == TouchCause::radius) json["radius"] = diagnosis.radius;
  if (diagnosis.cause == TouchCause::moved) json["after_roll"] = diagnosis.roll + 1;
  return json;
}

Json roll_json(const RollFacts& roll, const TouchTolerance& tolerance, bool place_counts) {
  return {{"name", roll.name},
          {"rows", roll.rows},
          {"length", json_number(roll.reading.length[0])},
          {"turn", json_number(roll.reading.turn)},
          {"centres", roll.has_centre},
          {"verdict", roll.alone.text()},
          {"placements", roll.placements},
          {"tolerance",
           Json::array({place_counts ? json_number(tolerance.length) : Json(nullptr), json_number(tolerance.angle)})}};
}

void add_rolls(const TouchAnswer& answer, Json& document) {
  if (answer.rolls.empty()) return;
  document["place"] = name_of(answer.place);
  document["rolls"] = Json::array();
  for (std::size_t k = 0; k < answer.rolls.size(); ++k) {
    const RollFacts& roll = answer.rolls[k];
    const bool place_counts = roll.has_centre && answer.place == PlaceKnown::measured;
    document["rolls"].push_back(roll_json(roll, answer.tolerance[k], place_counts));
    document["contacts"].push_back(
        Json{{"finger", 0}, {"roll", k + 1}, {"lines", roll.lines.empty() ? Json(nullptr) : Json(roll.lines)}});
  }
}

}  // namespace

Json pose_sets_json(const TouchAnswer& answer) {
  return json_list(answer.poses, [&](const TouchPose& set) { return pose_set_json(answer, set); });
}

Json touches_json(const std::vector<MeasuredTouch>& touches, const std::vector<TouchTolerance>& tolerance) {
  Json list = Json::array();
  for (std::size_t k = 0; k < touches.size(); ++k) list.push_back(measured_json(touches[k], tolerance[k]));
  return list;
}

Json clear_json(const std::vector<Clear>& paths) {
  return json_list(paths, [](const Clear& path) {
    return Json{path.from.x(), path.from.y(), path.to.x(), path.to.y()};
  });
}

Json touches_document(const TouchAnswer& answer) {
  Json document = {{"schema", "rollfix/locate/1"},
                   {"status", name_of(answer.status)},
                   {"verdict", answer.verdict_text()},
                   {"part", part_json(answer.part)},
                   {"fingers", 1},
                   {"radius", json_number(answer.radius)},
                   {"mirrored", answer.mirrored}};
  const auto rolls = static_cast<std::ptrdiff_t>(answer.rolls.size());
  document["touches"] = touches_json(answer.touches, {answer.tolerance.begin() + rolls, answer.tolerance.end()});
  document["contacts"] = Json::array();
  add_rolls(answer, document);
  for (std::size_t k = 0; k < answer.touches.size(); ++k) {
    document["contacts"].push_back(Json{{"finger", 0}, {"touch", k}});
  }
  document["clear"] = clear_json(answer.clear);
  document["placements"] = pose_sets_json(answer);
  document["dropped"] = answer.noise ? Json{{"improbable", answer.improbable}} : Json::object();
  document["unresolved"] = json_list(answer.unresolved, json_interval);
  document["unresolved_touch"] = answer.unresolved.empty() ? Json(nullptr) : Json(answer.unresolved_touch);
  document["counts"] = {{"comparisons", answer.comparisons}};
  document["noise"] = answer.noise ? noise_json(*answer.noise) : Json(nullptr);
  if (answer.noise) document["rest"] = json_number(answer.rest);
  if (!answer.outlier.empty()) {
    document["outlier"] = json_numbers(answer.outlier);
    document["anywhere"] = json_number(answer.anywhere);
  }
  document["fit"] = answer.fit ? fit_json(*answer.fit) : Json(nullptr);
  document["diagnosis"] =
      answer.diagnoses.empty()
          ? Json(nullptr)
          : json_list(answer.diagnoses, [&](const TouchDiagnosis& one) { return mistake_json(one, answer); });
  return document;
}

std::string format_touches(const TouchAnswer& answer, Layout layout) {
  return formatted(touches_document(answer), layout);
}

Json next_touch_document(const TouchAnswer& answer, const NextTouch& next) {
  Json document = {{"schema", "rollfix/advise/1"},
                   {"verdict", answer.verdict_text()},
                   {"part", part_json(answer.part)},
                   {"helps", next.helps},
                   {"why", next.why.empty() ? Json(nullptr) : Json(next.why)},
                   {"approach", nullptr},
                   {"expected_poses", nullptr},
                   {"bits", nullptr},
                   {"roll", nullptr},
                   {"bits_wanted", json_number(next.bits_wanted)}};
  if (!next.gains.empty()) {
    const TouchGain& advised = next.advised();
    if (next.helps) {
      document["approach"] = {{"from", {advised.approach.from.x(), advised.approach.from.y()}},
                              {"direction", json_number(nearest_angle(advised.approach.direction))}};
    }
    document["expected_poses"] = json_number(advised.poses);
    document["bits"] = json_number(advised.bits);
  }
  if (next.roll) {
    document["roll"] = {{"length", json_number(next.roll->length)}, {"bits", json_number(next.roll->bits)}};
  }
  document["contenders"] = json_list(next.expected, [](const ExpectedTouch& one) {
    return Json{{"placement", one.placement},
                {"probability", json_number(one.probability)},
                {"pose", pose_json(one.pose)},
                {"at", one.hits ? Json{one.at.x(), one.at.y()} : Json(nullptr)},
                {"normal", one.hits ? json_number(one.normal) : Json(nullptr)},
                {"travel", one.hits ? json_number(one.travel) : Json(nullptr)}};
  });
  document["prospects"] = json_list(next.gains, [](const TouchGain& one) {
    return Json{one.approach.from.x(), one.approach.from.y(), one.approach.direction, json_number(one.poses),
                json_number(one.bits)};
  });
  return document;
}

std::string format_next_touch(const TouchAnswer& answer, const NextTouch& next, Layout layout) {
  return formatted(next_touch_document(answer, next), layout);
}

}  // namespace rollfix
