#include <array>

#include "documents/documents.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/files.hpp"

namespace rollfix {
namespace {

Json place_json(const CurvePlace& place) { return Json::array({place.curve, json_number(place.u)}); }

Json curves_json(const std::vector<CurveRecord>& curves) {
  Json list = Json::array();
  for (const CurveRecord& curve : curves) {
    list.push_back({{"kind", curve.kind}, {"numbers", json_numbers(curve.numbers)}});
  }
  return list;
}

/// An open outline's last row ends the last cell.
Json rows_json(const Certificate& certificate) {
  Json list = Json::array();
  for (const CertificateRow& row : certificate.rows) {
    Json ends = Json::array();
    for (const CurvePlace& end : row.end) ends.push_back(place_json(end));
    list.push_back({{"start", place_json(row.start)}, {"end", ends}, {"off", json_numbers(row.off)}});
    if (!certificate.closed && list.size() == certificate.rows.size()) continue;
    list.back()["then"] = name_of(row.then);
    if (certificate.readings.size() > 1 && !row.by.empty()) list.back()["by"] = row.by;
  }
  return list;
}

/// At a corner the finger pivots, which leaves the tangent open.
Json placements_json(const Certificate& certificate) {
  Json list = Json::array();
  for (const CertifiedPlacement& one : certificate.placements) {
    const Placement& placement = one.placement;
    list.push_back({{"kind", name_of(placement.kind)},
                    {"start", json_number(placement.start[0])},
                    {"end", json_number(placement.end[0])},
                    {"at", place_json(one.at)},
                    {"point", point_json(placement.point[0])}});
    if (placement.kind != Kind::corner) list.back()["tangent"] = json_number(placement.tangent[0]);
  }
  return list;
}

Json pair_row_json(const PairRow& row) {
  return {{"start", Json::array({place_json(row.start[0]), place_json(row.start[1])})}, {"off", json_numbers(row.off)}};
}

Json pairs_json(const PairCertificate& certificate) {
  Json list = Json::array();
  for (const CertifiedPair& one : certificate.placements) {
    const Placement& placement = one.placement;
    const auto of_both = [](const auto& json_of) { return Json::array({json_of(0U), json_of(1U)}); };
    list.push_back({{"kind", name_of(placement.kind)},
                    {"start", of_both([&](std::size_t k) { return json_number(placement.start[k]); })},
                    {"end", of_both([&](std::size_t k) { return json_number(placement.end[k]); })},
                    {"at", of_both([&](std::size_t k) { return place_json(one.at[k]); })},
                    {"point", of_both([&](std::size_t k) { return point_json(placement.point[k]); })}});
    if (placement.kind != Kind::corner) {
      list.back()["tangent"] = of_both([&](std::size_t k) { return json_number(placement.tangent[k]); });
    }
    list.back()["proof"] = name_of(one.proof);
    if (one.proof == PairProof::family) {
      list.back()["family"] = one.line;
      list.back()["extent"] = of_both([&](std::size_t k) { return Json::array({one.extent[k].lo, one.extent[k].hi}); });
    }
    if (one.box) list.back()["box"] = Json::array({pair_row_json((*one.box)[0]), pair_row_json((*one.box)[1])});
  }
  return list;
}

Json readings_json(const std::vector<Reading>& readings) {
  Json list = Json::array();
  for (const Reading& reading : readings) {
    const PerFinger<double>& length = reading.length;
    list.push_back({{"length", length.size() == 1 ? json_number(length[0]) : json_numbers(length)},
                    {"turn", json_number(reading.turn)}});
  }
  return list;
}

/// What every certificate begins with.
Json outline_json(const char* schema, const CertifiedOutline& outline) {
  return {{"schema", schema},
          {"part", outline.part},
          {"closed", outline.closed},
          {"perimeter", json_number(outline.perimeter)},
          {"origin", point_json(outline.origin)},
          {"gap", json_number(outline.gap)},
          {"curves", curves_json(outline.curves)}};
}

Json intervals_json(const std::vector<Interval>& intervals) { return json_list(intervals, json_interval); }

Json touches_json(const TouchCertificate& certificate) {
  Json list = Json::array();
  for (std::size_t k = 0; k < certificate.touches.size(); ++k) {
    const MeasuredTouch& touch = certificate.touches[k];
    const TouchTolerance& tolerance = certificate.tolerance[certificate.rolls.size() + k];
    const double length = touch.has_place() ? tolerance.length : 0.0;
    list.push_back({{"tolerance", json_numbers(std::array{length, tolerance.angle})}});
    if (touch.has_place()) list.back()["at"] = point_json(touch.at);
    if (touch.normal) list.back()["normal"] = json_number(*touch.normal);
  }
  return list;
}

Json rolls_json(const TouchCertificate& certificate) {
  Json list = Json::array();
  for (std::size_t k = 0; k < certificate.rolls.size(); ++k) {
    const RollSearched& roll = certificate.rolls[k];
    const TouchTolerance& tolerance = certificate.tolerance[k];
    list.push_back({{"normal", json_number(roll.normal)},
                    {"tolerance", json_numbers(std::array{roll.at ? tolerance.length : 0.0, tolerance.angle})},
                    {"readings", readings_json(roll.readings)},
                    {"within", json_number(roll.tolerance)}});
    if (roll.at) list.back()["at"] = point_json(*roll.at);
  }
  return list;
}

/// Corners at which the finger can take every angle, or that are on no arc, say nothing.
Json reach_json(const std::optional<Reach>& reach) {
  if (!reach) return {};
  Json corners = Json::array();
  for (const PivotReach& pivot : reach->pivots) {
    if (pivot.is_whole()) continue;
    corners.push_back({{"s", json_number(pivot.s)}, {"angles", intervals_json(pivot.angles)}});
  }
  return {{"arcs", intervals_json(reach->arcs)}, {"corners", corners}};
}

template <class Value>
Json number_if_any(const Value& value) {
  return value ? json_number(*value) : Json();
}

Json held_finger_json(const CertifiedFinger& finger) {
  Json json = {{"kind", finger.kind},
               {"tolerance",
                {{"travel", json_number(finger.travel)},
                 {"angle", json_number(finger.angle)},
                 {"place", number_if_any(finger.place)}}},
               {"passed", json_interval(finger.passed)},
               {"reach", reach_json(finger.reach)}};
  if (finger.radius > 0) json["radius"] = json_number(finger.radius);
  return json;
}

Json held_wheel_json(const CertifiedWheel& wheel) {
  return {
      {"radius", json_number(wheel.radius)},
      {"tolerance",
       {{"place", json_number(wheel.place)}, {"spin", number_if_any(wheel.spin)}, {"line", number_if_any(wheel.line)}}},
      {"reach", reach_json(wheel.reach)}};
}

Json held_instant_json(const CertifiedInstant& instant) {
  Json contacts = Json::array(), pins = Json::array();
  for (const CertifiedInstant::Contact& contact : instant.contacts) {
    contacts.push_back({{"travelled", json_number(contact.travelled)}, {"tangent", json_number(contact.tangent)}});
    if (contact.at) contacts.back()["at"] = point_json(*contact.at);
  }
  for (const CertifiedInstant::Pin& pin : instant.pins) {
    pins.push_back({{"at", point_json(pin.at)}});
    if (pin.spin) pins.back()["spin"] = json_number(*pin.spin);
  }
  return {{"time", json_number(instant.time)}, {"contacts", contacts}, {"pins", pins}};
}

Json lie_json(const CertifiedLie& lie) {
  Json contacts = Json::array(), pins = Json::array();
  for (const auto& off : lie.off) contacts.push_back({{"off", json_numbers(off)}});
  for (const CertifiedLie::Wheel& wheel : lie.wheels) {
    pins.push_back(
        {{"at", place_json(wheel.at)}, {"tangent", json_number(wheel.tangent)}, {"off", json_numbers(wheel.off)}});
  }
  return {{"pose", pose_json(lie.pose)}, {"contacts", contacts}, {"pins", pins}};
}

Json held_set_json(const CertifiedHoldSet& set) {
  Json json = {{"listed", set.listed}, {"extent", intervals_json(set.extent)}};
  if (set.first.empty()) return json;
  Json first = Json::array();
  for (std::size_t k = 0; k < set.first.size(); ++k) {
    first.push_back({{"at", place_json(set.at[k])}, {"s", json_number(set.first[k])}});
  }
  json["first"] = first;
  json["zeros"] = json_numbers(set.zeros);
  json["instants"] = json_list(set.lies, lie_json);
  return json;
}

Json certified_pose_json(const CertifiedPose& one, const std::vector<TouchTolerance>& tolerance) {
  Json contacts = Json::array();
  for (std::size_t k = 0; k < one.at.size(); ++k) {
    const TouchContact& contact = one.pose.contacts[k];
    const std::array off{contact.distance / tolerance[k].length,
                         contact.turn ? *contact.turn / tolerance[k].angle : 0.0};
    contacts.push_back({{"at", place_json(one.at[k])},
                        {"s", json_number(contact.s)},
                        {"tangent", json_number(contact.tangent)},
                        {"off", json_numbers(off)}});
  }
  Json json = {{"listed", one.listed}};
  if (!one.at.empty()) json["pose"] = pose_json(one.pose.pose);
  if (one.is_own) json["extent"] = intervals_json({one.pose.extent.begin(), one.pose.extent.end()});
  if (!one.at.empty()) json["contacts"] = contacts;
  return json;
}

}  // namespace

std::string format_certificate(const Certificate& certificate) {
  Json json = outline_json("rollfix/certificate/1", certificate);
  json["readings"] = readings_json(certificate.readings);
  json["tolerance"] = json_number(certificate.tolerance);
  json["rows"] = rows_json(certificate);
  json["placements"] = placements_json(certificate);
  return json_text(json);
}

std::string format_certificate(const PairCertificate& certificate) {
  Json json = outline_json("rollfix/pair-certificate/1", certificate);
  json["readings"] = readings_json(certificate.readings);
  json["facing"] = certificate.facing ? json_number(*certificate.facing) : Json();
  json["tolerance"] = json_number(certificate.tolerance);
  json["from"] = pair_row_json(certificate.from);
  if (certificate.to) json["to"] = pair_row_json(*certificate.to);
  json["cells"] = certificate.cells;
  json["placements"] = pairs_json(certificate);
  return json_text(json);
}

std::string format_certificate(const TouchCertificate& certificate) {
  Json json = outline_json("rollfix/touch-certificate/1", certificate);
  json["mirrored"] = certificate.mirrored;
  json["radius"] = json_number(certificate.radius);
  if (!certificate.rolls.empty()) json["rolls"] = rolls_json(certificate);
  json["touches"] = touches_json(certificate);
  json["reach"] = reach_json(certificate.reach);
  json["poses"] = json_list(certificate.poses,
                            [&](const CertifiedPose& one) { return certified_pose_json(one, certificate.tolerance); });
  if (!certificate.is_complete()) {
    json["unresolved"] = {{"touch", certificate.unresolved_touch}, {"arcs", intervals_json(certificate.unresolved)}};
  }
  return json_text(json);
}

std::string format_certificate(const HoldCertificate& certificate) {
  Json json = outline_json("rollfix/hold-certificate/1", certificate);
  json["mirrored"] = certificate.mirrored;
  json["fingers"] = json_list(certificate.fingers, held_finger_json);
  json["wheels"] = json_list(certificate.wheels, held_wheel_json);
  json["instants"] = json_list(certificate.instants, held_instant_json);
  json["sets"] = json_list(certificate.sets, held_set_json);
  if (!certificate.unresolved.empty())
    json["unresolved"] = json_list(certificate.unresolved, [](const auto& arcs) { return intervals_json(arcs); });
  return json_text(json);
}

CertificateText certificate_of(const Answer& answer, std::optional<std::size_t> budget) {
  LocateOptions options;
  options.tolerance = answer.tolerance.value;
  options.facing = answer.facing;
  if (budget) options.budget = *budget;
  const auto text_of = [](const auto& certificate) {
    return CertificateText{format_certificate(certificate), certificate.is_complete(), "its cells say where"};
  };
  return answer.finger_count() == 2 ? text_of(certify_pair(answer.part, answer.readings, options))
                                    : text_of(certify(answer.part, answer.readings, options));
}

CertificateText certificate_of(const TouchAnswer& answer, std::optional<std::size_t> budget) {
  const TouchCertificate certificate = certify_touches(answer, budget);
  return {format_certificate(certificate), certificate.is_complete(), "`unresolved` says where"};
}

CertificateText certificate_of(const HoldProblem& problem, const HoldAnswer& answer) {
  const HoldCertificate certificate = certify_holds(problem, answer);
  return {format_certificate(certificate), certificate.is_complete(),
          certificate.unresolved.empty() ? "sets without `first` say where" : "`unresolved` says where"};
}

}  // namespace rollfix
