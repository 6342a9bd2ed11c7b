#include "rollfix/question.hpp"

// What answers of all kinds have in common.
// Idea: overloads for each kind of answer, called by `visit`; a template is the rule, an overload for a type the
// exception.
namespace rollfix {
namespace {

// What each kind of answer lists: `poses` of touches, else placements.
const auto& placements_of(const Answer& answer) { return answer.placements; }
const auto& placements_of(const TouchAnswer& answer) { return answer.poses; }
const auto& placements_of(const HoldAnswer& answer) { return answer.placements; }

template <class Any>
bool something_fits(const Any& answer) {
  return !placements_of(answer).empty();
}
// Of touches the verdict says it.
bool something_fits(const TouchAnswer& answer) { return answer.verdict.name != Verdict::inconsistent; }

template <class Any>
std::string text_of(const Any& answer) {
  return answer.verdict_text();
}
// A roll's verdict is a sentence by itself; those of other kinds need the answer.
std::string text_of(const Answer& answer) { return answer.verdict.text(); }

template <class Any>
std::optional<Noise> noise_of(const Any& answer) {
  return answer.noise;
}
// A roll's answer keeps its noise with what was weighed.
std::optional<Noise> noise_of(const Answer& answer) {
  return answer.weighing ? std::optional(answer.weighing->noise) : std::nullopt;
}

}  // namespace

/// Each of these asks the answer that there is.
const Part& Solution::part() const {
  return visit([](const auto& answer) -> const Part& { return answer.part; });
}
Status Solution::status() const {
  return visit([](const auto& answer) { return answer.status; });
}
const Verdict& Solution::verdict() const {
  return visit([](const auto& answer) -> const Verdict& { return answer.verdict; });
}
std::string Solution::verdict_text() const {
  return visit([](const auto& answer) { return text_of(answer); });
}
std::size_t Solution::count() const {
  return visit([](const auto& answer) { return placements_of(answer).size(); });
}
bool Solution::fits() const {
  return visit([](const auto& answer) { return something_fits(answer); });
}
std::optional<Noise> Solution::noise() const {
  return visit([](const auto& answer) { return noise_of(answer); });
}

}  // namespace rollfix
