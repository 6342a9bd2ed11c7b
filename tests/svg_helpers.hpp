#pragma once

#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "drawing_helpers.hpp"
#include "files/formats.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

/// Small words for tests about SVG files.
namespace svg_test {

using rollfix::Curve;
using rollfix::Drawing;
using rollfix::Vec2;

using drawings::area_of;
using drawings::length_of;

inline Drawing parse(const std::string& text) { return rollfix::files::parse_svg(text, "test.svg"); }

/// A file with this in it.
inline std::string svg(const std::string& content, const std::string& attributes = "") {
  return "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' " + attributes + ">" +
         content + "</svg>";
}

inline Drawing drawn(const std::string& content, const std::string& attributes = "") {
  return parse(svg(content, attributes));
}

inline Drawing path(const std::string& data) { return drawn("<path d='" + data + "'/>"); }

/// What a curve was made of: "line", "arc", ...
inline std::vector<std::string> kinds(const Drawing& drawing) {
  std::vector<std::string> result;
  for (const auto& drawn : drawing.curves) result.push_back(drawn.curve.record()->kind);
  return result;
}

/// The ends of the curves, as long as each starts where the one before ends.
inline std::vector<Vec2> joints(const Drawing& drawing) {
  std::vector<Vec2> result;
  for (const auto& drawn : drawing.curves) {
    if (result.empty() || (result.back() - drawn.curve.front()).norm() > 1e-9) result.push_back(drawn.curve.front());
    result.push_back(drawn.curve.back());
  }
  return result;
}

inline std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const rollfix::InputError& error) {
    return error.what();
  }
  return "no error";
}

inline std::string message_of_path(const std::string& data) { return message_of(svg("<path d='" + data + "'/>")); }

inline std::vector<Vec2> points(std::initializer_list<Vec2> list) { return list; }

inline std::vector<double> numbers(const Drawing& drawing, std::size_t k = 0) {
  return drawing.curves.at(k).curve.record()->numbers;
}

inline double ellipse_length(double a, double b) {
  return 4 * a * boost::math::ellint_2(std::sqrt(1 - b * b / (a * a)));
}

}  // namespace svg_test
