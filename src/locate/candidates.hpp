#pragma once

#include <boost/container/small_vector.hpp>

#include "corner_sets.hpp"
#include "rollfix/locate.hpp"

namespace rollfix {

/// Stretches of the boundary; mostly there are few.
using Stretches = boost::container::small_vector<Interval, 4>;

struct Candidates {
  Stretches stretches;
  SearchCounts counts;
};

/// The stretches of `range`, in rising order and apart, on which one finger's first contact can lie: everywhere else
/// some reading is off by more than the tolerance, whatever pivots at corners do, which bounds over runs of spirals
/// prove. They start and end where spirals do, or the range does; s = 0 of a closed outline may be in the last one, as
/// s = P. All of the range where the part has too few spirals to make it worth while.
Candidates find_candidates(const ContactEquations& question, const Interval& range, double tolerance);

}  // namespace rollfix
