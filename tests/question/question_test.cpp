// One question for all contacts with a part: the library decides which search answers, and what goes with what.
#include "rollfix/question.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "hold/hold_cases.hpp"
#include "hold/rig_cases.hpp"
#include "refusal.hpp"
#include "rollfix/files.hpp"
#include "rollfix/solve.hpp"
#include "touch/roll_cases.hpp"

namespace question_test {
namespace {

using namespace hold_cases;
using rollfix::Direction;
using rollfix::disk;
using rollfix::format_solution;
using rollfix::Measurements;
using rollfix::Outcome;
using rollfix::Question;
using rollfix::QuestionKind;
using rollfix::Reading;
using rollfix::Solution;
using rollfix::Status;
using testing::HasSubstr;
using testing::StartsWith;

const Part& cam() {
  static const Part part = rollfix::load_part("gallery:cam");
  return part;
}
const Part& wavy() {
  static const Part part = rollfix::load_part("gallery:spline,n=9,seed=4,wobble=0.25");
  return part;
}

double turn_of(double s, double length) { return cam().turning().angle(s + length) - cam().turning().angle(s); }

/// A roll from s = 1 on the cam, as a reading.
Question reading_question() {
  Measurements measured;
  measured.readings = {Reading(0.7, turn_of(1, 0.7))};
  return {cam(), measured};
}

Question touch_question(const TouchProblem& problem) {
  Measurements measured;
  measured.touches = problem.touches;
  measured.rolls = problem.rolls;
  measured.at_rest = !problem.rolls.empty();
  Question question(problem.part, measured, {}, problem.noise);
  if (problem.finger) question.fingers = {*problem.finger};
  question.tolerance = problem.tolerance;
  return question;
}

Question hold_question(const HoldProblem& problem) {
  Measurements measured;
  measured.rolls = problem.logs;
  measured.wheels = problem.wheels;
  return {problem.part, measured, problem.fingers, problem.noise};
}

touch_cases::Case touched() {
  std::mt19937_64 generator(3);
  return random_case(cam(), {4, 3, 0.1, 0.001, 0.01}, generator);
}

roll_cases::RollCase random_rolls_on_wavy(std::size_t touches) {
  std::mt19937_64 generator(4);
  roll_cases::Rolling rolling;
  rolling.touches = touches;
  roll_cases::RollCase one = roll_cases::random_rolls(wavy(), rolling, generator);
  if (touches > 0) one.problem.tolerance = rollfix::TouchTolerance{1e-3, 1e-3};
  return one;
}

/// Of one finger on a part at rest.
const roll_cases::RollCase& rolled_twice() {
  static const roll_cases::RollCase one = random_rolls_on_wavy(0);
  return one;
}
const roll_cases::RollCase& rolled_twice_and_touched() {
  static const roll_cases::RollCase one = random_rolls_on_wavy(2);
  return one;
}

HoldCase held(std::size_t fingers) {
  std::vector<Rolled> rolled{{1.0, 0.08}, {3.0, -0.06}, {5.0, 0.05}};
  rolled.resize(fingers);
  return hold_of(wavy(), rolled);
}

rig_cases::RigCase rig() {
  std::mt19937_64 generator(2);
  return rig_cases::random_rig(cam(), 0.04 * cam().perimeter(), generator, false, 12);
}

TEST(Question, OfAReadingOrALogIsAboutOneRoll) {
  EXPECT_EQ(kind_of(reading_question()), QuestionKind::roll);
  Question of_two_logs = hold_question(held(2).problem);
  EXPECT_EQ(kind_of(of_two_logs), QuestionKind::roll);
  of_two_logs.measured.rolls.resize(1);
  EXPECT_EQ(kind_of(of_two_logs), QuestionKind::roll);
  of_two_logs.measured.at_rest = true;  // there is nothing else that rests
  EXPECT_EQ(kind_of(of_two_logs), QuestionKind::roll);
}

TEST(Question, OfTouchesAndOfSeveralRollsOnAPartAtRestIsAboutOnePose) {
  EXPECT_EQ(kind_of(touch_question(touched().problem)), QuestionKind::at_rest);
  EXPECT_EQ(kind_of(touch_question(rolled_twice().problem)), QuestionKind::at_rest);
  EXPECT_EQ(kind_of(touch_question(rolled_twice_and_touched().problem)), QuestionKind::at_rest);
}

TEST(Question, OfThreeLogsOrOfAWheelIsAboutAPartThatMoves) {
  EXPECT_EQ(kind_of(hold_question(held(3).problem)), QuestionKind::moving);
  EXPECT_EQ(kind_of(hold_question(rig().problem)), QuestionKind::moving);
}

TEST(Question, AboutOneRollIsAnsweredWithItsStart) {
  const Solution solution = solve(reading_question());
  ASSERT_NE(solution.roll(), nullptr);
  EXPECT_TRUE(solution.fits());
  EXPECT_TRUE(std::any_of(solution.roll()->placements.begin(), solution.roll()->placements.end(),
                          [](const auto& one) { return cam().distance(one.start[0], 1) < 1e-7; }));
}

TEST(Question, AboutTwoLogsPairsThem) {
  const HoldCase one = held(2);
  const Solution solution = solve(hold_question(one.problem));
  ASSERT_NE(solution.roll(), nullptr);
  EXPECT_EQ(solution.roll()->finger_count(), 2U);
  EXPECT_TRUE(
      std::any_of(solution.roll()->placements.begin(), solution.roll()->placements.end(), [&](const auto& found) {
        return wavy().distance(found.start[0], one.starts[0]) < 1e-3 &&
               wavy().distance(found.start[1], one.starts[1]) < 1e-3;
      }));
}

TEST(Question, AboutTouchesIsAnsweredWithThePose) {
  const touch_cases::Case one = touched();
  const Solution solution = solve(touch_question(one.problem));
  ASSERT_NE(solution.at_rest(), nullptr);
  EXPECT_TRUE(std::any_of(solution.at_rest()->poses.begin(), solution.at_rest()->poses.end(),
                          [&](const TouchPose& pose) { return in_extent(pose, one.truth); }));
}

TEST(Question, AboutRollsAndTouchesOfAPartAtRestIsAnsweredWithThePose) {
  for (const roll_cases::RollCase& one : {rolled_twice(), rolled_twice_and_touched()}) {
    const Solution solution = solve(touch_question(one.problem));
    ASSERT_NE(solution.at_rest(), nullptr);
    EXPECT_EQ(solution.at_rest()->contact_count(), 2 + one.problem.touches.size());
    ASSERT_GE(solution.count(), 1U);
    EXPECT_TRUE(touch_cases::holds_heading(solution.at_rest()->poses[0].extent[2], one.truth.heading, 1e-6));
  }
}

TEST(Question, AboutThreeFingersAndAboutARigIsAnsweredWithFirstContacts) {
  const HoldCase three = held(3);
  const Solution of_three = solve(hold_question(three.problem));
  ASSERT_NE(of_three.moving(), nullptr);
  EXPECT_EQ(of_three.verdict_text(), "unique");
  EXPECT_TRUE(holds(of_three.moving()->placements.front(), three, 1e-6));
  const rig_cases::RigCase jaw_and_wheel = rig();
  const Solution of_rig = solve(hold_question(jaw_and_wheel.problem));
  ASSERT_NE(of_rig.moving(), nullptr);
  EXPECT_TRUE(std::any_of(
      of_rig.moving()->placements.begin(), of_rig.moving()->placements.end(),
      [&](const auto& found) { return cam().distance(found.contacts[0].start, jaw_and_wheel.start) < 1e-6; }));
}

TEST(Question, IsAnsweredAsTheSearchOfItsKindAnswersItsOwnProblem) {
  const Question readings = reading_question();
  EXPECT_EQ(format_solution(solve(readings)),
            format_answer(solve(rollfix::Problem{cam(), readings.measured.readings})));
  EXPECT_EQ(format_solution(solve(touch_question(touched().problem))), format_touches(solve(touched().problem)));
  EXPECT_EQ(format_solution(solve(hold_question(held(3).problem))), format_hold(solve(held(3).problem)));
}

TEST(Question, IsAnsweredWithWhatAllAnswersHaveInCommon) {
  for (const Question& question :
       {reading_question(), touch_question(touched().problem), hold_question(held(3).problem)}) {
    const Solution solution = solve(question);
    EXPECT_EQ(solution.part().name(), question.part.name());
    EXPECT_EQ(solution.status(), Status::complete);
    EXPECT_EQ(solution.noise().has_value(), question.noise.has_value());
    EXPECT_THAT(format_solution(solution), HasSubstr("\"verdict\": \"" + solution.verdict_text()));
    EXPECT_FALSE(solution.fits_badly());
  }
}

TEST(Question, OfOneTouchFitsAlthoughNoPoseIsListed) {
  TouchProblem one = touched().problem;
  one.touches.resize(1);
  const Solution solution = solve(touch_question(one));
  EXPECT_EQ(solution.count(), 0U);
  EXPECT_TRUE(solution.fits());
}

TEST(Question, SaysWhichWayRoundLengthsCount) {
  Question question = reading_question();
  question.measured.readings[0].length[0] = -0.7;
  question.direction = Direction::clockwise;
  EXPECT_EQ(format_solution(solve(question)), format_solution(solve(reading_question())));
  question.direction = Direction::either;
  EXPECT_TRUE(solve(question).roll()->either_way);
}

TEST(Question, PutsEveryOptionThatItsSearchTakesIntoTheProblem) {
  Question question = touch_question(rolled_twice().problem);
  question.noise = rollfix::Noise{};
  question.mirrored = question.robust = true;
  question.diagnose = false;
  question.budget = 17;
  question.pose = rollfix::PosePrior{{1, 2, 3}, 0.1, 0.2};
  const TouchProblem problem = rest_problem(question);
  EXPECT_TRUE(problem.mirrored && problem.robust && !problem.diagnose);
  EXPECT_EQ(problem.budget, 17U);
  EXPECT_EQ(problem.pose->mean.y, 2);
  EXPECT_EQ(problem.rolls.size(), 2U);
}

TEST(Question, OfManyIsAnsweredAlikeWithAnyNumberOfThreads) {
  Question wrong = reading_question();
  wrong.robust = true;
  const std::vector<Question> questions{reading_question(), touch_question(touched().problem), wrong,
                                        hold_question(held(3).problem)};
  for (const unsigned threads : {1U, 3U}) {
    rollfix::ManyOptions options;
    options.threads = threads;
    const std::vector<Outcome> outcomes = solve(questions, options);
    for (const std::size_t k : {0U, 1U, 3U}) {
      EXPECT_EQ(format_solution(*outcomes[k].solution), format_solution(solve(questions[k])));
    }
    EXPECT_FALSE(outcomes[2].solution);
    EXPECT_EQ(outcomes[2].error, "`robust` is about noise: give `noise` as well");
  }
}

/// What is said to a question with a change.
std::string refused(Question question, const std::function<void(Question&)>& change) {
  change(question);
  return refusal_of([&] { solve(question); });
}

void face(Question& question) { question.facing = 1; }
void expect_prior(Question& question) { question.prior = rollfix::Prior{1, 0.1}; }
void overlap(Question& question) { question.may_overlap = true; }
void squeeze(Question& question) { question.squeezed = 0.1; }
void turn_round(Question& question) { question.direction = Direction::counterclockwise; }
void read_as_well(Question& question) { question.measured.readings = {Reading(1, 0.5)}; }
void clear_a_path(Question& question) { question.measured.clear = {{{0, 0}, {1, 1}}}; }

TEST(QuestionRefusals, OfTouchesNameWhatOnlyRollsHave) {
  const Question question = touch_question(touched().problem);
  const std::string why = "touches do not roll and have no use for it; leave it out";
  EXPECT_EQ(refused(question, face), "`facing`: " + why);
  EXPECT_EQ(refused(question, expect_prior), "`prior`: " + why);
  EXPECT_EQ(refused(question, overlap), "`may_overlap`: " + why);
  EXPECT_EQ(refused(question, turn_round), "`direction`: " + why);
  EXPECT_EQ(refused(question, read_as_well), "`reading`: " + why);
  EXPECT_EQ(refused(question, [](Question& asked) { asked.at = {1}; }), "`at`: " + why);
  EXPECT_THAT(refused(question, squeeze), StartsWith("`squeezed`: it is about a finger with skin and a wheel"));
  EXPECT_EQ(refused(question,
                    [](Question& asked) {
                      asked.tolerance = rollfix::TouchTolerance{1, 1};
                    }),
            "`tolerance`: `noise` already says how far touches are off; leave one out");
}

TEST(QuestionRefusals, OfSeveralRollsNameWhatOnlyOneRollHas) {
  const Question question = touch_question(rolled_twice().problem);
  EXPECT_EQ(refused(question, face),
            "`facing`: rolls with u and psi have it themselves; leave it out, or choose one roll with `roll` N");
  EXPECT_THAT(refused(question, expect_prior), StartsWith("`prior`: it is of the start of one roll; leave it out"));
  EXPECT_THAT(refused(question, read_as_well), StartsWith("`reading`: `at_rest` takes the rolls of a log"));
  EXPECT_THAT(refused(question, [](Question& asked) { asked.fingers.resize(2, disk(1)); }),
              StartsWith("`finger`: expected one"));
}

TEST(QuestionRefusals, OfThreeFingersNameWhatTheyAreNotTakenWith) {
  const Question question = hold_question(held(3).problem);
  EXPECT_EQ(refused(question, face), "`facing`: logs of u and psi contain it; leave it out");
  EXPECT_EQ(refused(question, read_as_well), "`reading`: three and more fingers are taken from logs; leave it out");
  EXPECT_EQ(refused(question, clear_a_path), "`clear`: it is about touches; leave it out");
  EXPECT_EQ(refused(question, [](Question& asked) { asked.fingers.clear(); }).substr(0, 42),
            "`log` is given 3 times, which is as many f");
  EXPECT_THAT(refused(question,
                      [](Question& asked) {
                        asked.measured.touches = {{{0, 0}}};
                      }),
              StartsWith("`touch` and a `log` of rolls share a pose with `at_rest`"));
}

TEST(QuestionRefusals, OfOneRollNameWhatItLacks) {
  const Question question = reading_question();
  EXPECT_EQ(refused(question, face), "`facing` compares two fingers: expected `reading` LA,LB,THETA with it");
  EXPECT_EQ(refused(question, expect_prior), "`prior` weighs places against noisy readings: give `noise` as well");
  EXPECT_THAT(refused(question, clear_a_path), StartsWith("`clear` is about touches"));
  EXPECT_EQ(refused(question, [](Question& asked) { asked.measured.readings.clear(); }),
            "expected readings, a log or touches, found none");
  EXPECT_THAT(refused(question, [](Question& asked) { asked.measured.rolls = held(1).problem.logs; }),
              StartsWith("expected readings or a log, found both"));
  EXPECT_THAT(refused(question,
                      [](Question& asked) {
                        asked.tolerance = rollfix::TouchTolerance{0.1, 0.1};
                      }),
              StartsWith("`tolerance`: of one roll it is an angle"));
  Question of_log = hold_question(held(1).problem);
  of_log.direction = Direction::clockwise;
  EXPECT_THAT(refusal_of([&] { solve(of_log); }), HasSubstr("has u and psi, which say the direction themselves"));
}

TEST(QuestionRefusals, OfWheelsSayThatThePartMoves) {
  EXPECT_THAT(refused(hold_question(rig().problem), [](Question& asked) { asked.measured.at_rest = true; }),
              StartsWith("`at_rest`: a wheel without skin says something beside a finger"));
}

}  // namespace
}  // namespace question_test
