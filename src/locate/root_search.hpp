#pragma once

#include <vector>

#include "rollfix/locate/locate.hpp"
#include "spiral_pair.hpp"

namespace rollfix {

/// A set of first contacts on which |f| is within the tolerance.
struct Piece {
  double lo = 0;
  double hi = 0;
  bool exact = false;   // f = 0 on all of it
  bool corner = false;  // a single point, where a corner's pivot makes up the difference
};

/// A place worth looking at in a piece.
struct Root {
  double s = 0;
  bool exact = true;        // f = 0 there; false: a near miss
  bool corner = false;      // thanks to a corner's pivot
  bool crossing = false;    // strictly inside an interval on which f is monotone and changes sign
  ResidualSample sample{};  // of f at a crossing
};

/// What one reading leaves of a stretch of boundary.
struct Findings {
  std::vector<Piece> pieces;  // in rising order
  std::vector<Root> roots;
  std::vector<Interval> unresolved;
  SearchCounts counts;

  void clear() {
    pieces.clear();
    roots.clear();
  }
};

/// Branch and prune for one reading on one pair of spirals: every s with |f(s)| <= tolerance, proved complete.
class RootSearch {
 public:
  RootSearch(const LocateOptions& options, double perimeter, Findings& findings);

  /// The ends are samples of this pair.
  void run(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi);

 private:
  struct Range {
    ResidualSample lo;
    ResidualSample hi;
    int bend = 0;  // the sign of f'' where it is known
    int depth = 0;
  };

  bool is_far(const ResidualSample& lo, const ResidualSample& hi) const;
  bool is_stretch(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi);
  void decide(const SpiralPair& pair, const Range& range);
  void decide_bent(const SpiralPair& pair, const Range& range);
  void take_monotone(const SpiralPair& pair, const ResidualSample& lo, const ResidualSample& hi);
  void split_at_extremum(const SpiralPair& pair, const Range& range);
  void decide_by_polynomial(const SpiralPair& pair, const Range& range, const Panel& start, const Panel& end);
  void take_flat(const ResidualSample& lo, const ResidualSample& hi, bool exact);
  void halve(const SpiralPair& pair, const Range& range, double place);
  ResidualSample solve(const SpiralPair& pair, double level, ResidualSample lo, ResidualSample hi);
  ResidualSample sample(const SpiralPair& pair, double s) {
    findings_.counts.evaluations += 2;
    return pair.sample(s);
  }
  void add_piece(double lo, double hi, bool exact = false);

  double tolerance_;
  std::size_t budget_;
  double same_place_;  // lengths below this are rounding errors
  Findings& findings_;
  std::vector<Range> waiting_;
};

}  // namespace rollfix
