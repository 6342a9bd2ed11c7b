#pragma once

#include <cstddef>

#include "rollfix/locate/march/alternation.hpp"
#include "rollfix/locate/march/mode.hpp"
#include "rollfix/locate/march/pair.hpp"
#include "rollfix/locate/march/preprocessing.hpp"
#include "rollfix/locate/march/result.hpp"

namespace rollfix::march {

/// Section 2.2: slides a segment of length L once along the boundary, mode by mode, and notes each place where its
/// integral equals C. A convex boundary is one mode, and the sweep is then section 2.1.
class Sweep {
 public:
  Sweep(const Path& path, const Preprocessed& preprocessed, const Problem& problem, const Options& options);

  /// Segments, doubts and counts; starts as arc lengths in [0, P], ends not reduced to one loop.
  Result run();

 private:
  Pair first_pair(const Problem& problem);
  void start();
  void march_same_signs(const Mode& mode);
  void cross_mixed(const Mode& mode);
  void finish();

  void note(const Pair& at, const Alternation& found);
  void note_boundary();
  void reset();
  void escape(std::size_t iterations);
  void arrive();
  bool root_here() const;

  const Path& path_;
  const Preprocessed& preprocessed_;
  const Options& options_;
  Result result_;
  Tally tally_;
  Tally bisection_tally_;
  Pair pair_;
  Modes modes_;
  LimitRule rule_;
  double rounding_of_integral_;  // |phi - C| below this can't be told from zero
  double escape_amount_;         // by which the next escape begins
  int side_ = 1;                 // of phi - C at the pair's last place
  std::vector<Iterate> sequence_;
};

}  // namespace rollfix::march
