#pragma once

#include "corner_sets.hpp"
#include "rollfix/locate.hpp"

namespace rollfix {

/// A finger's first contacts whose rolls stay on the part: all of a closed outline, of an open one what leaves room for
/// every reading. Throws InputError: a roll longer than the open curve.
Interval first_contacts(const ContactEquations& question, std::size_t finger);

/// One finger: eqs. (4) and (5). The options' tolerance is at least kTurnAccuracy. Gives all but the status.
Search search_one(const ContactEquations& question, const LocateOptions& options);

/// Two: eqs. (8) and (9), and the facing equation.
Search search_two(const ContactEquations& question, const LocateOptions& options);

}  // namespace rollfix
