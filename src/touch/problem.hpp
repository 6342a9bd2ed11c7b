#pragma once

#include <optional>
#include <vector>

#include "centre_path.hpp"
#include "measured.hpp"
#include "roll_contacts.hpp"
#include "rollfix/touch.hpp"

// A problem as the search takes it: what of it is refused, all contacts alike, and of a part that lies face down what
// is seen in the mirror x = -x, where it does not.
namespace rollfix::touch {

/// Throws InputError as `solve` says.
void require_valid(const TouchProblem& problem);

/// The finger's; 0 of a point. REQUIRES a valid problem.
double radius_of(const TouchProblem& problem);

/// All contacts of a problem as the search takes them, rolls first, with what they point to.
struct AllContacts {
  /// `radius`: of the finger that touches.
  AllContacts(const TouchProblem& problem, double radius) : AllContacts(problem, radius, roll_contacts(problem)) {}
  /// `of_rolls` in place of the problem's.
  AllContacts(const TouchProblem& problem, double radius, std::vector<RollContact> of_rolls);
  AllContacts(const AllContacts&) = delete;
  AllContacts& operator=(const AllContacts&) = delete;

  std::vector<RollContact> rolls;
  std::vector<Measured> each;
  std::optional<CentrePath> path;  // of the centre of the finger that touches; none if none does
  std::optional<PathTree> tree;

  /// One of them can be nowhere on the part, whatever the others say.
  bool one_fits_nowhere() const;
};

TouchProblem in_mirror(const TouchProblem& problem);
/// Its first contact; readings are along the outline as it is.
RollSearched in_mirror(RollSearched roll);

/// Back into the world: poses, and what rolls say.
void out_of_mirror(TouchAnswer& answer);

}  // namespace rollfix::touch
