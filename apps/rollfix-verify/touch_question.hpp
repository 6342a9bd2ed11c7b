#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "document.hpp"
#include "pose_search.hpp"

namespace rollfix_verify {

/// A stated set of poses.
struct StatedSet {
  std::array<double, 3> pose{};
  std::optional<PoseBox> extent;   // none: the pose is in another one's
  const Json* contacts = nullptr;  // nullptr: it is not said that a pose of the set fits
};

/// What a certificate of touches and rolls states, read and not yet checked. A part that lies face down is seen in the
/// mirror x = -x. Refused: numbers that can't be meant.
struct TouchQuestion {
  explicit TouchQuestion(const Document& document);

  bool is_mirrored = false;
  double radius = 0;
  std::optional<Considered> considered;
  std::size_t rolls = 0;             // the first ones of:
  std::vector<SoughtTouch> touches;  // first contacts of rolls, then touches
  bool any_place = true;             // false: nothing tells where the part is
  std::vector<StatedSet> sets;

  double mirrored(double value) const { return is_mirrored ? -value : value; }
  Interval mirrored(const Interval& one) const { return is_mirrored ? Interval{-one.hi, -one.lo} : one; }
  std::string name_of(std::size_t contact) const {
    return contact < rolls ? "roll " + std::to_string(contact) : "touch " + std::to_string(contact - rolls);
  }

 private:
  void read_contact(const Json& stated, bool is_roll);
  double place_of(const Json& stated) const;
  Interval places_of(const Json& stated) const;
  StatedSet set_of(const Json& stated) const;
};

}  // namespace rollfix_verify
