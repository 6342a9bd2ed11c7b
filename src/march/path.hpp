#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/march.hpp"
#include "rollfix/outline.hpp"

namespace rollfix::march {

/// What is summed up along the boundary.
struct Span {
  double length = 0;    // integral of |alpha'| du, eq. (4)
  double integral = 0;  // integral of g |alpha'| du, eq. (5) when g is the curvature

  Span operator+(const Span& other) const { return {length + other.length, integral + other.integral}; }
  Span operator-(const Span& other) const { return {length - other.length, integral - other.integral}; }
  Span operator*(double factor) const { return {length * factor, integral * factor}; }
};

/// The integrands at one point.
struct Local {
  double speed = 0;    // |alpha'|
  double density = 0;  // g, per unit of arc length

  /// Both per unit of the parameter.
  Span spans() const { return {speed, speed * density}; }
};

/// An outline cut into steps of its parameter, with the quadrature rule that integrates over them. All that the march
/// knows of lengths and integrals comes from here: no closed form, no table.
class Path {
 public:
  /// `step` 0: on each curve the largest, of a halving sequence, that integrates each step to rounding.
  /// Throws Refusal (unresolved) for a curve on which the sequence ends before that, near a cusp for example.
  Path(Outline outline, Density density, double step);

  const Outline& outline() const { return outline_; }
  const Density& density() const { return density_; }
  bool closed() const { return outline_.closed; }
  std::size_t curves() const { return outline_.curves.size(); }
  std::size_t steps(std::size_t curve) const { return steps_[curve]; }

  std::size_t steps_per_loop() const { return steps_per_loop_; }  // T/h
  double parameter_range() const { return parameter_range_; }     // T
  std::size_t choosing_steps() const { return choosing_steps_; }

  /// By how much halving every step would change the sums of one loop, summed without regard to sign.
  const Span& loop_error() const { return loop_error_; }

  /// The part of a curve's parameter that its step number `index` covers.
  Interval step(std::size_t curve, std::size_t index) const;

  /// The integrands |alpha'| and g at parameter `u` of a curve.
  Local at(std::size_t curve, double u) const;

  /// Both integrals over a part of one step.
  Span integrate(std::size_t curve, double from, double to) const;

 private:
  /// What a curve's sums come to in `count` steps, and how far to trust them.
  struct Trial {
    Span sum;    // of the length, and of the integral's absolute values
    Span error;  // against steps of half the size, likewise
  };
  Trial try_steps(std::size_t curve, std::size_t count);
  std::size_t choose_steps(std::size_t curve);

  Outline outline_;
  Density density_;
  /// parameter range of each curve
  std::vector<Interval> domains_;
  /// equal steps of each curve
  std::vector<std::size_t> steps_;
  std::size_t steps_per_loop_ = 0;
  double parameter_range_ = 0;
  std::size_t choosing_steps_ = 0;
  Span loop_error_;
};

/// A Newton step shorter than this part of the parameter step is taken without another quadrature: what it leaves is
/// its square, a rounding error.
inline constexpr double kLastCorrection = 1e-8;

/// A point of the boundary on its step, with the sums from s = 0 up to it. On a closed outline they go on growing
/// after each loop.
struct Position {
  /// of the outline, from 0
  std::size_t curve = 0;
  std::size_t index = 0;  // of the step on its curve
  /// the curve's parameter, on that step
  double u = 0;
  Span before;  // up to the beginning of the step
  Span step;    // over the whole step
  Span here;    // up to u
  Local local;  // at u

  /// The same place with the sums that belong to it after `loops`.
  Position moved_by(const Span& loops) const;
};

/// Counts of a walker's work; see Steps.
struct Tally {
  std::size_t steps = 0;
  /// placements inside a step, on a length or on an integral
  std::size_t landings = 0;
  /// quadratures over a part of a step that they took
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

  /// The sums from s = 0 to the walker: arc length, and the integral of g.
  double length() const { return position_.here.length; }
  double integral() const { return position_.here.integral; }
  /// g at the walker.
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

  /// To a place that is known with its sums: costs nothing.
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
