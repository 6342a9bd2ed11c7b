// Answers to rolls and touches with their proof, which rollfix-verify's own search makes again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "refusal.hpp"
#include "touch/roll_certificates.hpp"

namespace roll_certificate_test {

using namespace roll_certificates;
using touch_certificates::certificate;
using touch_certificates::checked;
using touch_certificates::is_proved;
using touch_certificates::Verdict;
using touch_certificates::words;

Asking few(std::size_t rolls, std::size_t touches, bool centres = true) {
  Asking asking;
  asking.rolling.count = rolls;
  asking.rolling.touches = touches;
  asking.rolling.centres = centres;
  asking.rolling.rows = 10;
  asking.some_centres = false;
  return asking;
}

Json proof_of(const std::string& part, const Asking& asking, std::uint64_t seed = 1) {
  std::mt19937_64 generator = test_generator(seed);
  return certificate(question(rollfix::load_part(part), asking, generator));
}

/// Rolls from these places of a part that lies somewhere.
Json proof_from(const Part& part, const std::vector<double>& starts, double length, double radius = 0.02) {
  std::mt19937_64 generator = test_generator(7);
  const double size = diagonal(part);
  TouchProblem problem{part, {}};
  for (const double s : starts) {
    const auto roll = has_corners(part) ? pivoting_log : roll_log;
    Rolling rolling;
    rolling.rows = 12;
    problem.rolls.push_back(roll(part, {1, 2, 0.4}, s, length, radius * size, rolling, size, generator));
  }
  problem.finger = rollfix::disk(radius * size);
  problem.tolerance = {1e-3 * size, 2e-3};
  return certificate(problem);
}

const std::string kSpline = "gallery:spline,n=9,wobble=0.25,seed=3";

TEST(RollCertificate, of_rolls_and_touches_of_all_kinds_is_proved) {
  for (int k = 0; k < test_count(6); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 60);
    const Json proof = certificate(random_question(k, generator));
    EXPECT_TRUE(is_proved(proof)) << "question " << k << ": " << words(proof);
  }
}

TEST(RollCertificate, of_two_rolls_has_one_set_of_poses) {
  EXPECT_EQ(words(proof_of(kSpline, few(2, 0))), "proved: 1 set of poses, nothing else");
}

TEST(RollCertificate, of_a_roll_and_a_touch_is_proved) {
  EXPECT_TRUE(is_proved(proof_of(kSpline, few(1, 1)))) << words(proof_of(kSpline, few(1, 1)));
}

TEST(RollCertificate, of_rolls_without_centres_is_of_headings_alone) {
  const Json proof = proof_of(kSpline, few(3, 0, false));
  EXPECT_TRUE(is_proved(proof)) << words(proof);
  ASSERT_FALSE(proof["poses"].empty());
  EXPECT_TRUE(proof["poses"][0]["pose"][0].is_null());
  EXPECT_TRUE(proof["poses"][0]["extent"][1][0].is_null());
}

TEST(RollCertificate, of_a_circle_has_every_heading) {
  Asking wide = few(2, 0);
  wide.length = 0.01;
  wide.angle = 0.03;
  const Json proof = proof_of("gallery:circle,r=2", wide);
  EXPECT_EQ(words(proof), "proved: 1 set of poses, nothing else");
}

TEST(RollCertificate, of_an_ellipse_has_both_halves) {
  EXPECT_EQ(words(proof_of("gallery:ellipse,a=3,b=2", few(2, 1))), "proved: 2 sets of poses, nothing else");
}

TEST(RollCertificate, of_one_side_of_a_polygon_leaves_it_free_to_slide) {
  EXPECT_TRUE(is_proved(proof_from(bracket(), {10, 40}, 8))) << words(proof_from(bracket(), {10, 40}, 8));
}

TEST(RollCertificate, of_two_sides_of_a_polygon_is_proved) {
  EXPECT_TRUE(is_proved(proof_from(bracket(), {10, 65}, 8)));
}

TEST(RollCertificate, of_a_roll_that_starts_at_a_corner_and_ends_past_another_is_proved) {
  const Json proof = proof_from(bracket(), {0, 60}, 18.5);
  EXPECT_TRUE(is_proved(proof)) << words(proof);
}

TEST(RollCertificate, of_rolls_of_no_length_is_that_of_touches) {
  const Json proof = proof_from(rollfix::load_part(kSpline), {1, 3, 4.5}, 0);
  EXPECT_TRUE(is_proved(proof)) << words(proof);
}

TEST(RollCertificate, of_rolls_longer_than_the_perimeter_is_proved) {
  const Part part = rollfix::load_part("gallery:limacon");
  EXPECT_TRUE(is_proved(proof_from(part, {1, 4}, 1.3 * part.perimeter())));
}

TEST(RollCertificate, of_an_open_outline_up_to_its_end_is_proved) {
  const Part part = rollfix::load_part("gallery:log-spiral");
  const double P = part.perimeter();
  EXPECT_TRUE(is_proved(proof_from(part, {0.2 * P, 0.9 * P}, 0.1 * P)));
  EXPECT_TRUE(is_proved(proof_from(part, {0.2 * P, 0.6 * P}, 0.1 * P)));
}

TEST(RollCertificate, of_a_part_that_lies_face_down_is_proved) {
  std::mt19937_64 generator = test_generator(5);
  const TouchProblem problem = face_down(two_rolls(rollfix::load_part("gallery:cam"), generator));
  const Json proof = certificate(problem);
  EXPECT_TRUE(proof["mirrored"].get<bool>());
  EXPECT_EQ(words(proof), "proved: 1 set of poses, nothing else");
}

TEST(RollCertificate, of_rolls_that_share_no_pose_is_proved) {
  std::mt19937_64 generator = test_generator(6);
  TouchProblem problem = two_rolls(rollfix::load_part(kSpline), generator);
  for (double& x : problem.rolls.back().fingers.front().x) x += 0.3;
  EXPECT_EQ(words(certificate(problem)), "proved: 0 sets of poses, nothing else");
}

TEST(RollCertificate, counts_what_paths_leave_out) {
  std::mt19937_64 generator = test_generator(8);
  TouchProblem problem = two_rolls(rollfix::load_part("gallery:ellipse,a=3,b=2"), generator);
  const TouchAnswer all = rollfix::solve(problem);
  ASSERT_EQ(all.poses.size(), 2U);
  const Vec2 middle = all.poses[0].pose.world({0, 0});
  problem.clear = {{middle, middle + Vec2(0.1, 0)}};
  const Verdict verdict = checked(certificate(problem));
  EXPECT_TRUE(verdict.is_complete()) << verdict.refusal;
  EXPECT_EQ(verdict.placements + verdict.left_out, 2U);
  EXPECT_EQ(verdict.left_out, 2U);
}

TEST(RollCertificate, is_refused_with_the_heading_that_is_in_no_set) {
  Json proof = proof_of(kSpline, few(3, 0, false));
  proof["poses"] = Json::array();
  EXPECT_THAT(words(proof), testing::StartsWith("refused: the heading ")) << words(proof);
}

TEST(RollCertificate, says_what_it_is_not_of) {
  std::mt19937_64 generator = test_generator(9);
  TouchProblem noisy = two_rolls(rollfix::load_part(kSpline), generator);
  noisy.tolerance.reset();
  noisy.noise.emplace();
  noisy.noise->contact = noisy.noise->position = noisy.noise->angle = 0.01;
  EXPECT_THAT(refusal_of([&] { certificate(noisy); }), testing::HasSubstr("give `tolerance` LENGTH,ANGLE"));
  TouchProblem exact = two_rolls(rollfix::load_part(kSpline), generator);
  exact.tolerance = {1e-3, 1e-11};
  EXPECT_THAT(refusal_of([&] { certificate(exact); }), testing::HasSubstr("at least 2e-09 rad"));
}

TEST(RollCertificate, none_of_the_lies_is_proved) {
  std::vector<int> told;
  for (int k = 0; k < test_count(3); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 90);
    Asking asking = few(2, static_cast<std::size_t>(k) % 2);
    const Json truth = certificate(question(rollfix::load_part(kSpline), asking, generator));
    const auto has_pose = [](const Json& one) { return one.contains("pose"); };
    if (!std::all_of(truth["poses"].begin(), truth["poses"].end(), has_pose)) continue;
    told_lies::tell_each(lies(), truth, generator, told, [&](const Json& lie, const std::string& name) {
      EXPECT_FALSE(is_proved(lie)) << k << ": " << name;
    });
  }
  EXPECT_GT(std::accumulate(told.begin(), told.end(), 0), 20);
}

}  // namespace roll_certificate_test
