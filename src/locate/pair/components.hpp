#pragma once

#include <array>
#include <vector>

#include "pair_find.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// Pieces that touch, across s = 0 and t = 0 on a closed outline, and the roots in them.
struct PairCluster {
  PairBox extent;  // unwrapped: it may begin below 0
  std::array<bool, 2> whole_loop{};
  bool exact = false;
  bool corner = false;  // all of its pieces are
  std::vector<PairRoot> roots;
  PairPoint first{};              // of an exact one: where s is least, of those where t is
  std::vector<PairPoint> family;  // of an exact one: a line through all its exact pieces, unwrapped
  double family_error = 0;
};

/// Joins what touches, sorted by place.
std::vector<PairCluster> join_pieces(const Part& part, const PairFindings& findings, double same_place);

}  // namespace rollfix
