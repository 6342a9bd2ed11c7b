// Answers of holds and of the rig with their proof, which rollfix-verify's own search makes again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "hold/hold_certificates.hpp"
#include "hold/hold_liar.hpp"
#include "hold/rig_scan.hpp"
#include "random.hpp"
#include "refusal.hpp"

namespace hold_certificate_test {
namespace {

using namespace hold_certificates;
using testing::HasSubstr;

Part ellipse() { return rollfix::load_part("gallery:ellipse,a=2,b=1"); }
Part cam() { return rollfix::load_part("gallery:cam"); }
Part circle() { return rollfix::load_part("gallery:circle"); }

HoldProblem rig_on(const Part& part, unsigned seed, bool encoder = false) {
  std::mt19937_64 generator(seed);
  return rig_cases::random_rig(part, 0.04 * part.perimeter(), generator, encoder, 16).problem;
}

/// The bracket's corner at s = 60, at which the jaw pivots.
HoldProblem pivoting() {
  return rig_cases::held_at(
      touch_cases::bracket(), 3,
      {{50, 145, {5, 3, 0.3}}, {60, 147, {6, 3, 0.2}, 0.3}, {60, 149, {6, 4, 0.1}, 1.0}, {66, 151, {7, 4, 0.2}}});
}

TEST(HoldCertificate, of_rigs_of_all_kinds_is_proved) {
  for (int k = 0; k < test_count(2); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 60);
    const Json proof = certificate(random_rig_question(k, generator));
    EXPECT_TRUE(is_proved(proof)) << "question " << k << ": " << words(proof);
  }
}

TEST(HoldCertificate, of_three_and_more_fingers_is_proved) {
  for (int k = 0; k < test_count(3); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 80);
    const Json proof = certificate(random_hold_question(k, generator));
    EXPECT_TRUE(is_proved(proof)) << "question " << k << ": " << words(proof);
  }
}

TEST(HoldCertificate, of_a_cam_in_the_rig_proves_that_the_place_is_unique) {
  EXPECT_EQ(words(certificate(rig_on(cam(), 1))), "proved: 1 set of first contacts, nothing else");
}

TEST(HoldCertificate, of_an_ellipse_has_the_half_turn_as_well) {
  EXPECT_EQ(words(certificate(rig_on(ellipse(), 1))), "proved: 2 sets of first contacts, nothing else");
}

TEST(HoldCertificate, of_a_wheel_with_an_encoder_is_proved) {
  EXPECT_EQ(words(certificate(rig_on(cam(), 5, true))), "proved: 1 set of first contacts, nothing else");
}

TEST(HoldCertificate, of_an_encoder_that_turns_otherwise_proves_that_nothing_fits) {
  HoldProblem problem = rig_on(cam(), 5, true);
  std::vector<double>& psi = problem.wheels[0].log.rows.fingers[0].psi;
  for (std::size_t k = 0; k < psi.size(); ++k) psi[k] += 0.01 * static_cast<double>(k);
  EXPECT_EQ(words(certificate(problem)), "proved: 0 sets of first contacts, nothing else");
}

TEST(HoldCertificate, of_a_squeezed_part_has_its_half_turn) {
  const double s = 1.1, t = rig_cases::foot_across(ellipse(), s, s + 0.5 * ellipse().perimeter());
  HoldProblem problem = rig_cases::held_at(ellipse(), 0.4, {{s, t, {0.2, 0.1, 0.4}}, {s, t, {0.2, 0.1, 0.4}}});
  problem.squeezed = 1e-6;
  EXPECT_EQ(words(certificate(problem)), "proved: 2 sets of first contacts, nothing else");
}

TEST(HoldCertificate, of_a_circle_has_every_first_contact) {
  const HoldProblem problem = rig_cases::held_at(circle(), 0.3, {{1, 3, {0.2, 0.1, 0.4}}, {1.4, 3.3, {0.2, 0.2, 0.3}}});
  const Json proof = certificate(problem);
  EXPECT_EQ(words(proof), "proved: 1 set of first contacts, nothing else");
  const Json& arc = proof["sets"][0]["extent"][0];
  EXPECT_GE(arc[1].get<double>() - arc[0].get<double>(), circle().perimeter() * (1 - 1e-9));
}

TEST(HoldCertificate, of_a_jaw_that_pivots_at_a_corner_is_proved) {
  const Json proof = certificate(pivoting());
  EXPECT_TRUE(is_proved(proof)) << words(proof);
  EXPECT_FALSE(proof["fingers"][0]["reach"].is_null());  // a jaw bridges the bracket's inner corner
}

TEST(HoldCertificate, of_a_wheel_at_a_corner_is_proved) {
  const Json proof = certificate(rig_cases::held_at(
      touch_cases::bracket(), 3, {{20, 171, {5, 3, 0.3}, {}}, {24, 172, {6, 3, 0.2}}, {30, 174, {6, 4, 0.1}}}));
  EXPECT_TRUE(is_proved(proof)) << words(proof);
}

TEST(HoldCertificate, of_a_part_that_lies_face_down_is_proved) {
  HoldProblem problem = rig_on(cam(), 8, true);
  rollfix::FingerRows& jaw = problem.logs[0].fingers[0];
  rollfix::FingerRows& pin = problem.wheels[0].log.rows.fingers[0];
  for (auto* column : {&jaw.u, &jaw.psi, &jaw.x, &pin.x, &pin.psi}) {
    for (double& value : *column) value = -value;
  }
  problem.mirrored = true;
  const Json proof = certificate(problem);
  EXPECT_EQ(words(proof), "proved: 1 set of first contacts, nothing else");
  EXPECT_NEAR(proof["instants"][0]["pins"][0]["at"][0].get<double>(), pin.x[0], 1e-12);
}

TEST(HoldCertificate, of_an_open_outline_is_proved_up_to_its_ends) {
  const Part wall = rollfix::load_part("gallery:exponential");
  const double end = wall.perimeter();
  const auto jaw_at = [&](double from, double to) {
    return rig_cases::held_at(wall, 0.05 * end,
                              {{from * end, 0.5 * end, {0.2, 0.1, 0.4}}, {to * end, 0.5 * end, {0.1, 0.1, 0.3}}});
  };
  HoldProblem problem = jaw_at(0, 0.1);
  problem.wheels.clear();
  problem.logs.push_back(jaw_at(0.45, 0.5).logs[0]);
  problem.logs.push_back(jaw_at(0.9, 1).logs[0]);
  EXPECT_EQ(words(certificate(problem)), "proved: 1 set of first contacts, nothing else");
}

TEST(HoldCertificate, says_what_noise_leaves_out) {
  std::mt19937_64 generator(3);
  const double size = ellipse().perimeter();
  const Part egg = rollfix::load_part("gallery:superellipse,a=2,b=1.9,n=2");
  rig_cases::RigCase one = rig_cases::random_rig(egg, 0.04 * size, generator, false, 16);
  one = rig_cases::noisy(one, {1e-3 * size, 0.005, 1e-3 * size, 0}, generator);
  const HoldAnswer answer = rollfix::solve(one.problem);
  const Json proof = certificate(one.problem, answer);
  EXPECT_TRUE(is_proved(proof)) << words(proof);
  EXPECT_GE(proof["sets"].size(), 1U);
}

TEST(HoldCertificate, tells_what_a_search_left_unresolved) {
  HoldProblem problem = rig_on(cam(), 2);
  problem.budget = 300;
  const HoldAnswer answer = rollfix::solve(problem);
  ASSERT_EQ(answer.status, rollfix::Status::incomplete);
  const Verdict verdict = checked(certificate(problem, answer));
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_FALSE(verdict.is_complete());
}

TEST(HoldCertificate, is_refused_with_the_first_contacts_that_are_in_no_set) {
  Json proof = certificate(rig_on(ellipse(), 1));
  proof["sets"] = Json::array();
  EXPECT_THAT(words(proof), HasSubstr("first contacts about s = "));
  EXPECT_FALSE(is_proved(proof));
}

TEST(HoldCertificate, is_written_of_the_answer_to_the_same_problem) {
  const HoldProblem problem = rig_on(cam(), 1);
  HoldProblem other = problem;
  other.at = {0.5};
  EXPECT_THAT(refusal_of([&] { certificate(problem, rollfix::solve(other)); }), HasSubstr("found another one"));
}

TEST(HoldCertificate, none_of_the_lies_is_proved) {
  std::mt19937_64 generator = test_generator(4);
  const std::vector<int> told =
      hold_liar::tell(test_count(1), generator, [](const Json& lie, const std::string& name, int question) {
        EXPECT_FALSE(is_proved(lie)) << question << ": " << name;
      });
  EXPECT_GT(std::count_if(told.begin(), told.end(), [](int times) { return times > 0; }), 20);
}

}  // namespace
}  // namespace hold_certificate_test
