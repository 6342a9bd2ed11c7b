#pragma once

// One question for all kinds of contacts: the library knows which search answers it.
//
//     Measurements measured;
//     measured.readings = {Reading(1.0, 0.5)};
//     Question question(load_part("gallery:ellipse,a=2,b=1"), measured);
//     solve(question).verdict_text();  // "ambiguous (4)"
//
// Degenerate cases and accuracy are those of the search that answers: rollfix/solve.hpp, touch.hpp, hold.hpp. Contacts
// or options that don't go together are an InputError that names the field.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "rollfix/hold.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

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

// One question for all contacts with a rigid part: a roll, several rolls, touches, any number of fingers. What they
// have in common is the part's pose: of a part at rest one for all contacts, of one that moves one for each instant.
namespace rollfix {

/// All that touched the part.
struct Measurements {
  std::vector<Reading> readings{};     // of one roll, of one finger or of two, in place of its log
  std::vector<Rounding> roundings{};   // how far the digits of readings, and of the facing, may be off; none: exact
  std::vector<Log> rolls{};            // a log of each finger, or of each roll; one log may be of two fingers
  std::vector<PassiveWheel> wheels{};  // without skin, beside the fingers of these logs
  std::vector<MeasuredTouch> touches{};
  std::vector<Clear> clear{};  // where nothing was felt
  /// Of several logs: one finger rolled again and again, and the part stayed where it was. Else they are of as many
  /// fingers, at the same instants, on a part that is free to move. Touches alone, and one roll of one finger, are of a
  /// part at rest in any case.
  bool at_rest = false;
};

/// Which way round the part lengths and distances count as positive. Logs of u and psi say it themselves.
enum class Direction { counterclockwise, clockwise, either };

/// What is asked of a part and its contacts. What a field is not taken with is refused, never ignored.
struct Question {
  Question(Part asked_of, Measurements all, std::vector<Finger> with = {}, const std::optional<Noise>& stated = {})
      : part(std::move(asked_of)), measured(std::move(all)), fingers(std::move(with)), noise(stated) {}

  Part part;
  Measurements measured;
  std::vector<Finger> fingers;                // one that serves all, or one for each log; none: not known, or a point
  std::optional<Noise> noise;                 // none: exact but for the tolerance, or the digits
  std::optional<TouchTolerance> tolerance{};  // without noise; of one roll an angle, and the length is 0
  std::optional<std::size_t> budget{};        // of the search that is taken
  std::optional<double> facing{};             // of readings of two fingers, radians
  std::vector<double> at{};                   // instants of logs to search with, seconds
  std::optional<Prior> prior{};               // with noise: about where the finger, of several finger a, started
  std::optional<PosePrior> pose{};            // with noise: about how the part lies
  std::optional<double> squeezed{};           // see HoldProblem
  std::optional<Direction> direction{};       // none: counter-clockwise
  bool mirrored = false;                      // the part lies face down
  bool robust = false;                        // with noise: outliers don't count
  bool may_overlap = false;                   // fingers at different heights
  bool diagnose = true;                       // if the contacts contradict the noise, the usual mistakes are tried
};

/// What contacts share, and with it which search answers.
enum class QuestionKind {
  roll,     // one roll: of one finger on a part at rest, or of two on one that is free to move
  at_rest,  // touches, several rolls, or both: all contacts share one pose
  moving    // several fingers, or wheels: the contacts of an instant share one
};
QuestionKind kind_of(const Question& question);

// The question as the search of its kind takes it. Throw InputError: contacts of another kind, and an option that this
// search has no use for, by the name of the Question's field in backticks; of contacts `reading`, `log` and `touch`.
Problem roll_problem(const Question& question);
TouchProblem rest_problem(const Question& question);
HoldProblem moving_problem(const Question& question);

/// Every place, or pose, that fits all contacts; there is no other where the status is `complete`. Throws InputError:
/// what goes with what not, and what `solve` of the problem of its kind throws.
Solution solve(const Question& question);

/// A solution, or why there is none: what `solve` of that question throws as InputError.
struct Outcome {
  std::optional<Solution> solution{};
  std::string error{};
};

/// A solution to each question, in order; the same bits with any number of threads. Throws what `solve` throws but
/// InputError, and InputError where go_on stopped it.
std::vector<Outcome> solve(std::span<const Question> questions, const ManyOptions& options = {});

}  // namespace rollfix
