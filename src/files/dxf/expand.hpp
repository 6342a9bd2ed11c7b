#pragma once

#include <string>

#include "files/dxf/model.hpp"
#include "files/dxf/tags.hpp"
#include "rollfix/outline/loops.hpp"

namespace rollfix::dxf {

/// As many curves, points and cells of arrays may come out of INSERTs: ten times what a large drawing has. A file of a
/// few hundred bytes could ask for any number.
inline constexpr std::size_t kMostInserted = 1'000'000;
/// INSERTs may be nested as deep.
inline constexpr int kMostNested = 100;

/// Draws all that is shown of the file, or what is on the layer (empty: any), into the drawing's curves and notes.
/// Throws InputError: no such layer or block, nesting without end, more than kMostInserted.
void expand(const Model& model, const TagReader& reader, const std::string& layer, Drawing& drawing);

}  // namespace rollfix::dxf
