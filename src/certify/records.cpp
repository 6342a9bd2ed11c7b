#include "records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "outline/shapes/shapes.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
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

}  // namespace

std::vector<CurveRecord> formulas_of(const Outline& outline) {
  const bool is_as_given = !outline.gallery.empty() && !outline.reversed;
  Records records = is_as_given ? of_gallery(outline.gallery) : Records{};
  if (records.size() == outline.curves.size()) return records;
  records.clear();
  for (const Curve& curve : outline.curves) {
    const std::optional<CurveRecord> record = curve.formula();
    if (!record) {
      throw InputError(fmt::format("{}: curve {} is of a kind that certificates have no formula for", outline.name,
                                   records.size() + 1));
    }
    records.push_back(*record);
  }
  return records;
}

}  // namespace rollfix
