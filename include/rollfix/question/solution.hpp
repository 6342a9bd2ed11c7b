#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "rollfix/answer/answer.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// The answer to a Question, of whichever kind: what all kinds have in common, and the answer itself, whose fields are
/// those of the JSON document.
class Solution {
 public:
  Solution(Answer answer) : answer_(std::move(answer)) {}       // NOLINT: each is a solution
  Solution(TouchAnswer answer) : answer_(std::move(answer)) {}  // NOLINT
  Solution(HoldAnswer answer) : answer_(std::move(answer)) {}   // NOLINT

  // Of one roll; of contacts that share one pose; of those of each instant. Null: it is of another kind.
  const Answer* roll() const { return std::get_if<Answer>(&answer_); }
  const TouchAnswer* at_rest() const { return std::get_if<TouchAnswer>(&answer_); }
  const HoldAnswer* moving() const { return std::get_if<HoldAnswer>(&answer_); }

  /// `visitor` of the answer, of whichever type.
  template <class Visitor>
  decltype(auto) visit(Visitor&& visitor) const {
    return std::visit(std::forward<Visitor>(visitor), answer_);
  }

  const Part& part() const;
  Status status() const;
  const Verdict& verdict() const;
  /// "unique", "ambiguous (2)", "unique, but the rows fit badly", ...
  std::string verdict_text() const;
  /// Connected sets of places, or of poses, that fit and are listed.
  std::size_t count() const;
  /// Whether something fits. One touch alone leaves so much that no pose is listed, and fits all the same.
  bool fits() const;
  /// With noise: whether the measurements contradict it.
  bool fits_badly() const { return verdict().fits_badly; }
  /// That the contacts were weighed with; none: without.
  std::optional<Noise> noise() const;

 private:
  std::variant<Answer, TouchAnswer, HoldAnswer> answer_;
};

}  // namespace rollfix
