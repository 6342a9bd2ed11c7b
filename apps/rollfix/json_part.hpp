#pragma once

#include <string>

#include "rollfix/outline/outline.hpp"

namespace rollfix::app {

/// Whether a PART names a JSON file, by its ending.
bool is_json_part(const std::string& path);

/// The gallery shape of a file such as {"gallery": "ellipse", "parameters": {"a": 2}}, named after the file.
/// Throws InputError: not readable, not JSON (line and column), or something else than such an object.
Outline load_json_part(const std::string& path);

}  // namespace rollfix::app
