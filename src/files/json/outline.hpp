#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "rollfix/outline/loops.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix {

/// What a JSON file of a user's holds: a gallery shape, or curves that are still to be joined (see loops).
///   {"gallery": "ellipse", "parameters": {"a": 2, "b": 1}}
///   {"curves": [{"type": "line", "from": [0, 0], "to": [1, 0]}, ...], "closed": true, "unit": "mm"}
/// docs/files.md lists the types of curves and their fields. Either is named `name`, which is what messages call the
/// file. Throws InputError with the line or the field: not JSON, a field that is missing, unknown or there twice, a
/// value that is not allowed.
std::variant<Outline, Drawing> parse_json_outline(std::string_view text, const std::string& name);

}  // namespace rollfix
