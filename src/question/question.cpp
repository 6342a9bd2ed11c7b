#include <fmt/format.h>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "answer/steps.hpp"
#include "rollfix/cpp20.hpp"  // IWYU pragma: keep
#include "rollfix/error.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"
#include "work/crew.hpp"

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

// Why an option does not go with some contacts, in one sentence each.
// Idea: two tables of reasons, one for each kind of search; an option without an entry has a general reason.

namespace {

struct Reason {
  std::string_view name;  // of the Question's field
  const char* text;       // {}: what contacts of this kind are called
};

// Of several rolls on a part at rest.
constexpr std::array<Reason, 6> kOfRollsAtRest = {{
    {"reading", "`at_rest` takes the rolls of a log"},
    {"facing", "rolls with u and psi have it themselves"},
    {"at", "`at_rest` takes rows all along every roll"},
    {"prior", "it is of the start of one roll"},
    {"direction", "rolls with u and psi say the direction themselves"},
    {"may_overlap", "it is of two fingers"},
}};

// Of several fingers on a part that moves.
constexpr std::array<Reason, 4> kOfMoving = {{
    {"reading", "{} are taken from logs"},
    {"facing", "logs of u and psi contain it"},
    {"direction", "logs of u and psi contain it"},
    {"clear", "it is about touches"},
}};

/// `contacts`: what to call contacts of this kind in the message.
template <class Reasons>
std::string reason_for(std::string_view name, const Reasons& reasons, const char* contacts) {
  // Reasons name the contacts with {} where that reads better.
  for (const Reason& one : reasons) {
    if (one.name == name) return fmt::format(fmt::runtime(one.text), contacts);
  }
  return fmt::format("it is not taken with {}", contacts);
}

}  // namespace

Uses::Uses(const Question& question)
    : question_(question), kind_(kind_of(question)), has_rolls_(!question.measured.rolls.empty()) {}

/// The field, the reason, and what to do instead.
std::string Uses::why_not(std::string_view name) const {
  // Here the advice is to give other contacts.
  if (name == "clear" && kind_ == QuestionKind::roll) {
    return "`clear` is about touches and several rolls: give `touch`, or rolls with `at_rest`, or leave `clear` out";
  }
  // Touches alone.
  if (kind_ == QuestionKind::at_rest && !has_rolls_) {
    return fmt::format("`{}`: touches do not roll and have no use for it; leave it out", name);
  }
  // Rolls on a part at rest, with or without touches.
  if (kind_ == QuestionKind::at_rest) {
    return fmt::format("`{}`: {}; leave it out, or choose one roll with `roll` N", name,
                       reason_for(name, kOfRollsAtRest, "several rolls"));
  }
  // Fingers on a part that moves.
  const bool has_wheel = !question_.measured.wheels.empty();
  const char* const contacts = has_wheel ? "fingers beside a wheel" : "three and more fingers";
  return fmt::format("`{}`: {}; leave it out", name, reason_for(name, kOfMoving, contacts));
}

void Uses::refuse(bool is_given, std::string_view name) const {
  if (is_given) throw InputError(why_not(name));
}

/// After this the kind of the question has all contacts that it needs, and none of another kind.
void require_contacts(const Question& question) {
  const Measurements& measured = question.measured;
  const QuestionKind kind = kind_of(question);
  // Wheels turn a part that moves.
  if (kind == QuestionKind::at_rest && !measured.wheels.empty()) {
    throw InputError(
        "`at_rest`: a wheel without skin says something beside a finger, of a part that both of them touch at once; "
        "leave it out, or the wheels");
  }
  // Touches are all of one pose, which a moving part does not have.
  if (kind != QuestionKind::at_rest && !measured.touches.empty()) {
    throw InputError("`touch` and a `log` of rolls share a pose with `at_rest`: add it");
  }
  // A part is squeezed between a finger and a wheel.
  if (question.squeezed && measured.wheels.empty()) {
    throw InputError(
        "`squeezed`: it is about a finger with skin and a wheel without that squeeze a part, such as a jaw and "
        "wheel,r=0.4; leave it out");
  }
  // Readings are of one roll alone.
  if (kind != QuestionKind::roll) return Uses(question).refuse(!measured.readings.empty(), "reading");
  // The kind is a roll, for want of anything else.
  if (measured.readings.empty() && measured.rolls.empty()) {
    throw InputError("expected readings, a log or touches, found none");
  }
  if (!measured.readings.empty() && !measured.rolls.empty()) {
    throw InputError("expected readings or a log, found both: they can't be of the same roll");
  }
}

}  // namespace rollfix::question

// ---- the question
// Which search answers a question, and the problem that it takes.
// Notation:
//   roll            one roll of one finger, or of two together: Problem, `roll_problem`
//   at_rest         touches and rolls on a part that stays where it is: TouchProblem, `rest_problem`
//   moving          three fingers and more, or wheels, on a part that moves: HoldProblem, `moving_problem`
// Idea: the kind follows from how many contacts of which sort there are. Each problem gets the options that it has
// fields for (`hand_over`); then what goes together is checked.
namespace rollfix {
namespace {

/// Throws InputError: contacts that don't go together, or of another kind than `expected` says.
void require_kind(const Question& question, QuestionKind kind, const char* expected) {
  question::require_contacts(question);
  // Contacts that go together, but another search answers them.
  if (kind_of(question) != kind) throw InputError(fmt::format("expected {}, found other contacts", expected));
}

/// Readings, one log, or one of each of two fingers.
/// Two logs are paired row by row, by their times.
Measurement roll_of(const Measurements& measured) {
  if (measured.rolls.size() == 2) return paired(measured.rolls[0], measured.rolls[1]);
  Measurement of_roll = measured.rolls.empty() ? Measurement(measured.readings) : Measurement(measured.rolls.front());
  // Of typed readings; a log has its own digits.
  of_roll.roundings = measured.roundings;
  return of_roll;
}

/// Throws InputError: clockwise or either, of a log of u and psi.
void require_direction(const Problem& problem, const Question& question) {
  if (question.direction.value_or(Direction::counterclockwise) == Direction::counterclockwise) return;
  // Lengths may be counted either way, u and psi are counter-clockwise.
  if (!problem.measured.is_log() || problem.measured.log->kind != LogKind::contact) return;
  throw InputError(fmt::format("`direction`: {} has u and psi, which say the direction themselves: leave it out",
                               problem.measured.log->name));
}

/// Throws InputError: a facing of one finger.
void require_facing(const Problem& problem) {
  if (!problem.facing) return;
  const Measurement& measured = problem.measured;
  // Either all readings are of two fingers, or none.
  const std::size_t fingers = measured.is_log() ? measured.log->fingers.size() : measured.readings.front().fingers();
  if (fingers != 2) throw InputError("`facing` compares two fingers: expected `reading` LA,LB,THETA with it");
}

/// Of several contacts noise and tolerance say the same twice, and may not agree.
/// Throws InputError where both are given. `measured`: what to call the measurements in the message.
void require_one_exactness(const Question& question, const char* measured) {
  if (!question.noise || !question.tolerance) return;
  throw InputError(fmt::format("`tolerance`: `noise` already says how far {} are off; leave one out", measured));
}

/// Throws InputError: more than `most`.
void require_one_finger(const std::vector<Finger>& fingers, std::size_t most) {
  if (fingers.size() <= most) return;
  throw InputError(fmt::format("`finger`: expected one, which is lifted in between, found {}", fingers.size()));
}

/// Throws InputError where no finger's shape is known.
void require_fingers(const HoldProblem& problem) {
  if (!problem.fingers.empty()) return;
  throw InputError(fmt::format(
      "`log` is given {} times, which is as many fingers on a part that is free to move: expected `finger`, once for "
      "all or once for each; rolls of one finger on a part at rest are `at_rest`",
      problem.logs.size() + problem.wheels.size()));
}

}  // namespace

/// By the contacts alone, without options but `at_rest`. Contacts that don't go together have a kind as well, under
/// which `require_contacts` refuses them.
QuestionKind kind_of(const Question& question) {
  const Measurements& measured = question.measured;
  const std::size_t rolls = measured.rolls.size();
  if (measured.at_rest || (rolls == 0 && measured.wheels.empty())) {
    // A roll of one row says where it touched, and nothing of a roll.
    const bool is_touch = rolls == 1 && measured.rolls.front().rows() == 1;  // of a finger with skin
    // One roll, or readings: at rest or not makes no difference to it.
    const bool is_one = measured.touches.empty() && rolls <= 1 && measured.wheels.empty() && !is_touch;
    return is_one ? QuestionKind::roll : QuestionKind::at_rest;
  }
  // One or two logs without wheels are one roll of one finger or of two.
  return rolls > 2 || !measured.wheels.empty() ? QuestionKind::moving : QuestionKind::roll;
}

/// Throws InputError: another kind of contacts, options that don't go with them.
Problem roll_problem(const Question& question) {
  require_kind(question, QuestionKind::roll, "readings or one roll");
  Problem problem{question.part, roll_of(question.measured), question.fingers};
  question::hand_over(question, problem);
  require_direction(problem, question);
  require_facing(problem);
  require_noise(problem);
  if (question.tolerance) {
    // A roll is compared by its turns alone.
    if (question.tolerance->length != 0) {
      throw InputError("`tolerance`: of one roll it is an angle, found a length as well; leave that out");
    }
    problem.tolerance = question.tolerance->angle;
  }
  // The part face down (`mirrored`) stays in the problem; counting clockwise is done here.
  return View{false, question.direction == Direction::clockwise}.of(problem);
}

/// Throws InputError likewise. Without a finger contacts are points.
TouchProblem rest_problem(const Question& question) {
  require_kind(question, QuestionKind::at_rest, "touches, or several rolls of a part at rest");
  const Measurements& measured = question.measured;
  TouchProblem problem{question.part, measured.touches};
  question::hand_over(question, problem);
  require_one_exactness(question, measured.rolls.empty() ? "touches" : "rows");
  require_one_finger(question.fingers, 1);
  // All touches are of one finger.
  if (!question.fingers.empty()) problem.finger = question.fingers.front();
  problem.rolls = measured.rolls;
  problem.tolerance = question.tolerance;
  return problem;
}

/// Throws InputError likewise.
HoldProblem moving_problem(const Question& question) {
  require_kind(question, QuestionKind::moving, "three fingers or more, or wheels beside fingers");
  HoldProblem problem{question.part, question.measured.rolls, question.fingers};
  problem.wheels = question.measured.wheels;
  question::hand_over(question, problem);
  // Without noise `at` says which rows are searched with.
  if (question.noise && !question.at.empty()) {
    throw InputError("`at`: with `noise` all rows are used; leave it out");
  }
  require_one_exactness(question, "rows");
  require_fingers(problem);
  problem.tolerance = question.tolerance;
  return problem;
}

/// The three answers are one type from here on.
Solution solve(const Question& question) {
  switch (kind_of(question)) {
    case QuestionKind::at_rest:
      return solve(rest_problem(question));
    case QuestionKind::moving:
      return solve(moving_problem(question));
    case QuestionKind::roll:
      break;
  }
  return solve(roll_problem(question));
}

/// Questions are independent: each has a solution or a message.
std::vector<Outcome> solve(std::span<const Question> questions, const ManyOptions& options) {
  std::vector<Outcome> outcomes(questions.size());
  each_of(questions.size(), options, [&](std::size_t k) {
    try {
      outcomes[k].solution.emplace(solve(questions[k]));
    } catch (const InputError& error) {
      outcomes[k].error = error.what();
    }
  });
  return outcomes;
}

// ---- the solution
// What answers of all kinds have in common.
// Idea: overloads for each kind of answer, called by `visit`; a template is the rule, an overload for a type the
// exception.

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
