#pragma once

#include <cstddef>
#include <cstdint>

#include "rollfix/turning_function.hpp"

namespace rollfix {

/// A place that moves along a boundary from spiral to spiral, lap after lap: it knows what to add to the spiral's own
/// arc lengths and angles so that both go on without a jump. Copies are cheap.
class Cursor {
 public:
  /// On the spiral that holds s: any s of a closed boundary, clamped on an open one; of two that meet there the one on
  /// this side.
  Cursor(const TurningFunction& turning, double s, Side side = Side::after) : turning_(&turning) {
    // The spiral is found by its place on the first lap, and the laps are kept apart: sums of laps are exact.
    const Wrapped place = turning.boundary().reduced(s, side);
    index_ = turning.spiral_at(place.base, side);
    winding_ = place.winding;
  }
  /// The same from where a roll forwards from s goes on: what lies before a joint by no more than rounding is past it.
  static Cursor ahead(const TurningFunction& turning, double s) {
    Cursor cursor(turning, s);
    const Wrapped place = turning.boundary().reduced(s);
    const double rounding = kLengthAccuracy * turning.perimeter();
    // How far it is from s to the spiral's end.
    const auto left = [&] {
      return cursor.spiral().hi + (cursor.winding_ - place.winding) * turning.perimeter() - place.base;
    };
    while (left() <= rounding && !cursor.is_last()) cursor.advance();
    return cursor;
  }
  /// On spiral k, counted on over the laps of a closed boundary, below 0 backwards.
  static Cursor at_spiral(const TurningFunction& turning, std::int64_t k) {
    const auto count = static_cast<std::int64_t>(turning.spirals().size());
    // C++'s remainder has the sign of k: made to lie in [0, count).
    const std::int64_t index = (k % count + count) % count;
    const std::int64_t laps = (k - index) / count;  // without a rest
    return {turning, static_cast<std::size_t>(index), static_cast<double>(laps)};
  }
  /// On spiral k of the first lap, k below their number.
  static Cursor at_spiral(const TurningFunction& turning, std::size_t k) { return {turning, k, 0.0}; }

  /// Of the spiral, on the first lap.
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
  double angle_before() const { return is_first() ? angle_after() : end_before() + lift(); }
  double angle_after() const { return spiral().start.angle + lift(); }
  /// By how much it jumps there: above 0 at a convex corner.
  double jump() const { return is_first() ? 0 : spiral().start.angle - end_before(); }

 private:
  Cursor(const TurningFunction& turning, std::size_t index, double winding)
      : turning_(&turning), index_(index), winding_(winding) {}

  /// Theta where the spiral before ends, as this one's own angles go on from it.
  double end_before() const {
    return index_ > 0 ? turning_->spirals()[index_ - 1].end.angle
                      : turning_->spirals().back().end.angle - turning_->period_turn();
  }

  const TurningFunction* turning_;  // a pointer, so that cursors can be assigned
  std::size_t index_ = 0;           // of the spiral
  double winding_ = 0;              // whole laps
};

}  // namespace rollfix
