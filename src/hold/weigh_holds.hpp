#pragma once

#include <cstddef>
#include <vector>

#include "box_search.hpp"
#include "hold_modes.hpp"
#include "rollfix/hold.hpp"

namespace rollfix::hold {

// Places in a set from which a fit starts.
inline constexpr std::size_t kStarts = 8;

/// Boxes that hang together, with what was found in them.
struct FoundSet {
  std::vector<Box> boxes;
  HeldSet set;
};

/// The first contacts in the middle of one of a set's boxes, `look` of `looks` through it.
std::vector<double> middle_of_box(BoxSearch& search, const FoundSet& found, std::size_t look, std::size_t looks);

/// How much is looked at: at a glance the likeliest place, by few starts, that may be missed.
enum class Care { full, glance };

/// With noise: the posterior over these sets, into the answer. `searched`: of the rows those that were searched with.
void weigh(const HoldProblem& problem, const HeldRows& rows, const HeldRows& searched,
           const std::vector<FoundSet>& found, BoxSearch& search, const WheelPaths& wheels, Care care,
           HoldAnswer& answer);

}  // namespace rollfix::hold
