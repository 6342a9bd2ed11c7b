#include "files/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "files/json/fields.hpp"
#include "outline/turn.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"

namespace rollfix::files {

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

/// The curves of one entry of "curves". Throws InputError with its place.
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

constexpr const char* kExpected =
    R"(expected a gallery shape such as {"gallery": "ellipse", "parameters": {"a": 2}} or curves such as )"
    R"({"curves": [{"type": "line", "from": [0, 0], "to": [1, 0]}, ...], "closed": true})";

/// The same InputError with the place before it.
template <class Make>
auto located(const std::string& place, Make make) -> decltype(make()) {
  try {
    return make();
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.rfind(place, 0) == 0 ? message : fmt::format("{}: {}", place, message));
  }
}

std::string as_parameter(const JsonFields& fields, const std::string& name, const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  fields.refuse(fmt::format("parameter '{}' is {}, expected a number or a text in quotes", name, value.type_name()));
}

Outline gallery_outline(const Json& object, const std::string& name) {
  const JsonFields fields(object, name);
  fields.allow_only({"gallery", "parameters"});
  ParameterList parameters;
  if (fields.has("parameters")) {
    const Json& given = object["parameters"];
    if (!given.is_object()) fields.refuse(fmt::format("'parameters' is not an object, {}", kExpected));
    for (const auto& [key, value] : given.items()) parameters.emplace_back(key, as_parameter(fields, key, value));
  }
  Outline outline = located(name, [&] { return gallery(fields.text("gallery"), parameters); });
  outline.name = name;
  return outline;
}

/// The lines on which the entries of the outermost object's "curves" begin. The text is known to be JSON.
std::vector<std::size_t> lines_of_curves(std::string_view text) {
  std::vector<std::size_t> lines;
  std::size_t line = 1;
  int depth = 0;
  bool in_curves = false;
  std::string_view key;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '\n') ++line;
    if (c == '"') {
      const std::size_t start = ++k;
      while (k < text.size() && text[k] != '"') k += text[k] == '\\' ? 2 : 1;
      if (depth == 1) key = text.substr(start, k - start);
    }
    if (c == '[' && depth == 1) in_curves = key == "curves";
    if (c == '{' && depth == 2 && in_curves) lines.push_back(line);
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
  }
  return lines;
}

/// A line back to where the first curve starts, where there is a way to go.
void close(Drawing& drawing) {
  if (drawing.curves.empty()) return;
  const Vec2 start = drawing.curves.front().curve.front();
  const Vec2 end = drawing.curves.back().curve.back();
  double size = 0;
  for (const DrawnCurve& drawn : drawing.curves) size = std::max(size, (drawn.curve.front() - start).norm());
  if ((end - start).norm() <= kSamePoint * size) return;
  if (end != start) drawing.curves.push_back({Line(end, start), {"closed", "", drawing.curves.back().origin.line}});
}

Drawing drawing_of_curves(const Json& object, std::string_view text, const std::string& name) {
  const JsonFields fields(object, name);
  fields.allow_only({"curves", "closed", "unit"});
  const Json& entries = object["curves"];
  if (!entries.is_array() || entries.empty())
    fields.refuse(fmt::format("'curves' is not an array of curves, {}", kExpected));
  Drawing drawing;
  drawing.name = name;
  if (fields.has("unit")) drawing.unit = fields.text("unit");
  const std::vector<std::size_t> lines = lines_of_curves(text);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    // An entry that is no object has no line of its own, and is refused.
    const std::size_t line = lines.size() == entries.size() ? lines[k] : 1;
    const std::string place = fmt::format("{}:{}: curves[{}]", name, line, k);
    const JsonFields entry(entries[k], place);
    for (Curve& curve : located(place, [&] { return json_curves(entry); })) {
      drawing.curves.push_back({std::move(curve), {entry.text("type"), "", line}});
    }
  }
  if (fields.flag("closed", false)) close(drawing);
  return drawing;
}

}  // namespace

std::variant<Outline, Drawing> parse_json_outline(std::string_view text, const std::string& name) {
  const Json object = parse_json(text, name, kExpected);
  if (object.is_object() && object.contains("gallery") && object["gallery"].is_string()) {
    return gallery_outline(object, name);
  }
  if (object.is_object() && object.contains("curves")) return drawing_of_curves(object, text, name);
  throw InputError(fmt::format("{}: holds something else, {}", name, kExpected));
}

}  // namespace rollfix::files
