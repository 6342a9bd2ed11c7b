#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/answer/answer.hpp"
#include "rollfix/belief/advise.hpp"

namespace rollfix {

/// What was found so far, and which roll tells apart what remains.
struct NextRoll {
  Answer answer;
  std::vector<Contender> contenders;  // where the contact may be now
  std::optional<Advice> advice{};     // none where there is nothing to tell apart
  std::string why{};                  // where there is none, or no roll helps: why, in words; else empty

  bool helps() const { return advice && advice->helps; }
  /// How far the tangent turns along the advised roll if this is the place, radians. REQUIRES helps().
  double turn_ahead(const Contender& contender) const;
};

/// How well what was felt for this answer tells turns and lengths apart.
AdviceOptions advice_options(const Answer& answer, const std::optional<Interval>& travel);
/// Where this finger of an answer can touch the part; nothing: anywhere, as far as is known.
std::optional<Reach> reach_for_advice(const Answer& answer);

/// From an answer of one finger to the roll to do next: with the answer's noise, within the reach of its finger.
/// `travel`: how far the finger can roll on, see AdviceOptions. Throws InputError: an answer of two fingers, and as
/// `advise` does.
NextRoll next_roll(const Answer& answer, const std::optional<Interval>& travel = {});

}  // namespace rollfix
