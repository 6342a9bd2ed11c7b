#pragma once

#include <cstddef>
#include <optional>

#include "rollfix/locate/march/pair.hpp"
#include "rollfix/locate/march/preprocessing.hpp"

namespace rollfix::march {

/// A stretch of starts on which g(s) and g(s + L) keep their signs: convex-convex (+, +), concave-concave (-, -),
/// convex-concave (+, -) or concave-convex (-, +). It ends with s at min(z_k, sigma^-1(z_{l+1})).
struct Mode {
  int sign_s = 1;
  int sign_t = 1;
  double s_end = 0;
  double t_end = 0;                // sigma(s_end) = s_end + L
  std::optional<Position> s_mark;  // s_end, where it is known from preprocessing: a z_k
  std::optional<Position> t_mark;  // t_end, likewise

  bool mixed() const { return sign_s != sign_t; }

  /// Both endpoints to the mode's end. What is known from preprocessing costs no steps.
  void finish(Pair& pair) const;
};

/// The sequence of modes that a pair passes through, from its first place to the end of the sweep.
class Modes {
 public:
  /// `first` is the pair at s = 0. The sweep ends at s = P on a closed outline, at t = P on an open one.
  Modes(const Path& path, const Preprocessed& preprocessed, const Pair& first);

  double sweep_end() const { return sweep_end_; }

  /// The mode in which the pair is now.
  Mode at(const Pair& pair);

 private:
  bool exists(std::size_t number) const;
  double length_of(std::size_t number) const;
  Position position_of(std::size_t number) const;
  int sign_before(std::size_t number) const;
  void pass(std::size_t& next, double length) const;

  const Preprocessed* preprocessed_;
  bool closed_;
  double segment_length_;
  double sweep_end_;
  std::optional<Position> last_s_;  // the sweep's last places, where they are known
  std::optional<Position> last_t_;
  std::size_t next_s_ = 0;  // the first sign change after s, counted on through all loops
  std::size_t next_t_ = 0;  // ... after t
};

}  // namespace rollfix::march
