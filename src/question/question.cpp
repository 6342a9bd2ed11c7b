#include "rollfix/question.hpp"

#include <fmt/format.h>

#include <utility>

#include "answer/steps.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"
#include "uses.hpp"
#include "work/crew.hpp"

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

/// In a message: how the fingers of this part are told.
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
  Crew crew(questions.size(), 1);
  crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) {
      try {
        outcomes[k].solution.emplace(solve(questions[k]));
      } catch (const InputError& error) {
        outcomes[k].error = error.what();
      }
    }
  });
  crew.require_done();
  return outcomes;
}

}  // namespace rollfix
