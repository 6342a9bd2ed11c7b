#pragma once

#include <boost/container/small_vector.hpp>
#include <cstddef>

#include "root_search.hpp"

namespace rollfix {

/// Stretches of the boundary; mostly there are few.
using Stretches = boost::container::small_vector<Interval, 4>;
/// Numbers of blocks of the part's tree.
using Blocks = boost::container::small_vector<std::size_t, 16>;

/// Pieces that touch, and the roots in them. lo <= hi, hi beyond P where it reaches across s = 0.
struct Cluster {
  double lo = 0;
  double hi = 0;
  bool exact = false;
  bool corner = false;  // all of its pieces are
  bool whole_loop = false;
  bool is_joined = false;      // of several pieces
  std::size_t first_root = 0;  // of those handed out
  std::size_t root_count = 0;
};

/// The lists that a search of one finger works with, each step clears its own: short ones are kept in place, and one
/// search after the other needs no allocation for long ones either.
struct Workspace {
  Blocks blocks;  // that a roll may start on
  Blocks fewer;   // what a further reading leaves of them
  Stretches stretches;
  Findings found;
  Findings narrowed;  // to what a further reading allows as well
  boost::container::small_vector<Cluster, kFewAnswers> clusters;
  FoundRoots handed_out;  // the roots, those of one cluster next to each other
  FoundRoots left_over;   // that no cluster holds before s = 0 is crossed
};

}  // namespace rollfix
