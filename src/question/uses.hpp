#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <string>
#include <string_view>

#include "answer/steps.hpp"
#include "rollfix/question.hpp"

// Which options go with which contacts. A search takes an option if its problem has the field; what it has no use for
// is refused, with the reason that `Uses` knows for this kind of contacts.
namespace rollfix::question {

/// Why contacts of some kind have no use for an option, as a whole message.
class Uses {
 public:
  explicit Uses(const Question& question);

  /// Throws InputError where it is given all the same. `name`: of the Question's field.
  void refuse(bool is_given, std::string_view name) const;

 private:
  /// The message for this kind of contacts.
  std::string why_not(std::string_view name) const;

  const Question& question_;  // has to outlive this
  QuestionKind kind_;         // which search answers
  bool has_rolls_;            // logs of fingers are among the contacts
};

/// Throws InputError: contacts of different kinds, none at all.
void require_contacts(const Question& question);

/// The options that a search has fields for; those that it has not must not be given.
template <class Searched>
void hand_over(const Question& question, Searched& problem) {
  // A field that the problem has is handed over; what is given of the others is refused. Noise, budget and mirror are
  // taken by all searches.
  const Uses uses(question);
  problem.noise = question.noise;
  problem.budget = question.budget;
  problem.mirrored = question.mirrored;
  if constexpr (requires { problem.facing; })
    problem.facing = question.facing;
  else
    uses.refuse(question.facing.has_value(), "facing");
  if constexpr (requires { problem.at; })
    problem.at = question.at;
  else
    uses.refuse(!question.at.empty(), "at");
  if constexpr (requires { problem.prior; })
    problem.prior = question.prior;
  else
    uses.refuse(question.prior.has_value(), "prior");
  // `heading` is a pose prior without a place: its message has its own name.
  if constexpr (requires { problem.pose; })
    problem.pose = question.pose;
  else if (question.pose)
    uses.refuse(true, name_of(*question.pose));
  // Counting clockwise is no field: `roll_problem` turns the lengths.
  if constexpr (requires { problem.either_way; })
    problem.either_way = question.direction == Direction::either;
  else
    uses.refuse(question.direction.has_value(), "direction");
  if constexpr (requires { problem.robust; })
    problem.robust = question.robust;
  else
    uses.refuse(question.robust, "robust");
  if constexpr (requires { problem.may_overlap; })
    problem.may_overlap = question.may_overlap;
  else
    uses.refuse(question.may_overlap, "may_overlap");
  // Refused in `require_contacts` where no wheel is given.
  if constexpr (requires { problem.squeezed; }) problem.squeezed = question.squeezed;
  // Paths that were free before a touch.
  if constexpr (requires { problem.clear; })
    problem.clear = question.measured.clear;
  else
    uses.refuse(!question.measured.clear.empty(), "clear");
  // A search that looks for no mistakes ignores it.
  if constexpr (requires { problem.diagnose; }) problem.diagnose = question.diagnose;
}

}  // namespace rollfix::question
