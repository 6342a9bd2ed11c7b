#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "files/svg/document.hpp"
#include "files/svg/segment.hpp"
#include "files/svg/value.hpp"

namespace rollfix::svg {

/// Whether an element is one that draws: path, rect, circle, ellipse, line, polyline, polygon.
bool is_shape(std::string_view kind);

/// What it draws, before its transformations, in the direction and from the point that SVG gives it; nothing where it
/// has no size. No value: a size of it is below 0. Percentages are of `viewport`. Throws InputError with the place.
std::optional<std::vector<Subpath>> shape(const Document& document, pugi::xml_node node, const Vec2& viewport);

/// An attribute's length in user units, of which `whole` is 100 %; nothing where it is missing, empty or "auto".
/// Throws InputError: a unit or a percentage of something unknown.
std::optional<double> length_of(const Document& document, pugi::xml_node node, const char* name, double whole);

/// The subpaths of a `d` attribute, without those that are only a "move to". Throws InputError with the place of what
/// is not SVG's path grammar: unlike a viewer, which would draw what comes before it.
std::vector<Subpath> parse_path(const Value& data);

/// The points of a `points` attribute.
std::vector<Vec2> parse_point_list(const Value& points);

}  // namespace rollfix::svg
