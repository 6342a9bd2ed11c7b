#pragma once

#include <vector>

#include "measured.hpp"
#include "roll_contacts.hpp"
#include "rollfix/touch.hpp"

// What a search for poses does otherwise where contacts roll.
namespace rollfix::touch {

/// Says where rolls end.
void add_roll_ends(const std::vector<RollContact>& rolls, const std::vector<Measured>& contacts, TouchAnswer& answer);

/// What was not decided of a roll is not decided of all contacts, and rows that fit badly fit no better together.
void take_over_doubts(const std::vector<RollContact>& rolls, TouchAnswer& answer);

/// The answer of one roll as poses.
void take_from(const RollContact& roll, TouchAnswer& answer);

}  // namespace rollfix::touch
