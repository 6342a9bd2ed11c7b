#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/answer/part_facts.hpp"
#include "rollfix/contact/finger.hpp"
#include "rollfix/files/load_part.hpp"
#include "rollfix/part/reach.hpp"

namespace rollfix {

/// What a part is: how large, how curved, how ambiguous rolls on it are, where a finger can touch it.
struct Inspection {
  Part part;
  std::string unit;         // of a drawing, empty: not known
  std::vector<Loop> loops;  // of a drawing
  std::size_t loop = 0;     // the one that the part is, counted from 1
  BoundingBox box;
  Interval curvature;
  double largest_disk = 0;
  int symmetry = 1;
  std::vector<Ambiguity> ambiguity;
  std::optional<Finger> finger{};  // that was asked about, and ...
  std::optional<Reach> reach{};    // ... how far it can reach
};

/// Tries rolls all along the boundary for `ambiguity`: the slow part. Throws InputError: a finger of which it is not
/// known where it can touch (see has_reach), or a disk that is not valid.
Inspection inspect(const LoadedPart& loaded, const std::optional<Finger>& finger = {});

}  // namespace rollfix
