#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "centre_path.hpp"
#include "heading_arc.hpp"
#include "measured.hpp"
#include "roll_belief.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

// Rolls as contacts, and what a search for poses does otherwise where contacts roll.
namespace rollfix::touch {

/// A roll as a contact: its first one, on what its readings leave of the boundary.
/// `measured` points to `tree` and `belief`, which stay where they are when a contact is moved.
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

// Of a connected set without noise a number counts as free where it has more room than its tolerance makes: so many
// tolerances, and a share of the perimeter or radians.
inline constexpr double kFreeTolerances = 24;
inline constexpr double kFreePlace = 1e-3;
inline constexpr double kFreeHeading = 6e-3;

/// Contacts that tell the part's heading alone, without noise: connected sets of where they all can be together, each
/// as an answer. Complete: the tangent's angle is monotone on every stretch of a path, so that stretches, one for each
/// contact, go together in one connected set, or not at all.
struct HeadingSets {
  std::vector<TouchPose> poses;
  bool complete = true;  // false: the budget ran out
  std::size_t comparisons = 0;
};

/// `budget`: sets of stretches; no more than 200,000 are compared.
HeadingSets heading_sets(const std::vector<Measured>& contacts, std::size_t budget);

/// Says where rolls end.
/// Sets `end` and `extent` of rolls' contacts in all poses; `contacts`: of the search, rolls first.
void add_roll_ends(const std::vector<RollContact>& rolls, const std::vector<Measured>& contacts, TouchAnswer& answer);

/// What was not decided of a roll is not decided of all contacts, and rows that fit badly fit no better together.
void take_over_doubts(const std::vector<RollContact>& rolls, TouchAnswer& answer);

/// The answer of one roll as poses.
void take_from(const RollContact& roll, TouchAnswer& answer);

}  // namespace rollfix::touch
