// Answers to touches with their proof, which rollfix-verify's own search makes again.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/error.hpp"
#include "touch/touch_certificates.hpp"
#include "touch/touch_liar.hpp"

namespace touch_certificate_test {
namespace {

using namespace touch_certificates;

Part circle() { return rollfix::load_part("gallery:circle"); }

/// Where the bracket lies in these tests.
const Pose kLies{100, 50, 0.3};

MeasuredTouch touch_of(const Part& part, double s, double radius = 0) {
  const Vec2 centre = part.point(s) + radius * outward(part.tangent(s));
  return {kLies.world(centre)};
}

std::vector<MeasuredTouch> touches_of(const Part& part, const std::vector<double>& places, double radius = 0) {
  std::vector<MeasuredTouch> touches;
  for (const double s : places) touches.push_back(touch_of(part, s, radius));
  return touches;
}

TEST(TouchCertificate, of_touches_of_three_kinds_of_parts_is_proved) {
  for (int k = 0; k < test_count(3); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 40);
    EXPECT_TRUE(is_proved(certificate(random_question(k, generator, 5e-3)))) << "question " << k;
  }
}

TEST(TouchCertificate, of_a_ball_that_bridges_a_notch_is_proved) {
  const Part plate = polygon({{0, 0}, {40, 0}, {41, 5}, {44, 5}, {44, 0.5}, {100, 0.5}, {100, 60}, {0, 60}});
  TouchProblem problem = within(plate, touches_of(plate, {20, 130, 200, 300}, 30), 0.05);
  problem.finger = rollfix::disk(30);
  EXPECT_TRUE(is_proved(certificate(problem)));
}

TEST(TouchCertificate, says_how_many_sets_of_poses_there_are) {
  const Json proof = certificate(within(bracket(), touches_of(bracket(), {10, 70, 100, 150}), 0.05));
  EXPECT_EQ(words(proof), "proved: 1 set of poses, nothing else");
}

TEST(TouchCertificate, of_touches_that_fit_nowhere_is_proved) {
  const Json proof = certificate(within(bracket(), {{{0, 0}}, {{100, 0}}, {{0, 100}}}, 0.05));
  EXPECT_EQ(words(proof), "proved: 0 sets of poses, nothing else");
}

TEST(TouchCertificate, of_a_circle_has_one_set_with_every_heading) {
  const Json proof = certificate(within(circle(), {{{1, 0}}, {{0, 1}}, {{-1, 0}}}, 0.02));
  EXPECT_EQ(words(proof), "proved: 1 set of poses, nothing else");
  const Json& heading = proof["poses"][0]["extent"][2];
  EXPECT_GE(heading[1].get<double>() - heading[0].get<double>(), kFullTurn);
}

TEST(TouchCertificate, of_parallel_flats_has_the_continua_along_them) {
  const Part plate = polygon({{0, 0}, {40, 0}, {40, 10}, {0, 10}});
  const Json proof =
      certificate(within(plate, {{{10, 0}, -0.5 * std::numbers::pi}, {{20, 10}, 0.5 * std::numbers::pi}}, 0.05));
  EXPECT_EQ(words(proof), "proved: 2 sets of poses, nothing else");
}

TEST(TouchCertificate, of_a_corner_that_is_touched_is_proved) {
  const Part part = bracket();
  const double corner = part.corners()[1].s;
  EXPECT_TRUE(is_proved(certificate(within(part, touches_of(part, {corner, 30, 100, 150}), 0.05))));
  std::vector<MeasuredTouch> balls = touches_of(part, {30, 100, 150}, 3);
  const Vec2 around = part.point(corner) + 3 * outward(part.tangent(corner + 1) - 0.3);
  balls.push_back({kLies.world(around)});
  TouchProblem problem = within(part, balls, 0.05);
  problem.finger = rollfix::disk(3);
  EXPECT_TRUE(is_proved(certificate(problem)));
}

TEST(TouchCertificate, lists_what_an_answer_leaves_out_as_in_the_way) {
  const Part part = bracket();
  TouchProblem problem = within(part, touches_of(part, {10, 70, 100}), 0.05);
  const std::size_t all = rollfix::solve(problem).poses.size();
  const Vec2 inside = kLies.world({10, 20});
  problem.clear = {{inside, inside + Vec2(0.5, 0)}};
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_LT(answer.poses.size(), all);
  const Verdict verdict = checked(certificate(answer));
  EXPECT_TRUE(verdict.is_complete()) << verdict.refusal;
  EXPECT_EQ(verdict.placements, answer.poses.size());
  EXPECT_EQ(verdict.placements + verdict.left_out, all);
}

TEST(TouchCertificate, tells_what_a_search_left_unresolved) {
  TouchProblem problem = within(bracket(), touches_of(bracket(), {10, 70, 100, 150}), 0.05);
  problem.budget = 2000;
  const TouchAnswer answer = rollfix::solve(problem);
  ASSERT_EQ(answer.status, rollfix::Status::incomplete);
  const Verdict verdict = checked(certificate(answer));
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_FALSE(verdict.is_complete());
  EXPECT_GT(verdict.share, 0);
}

TEST(TouchCertificate, is_refused_with_the_pose_that_is_in_no_set) {
  Json proof = certificate(within(bracket(), touches_of(bracket(), {10, 70, 100, 150}), 0.05));
  proof["poses"] = Json::array();
  EXPECT_TRUE(words(proof).starts_with("refused: the pose x ")) << words(proof);
  EXPECT_TRUE(words(proof).ends_with(" rad fits and is in no set")) << words(proof);
}

TEST(TouchCertificate, is_not_written_of_one_touch_or_of_rolls) {
  EXPECT_THROW(certificate(within(bracket(), touches_of(bracket(), {10}), 0.05)), rollfix::InputError);
}

TEST(TouchCertificate, none_of_the_lies_is_proved) {
  std::mt19937_64 generator = test_generator(3);
  const std::vector<int> polygons{3, 4};
  const auto expect_unproved = [](const Json& lie, const std::string& name, int question) {
    EXPECT_FALSE(is_proved(lie)) << question << ": " << name;
  };
  const std::vector<int> told = touch_liar::tell(test_count(2), polygons, generator, expect_unproved);
  EXPECT_GT(std::count_if(told.begin(), told.end(), [](int times) { return times > 0; }), 20);
}

}  // namespace
}  // namespace touch_certificate_test
