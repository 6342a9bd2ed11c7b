#pragma once

#include <array>
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
  /// How far the tangent turns along the advised roll if this is the place, radians; of two fingers the difference of
  /// both, a's less b's. REQUIRES helps().
  double turn_ahead(const Contender& contender) const;
};

/// What is known before any contact, for next_roll to say which roll tells most at first: places spread evenly over the
/// boundary, of two fingers pairs of places, wherever these fingers can be, apart from each other; all as probable.
/// `noise`: of the rolls to come. Throws InputError: no finger, or more than two.
Answer before_contact(const Part& part, const std::vector<Finger>& fingers, const std::optional<Noise>& noise = {},
                      bool may_overlap = false);

/// How well what was felt for this answer tells turns and lengths apart.
AdviceOptions advice_options(const Answer& answer, const std::optional<Interval>& travel);
/// Where each finger of an answer can touch the part.
class ReachForAdvice {
 public:
  explicit ReachForAdvice(const Answer& answer);
  /// As long as this lives; nullptr: anywhere, as far as is known.
  PerFinger<const Reach*> pointers() const;

 private:
  std::array<std::optional<Reach>, 2> each_;
};
/// The radii of two disks that must not overlap; nothing where that is not asked.
std::optional<PerFinger<double>> disks_for_advice(const Answer& answer, bool may_overlap);

/// From an answer of one finger or of two to the roll to do next: with the answer's noise, within the reach of its
/// fingers. `travel`: how far each finger can roll on, see AdviceOptions. `may_overlap`: as in Problem. `friction`: of
/// two fingers, the coefficient between each and the part; only rolls are advised that can be planned with it, from
/// every place that counts and where the part can be held at all (PlanProblem). Throws InputError as `advise` does,
/// and: friction of one finger, or of fingers that are not disks and jaws.
NextRoll next_roll(const Answer& answer, const std::optional<Interval>& travel = {}, bool may_overlap = false,
                   const std::optional<PerFinger<double>>& friction = {});

}  // namespace rollfix
