#include "document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

// Notation:
//   s, P            arc length, perimeter: `period_`
//   place           [curve, its parameter]; s, point and tangent that are stated of it have to be within the slacks of
//                   document.hpp of what the formulas say
//   turn_beside     |kappa| times what a place may be off: by so much a tangent may turn
// Follows docs/certificates.md, "What 'proved' means": T4, the question.
// Idea: nothing that is stated is used without being computed again. Angles are compared modulo whole turns.
namespace rollfix_verify {
namespace {

// Tangents are stated in (-pi, pi].
constexpr double kHalfTurn = 3.1415926536;
constexpr double kFullTurnUp = 2 * kHalfTurn;
// Longer rolls and larger angles are not looked at: the digits of a double are used up.
constexpr double kMostLaps = 1e6;
// Curves meet to this share of the perimeter.
constexpr double kMostGap = 1e-9;

/// T4: each curve by its kind and numbers. Throws std::runtime_error where there is no such curve.
std::vector<Formula> formulas(const Json& curves) {
  std::vector<Formula> result;
  for (const Json& curve : curves) {
    const auto kind = curve.at("kind").get<std::string>();
    const auto numbers = curve.at("numbers").get<std::vector<double>>();
    try {
      result.push_back(formula_of(kind, numbers));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("/curves/" + std::to_string(result.size()) + ": " + error.what());
    }
  }
  return result;
}

}  // namespace

/// A std::domain_error, which `check` turns into the verdict.
void refuse(const std::string& why) { throw std::domain_error(why); }

/// In so many digits that two doubles which differ by more than the slacks look different.
void refuse_number(const std::string& what, double stated, const Ball& computed) {
  std::array<char, 100> numbers;
  std::snprintf(numbers.data(), numbers.size(), ": stated %.15g, computed %.15g", stated, computed.middle());
  refuse(what + numbers.data());
}

/// Builds the boundary, and computes its length; nothing that is stated is compared yet. Certificates of touches and
/// holds have no tolerance here.
Document::Document(const Json& json)
    : json_(json),
      boundary_(formulas(json.at("curves")), json.at("closed").get<bool>()),
      period_(boundary_.perimeter().middle()),
      tolerance_(json.value("tolerance", 0.0)) {}

/// Also refuses a tolerance that is NaN or infinite.
void Document::check() const {
  if (!(tolerance_ >= kLeastTolerance) || !std::isfinite(tolerance_)) {
    refuse("the tolerance is below what rounding allows");
  }
  check_outline();
}

/// T4: perimeter, largest gap and first point, to the slacks of document.hpp.
void Document::check_outline() const {
  const double stated = json_.at("perimeter").get<double>();
  if (!abs(boundary_.perimeter() - stated).is_below(kLengthSlack * period_)) {
    refuse_number("perimeter", stated, boundary_.perimeter());
  }
  if (!(period_ > 0)) refuse("the outline has no length");
  // An open outline that is stated as closed has a gap between its ends.
  if (!(boundary_.largest_gap() <= kMostGap * period_)) refuse("its curves do not meet");
  const double gap = json_.at("gap").get<double>();
  if (!(std::abs(boundary_.largest_gap() - gap) <= kLengthSlack * period_)) {
    refuse_number("gap", gap, boundary_.largest_gap());
  }
  const Place first = boundary_.at(0, boundary_.front(0).u.middle());
  require_at(boundary_.position(first), json_.at("origin"), "origin");
}

/// L, in the outline's unit.
Ball Document::length(const Json& stated) const {
  const double value = stated.get<double>();
  if (!(std::abs(value) <= kMostLaps * period_)) refuse("a roll of more than a million laps");
  return value;
}

/// Radians.
Ball Document::turn(const Json& stated) {
  const double value = stated.get<double>();
  if (!(std::abs(value) <= kMostLaps * kFullTurnUp)) refuse("an angle of more than a million turns");
  return value;
}

/// 0 <= s and s + L <= P for each length.
Interval Document::starts(const std::vector<Ball>& lengths) const {
  Interval all{0, period_};
  for (const Ball& length : lengths) {
    if (boundary_.closed()) break;
    all.lo = std::max(all.lo, -length.middle());
    all.hi = std::min(all.hi, period_ - length.middle());
  }
  return all;
}

std::string Document::kind_of(const std::string& name, const Json& placement) {
  auto kind = placement.at("kind").get<std::string>();
  if (kind != "crossing" && kind != "touching" && kind != "corner" && kind != "stretch") {
    refuse(name + ", kind: expected crossing, touching, corner or stretch, found '" + kind + "'");
  }
  // T2 leaves the tangent open there, so that a stated one would be believed unchecked.
  if (kind == "corner" && placement.contains("tangent")) refuse(name + " has a tangent, but pivots");
  return kind;
}

/// To kPlaceSlack of the perimeter, in each coordinate.
void Document::require_at(const Point& point, const Json& stated, const std::string& what) const {
  const auto x = stated.at(0).get<double>();
  const auto y = stated.at(1).get<double>();
  if (!abs(point.x - x).is_below(kPlaceSlack * period_)) refuse_number(what + ", x", x, point.x);
  if (!abs(point.y - y).is_below(kPlaceSlack * period_)) refuse_number(what + ", y", y, point.y);
}

/// Refuses a curve or a parameter that is not there.
Place Document::place_at(const Json& stated) const {
  const auto curve = stated.at(0).get<long>();
  if (curve < 0 || curve >= boundary_.curves()) refuse("a place on a curve that is not there");
  return boundary_.at(curve, stated.at(1).get<double>());
}

bool Document::is_as_far(const Ball& s, const Ball& stated) const {
  const Ball off = s - stated;
  // The nearest number of whole laps.
  const Ball laps = boundary_.closed() ? Ball(std::round(off.middle() / period_)) * boundary_.perimeter() : Ball(0.0);
  return abs(off - laps).is_below(kLengthSlack * period_);
}

void Document::require_as_far(const Ball& s, const Ball& stated, const std::string& what) const {
  if (!is_as_far(s, stated)) refuse_number(what, stated.middle(), s);
}

/// |kappa| times the slack of lengths. At rest kappa has no bound: there the angles beside the place are compared with
/// its own.
Ball Document::turn_beside(const Place& place) const {
  const Ball reach = kLengthSlack * period_;
  const Ball curvature = boundary_.bend(place.curve, place.u).curvature;
  if (curvature.is_finite()) return reach * abs(curvature);
  Ball most = 0.0;
  for (const double way : {-1.0, 1.0}) {
    const std::optional<Place> beside = boundary_.after(place.s + way * reach);
    if (beside && beside->curve == place.curve) most = hull(most, abs(beside->angle - place.angle));
  }
  return most;
}

/// T4 of one finger's placement. At a corner the tangent is left open, and is not compared.
Place Document::contact(const std::string& name, const Json& placement, const Ball& length,
                        std::optional<std::size_t> finger) const {
  // Of two fingers each field is a list.
  const auto stated = [&](const char* key) -> const Json& {
    const Json& all = placement.at(key);
    return finger ? all.at(*finger) : all;
  };
  Place start = place_at(stated("at"));
  require_as_far(start.s, stated("start").get<double>(), name + ", start");
  require_as_far(start.s + length, stated("end").get<double>(), name + ", end");
  require_at(boundary_.position(start), stated("point"), name + ", point");
  if (placement.at("kind") == "corner") return start;
  // The angle between the curve's velocity and the stated tangent, which needs no unwrapping.
  const Point v = boundary_.velocity(start);
  const double tangent = stated("tangent").get<double>();
  // The stated tangent as a unit vector.
  const Ball c = cos(Ball(tangent));
  const Ball s = sin(Ball(tangent));
  const Ball apart = atan2(v.y * c - v.x * s, v.x * c + v.y * s);
  // The place is known to a slack only, and the tangent turns over it.
  const Ball most = kPlaceSlack + turn_beside(start);
  if (!abs(apart).is_below(most) || !(std::abs(tangent) < kHalfTurn)) {
    refuse_number(name + ", tangent", tangent, apart + tangent);
  }
  return start;
}

/// A stated double.
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
    // Negated, so that NaN is refused.
    if (!(arc.lo >= -kLengthSlack * period && arc.lo <= period && arc.hi >= arc.lo &&
          arc.hi <= arc.lo + (1 + kLengthSlack) * period)) {
      refuse("an arc that is none of the boundary");
    }
  }
  return result;
}

/// `null`: everywhere.
std::optional<Considered> considered(const Json& stated, double period) {
  if (stated.is_null()) return std::nullopt;
  Considered result;
  result.arcs = arcs(stated.at("arcs"), period);
  for (const Json& corner : stated.at("corners")) {
    result.corners.push_back({number(corner.at("s")), intervals(corner.at("angles"))});
  }
  return result;
}

/// On an arc of `reach`, or at one of its corners with one of its angles; to kPlaceSlack.
bool is_considered(const Boundary& boundary, const std::optional<Considered>& considered, const Place& place,
                   double tangent) {
  if (!considered) return true;
  const double slack = kPlaceSlack * boundary.perimeter().middle();
  const double s = place.s.middle();
  for (const double lap : boundary.laps()) {
    for (const Interval& arc : considered->arcs) {
      // Tangents are any on an arc.
      if (s >= arc.lo + lap - slack && s <= arc.hi + lap + slack) return true;
    }
    for (const CornerAngles& corner : considered->corners) {
      if (std::abs(s - corner.s - lap) > slack) continue;
      for (const Interval& angles : corner.angles) {
        // From the middle of the stated angles, modulo turns.
        const Ball off = to_nearest_turn(Ball(tangent) - 0.5 * (angles.lo + angles.hi));
        if (abs(off).is_below(0.5 * angles.width() + kPlaceSlack)) return true;
      }
    }
  }
  return false;
}

/// Refuses an angle that the boundary does not have at this place. At a corner the end angles count to the slack, a
/// convex one has all in between.
Ball direction_at(const Document& document, const CentreTree& tree, const Place& place, double stated,
                  const std::string& name) {
  if (!(std::abs(stated) <= kMostAngle)) refuse(name + ", tangent: an angle of too many turns");
  const Boundary& boundary = document.boundary();
  // Modulo whole turns.
  const auto near = [&](const Ball& one, const Ball& slack) {
    return abs(to_nearest_turn(one - stated)).is_below(slack);
  };
  const Ball slack = kPlaceSlack + document.turn_beside(place);
  Ball own = tree.direction(place);
  if (near(own, slack)) return own;
  // The joints at both ends of the place's curve, if the place is at one of them.
  for (const long joint : {place.curve, place.curve - 1}) {
    const bool is_end = !boundary.closed() && (joint < 0 || joint + 1 == boundary.curves());
    if (is_end) continue;
    const Ball apart = boundary.back(joint).s - place.s;
    if (!abs(apart).is_below(kPlaceSlack * document.period())) continue;
    Ball before = tree.direction(boundary.back(joint));
    Ball after = before + boundary.jump(joint);
    // One of the two ends, known to all digits.
    if (near(before, slack)) return before;
    if (near(after, slack)) return after;
    if (const std::optional<Ball> pivots = tree.pivots(joint)) {
      const Ball off = to_nearest_turn(Ball(stated) - pivots->middle());
      if (abs(off).is_below(0.5 * spread(*pivots))) return stated;
    }
  }
  refuse_number(name + ", tangent", stated, own);
}

/// `slack`: what doubles may have made of the stated numbers, in the residual's own unit.
void require_off(const Ball& residual, double tolerance, double slack, double stated, const std::string& name) {
  // The stated share must be the computed one: so every number of the pose is tied to the formulas.
  const bool is_within = abs(residual).is_below((1 + kEdge) * tolerance + slack);
  const bool is_as_stated = abs(residual - Ball(stated) * tolerance).is_below(kEdge * tolerance + 2 * slack);
  if (!is_within || !is_as_stated) {
    refuse_number(name + ", off, in tolerances" + (is_within ? "" : ", of which it may be 1"), stated,
                  residual * (1 / tolerance));
  }
}

}  // namespace rollfix_verify
