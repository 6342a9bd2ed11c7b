#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "centre_path.hpp"
#include "measured.hpp"
#include "roll_belief.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// A roll as a contact: its first one, on what its readings leave of the boundary.
struct RollContact {
  Answer alone;  // without the other contacts
  Confined confined;
  std::unique_ptr<CentrePath> path;    // where that is
  std::unique_ptr<PathTree> tree;      // likewise; null where the path is empty
  std::unique_ptr<RollBelief> belief;  // with noise
  Measured measured;
  double travelled = 0;  // by its last row, along the stored outline
  double log_evidence =
      0;  // with noise: log of the likelihood of its rows, summed over all poses and over the boundary

  /// It fits no place of the part by itself.
  bool fits_nowhere() const {
    return alone.verdict.name == Verdict::inconsistent || !tree || (belief && belief->nodes().empty());
  }
};

/// A roll of the problem as one of one finger. Throws InputError: no finger is known, or the log does not have u and
/// psi.
Problem alone(const TouchProblem& problem, const Log& log);

/// The problem's rolls. Which of the centres are evidence: all that are known, unless noise leaves them out; where no
/// contact's is, the first roll's is the reference.
std::vector<RollContact> roll_contacts(const TouchProblem& problem);

/// Confines a contact to where the readings of its roll alone, `alone`, leave it: a finger of this radius.
void confine_by_readings(RollContact& contact, const Part& part, double radius);

/// What of a roll goes into an answer.
RollFacts facts_of(const RollContact& contact, const Log& log);

}  // namespace rollfix::touch
