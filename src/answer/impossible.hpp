#pragma once

#include "rollfix/solve.hpp"
#include "steps.hpp"

namespace rollfix::answer {

/// Takes the placements out of the answer that the fingers can't reach, or in which two would be in one another: where
/// they can be is known if all of them are disks or jaws; two of any shape are followed along their log, from wherever
/// in its extent a placement starts. With an outline that takes u: of readings nothing goes.
void drop_impossible(const Problem& problem, const Observation& observed, Answer& answer);

}  // namespace rollfix::answer
