#pragma once

#include <cstddef>
#include <vector>

#include "centre_path.hpp"
#include "heading_arc.hpp"
#include "measured.hpp"
#include "roll_contacts.hpp"
#include "rollfix/touch.hpp"

// What a search for poses does otherwise where contacts roll.
namespace rollfix::touch {

// Of a connected set without noise a number counts as free where it has more room than its tolerance makes: so many
// tolerances, and a share of the perimeter or radians.
inline constexpr double kFreeTolerances = 24;
inline constexpr double kFreePlace = 1e-3;
inline constexpr double kFreeHeading = 6e-3;

/// Contacts that tell the part's heading alone, without noise: connected sets of where they all can be together, each
/// as an answer. Complete: the tangent's angle is monotone on every stretch of a path, so that stretches, one for each
/// contact, go together in one connected set, or not at all.
struct HeadingSets {
  std::vector<TouchPose> poses;
  bool complete = true;  // false: the budget ran out
  std::size_t comparisons = 0;
};

HeadingSets heading_sets(const std::vector<Measured>& contacts, std::size_t budget);

/// Says where rolls end.
void add_roll_ends(const std::vector<RollContact>& rolls, const std::vector<Measured>& contacts, TouchAnswer& answer);

/// What was not decided of a roll is not decided of all contacts, and rows that fit badly fit no better together.
void take_over_doubts(const std::vector<RollContact>& rolls, TouchAnswer& answer);

/// The answer of one roll as poses.
void take_from(const RollContact& roll, TouchAnswer& answer);

}  // namespace rollfix::touch
