#pragma once

#include <string>
#include <vector>

namespace rollfix {

/// The name that takes the fewest edits (letters inserted, dropped, changed, or two neighbours swapped) to get
/// from what was typed; empty when none is near enough to be what was meant.
std::string nearest_name(const std::string& typed, const std::vector<std::string>& names);

/// For an error message: "did you mean 'ellipse'? Known are: circle, ellipse", the question only where a name is near.
std::string known_names(const std::string& typed, const std::vector<std::string>& names);

}  // namespace rollfix
