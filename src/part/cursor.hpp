#pragma once

#include <cstddef>

#include "rollfix/part/turning_function.hpp"

namespace rollfix {

/// A place that moves along a boundary from spiral to spiral, lap after lap: it knows what to add to the spiral's own
/// arc lengths and angles so that both go on without a jump. Copies are cheap.
class Cursor {
 public:
  /// On the spiral that holds s: any s of a closed boundary, clamped on an open one; of two that meet there the one on
  /// this side.
  Cursor(const TurningFunction& turning, double s, Side side = Side::after) : turning_(&turning) {
    const Wrapped place = turning.boundary().reduced(s, side);
    index_ = turning.spiral_at(place.base, side);
    winding_ = place.winding;
  }
  /// On a spiral, on the first lap.
  static Cursor at_spiral(const TurningFunction& turning, std::size_t index) { return {turning, index, 0.0}; }

  std::size_t index() const { return index_; }
  const Spiral& spiral() const { return turning_->spirals()[index_]; }
  double winding() const { return winding_; }  // whole laps gone, below 0 backwards

  double shift() const { return winding_ * turning_->perimeter(); }   // adds to its arc lengths
  double lift() const { return winding_ * turning_->period_turn(); }  // adds to its angles, radians
  double lo() const { return spiral().lo + shift(); }                 // its ends, unwrapped
  double hi() const { return spiral().hi + shift(); }

  /// No spiral comes before, or after: the ends of an open boundary.
  bool is_first() const { return !turning_->closed() && index_ == 0; }
  bool is_last() const { return !turning_->closed() && index_ + 1 == turning_->spirals().size(); }

  /// To the next spiral, from the last one to the first one of the next lap; to the one before.
  void advance() {
    if (++index_ < turning_->spirals().size()) return;
    index_ = 0;
    winding_ += 1;
  }
  void retreat() {
    if (index_-- > 0) return;
    index_ = turning_->spirals().size() - 1;
    winding_ -= 1;
  }

  /// Theta on both sides of the joint where the spiral starts, unwrapped; before the first of an open boundary there is
  /// none, and both are the same.
  double angle_before() const {
    if (is_first()) return angle_after();
    if (index_ > 0) return turning_->spirals()[index_ - 1].end.angle + lift();
    return turning_->spirals().back().end.angle + (winding_ - 1) * turning_->period_turn();
  }
  double angle_after() const { return spiral().start.angle + lift(); }

 private:
  Cursor(const TurningFunction& turning, std::size_t index, double winding)
      : turning_(&turning), index_(index), winding_(winding) {}

  const TurningFunction* turning_;
  std::size_t index_ = 0;
  double winding_ = 0;
};

}  // namespace rollfix
