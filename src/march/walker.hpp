#pragma once

#include <cstddef>

#include "march/path.hpp"

namespace rollfix::march {

/// A Newton step shorter than this part of the parameter step is taken without another quadrature: what it leaves is
/// its square, a rounding error.
inline constexpr double kLastCorrection = 1e-8;

/// A point of the boundary on its step, with the sums from s = 0 up to it. On a closed outline they go on growing
/// after each loop.
struct Position {
  std::size_t curve = 0;
  std::size_t index = 0;  // of the step on its curve
  double u = 0;
  Span before;  // up to the beginning of the step
  Span step;    // over the whole step
  Span here;    // up to u
  Local local;  // at u

  Position moved_by(const Span& loops) const;
};

/// Counts of a walker's work; see Steps.
struct Tally {
  std::size_t steps = 0;
  std::size_t landings = 0;
  std::size_t refinements = 0;
};

/// One endpoint of the segment. In section 2 it only moves forward: step by step, and within the last step by a
/// safeguarded Newton iteration to where a target is met exactly. In section 3 it also moves back. Sums never depend on
/// the places where it stopped within a step: they are taken from the step's beginning, so that ten thousand small
/// advances add no error.
class Walker {
 public:
  Walker(const Path& path, const Position& position, Tally& tally)
      : path_(&path), tally_(&tally), position_(position) {}

  double length() const { return position_.here.length; }
  double integral() const { return position_.here.integral; }
  double density() const { return position_.local.density; }
  const Position& position() const { return position_; }

  Tally* tally() const { return tally_; }
  /// A copy whose work is counted elsewhere.
  Walker counted_by(Tally& tally) const {
    Walker copy = *this;
    copy.tally_ = &tally;
    return copy;
  }

  /// Steps entered going forward, less those entered going back, since the walker was made.
  long net_steps() const { return net_steps_; }

  void jump(const Position& position) { position_ = position; }

  /// Forward to arc length `target` (an open outline's end stops it).
  void to_length(double target);

  /// Forward until the integral equals `target`, but not beyond arc length `end`, up to which the density's sign is
  /// `sign`. False: the integral at `end` falls short of the target, and the walker stands there.
  bool to_integral(double target, int sign, double end);

  /// Forward or back to arc length `target`. On a closed outline the sums go on below 0 as they do above P.
  void move_to_length(double target);

  /// A shift by so little that the integrands do not change: no quadrature.
  void nudge(double by);

 private:
  Span at_step_end() const { return position_.before + position_.step; }
  bool last_step() const;
  bool first_step() const;
  void next_step();
  void previous_step();
  Position at_length(double target);

  const Path* path_;
  Tally* tally_;
  Position position_;
  long net_steps_ = 0;
};

/// The first position of an outline (s = 0), on its first step: costs that step.
Position first_position(const Path& path);

/// The position at the beginning of the step after this one: costs that step. REQUIRES that there is one (an outline
/// that is closed has always one).
Position next_position(const Path& path, const Position& position);

/// The position at the end of the step before this one: costs that step. REQUIRES that there is one.
Position previous_position(const Path& path, const Position& position);

}  // namespace rollfix::march
