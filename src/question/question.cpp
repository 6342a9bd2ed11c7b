#include "rollfix/question.hpp"

#include <fmt/format.h>

#include <utility>

#include "answer/steps.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"
#include "uses.hpp"
#include "work/crew.hpp"

namespace rollfix {
namespace {

void require_kind(const Question& question, QuestionKind kind, const char* expected) {
  question::require_contacts(question);
  if (kind_of(question) != kind) throw InputError(fmt::format("expected {}, found other contacts", expected));
}

/// Readings, one log, or one of each of two fingers.
Measurement roll_of(const Measurements& measured) {
  if (measured.rolls.size() == 2) return paired(measured.rolls[0], measured.rolls[1]);
  Measurement of_roll = measured.rolls.empty() ? Measurement(measured.readings) : Measurement(measured.rolls.front());
  of_roll.roundings = measured.roundings;
  return of_roll;
}

void require_direction(const Problem& problem, const Question& question) {
  if (question.direction.value_or(Direction::counterclockwise) == Direction::counterclockwise) return;
  if (!problem.measured.is_log() || problem.measured.log->kind != LogKind::contact) return;
  throw InputError(fmt::format("`direction`: {} has u and psi, which say the direction themselves: leave it out",
                               problem.measured.log->name));
}

void require_facing(const Problem& problem) {
  if (!problem.facing) return;
  const Measurement& measured = problem.measured;
  const std::size_t fingers = measured.is_log() ? measured.log->fingers.size() : measured.readings.front().fingers();
  if (fingers != 2) throw InputError("`facing` compares two fingers: expected `reading` LA,LB,THETA with it");
}

/// Of several contacts noise and tolerance say the same twice, and may not agree.
void require_one_exactness(const Question& question, const char* measured) {
  if (!question.noise || !question.tolerance) return;
  throw InputError(fmt::format("`tolerance`: `noise` already says how far {} are off; leave one out", measured));
}

void require_one_finger(const std::vector<Finger>& fingers, std::size_t most) {
  if (fingers.size() <= most) return;
  throw InputError(fmt::format("`finger`: expected one, which is lifted in between, found {}", fingers.size()));
}

/// In a message: how the fingers of this part are told.
void require_fingers(const HoldProblem& problem) {
  if (!problem.fingers.empty()) return;
  throw InputError(fmt::format(
      "`log` is given {} times, which is as many fingers on a part that is free to move: expected `finger`, once for "
      "all or once for each; rolls of one finger on a part at rest are `at_rest`",
      problem.logs.size() + problem.wheels.size()));
}

}  // namespace

QuestionKind kind_of(const Question& question) {
  const Measurements& measured = question.measured;
  const std::size_t rolls = measured.rolls.size();
  if (measured.at_rest || (rolls == 0 && measured.wheels.empty())) {
    const bool is_touch = rolls == 1 && measured.rolls.front().rows() == 1;  // of a finger with skin
    const bool is_one = measured.touches.empty() && rolls <= 1 && measured.wheels.empty() && !is_touch;
    return is_one ? QuestionKind::roll : QuestionKind::at_rest;
  }
  return rolls > 2 || !measured.wheels.empty() ? QuestionKind::moving : QuestionKind::roll;
}

Problem roll_problem(const Question& question) {
  require_kind(question, QuestionKind::roll, "readings or one roll");
  Problem problem{question.part, roll_of(question.measured), question.fingers};
  question::hand_over(question, problem);
  require_direction(problem, question);
  require_facing(problem);
  require_noise(problem);
  if (question.tolerance) {
    if (question.tolerance->length != 0) {
      throw InputError("`tolerance`: of one roll it is an angle, found a length as well; leave that out");
    }
    problem.tolerance = question.tolerance->angle;
  }
  return View{false, question.direction == Direction::clockwise}.of(problem);
}

TouchProblem rest_problem(const Question& question) {
  require_kind(question, QuestionKind::at_rest, "touches, or several rolls of a part at rest");
  const Measurements& measured = question.measured;
  TouchProblem problem{question.part, measured.touches};
  question::hand_over(question, problem);
  require_one_exactness(question, measured.rolls.empty() ? "touches" : "rows");
  require_one_finger(question.fingers, 1);
  if (!question.fingers.empty()) problem.finger = question.fingers.front();
  problem.rolls = measured.rolls;
  problem.tolerance = question.tolerance;
  return problem;
}

HoldProblem moving_problem(const Question& question) {
  require_kind(question, QuestionKind::moving, "three fingers or more, or wheels beside fingers");
  HoldProblem problem{question.part, question.measured.rolls, question.fingers};
  problem.wheels = question.measured.wheels;
  question::hand_over(question, problem);
  if (question.noise && !question.at.empty()) {
    throw InputError("`at`: with `noise` all rows are used; leave it out");
  }
  require_one_exactness(question, "rows");
  require_fingers(problem);
  problem.tolerance = question.tolerance;
  return problem;
}

Solution solve(const Question& question) {
  switch (kind_of(question)) {
    case QuestionKind::at_rest:
      return solve(rest_problem(question));
    case QuestionKind::moving:
      return solve(moving_problem(question));
    default:
      return solve(roll_problem(question));
  }
}

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
