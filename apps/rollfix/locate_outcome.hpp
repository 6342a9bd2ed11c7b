#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/pose.hpp"
#include "rollfix/dropped.hpp"
#include "rollfix/json_output.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/tolerance.hpp"
#include "rollfix/weighing.hpp"

namespace rollfix::app {

/// A search with all that it was asked.
struct LocateOutcome {
  Part part;
  std::vector<Reading> readings;
  std::vector<double> instants;  // of a log: the time of each reading, seconds
  Tolerance tolerance;
  Search found;
  std::vector<std::optional<Poses>> poses;  // of each placement at every row of a log; nothing where it does not tell
  std::vector<double> times;                // of a log with times: of those rows, seconds
  std::optional<Finger> finger{};
  Dropped<Impossible> dropped{};       // what the finger makes impossible; no longer in `found`
  std::optional<Weighing> weighing{};  // with noise; `found` lists what it leaves, the most probable first
};

/// The contract's "rollfix/locate/1"; docs/json.md lists the fields.
Json locate_json(const LocateOutcome& outcome);

/// For people: the verdict, what was asked, a table of the placements, and what is special about some.
std::string locate_text(const LocateOutcome& outcome);

/// The verdict with what to do next.
std::string advice(const LocateOutcome& outcome);

/// What --json says of a part; `inspect` says more.
Json part_json(const Part& part);

/// "the part is at x, y, turned by 12.000 deg at 3.5 s (off by ...)": the last pose.
std::string about_pose(const Poses& poses, const Part& part);

/// "crossing", "touching", "stretch", "corner".
std::string name_of(Kind kind);

}  // namespace rollfix::app
