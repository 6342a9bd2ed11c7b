#pragma once

#include <string_view>
#include <vector>

#include "files/svg/document.hpp"
#include "files/svg/segment.hpp"

namespace rollfix::svg {

/// Whether an element is one that draws: path, rect, circle, ellipse, line, polyline, polygon.
bool is_shape(std::string_view kind);

/// What it draws, before its transformations, in the direction and from the point that SVG gives it; nothing where it
/// has no size. Percentages are of `viewport`. Throws InputError with the place.
std::vector<Subpath> shape(const Document& document, pugi::xml_node node, const Vec2& viewport);

/// A length in user units. Throws InputError: a unit or a percentage of something unknown.
double user_units(const Value& value, double fallback, double whole);

}  // namespace rollfix::svg
