#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "rollfix/outline.hpp"

// From a file's bytes to what it draws. `name` is what messages call the file.
namespace rollfix::files {

struct DxfOptions {
  std::string layer;  // take only the entities on this layer; empty: on all that are shown
};

/// What a DXF file draws, ASCII or binary: see docs/files.md for the entities. Arcs and lines stay what they are.
/// Throws InputError naming line and value: not a DXF, cut short, nonsense.
Drawing parse_dxf(std::string_view bytes, const std::string& name, const DxfOptions& options = {});

/// What an SVG file draws: see docs/files.md for the elements. The y axis is turned up, so that what looks
/// counter-clockwise is. Lengths are in user units, or in millimetres where the file gives a physical width and a
/// viewBox. Throws InputError naming line and value: not an SVG, a path that is nonsense, a reference outside the file
/// or without an end.
Drawing parse_svg(std::string_view text, const std::string& name);

/// What a JSON file of a user's holds: a gallery shape, or curves that are still to be joined (see loops).
///   {"gallery": "ellipse", "parameters": {"a": 2, "b": 1}}
///   {"curves": [{"type": "line", "from": [0, 0], "to": [1, 0]}, ...], "closed": true, "unit": "mm"}
/// docs/files.md lists the types of curves and their fields. Either is named `name`. Throws InputError with the line or
/// the field: not JSON, a field that is missing, unknown or there twice, a value that is not allowed.
std::variant<Outline, Drawing> parse_json_outline(std::string_view text, const std::string& name);

}  // namespace rollfix::files
