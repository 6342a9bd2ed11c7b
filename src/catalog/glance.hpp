#pragma once

#include <cstddef>
#include <vector>

#include "bounds/bounds.hpp"
#include "rollfix/identify.hpp"

namespace rollfix {

/// Of these parts those that may be something next to the likeliest of them, or of those whose weights are known
/// already, by a roll of one finger with noise: all rows are looked at, but joined to a few, and only where bounds let
/// a roll start. No part is left out that has more than exp(-20) of its weight.
std::vector<std::size_t> worth_a_look(const Catalog& catalog, const Problem& like, const std::vector<PartLeft>& parts,
                                      std::vector<PartWeight> known, const IdentifyOptions& options);

/// Whether a glance tells anything: not without noise, of two fingers, or with stray rows among them.
bool can_glance(const Problem& like);

}  // namespace rollfix
