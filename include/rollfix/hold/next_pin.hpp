#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/belief/advise.hpp"
#include "rollfix/hold/hold.hpp"

namespace rollfix {

/// How the pin of a wheel without skin moves next, against the jaw beside it, to tell apart where both can be.
struct NextPin {
  std::vector<Contender> contenders{};  // where jaw and wheel touch now, the most probable first, up to kMostPinPlaces
  std::vector<double> travels{};        // of each: how far the jaw's contact travels then, along the stored outline
  /// Its lengths are the pin's: in the jaw's frame, along its surface and away from it. None where there is nothing to
  /// tell apart.
  std::optional<Advice> advice{};
  std::string why{};  // where there is none, or no motion helps: why, in words; else empty

  bool helps() const { return advice && advice->helps; }
};

/// Places that are told apart: a motion is looked at from each of them.
inline constexpr std::size_t kMostPinPlaces = 20;

/// From an answer of a jaw and one wheel to that motion: straight, while the jaw stays as it is turned. The same motion
/// of the pin moves the jaw's contact otherwise from each of the places, which its skin feels. Looked at are the
/// motions that every place which counts allows: until the wheel's normal passes through the jaw's contact. `travel`:
/// how far the pin can go in either coordinate, see AdviceOptions; none: a tenth of the perimeter either way. Throws
/// InputError: other fingers.
NextPin next_pin(const HoldAnswer& held, const std::optional<Interval>& travel = {});

}  // namespace rollfix
