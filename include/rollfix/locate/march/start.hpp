#pragma once

#include <array>
#include <cstddef>

#include "rollfix/locate/march/walker.hpp"

namespace rollfix::march {

/// One finger's two segments: phi_k(s) = Phi(s, s + L_k), k = 0 and 1. Whole loops are taken off L_k and their turn is
/// kept apart: 0 < length < P.
struct Segments {
  std::array<double, 2> length{};
  std::array<double, 2> loops_turn{};
};

/// A start s of one finger with the endpoints s + L_1 and s + L_2 of its segments. "Movement of s results in movements
/// of the endpoints [...] Updates on their total curvatures are performed along the way" (section 3.2).
class Start {
 public:
  /// The two ends stand where `start` does until it moves.
  Start(const Walker& start, const Segments& segments);

  double s() const { return start_.length(); }
  /// phi_{k+1}(s), or phi_{k+3} of finger b.
  double phi(std::size_t k) const { return ends_[k].integral() - start_.integral() + segments_->loops_turn[k]; }
  /// phi'(s) = kappa(s + L) - kappa(s).
  double slope(std::size_t k) const { return ends_[k].density() - start_.density(); }

  Start counted_by(Tally& tally) const;

  /// All three, either way.
  void move_to(double s);

  /// Towards `stop` until phi_k equals `target`. REQUIRES that sign * phi_k grows all the way. False: it falls short at
  /// `stop`, and s stands there. Where the target is reached already, s stays.
  bool move_to_value(std::size_t k, double target, int sign, double stop);

 private:
  long steps_since(const Start& before) const;
  void become(const Start& landed, const Tally& spent);
  void nudge(double by);

  const Segments* segments_;
  Tally* tally_;
  Walker start_;
  std::array<Walker, 2> ends_;
};

}  // namespace rollfix::march
