#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/answer/part_facts.hpp"
#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/files/load_part.hpp"
#include "rollfix/output/json_output.hpp"
#include "rollfix/part/reach.hpp"

namespace rollfix::app {

/// What `inspect` says of a part.
struct InspectOutcome {
  Part part;
  std::string unit;         // of a drawing, empty: not known
  std::vector<Loop> loops;  // of a drawing
  std::size_t loop = 0;     // the one that the part is, counted from 1
  Box box;
  Interval curvature;
  double largest_disk = 0;
  int symmetry = 1;
  std::vector<Ambiguity> ambiguity;
  std::optional<Finger> finger{};  // --finger, and ...
  std::optional<Reach> reach{};    // ... how far it can reach
};

InspectOutcome look_at(const LoadedPart& loaded);

/// The contract's "rollfix/inspect/1"; docs/json.md lists the fields.
Json inspect_json(const InspectOutcome& outcome);

/// For people.
std::string inspect_text(const InspectOutcome& outcome);

}  // namespace rollfix::app
