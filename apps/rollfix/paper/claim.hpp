#pragma once

#include <string>
#include <vector>

#include "documents/json_output.hpp"

namespace rollfix::app {

/// One line of the paper (Jia, Localization on Curved Objects Using Tactile Information, IROS 2001), and what this
/// program computes of it when it is asked.
struct Claim {
  std::string where;  // "Theorem 4", "Figure 8"
  std::string says;
  std::string get;
  bool agrees = false;
  Json figures;  // the numbers in `get`, and more of them
};

/// Lemma 2, Theorems 4 and 5, Figures 2, 3 and 7.
void add_one_finger_claims(std::vector<Claim>& claims);
/// Figures 5, 6 and 8.
void add_two_finger_claims(std::vector<Claim>& claims);

}  // namespace rollfix::app
