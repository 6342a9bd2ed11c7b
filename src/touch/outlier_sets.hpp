#pragma once

#include <functional>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Solves a problem in which every touch counts.
using SolveCounted = std::function<void(const TouchProblem&, TouchAnswer&)>;

/// The poses if any touch may be an outlier, and the verdict is yet to be made. REQUIRES noise, and two contacts or
/// more.
void solve_with_outliers(const TouchProblem& problem, const SolveCounted& solve_counted, TouchAnswer& answer);

/// Whether chance makes so many touches outliers less than once in a thousand times.
bool has_many_outliers(const TouchAnswer& answer);

}  // namespace rollfix::touch
