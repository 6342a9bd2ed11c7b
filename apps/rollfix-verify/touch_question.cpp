#include "touch_question.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stated.hpp"

namespace rollfix_verify {
TouchQuestion::TouchQuestion(const Document& document)
    : is_mirrored(document.json().at("mirrored").get<bool>()), radius(number(document.json().at("radius"))) {
  if (!(radius >= 0)) refuse("a finger whose radius is below 0");
  considered = rollfix_verify::considered(document.json().at("reach"), document.period());
  if (document.json().contains("rolls")) {
    for (const Json& stated : document.json().at("rolls")) read_contact(stated, true);
  }
  rolls = touches.size();
  for (const Json& stated : document.json().at("touches")) read_contact(stated, false);
  if (touches.empty()) refuse("there is no touch");
  any_place = std::any_of(touches.begin(), touches.end(), [](const SoughtTouch& one) { return one.has_place; });
  for (const Json& stated : document.json().at("poses")) sets.push_back(set_of(stated));
}

/// Of a touch, or of a roll's first contact; it may have no place.
void TouchQuestion::read_contact(const Json& stated, bool is_roll) {
  SoughtTouch touch;
  touch.has_place = stated.contains("at");
  if (touch.has_place) {
    touch.x = mirrored(number(stated.at("at").at(0)));
    touch.y = number(stated.at("at").at(1));
  }
  if (touch.has_place || is_roll) touch.length = number(stated.at("tolerance").at(0));
  touch.angle = number(stated.at("tolerance").at(1));
  if (is_roll && !stated.contains("normal")) refuse("a roll without a normal");
  if (!touch.has_place && !stated.contains("normal")) refuse("a touch without a place and a normal");
  if (stated.contains("normal")) {
    const double normal = number(stated.at("normal"));
    if (!(std::abs(normal) <= kMostAngle)) refuse("an angle of too many turns");
    const Ball quarter = 0.25 * full_turn();
    const Ball tangent = is_mirrored ? 3.0 * quarter - normal : Ball(normal) + quarter;
    touch.tangent = to_nearest_turn(tangent).middle();
  }
  touches.push_back(touch);
}

/// Where no contact has a place, x and y are null, and anything.
double TouchQuestion::place_of(const Json& stated) const {
  if (any_place) return number(stated);
  if (!stated.is_null()) refuse("a place, which nothing tells");
  return 0;
}

Interval TouchQuestion::places_of(const Json& stated) const {
  if (any_place) return interval(stated);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  place_of(stated.at(0));
  place_of(stated.at(1));
  return {-kFar, kFar};
}

StatedSet TouchQuestion::set_of(const Json& stated) const {
  StatedSet set;
  if (stated.contains("extent")) {
    const Json& extent = stated.at("extent");
    set.extent = {mirrored(places_of(extent.at(0))), places_of(extent.at(1)), mirrored(interval(extent.at(2)))};
  }
  if (!stated.contains("pose")) {
    if (stated.at("listed").get<bool>() || !set.extent) refuse("a set without a pose");
    return set;
  }
  const Json& pose = stated.at("pose");
  set.pose = {mirrored(place_of(pose.at(0))), place_of(pose.at(1)), mirrored(number(pose.at(2)))};
  set.contacts = &stated.at("contacts");
  return set;
}

}  // namespace rollfix_verify
