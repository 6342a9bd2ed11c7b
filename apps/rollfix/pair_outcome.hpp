#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/pair_log.hpp"
#include "rollfix/contact/pose.hpp"
#include "rollfix/draw/pair_figure.hpp"
#include "rollfix/dropped.hpp"
#include "rollfix/json_output.hpp"
#include "rollfix/locate/locate_pair.hpp"
#include "rollfix/pair_weighing.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/tolerance.hpp"

namespace rollfix::app {

/// A search for two fingers with all that it was asked.
struct PairOutcome {
  Part part;
  std::vector<PairReading> readings;
  std::vector<double> instants;  // of a log: the time of each reading, seconds
  std::optional<double> facing;
  Tolerance tolerance;
  PairSearch found;
  std::vector<std::optional<Poses>> poses;  // of each placement at every row of a log; nothing where it does not tell
  std::vector<double> times;                // of a log with times: of those rows, seconds
  Dropped<PairImpossible> dropped{};        // what the fingers make impossible; no longer in `found`
  std::optional<PairWeighing> weighing{};   // with noise; `found` lists what it leaves, the most probable first
};

/// The contract's "rollfix/locate/1" for two fingers; docs/json.md lists the fields.
Json pair_json(const PairOutcome& outcome);

/// For people, as locate_text.
std::string pair_text(const PairOutcome& outcome);

/// The figure that -o writes; it refers to the outcome.
PairFigure figure_of(const PairOutcome& outcome, const std::optional<FingerPair>& fingers);

}  // namespace rollfix::app
