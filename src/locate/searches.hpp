#pragma once

#include <boost/container/small_vector.hpp>
#include <vector>

#include "corner_sets.hpp"
#include "placements.hpp"
#include "rollfix/locate.hpp"
#include "root_search.hpp"

namespace rollfix::locating {

/// Stretches of the boundary; mostly there are few.
using Stretches = boost::container::small_vector<Interval, 4>;

/// What the tree over the part's spirals leaves of the first contacts.
struct Candidates {
  Stretches stretches;
  SearchCounts counts;  // pairs of blocks that were looked at
};

/// The stretches of `range`, in rising order and apart, on which one finger's first contact can lie: everywhere else
/// some reading is off by more than the tolerance, whatever pivots at corners do, which bounds over runs of spirals
/// prove. They start and end where spirals do, or the range does; s = 0 of a closed outline may be in the last one, as
/// s = P. All of the range where the part has too few spirals to make it worth while.
Candidates find_candidates(const ContactEquations& question, const Interval& range, double tolerance);

/// A finger's first contacts whose rolls stay on the part: all of a closed outline, of an open one what leaves room for
/// every reading. Throws InputError: a roll longer than the open curve.
Interval first_contacts(const ContactEquations& question, std::size_t finger);

/// One finger: eqs. (4) and (5). The options' tolerance is at least kTurnAccuracy. Gives all but the status.
Search search_one(const ContactEquations& question, const LocateOptions& options);

/// Two: eqs. (8) and (9), and the facing equation.
Search search_two(const ContactEquations& question, const LocateOptions& options);

/// Joins pieces that touch into connected sets (across s = 0 on a closed outline), one placement each, and says
/// what kind of answer each is. What was found may be in any order, of all readings together.
std::vector<Placement> make_placements(const ContactEquations& question, Findings found);

}  // namespace rollfix::locating
