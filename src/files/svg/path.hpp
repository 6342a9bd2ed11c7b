#pragma once

#include <vector>

#include "files/svg/context.hpp"
#include "files/svg/segment.hpp"

namespace rollfix::svg {

/// The subpaths of a `d` attribute, without those that are only a "move to". Throws InputError with the place of what
/// is not SVG's path grammar: unlike a viewer, which would draw what comes before it.
std::vector<Subpath> parse_path(const Value& data);

/// The points of a `points` attribute.
std::vector<Vec2> parse_point_list(const Value& points);

}  // namespace rollfix::svg
