#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "held_rows.hpp"
#include "spin_set.hpp"
#include "touch/heading_arc.hpp"
#include "wheel_path.hpp"

namespace rollfix::hold {

using WheelPaths = std::vector<std::unique_ptr<WheelPath>>;  // of each wheel; nearest places need not const

/// Where a finger's contact is at an instant, in the part's frame and in the world, and how far off that can be.
struct HeldFrom {
  Vec2 point = Vec2::Zero();
  Vec2 at = Vec2::Zero();
  double reach = 0;    // length: the arc's, and of what was measured
  double place = 0;    // of it what was measured
  double heading = 0;  // one of the part's, radians, unwrapped over all instants
};

/// What of a wheel suits some arc of a finger's contacts at one instant.
struct PinFound {
  std::vector<Interval> spins;       // what the encoder's zero can be
  bool any_spin = false;             // it can be anything
  std::vector<PinStretch> touching;  // where the wheel can touch
};

/// Whether wheels can touch the part where their pins were. What is tested follows from "there is a heading in this
/// arc, and a contact within reach, with every residual within its slack".
class PinSearch {
 public:
  /// `instants`: rows that are searched with.
  PinSearch(const HeldRows& rows, const std::vector<std::size_t>& instants, const WheelPaths& paths);

  std::size_t wheels() const { return wheels_.size(); }
  bool has_spin(std::size_t wheel) const { return wheels_[wheel].spin.has_value(); }
  SpinSet any_spin(std::size_t wheel) const { return SpinSet(paths_[wheel]->spin_period()); }
  Vec2 pin(std::size_t wheel, std::size_t instant) const { return pins_[instant][wheel].at; }
  /// How far off a pin can be.
  double slack(std::size_t wheel) const;
  /// Places that were compared since this was made.
  std::size_t looks() const { return looks_; }

  /// `found`: filled if given, else any place will do.
  bool may_touch(std::size_t wheel, std::size_t instant, const HeldFrom& from, const touch::HeadingArc& heading,
                 PinFound* found);

 private:
  struct Question;
  bool look(const Question& question, double middle, double half, std::size_t& left);
  bool keep_touching(const Question& question, double middle, double half, const Vec2& point, double reach);
  double spin_slack(std::size_t wheel, std::size_t instant) const;

  bool has_noise_;
  std::vector<HeldWheel> wheels_;
  std::vector<std::vector<HeldPin>> pins_;  // of each instant, of each wheel
  const WheelPaths& paths_;
  std::size_t looks_ = 0;
};

}  // namespace rollfix::hold
