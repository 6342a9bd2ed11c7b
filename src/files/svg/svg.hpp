#pragma once

#include <string>
#include <string_view>

#include "rollfix/outline/loops.hpp"

namespace rollfix {

/// What an SVG file draws: see docs/files.md for the elements. The y axis is turned up, so that what looks
/// counter-clockwise is. Lengths are in user units, or in millimetres where the file gives a physical width and a
/// viewBox. `name` is what messages call the file. Throws InputError naming line and value: not an SVG, a path that is
/// nonsense, a reference outside the file or without an end.
Drawing parse_svg(std::string_view text, const std::string& name);

}  // namespace rollfix
