#pragma once

#include <string>
#include <string_view>

#include "rollfix/outline/loops.hpp"

namespace rollfix {

struct DxfOptions {
  std::string layer;  // take only the entities on this layer; empty: on all that are shown
};

/// What a DXF file draws, ASCII or binary: see docs/files.md for the entities. Arcs and lines stay what they are.
/// `name` is what messages call the file. Throws InputError naming line and value: not a DXF, cut short, nonsense.
Drawing parse_dxf(std::string_view bytes, const std::string& name, const DxfOptions& options = {});

}  // namespace rollfix
