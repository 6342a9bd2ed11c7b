#pragma once

#include <string>
#include <vector>

#include "rollfix/json_output.hpp"
#include "rollfix/part_facts.hpp"

namespace rollfix::app {

/// What `inspect` says of a part.
struct InspectOutcome {
  Part part;
  Box box;
  Interval curvature;
  double largest_disk = 0;
  int symmetry = 1;
  std::vector<Ambiguity> ambiguity;
};

InspectOutcome look_at(const Part& part);

/// The contract's "rollfix/inspect/1"; docs/json.md lists the fields.
Json inspect_json(const InspectOutcome& outcome);

/// For people.
std::string inspect_text(const InspectOutcome& outcome);

}  // namespace rollfix::app
