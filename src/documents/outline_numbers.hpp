#pragma once

#include <string>

#include "documents/json_output.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// The boundary as samples_of gives it, as CSV with a line of titles: s,x,y,tangent,curvature, lengths with the part's
/// unit behind them as in x [mm]; the tangent in radians.
/// Numbers read back as the same doubles.
std::string outline_table(const Part& part);

/// The same as JSON: a list for each of these names.
Json outline_json(const Part& part);

}  // namespace rollfix
