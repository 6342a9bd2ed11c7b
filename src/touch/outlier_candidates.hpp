#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Numbers of touches, ascending.
using Outliers = std::vector<std::size_t>;
/// The answer by all touches but these.
using SolveWithout = std::function<TouchAnswer(const Outliers&)>;

/// Of many touches the sets of outliers that count: for each pose that all touches fit but `most`, or fewer, those that
/// do not, and sets that differ from them by one touch that is in doubt.
std::set<Outliers> outlier_candidates(const TouchProblem& problem, double radius, std::size_t most,
                                      const SolveWithout& solve_without);

}  // namespace rollfix::touch
