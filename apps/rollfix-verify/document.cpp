#include "document.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace rollfix_verify {
namespace {

// Tangents are stated in (-pi, pi].
constexpr double kHalfTurn = 3.1415926536;
constexpr double kFullTurnUp = 2 * kHalfTurn;
// Longer rolls and larger angles are not looked at: the digits of a double are used up.
constexpr double kMostLaps = 1e6;
// Curves meet to this share of the perimeter.
constexpr double kMostGap = 1e-9;

std::vector<Formula> formulas(const Json& curves) {
  std::vector<Formula> result;
  for (const Json& curve : curves) {
    result.push_back(formula_of(curve.at("kind").get<std::string>(), curve.at("numbers").get<std::vector<double>>()));
  }
  return result;
}

}  // namespace

void refuse(const std::string& why) { throw std::domain_error(why); }

Document::Document(const Json& json)
    : json_(json),
      boundary_(formulas(json.at("curves")), json.at("closed").get<bool>()),
      period_(boundary_.perimeter().middle()),
      tolerance_(json.value("tolerance", 0.0)) {}

void Document::check() const {
  if (!(tolerance_ >= kLeastTolerance) || !std::isfinite(tolerance_)) {
    refuse("the tolerance is below what rounding allows");
  }
  check_outline();
}

void Document::check_outline() const {
  const double stated = json_.at("perimeter").get<double>();
  if (!abs(boundary_.perimeter() - stated).is_below(kLengthSlack * period_)) refuse("the perimeter is another one");
  if (!(period_ > 0)) refuse("the outline has no length");
  if (!(boundary_.largest_gap() <= kMostGap * period_)) refuse("its curves do not meet");
  const double gap = json_.at("gap").get<double>();
  if (!(std::abs(boundary_.largest_gap() - gap) <= kLengthSlack * period_)) refuse("its curves meet otherwise");
  const Place first = boundary_.at(0, boundary_.front(0).u.middle());
  if (!is_at(boundary_.position(first), json_.at("origin"))) refuse("the outline starts elsewhere");
}

Ball Document::length(const Json& stated) const {
  const double value = stated.get<double>();
  if (!(std::abs(value) <= kMostLaps * period_)) refuse("a roll of more than a million laps");
  return value;
}

Ball Document::turn(const Json& stated) {
  const double value = stated.get<double>();
  if (!(std::abs(value) <= kMostLaps * kFullTurnUp)) refuse("an angle of more than a million turns");
  return value;
}

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
    refuse(name + " is of a kind that is not known");
  }
  if (kind == "corner" && placement.contains("tangent")) refuse(name + " has a tangent, but pivots");
  return kind;
}

bool Document::is_at(const Point& point, const Json& stated) const {
  const double slack = kPlaceSlack * period_;
  return abs(point.x - stated.at(0).get<double>()).is_below(slack) &&
         abs(point.y - stated.at(1).get<double>()).is_below(slack);
}

Place Document::place_at(const Json& stated) const {
  const auto curve = stated.at(0).get<long>();
  if (curve < 0 || curve >= boundary_.curves()) refuse("a place on a curve that is not there");
  return boundary_.at(curve, stated.at(1).get<double>());
}

bool Document::is_as_far(const Ball& s, const Ball& stated) const {
  const Ball off = s - stated;
  const Ball laps = boundary_.closed() ? Ball(std::round(off.middle() / period_)) * boundary_.perimeter() : Ball(0.0);
  return abs(off - laps).is_below(kLengthSlack * period_);
}

/// Where a curve is at rest its curvature does not tell.
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

Place Document::contact(const std::string& name, const Json& placement, const Ball& length,
                        std::optional<std::size_t> finger) const {
  const auto stated = [&](const char* key) -> const Json& {
    const Json& all = placement.at(key);
    return finger ? all.at(*finger) : all;
  };
  Place start = place_at(stated("at"));
  if (!is_as_far(start.s, stated("start").get<double>())) refuse(name + " starts elsewhere");
  if (!is_as_far(start.s + length, stated("end").get<double>())) refuse(name + " ends elsewhere");
  if (!is_at(boundary_.position(start), stated("point"))) refuse(name + " is at another point");
  if (placement.at("kind") == "corner") return start;
  const Point v = boundary_.velocity(start);
  const double tangent = stated("tangent").get<double>();
  const Ball c = cos(Ball(tangent));
  const Ball s = sin(Ball(tangent));
  const Ball apart = atan2(v.y * c - v.x * s, v.x * c + v.y * s);
  const Ball most = kPlaceSlack + turn_beside(start);
  if (!abs(apart).is_below(most) || !(std::abs(tangent) < kHalfTurn)) refuse(name + " has another tangent");
  return start;
}

}  // namespace rollfix_verify
