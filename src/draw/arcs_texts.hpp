#pragma once

#include <cstddef>
#include <vector>

#include "arcs_plan.hpp"
#include "legend.hpp"
#include "rollfix/contact/reading.hpp"
#include "rollfix/draw/svg.hpp"

namespace rollfix::draw {

/// The letter of the contact at reading k = 1, 2, ... of a placement, with its number; the first contact is k = 0.
Text contact_name(std::size_t k, std::size_t number);

/// Up to three readings in full, of more the last.
Text readings_text(const std::vector<Reading>& readings);

/// The placements with arc length at start and end; empty where the plan has no legend.
Legend legend_of(const Plan& plan);

}  // namespace rollfix::draw
