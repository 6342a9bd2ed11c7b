#include "records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "outline/shapes/shapes.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/gallery.hpp"
#include "rollfix/outline/primitives.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

using Records = std::vector<CurveRecord>;

Records superellipse(double a, double b, double n) {
  if (std::fmod(n, 2) == 0) return {{"superellipse", {a, b, n}}};
  Records records;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const bool swapped = quarter % 2 == 1;
    records.push_back({"superellipse-quarter", {swapped ? b : a, swapped ? a : b, n, static_cast<double>(quarter)}});
  }
  return records;
}

Records naca(const std::string& digits, double chord) {
  const double height = (digits[0] - '0') / 100.0;
  const double place = (digits[1] - '0') / 10.0;
  const double thickness = ((digits[2] - '0') * 10 + (digits[3] - '0')) / 100.0;
  if (height == 0) return {{"naca-upper", {chord, thickness}}, {"naca-lower", {chord, thickness}}};
  const double top = std::sqrt(place);
  const auto piece = [&](const char* kind, double from, double to) {
    return CurveRecord{kind, {chord, thickness, height, place, from, to}};
  };
  return {piece("naca-upper-aft", -1, -top), piece("naca-upper-fore", -top, 0), piece("naca-lower-fore", 0, top),
          piece("naca-lower-aft", top, 1)};
}

/// The gallery's shapes with formulas of their own; none of those that are made of other curves.
Records of_shape(const std::string& name, const Parameters& is) {
  const auto listed = [&](const auto&... names) { return Records{{name, {is.number(names)...}}}; };
  if (name == "limacon") return listed("a", "b");
  if (name == "cam") return listed("base", "lift");
  if (name == "gear") return listed("r", "depth", "teeth");
  if (name == "log-spiral") return listed("a", "b", "turns");
  if (name == "exponential") return listed("scale", "from", "to");
  if (name == "superellipse") return superellipse(is.number("a"), is.number("b"), is.number("n"));
  if (name == "naca") return naca(is.text("digits"), is.number("chord"));
  return {};
}

/// Of a gallery's specification, "gallery:ellipse,a=2,b=1".
Records of_gallery(const std::string& specification) {
  const std::string_view text(specification);
  const std::vector<std::string_view> parts = split(text.substr(text.find(':') + 1), ',');
  ParameterList parameters;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const std::size_t equals = parts[k].find('=');
    parameters.emplace_back(trimmed(parts[k].substr(0, equals)), trimmed(parts[k].substr(equals + 1)));
  }
  const std::string name(parts.front());
  const auto& shapes = gallery_shapes();
  const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const auto& one) { return one.name == name; });
  return shape == shapes.end() ? Records{} : of_shape(name, Parameters(*shape, parameters));
}

constexpr std::string_view kReversed = "reversed ";
constexpr std::string_view kScaled = "scaled ";

bool begins_with(const std::string& kind, std::string_view prefix) { return kind.rfind(prefix, 0) == 0; }
bool is_at_rest(const CurveRecord& record) { return record.kind.find("-rest") != std::string::npos; }

/// Without "reversed" or "scaled".
CurveRecord inner(const CurveRecord& record) {
  if (begins_with(record.kind, kReversed)) return {record.kind.substr(kReversed.size()), record.numbers};
  return {record.kind.substr(kScaled.size()), {record.numbers.begin(), record.numbers.end() - 1}};
}

BezierFromRest resting_bezier(const CurveRecord& record) {
  const bool is_rational = begins_with(record.kind, "rational");
  std::vector<Vec2> points;
  std::vector<double> weights;
  for (std::size_t k = 0; k < record.numbers.size(); k += is_rational ? 3 : 2) {
    points.emplace_back(record.numbers[k], record.numbers[k + 1]);
    if (is_rational) weights.push_back(record.numbers[k + 2]);
  }
  const bool is_at_start = record.kind.find("from") != std::string::npos;
  return BezierFromRest(std::move(points), std::move(weights), is_at_start ? Rest::start : Rest::end);
}

/// Of curves that start or end at rest the Bezier curve itself: the library's own parameter is another.
CurveRecord formula_of(const CurveRecord& record) {
  if (!is_at_rest(record)) return record;
  if (begins_with(record.kind, kReversed)) {
    const CurveRecord forward = formula_of(inner(record));
    return {std::string(kReversed) + forward.kind, forward.numbers};
  }
  if (begins_with(record.kind, kScaled)) {
    CurveRecord original = formula_of(inner(record));
    original.numbers.push_back(record.numbers.back());
    return {std::string(kScaled) + original.kind, original.numbers};
  }
  return resting_bezier(record).bezier().record();
}

double formula_parameter(const CurveRecord& record, double u) {
  if (begins_with(record.kind, kReversed)) return 1 - formula_parameter(inner(record), 1 - u);
  if (begins_with(record.kind, kScaled)) return formula_parameter(inner(record), u);
  return resting_bezier(record).bezier_parameter(u);
}

}  // namespace

double formula_parameter(const Curve& curve, double u) {
  const std::optional<CurveRecord> record = curve.record();
  return record && is_at_rest(*record) ? formula_parameter(*record, u) : u;
}

std::vector<CurveRecord> formulas_of(const Outline& outline) {
  const bool is_as_given = !outline.gallery.empty() && !outline.reversed;
  Records records = is_as_given ? of_gallery(outline.gallery) : Records{};
  if (records.size() == outline.curves.size()) return records;
  records.clear();
  for (const Curve& curve : outline.curves) {
    const std::optional<CurveRecord> record = curve.record();
    if (!record) {
      throw InputError(fmt::format("{}: curve {} is of a kind that certificates have no formula for", outline.name,
                                   records.size() + 1));
    }
    records.push_back(formula_of(*record));
  }
  return records;
}

}  // namespace rollfix
