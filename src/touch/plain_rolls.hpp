#pragma once

#include <vector>

#include "roll_contacts.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Rolls as contacts by the readings that were searched with alone, without noise: also where other rows of the log
/// contradict them, or where the finger could not have rolled. `tolerance`: of each, first those of rolls.
/// Throws InputError as `locate` does.
std::vector<RollContact> plain_rolls(const Part& part, double radius, const std::vector<RollSearched>& rolls,
                                     const std::vector<TouchTolerance>& tolerance);

}  // namespace rollfix::touch
