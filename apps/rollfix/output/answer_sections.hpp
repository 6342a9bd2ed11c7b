#pragma once

#include <string>

#include "rollfix/solve.hpp"

// What an answer's text consists of, section by section.
namespace rollfix::app {

/// The verdict with what to do next, and below it what may be wrong.
std::string verdict_lines(const Answer& answer);

/// What was asked: the part, the readings, the tolerance, the noise and what the rows are like; `verbose`: what was
/// taken as exact as well.
std::string asked_lines(const Answer& answer, bool verbose);

/// What was dropped because the fingers can't do it; `explain`: one by one.
std::string dropped_lines(const Answer& answer, bool explain);

/// The placements, with noise their probabilities; `verbose`: without noise their widths, errors, and how they move.
/// REQUIRES some.
std::string placements_table(const Answer& answer, bool verbose);

}  // namespace rollfix::app
