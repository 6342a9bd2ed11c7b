#pragma once

#include <optional>
#include <vector>

#include "centre_path.hpp"
#include "measured.hpp"
#include "path_tree.hpp"
#include "roll_contacts.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

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

}  // namespace rollfix::touch
