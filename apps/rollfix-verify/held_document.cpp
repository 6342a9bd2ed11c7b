#include "document.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "centre_tree.hpp"

// What a certificate of a hold states of fingers, wheels and instants, read; and what of it can't be meant, or is so
// exact that doubles would decide.
// Notation:
//   L, a            how far a contact travelled, and its tolerance: `travelled`, `travel`
//   passed          from the first contact on, what was rolled over for certain
//   gaps, within    where a finger can't touch, and where it can, by arc length
// Follows docs/certificates.md, "Holds".
namespace rollfix_verify {
namespace {

// Tolerances are at least these shares of the largest coordinate and of the perimeter, and so many radians: below
// doubles decide.
constexpr double kLeastHeldLength = 1e-9;
constexpr double kLeastHeldTravel = 1e-10;
constexpr double kLeastHeldAngle = 1e-10;
constexpr std::size_t kMostFingers = 8;
constexpr std::size_t kMostInstants = 1000;
// More laps, or a tolerance of more radians, is not looked at.
constexpr double kMostHeldLaps = 1e3;
constexpr double kMostTolerance = 1e3;

/// Above 0.
/// Also refuses NaN.
double positive(const Json& stated) {
  const double value = number(stated);
  if (!(value > 0)) refuse("a tolerance or a radius that is not above 0");
  return value;
}

/// Of an angle.
double tolerance_of(const Json& stated) {
  const double value = positive(stated);
  if (!(value <= kMostTolerance)) refuse("a tolerance of too many turns");
  return value;
}

/// `null`: what it is of was not measured.
std::optional<double> tolerance_if_any(const Json& stated) {
  if (stated.is_null()) return std::nullopt;
  return tolerance_of(stated);
}

/// The parts of the boundary that are on no arc, on the first lap.
std::vector<Interval> gaps_between(const std::vector<Interval>& arcs, const Boundary& boundary) {
  const double period = boundary.perimeter().middle();
  std::vector<Interval> on;
  for (const Interval& arc : arcs) {
    // Arcs may go on beyond the perimeter: the lap before and the one behind have what of them is on the first lap.
    for (const double lap : boundary.laps()) on.push_back({arc.lo + lap, arc.hi + lap});
  }
  std::sort(on.begin(), on.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> gaps;
  double from = 0;
  for (const Interval& arc : on) {
    // `from`: up to here all is on some arc.
    if (arc.lo > from) gaps.push_back({from, std::min(arc.lo, period)});
    from = std::max(from, arc.hi);
    if (from >= period) return gaps;
  }
  gaps.push_back({from, period});
  return gaps;
}

/// Of the certificate's `fingers`, without its instants.
HeldFinger finger_of(const Json& stated, const Boundary& boundary) {
  HeldFinger finger;
  const Json& tolerance = stated.at("tolerance");
  finger.travel = positive(tolerance.at("travel"));
  finger.angle = tolerance_of(tolerance.at("angle"));
  // Negated, as all of these: NaN is refused.
  if (!(finger.travel <= boundary.perimeter().middle())) refuse("a contact that may be anywhere");
  finger.has_place = !tolerance.at("place").is_null();
  if (finger.has_place) finger.place = positive(tolerance.at("place"));
  finger.passed = interval(stated.at("passed"));
  const double most = kMostHeldLaps * boundary.perimeter().middle();
  if (!(std::max(std::abs(finger.passed.lo), std::abs(finger.passed.hi)) <= most)) refuse("a roll of too many laps");
  finger.reach = considered(stated.at("reach"), boundary.perimeter().middle());
  if (!finger.reach) return finger;
  // Empty without a reach: then all of the boundary is within reach.
  finger.within = finger.reach->arcs;
  // A corner counts as a place within reach if any of its tangents is.
  for (const CornerAngles& corner : finger.reach->corners) {
    if (!corner.angles.empty()) finger.within.push_back({corner.s, corner.s});
  }
  finger.gaps = gaps_between(finger.reach->arcs, boundary);
  return finger;
}

/// Of the certificate's `wheels`, without its instants.
HeldWheel wheel_of(const Json& stated, double period) {
  HeldWheel wheel;
  wheel.radius = positive(stated.at("radius"));
  const Json& tolerance = stated.at("tolerance");
  wheel.place = positive(tolerance.at("place"));
  wheel.spin = tolerance_if_any(tolerance.at("spin"));
  wheel.line = tolerance_if_any(tolerance.at("line"));
  wheel.reach = considered(stated.at("reach"), period);
  return wheel;
}

/// Radians.
double angle(const Json& stated) {
  const double value = number(stated);
  if (!(std::abs(value) <= kMostAngle)) refuse("an angle of too many turns");
  return value;
}

/// Of a finger, infinity of a jaw; 0: of one whose reach is not looked at.
double radius_of(const Json& stated) {
  // The kind says which shape is tested against the reach.
  const auto kind = stated.at("kind").get<std::string>();
  if (kind == "jaw") return std::numeric_limits<double>::infinity();
  if (kind == "disk") return positive(stated.at("radius"));
  if (kind != "outline") refuse("a finger of a kind that is not known");
  if (!stated.at("reach").is_null()) refuse("a finger whose reach is not known");
  return 0;
}

/// P1 of the reach: everywhere else the finger would enter the part. Refused with the first place where that is not
/// shown.
void require_reach(const Boundary& boundary, double radius, const std::optional<Considered>& reach) {
  if (!reach) return;
  const std::optional<double> place = not_out_of_reach(boundary, radius, *reach);
  if (!place) return;
  char text[120];
  std::snprintf(text, sizeof text, "the reach leaves out s = %.6g, where the finger may touch", *place);
  refuse(text);
}

}  // namespace

/// Reads everything and turns what lies face down: x to -x, an angle a to pi - a. Refused: counts that do not agree,
/// numbers that are too large for their digits.
HeldQuestion::HeldQuestion(const Document& document) : is_mirrored(document.json().at("mirrored").get<bool>()) {
  const Json& json = document.json();
  for (const Json& stated : json.at("fingers")) fingers.push_back(finger_of(stated, document.boundary()));
  for (const Json& stated : json.at("wheels")) wheels.push_back(wheel_of(stated, document.period()));
  // One finger with skin at least, and two bodies that touch.
  const std::size_t count = fingers.size() + wheels.size();
  if (fingers.empty() || count < 2 || count > kMostFingers) refuse("expected two to eight fingers, one with skin");
  instants = json.at("instants").size();
  if (instants == 0 || instants > kMostInstants) refuse("expected 1 to 1000 instants");
  for (const Json& instant : json.at("instants")) {
    if (instant.at("contacts").size() != fingers.size() || instant.at("pins").size() != wheels.size()) {
      refuse("an instant without a contact of each finger");
    }
    for (std::size_t k = 0; k < fingers.size(); ++k) {
      const Json& stated = instant.at("contacts").at(k);
      HeldFinger::At at;
      at.travelled = number(stated.at("travelled"));
      at.tangent = angle(stated.at("tangent"));
      // A direction in the mirror; turns of a wheel only change their sign.
      if (is_mirrored) at.tangent = (0.5 * full_turn() - at.tangent).middle();
      // Without a place x and y stay 0 and are not looked at.
      if (fingers[k].has_place) {
        at.x = mirrored(number(stated.at("at").at(0)));
        at.y = number(stated.at("at").at(1));
      }
      fingers[k].at.push_back(at);
      if (!(std::abs(at.travelled) <= kMostHeldLaps * document.period())) refuse("a roll of more than a thousand laps");
      size = std::max({size, std::abs(at.x), std::abs(at.y)});
    }
    for (std::size_t k = 0; k < wheels.size(); ++k) {
      const Json& stated = instant.at("pins").at(k);
      HeldWheel::At at{mirrored(number(stated.at("at").at(0))), number(stated.at("at").at(1)), 0};
      // Without an encoder it stays 0.
      if (wheels[k].spin) at.spin = mirrored(angle(stated.at("spin")));
      wheels[k].at.push_back(at);
      size = std::max({size, std::abs(at.x), std::abs(at.y)});
    }
  }
  // Needs the places of all instants.
  set_turn();
  for (const HeldFinger& finger : fingers) any_place = any_place || finger.has_place;
  // The part's own coordinates count for rounding as well.
  const CentreTree all(document.boundary(), 0, std::nullopt);
  const CentreTree::Node& root = all.node(all.root());
  size = std::max({size, std::abs(root.x) + root.radius, std::abs(root.y) + root.radius});
}

/// The tangent of a single finger tells the heading, which is seen where it moves a pin further than that is known.
void HeldQuestion::set_turn() {
  for (HeldFinger& finger : fingers) finger.turn = finger.angle;
  // The chords between several fingers tell the heading.
  if (fingers.size() > 1) return;
  HeldFinger& finger = fingers.front();
  double least = kMostAngle;
  for (const HeldWheel& wheel : wheels) {
    if (wheel.spin) least = std::min(least, *wheel.spin);
    if (wheel.line) least = std::min(least, *wheel.line);
    for (std::size_t t = 0; t < instants; ++t) {
      const double arm = std::hypot(wheel.at[t].x - finger.at[t].x, wheel.at[t].y - finger.at[t].y);
      // An angle by which the arm from contact to pin moves the pin as far as both are known.
      least = std::min(least, (finger.place + wheel.place) / arm);
    }
  }
  finger.turn += least;
}

void HeldQuestion::require_sound(const Document& document) const {
  // Negated, so that NaN is refused.
  const auto require = [](double tolerance, double least) {
    if (!(tolerance >= least)) refuse("a tolerance below what rounding allows");
  };
  for (const HeldFinger& finger : fingers) {
    require(finger.travel, kLeastHeldTravel * document.period());
    require(finger.angle, kLeastHeldAngle);
    if (finger.has_place) require(finger.place, kLeastHeldLength * size);
  }
  for (const HeldWheel& wheel : wheels) {
    require(wheel.place, kLeastHeldLength * size);
    if (wheel.spin) require(*wheel.spin, kLeastHeldAngle);
    if (wheel.line) require(*wheel.line, kLeastHeldAngle);
    // Its period, whole turn plus P / r, must not be 0 or negative.
    const bool is_known = !document.boundary().closed() || document.boundary().total_turn().is_above(0.0);
    if (wheel.spin && !is_known) refuse("an encoder on an outline that goes round clockwise");
    if (!any_place) refuse("a wheel beside fingers whose places are not known");
    require_reach(document.boundary(), wheel.radius, wheel.reach);
  }
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    require_reach(document.boundary(), radius_of(document.json().at("fingers").at(k)), fingers[k].reach);
  }
}

}  // namespace rollfix_verify
