#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

#include "locate/corner_sets.hpp"
#include "pair_find.hpp"
#include "rollfix/part.hpp"

namespace rollfix::locating {

// What is near is looked for along a slant, s + kSlant t: on a part that repeats itself as many pieces as repetitions
// have the same s, or the same t. By the golden ratio, which is far from all fractions.
inline constexpr double kSlant = 0.6180339887498949;

/// The place of a point along the slant, of a box the places of all its points; length.
inline double along_slant(const PairPoint& at) { return at[0] + kSlant * at[1]; }

inline Interval along_slant(const PairBox& box) {
  return {along_slant(PairPoint{box[0].lo, box[1].lo}), along_slant(PairPoint{box[0].hi, box[1].hi})};
}

/// The same box, larger by this on all four sides.
inline PairBox widened(const PairBox& box, double by) {
  return {Interval{box[0].lo - by, box[0].hi + by}, Interval{box[1].lo - by, box[1].hi + by}};
}

/// Their indices in order of where they begin.
inline std::vector<std::size_t> by_place(const std::vector<Interval>& intervals) {
  std::vector<std::size_t> order(intervals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::tie(intervals[a].lo, a) < std::tie(intervals[b].lo, b); });
  return order;
}

// Lines that end closer together than this share of the perimeter continue each other.
inline constexpr double kJointWidth = 1e-8;

/// A piece that touches another one.
struct PieceLink {
  std::size_t to;
  Shift shift;  // added to the other piece brings it here
};

/// A line through all the exact pieces of a set, unwrapped.
struct FamilyLine {
  std::vector<PairPoint> points;  // each next to the one before; branches are passed twice
  double error = 0;               // how far the line may be off the set
};

/// Depth first through the exact ones among the `members` of a set; where a branch ends the line goes back the way it
/// came. REQUIRES an exact member, and of each piece the links to exact ones first.
FamilyLine line_through_family(const std::vector<PairPiece>& pieces, const std::vector<std::vector<PieceLink>>& links,
                               const std::vector<std::size_t>& members, double period);

/// Does a line, moved by `shift`, come as near as `slack` to a box?
bool line_meets(const std::vector<PairPoint>& line, const Shift& shift, const PairBox& box, double slack);

/// Of each piece those that it touches, across s = 0 and t = 0 on a closed outline; exact ones first, so that a walk
/// along a family leaves it only where it must. Elsewhere it is enough that what hangs together does so by some links.
/// `same_place`: pieces that come as near as this are one.
std::vector<std::vector<PieceLink>> links_of(const std::vector<PairPiece>& pieces, const Boundary& boundary,
                                             double same_place);

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

/// One placement for each connected set: its kind, its roots, how sure they are; ordered by start.
std::vector<Placement> make_placements(const ContactEquations& question, const std::vector<PairCluster>& clusters);

}  // namespace rollfix::locating
