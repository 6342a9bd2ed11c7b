#include "stated.hpp"

#include <cmath>

namespace rollfix_verify {

double number(const Json& stated) {
  const double value = stated.get<double>();
  if (!std::isfinite(value)) refuse("a number that is not finite");
  return value;
}

Interval interval(const Json& stated) { return {number(stated.at(0)), number(stated.at(1))}; }

std::vector<Interval> intervals(const Json& stated) {
  std::vector<Interval> result;
  for (const Json& one : stated) result.push_back(interval(one));
  return result;
}

std::vector<Interval> arcs(const Json& stated, double period) {
  std::vector<Interval> result = intervals(stated);
  for (const Interval& arc : result) {
    if (!(arc.lo >= -kLengthSlack * period && arc.lo <= period && arc.hi >= arc.lo &&
          arc.hi <= arc.lo + (1 + kLengthSlack) * period)) {
      refuse("an arc that is none of the boundary");
    }
  }
  return result;
}

std::optional<Considered> considered(const Json& stated, double period) {
  if (stated.is_null()) return std::nullopt;
  Considered result;
  result.arcs = arcs(stated.at("arcs"), period);
  for (const Json& corner : stated.at("corners")) {
    result.corners.push_back({number(corner.at("s")), intervals(corner.at("angles"))});
  }
  return result;
}

bool is_considered(const Boundary& boundary, const std::optional<Considered>& considered, const Place& place,
                   double tangent) {
  if (!considered) return true;
  const double slack = kPlaceSlack * boundary.perimeter().middle();
  const double s = place.s.middle();
  for (const double lap : boundary.laps()) {
    for (const Interval& arc : considered->arcs) {
      if (s >= arc.lo + lap - slack && s <= arc.hi + lap + slack) return true;
    }
    for (const CornerAngles& corner : considered->corners) {
      if (std::abs(s - corner.s - lap) > slack) continue;
      for (const Interval& angles : corner.angles) {
        const Ball off = to_nearest_turn(Ball(tangent) - 0.5 * (angles.lo + angles.hi));
        if (abs(off).is_below(0.5 * angles.width() + kPlaceSlack)) return true;
      }
    }
  }
  return false;
}

Ball direction_at(const Document& document, const CentreTree& tree, const Place& place, double stated,
                  const std::string& name) {
  if (!(std::abs(stated) <= kMostAngle)) refuse(name + " has another tangent");
  const Boundary& boundary = document.boundary();
  const auto near = [&](const Ball& one, const Ball& slack) {
    return abs(to_nearest_turn(one - stated)).is_below(slack);
  };
  const Ball slack = kPlaceSlack + document.turn_beside(place);
  Ball own = tree.direction(place);
  if (near(own, slack)) return own;
  for (const long joint : {place.curve, place.curve - 1}) {
    const bool is_end = !boundary.closed() && (joint < 0 || joint + 1 == boundary.curves());
    if (is_end) continue;
    const Ball apart = boundary.back(joint).s - place.s;
    if (!abs(apart).is_below(kPlaceSlack * document.period())) continue;
    Ball before = tree.direction(boundary.back(joint));
    Ball after = before + boundary.jump(joint);
    if (near(before, slack)) return before;
    if (near(after, slack)) return after;
    if (const std::optional<Ball> pivots = tree.pivots(joint)) {
      const Ball off = to_nearest_turn(Ball(stated) - pivots->middle());
      if (abs(off).is_below(0.5 * spread(*pivots))) return stated;
    }
  }
  refuse(name + " has another tangent");
}

void require_off(const Ball& residual, double tolerance, double slack, const Ball& stated, const std::string& name) {
  if (!abs(residual).is_below((1 + kEdge) * tolerance + slack)) refuse(name + " is off by more than its tolerance");
  if (!abs(residual - stated * tolerance).is_below(kEdge * tolerance + 2 * slack)) {
    refuse(name + " is off by another share of its tolerance");
  }
}

}  // namespace rollfix_verify
