#pragma once

#include "rollfix/catalog/identify.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// Whether two parts are the same outline as far as a roll can tell, each seen from a place of its own on.
bool are_congruent(const Part& one, double from, const Part& other, double other_from, const Likeness& likeness);

}  // namespace rollfix
