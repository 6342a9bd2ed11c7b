#pragma once

#include <span>

#include "corner_sets.hpp"
#include "rollfix/locate/locate.hpp"

namespace rollfix {

/// A finger's first contacts whose rolls stay on the part: all of a closed outline, of an open one what leaves room for
/// every reading. Throws InputError: a roll longer than the open curve.
Interval first_contacts(const Question& question, std::size_t finger);

struct Workspace;

/// What locate() says, into `search`, whatever was in it.
void search(const Part& part, std::span<const Reading> readings, const LocateOptions& options, Workspace& work,
            Search& search);

/// One finger: eqs. (4) and (5). The options' tolerance is at least kTurnAccuracy. Gives all but the status.
void search_one(const Question& question, const LocateOptions& options, Workspace& work, Search& search);

/// Two: eqs. (8) and (9), and the facing equation.
Search search_two(const Question& question, const LocateOptions& options);

}  // namespace rollfix
