#pragma once

#include <vector>

#include "rollfix/hold.hpp"
#include "weigh_holds.hpp"

namespace rollfix::hold {

/// `solve` of a problem, without looking for mistakes. At a glance, of a problem with noise, nothing is proved.
HoldAnswer solve_plain(const HoldProblem& problem, Care care = Care::full);

/// The usual mistakes, each tried: those without which the logs fit, else those with which they fit far better, the
/// likeliest first. `as_said`: the answer as it is. Without noise logs are looked at as if they had a little.
std::vector<HoldDiagnosis> mistakes(const HoldProblem& problem, const HoldAnswer& as_said);

}  // namespace rollfix::hold
