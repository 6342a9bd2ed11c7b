#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {
struct TouchProblem;
}

namespace rollfix::touch {

class PathTree;
class RollBelief;

/// A contact as the search and the fit take it: what was measured, and how far each of it may be off. The units of
/// residuals are standard deviations, without noise tolerances.
struct Measured {
  Vec2 at = Vec2::Zero();            // where the finger's centre was
  bool has_place = true;             // false: `at` is not known, or no evidence
  std::optional<double> tangent{};   // direction of the part's tangent in the world, radians: normal + pi / 2
  double place_unit = 1;             // length
  double angle_unit = 1;             // radians
  double place_most = 1;             // how far it can be off: the search's tolerance, length, ...
  double angle_most = 1;             // ... and radians
  PathTree* tree = nullptr;          // where on the part it can be; not owned
  bool is_roll = false;              // its tree is of what its readings leave
  const RollBelief* roll = nullptr;  // of a roll with noise: what all of its rows say; not owned
};

/// The touches as the search takes them. REQUIRES noise or a tolerance.
/// In the problem's order, without trees.
std::vector<Measured> measured(const TouchProblem& problem);

/// Whether such a centre only says where the part is: it is nowhere off.
/// A first roll's centre where no contact's place is evidence, see RollCentre.
bool is_reference(const Measured& contact);

}  // namespace rollfix::touch
