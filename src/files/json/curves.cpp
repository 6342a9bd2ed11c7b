#include "files/json/curves.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <string>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/primitives.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

std::vector<double> weights(const JsonFields& entry) {
  return entry.has("weights") ? entry.numbers("weights") : std::vector<double>();
}

std::vector<Curve> line(const JsonFields& entry) { return {Line(entry.point("from"), entry.point("to"))}; }

std::vector<Curve> arc(const JsonFields& entry) {
  return {Arc(entry.point("centre"), entry.number("radius"), entry.angle("from", 0), entry.angle("sweep", kFullTurn))};
}

std::vector<Curve> ellipse(const JsonFields& entry) {
  return {EllipticArc(entry.point("centre"), entry.point("major"), entry.point("minor"), entry.angle("from", 0),
                      entry.angle("sweep", kFullTurn))};
}

std::vector<Curve> bezier(const JsonFields& entry) {
  std::vector<Curve> curves = bezier_curves(entry.points("points"), weights(entry));
  if (curves.empty()) throw InputError("all control points of a curve are the same; leave it out");
  return curves;
}

std::vector<Curve> spline(const JsonFields& entry) {
  std::vector<Curve> curves =
      nurbs(entry.whole("degree"), entry.numbers("knots"), entry.points("points"), weights(entry));
  if (curves.empty()) throw InputError("all control points of a curve are the same; leave it out");
  return curves;
}

std::vector<Curve> polyline(const JsonFields& entry) {
  const std::vector<Vec2> points = entry.points("points");
  if (points.size() < 2) throw InputError(fmt::format("expected at least 2 points, found {}", points.size()));
  std::vector<Curve> curves;
  for (std::size_t k = 1; k < points.size(); ++k) curves.emplace_back(Line(points[k - 1], points[k]));
  return curves;
}

struct CurveType {
  const char* name;
  std::vector<std::string> fields;
  std::vector<Curve> (*make)(const JsonFields&);
};

const std::array<CurveType, 6>& curve_types() {
  static const std::array<CurveType, 6> types = {{
      {"line", {"type", "from", "to"}, line},
      {"arc", {"type", "centre", "radius", "from", "sweep"}, arc},
      {"ellipse", {"type", "centre", "major", "minor", "from", "sweep"}, ellipse},
      {"bezier", {"type", "points", "weights"}, bezier},
      {"nurbs", {"type", "degree", "knots", "points", "weights"}, spline},
      {"polyline", {"type", "points"}, polyline},
  }};
  return types;
}

}  // namespace

std::vector<Curve> json_curves(const JsonFields& entry) {
  const std::string name = entry.text("type");
  std::vector<std::string> names;
  for (const CurveType& type : curve_types()) {
    names.emplace_back(type.name);
    if (name != type.name) continue;
    entry.allow_only(type.fields);
    return type.make(entry);
  }
  entry.refuse(fmt::format("has the unknown type {}: {}", quoted(name), known_names(name, names)));
}

}  // namespace rollfix
