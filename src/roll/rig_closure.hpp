#pragma once

#include <Eigen/Core>
#include <memory>

#include "roll/motion.hpp"
#include "roll/track.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix::rolling {

/// What holds of a rig at one instant, and how it changes with both fingers' rotations against the part.
struct RigState {
  Vec2 rotations = Vec2::Zero();
  Walked jaw;
  Walked wheel;
  double u = 0;                                     // where on the jaw the contact is
  Vec2 pin = Vec2::Zero();                          // in the jaw's frame
  Vec2 value = Vec2::Zero();                        // what the plan says: the pin; of a squeezed rig its x, and g
  Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();  // of the value, per rotation of the jaw and of the wheel
  double margin = 0;  // length: g, whose sign stays; of a squeezed rig how stable it is, which stays above 0
};

/// The two contacts of a rig and what they say about the pin.
class RigClosure {
 public:
  /// At the start; `displacement`: the first motion of the pin, which says on which side of a corner it is. Throws
  /// InputError where a finger can't be.
  RigClosure(const Part& part, const RigPlan& plan, const Vec2& displacement);

  const RigState& first() const { return first_; }
  const Track& jaw() const { return *jaw_; }
  const Track& wheel() const { return *wheel_; }
  /// Of lengths that are small: the part's size and the wheel's.
  double size() const { return size_; }

  /// When the fingers have turned against the part by so much. Throws InputError where one of them can't.
  RigState at(const Vec2& rotations);

 private:
  RigState state(const Walked& jaw, const Walked& wheel) const;
  void start_walks(const Vec2& displacement);

  const Part& part_;
  const RigPlan& plan_;
  double size_;
  std::unique_ptr<Track> jaw_;
  std::unique_ptr<Track> wheel_;
  std::unique_ptr<Walk> jaw_walk_;
  std::unique_ptr<Walk> wheel_walk_;
  PerFinger<double> start_;  // on the first lap
  RigState first_;
};

}  // namespace rollfix::rolling
