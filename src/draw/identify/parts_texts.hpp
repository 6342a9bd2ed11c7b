#pragma once

#include <string>
#include <vector>

#include "draw/identify/parts_plan.hpp"

// What is written in a figure of parts.
namespace rollfix::draw {

inline constexpr double kNoteSize = 10;  // of all but names, pixels

/// The first placements, each with its start and its end.
Legend panel_legend(const Plan& plan, double width);

/// "2 places", "any place", and what is wrong with them.
std::string places_text(const Plan& plan);

/// "can't be told from a, b and 3 more", as many names as there is room for.
std::string congruent_text(const std::vector<std::string>& names, double width);

/// "2 of 1802 parts fit"; empty: it is not known of how many.
std::string fit_text(const PartsFigure& figure);

/// The readings, which are those of all parts; of two fingers what is whose.
Text roll_text(const PartsPlan& plan);

/// What the drawings leave unsaid, as lines that fit on the page.
std::vector<std::string> footer_of(const PartsPlan& plan);

}  // namespace rollfix::draw
