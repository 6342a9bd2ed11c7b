#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix::python {

/// What is asked of touches, checked by Python. `rows`, (n, 5): x, y, normal, and the standard deviations of both, NaN
/// for what is not there; `clear`, (n, 4): from x, y to x, y.
TouchProblem touch_problem_from(const Part& part, const Numbers& rows, const py::object& finger,
                                const py::object& noise, const std::optional<std::pair<double, double>>& tolerance,
                                const std::optional<std::vector<double>>& pose, bool mirrored,
                                const std::optional<std::size_t>& budget, const Numbers& clear);

}  // namespace rollfix::python
