#include <algorithm>
#include <array>

#include "documents/documents.hpp"
#include "outline/turn.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/touch.hpp"

namespace rollfix {
namespace {

template <class Entries, class ToJson>
Json each_of(const Entries& entries, const ToJson& to_json) {
  Json list = Json::array();
  for (const auto& entry : entries) list.push_back(to_json(entry));
  return list;
}

Json number_or_null(const std::optional<double>& value) { return value ? json_number(*value) : Json(nullptr); }

Json triple(const Pose& pose) { return json_numbers(std::array<double, 3>{pose.x, pose.y, pose.heading}); }

Json measured_json(const MeasuredTouch& touch, const TouchTolerance& tolerance) {
  return {{"at", touch.has_place() ? point_json(touch.at) : Json(nullptr)},
          {"normal", number_or_null(touch.normal)},
          {"position_sd", number_or_null(touch.position_sd)},
          {"normal_sd", number_or_null(touch.normal_sd)},
          {"tolerance", Json::array({touch.has_place() ? json_number(tolerance.length) : Json(nullptr),
                                     touch.normal ? json_number(tolerance.angle) : Json(nullptr)})}};
}

Json fit_of_touches(const TouchFit& fit) {
  return {{"chi_square", json_number(fit.chi_square)}, {"freedom", fit.freedom}, {"p", json_number(fit.p)}};
}

Json slide_json(const std::optional<Slide>& slide) {
  if (!slide) return nullptr;
  return {{"direction", json_number(slide->direction)}, {"length", json_number(slide->length)}};
}

Json pose_set_json(const TouchAnswer& answer, const TouchPose& set) {
  const auto numbers = [&](auto value) { return each_of(set.contacts, value); };
  Json json = {
      {"kind", set.continuum ? "continuum" : "place"},
      {"pose", Json::array({triple(set.pose)})},
      {"any_heading", set.any_heading},
      {"slide", slide_json(slide_of(answer, set))},
      {"pose_extent", each_of(set.extent, json_interval)},
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
  json["pose_mean"] = triple(set.spread.mean);
  json["pose_covariance"] = Json::array();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d row = set.spread.covariance.row(i).transpose();
    json["pose_covariance"].push_back(json_numbers(std::array<double, 3>{row(0), row(1), row(2)}));
  }
  json["pose_interval"] = each_of(set.interval, json_interval);
  return json;
}

Json mistake_json(const TouchDiagnosis& diagnosis) {
  Json json = {{"cause", name_of(diagnosis.cause)},
               {"places", diagnosis.poses},
               {"pose", triple(diagnosis.pose)},
               {"fit", fit_of_touches(diagnosis.fit)}};
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

const char* name_of(PlaceKnown place) {
  constexpr std::array<const char*, 3> kNames = {"measured", "reference", "unknown"};
  return kNames[static_cast<std::size_t>(place)];
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
  return each_of(answer.poses, [&](const TouchPose& set) { return pose_set_json(answer, set); });
}

Json touches_json(const std::vector<MeasuredTouch>& touches, const std::vector<TouchTolerance>& tolerance) {
  Json list = Json::array();
  for (std::size_t k = 0; k < touches.size(); ++k) list.push_back(measured_json(touches[k], tolerance[k]));
  return list;
}

Json clear_json(const std::vector<Clear>& paths) {
  return each_of(paths, [](const Clear& path) { return Json{path.from.x(), path.from.y(), path.to.x(), path.to.y()}; });
}

std::string format_touches(const TouchAnswer& answer, Layout layout) {
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
  document["unresolved"] = each_of(answer.unresolved, json_interval);
  document["unresolved_touch"] = answer.unresolved.empty() ? Json(nullptr) : Json(answer.unresolved_touch);
  document["counts"] = {{"comparisons", answer.comparisons}};
  document["noise"] = answer.noise ? noise_json(*answer.noise) : Json(nullptr);
  if (answer.noise) document["rest"] = json_number(answer.rest);
  if (!answer.outlier.empty()) {
    document["outlier"] = json_numbers(answer.outlier);
    document["anywhere"] = json_number(answer.anywhere);
  }
  document["fit"] = answer.fit ? fit_of_touches(*answer.fit) : Json(nullptr);
  document["diagnosis"] = answer.diagnoses.empty() ? Json(nullptr) : each_of(answer.diagnoses, mistake_json);
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

std::string format_next_touch(const TouchAnswer& answer, const NextTouch& next, Layout layout) {
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
  document["contenders"] = each_of(next.expected, [](const ExpectedTouch& one) {
    return Json{{"placement", one.placement},
                {"probability", json_number(one.probability)},
                {"pose", triple(one.pose)},
                {"at", one.hits ? Json{one.at.x(), one.at.y()} : Json(nullptr)},
                {"normal", one.hits ? json_number(one.normal) : Json(nullptr)},
                {"travel", one.hits ? json_number(one.travel) : Json(nullptr)}};
  });
  document["prospects"] = each_of(next.gains, [](const TouchGain& one) {
    return Json{one.approach.from.x(), one.approach.from.y(), one.approach.direction, json_number(one.poses),
                json_number(one.bits)};
  });
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

}  // namespace rollfix
