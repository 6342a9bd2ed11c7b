// The C interface against the C++ library, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/files.hpp"
#include "rollfix/rollfix.h"
#include "rollfix/rolling.hpp"

namespace c_api_test {
namespace {

using rollfix::Mode;
using rollfix::Noise;
using rollfix::NoisyIncrements;
using rollfix::Part;
using testing::HasSubstr;

constexpr const char* kCourse = "gallery:spline,n=12,seed=5,wobble=0.3";

/// A handle that is given back in the end.
struct Course {
  explicit Course(const char* name = kCourse) {
    EXPECT_EQ(rollfix_part_load(name, nullptr, &handle, nullptr, 0), ROLLFIX_OK);
  }
  ~Course() { rollfix_part_free(handle); }
  Course(const Course&) = delete;
  Course& operator=(const Course&) = delete;

  rollfix_part* handle = nullptr;
};

struct Locator {
  explicit Locator(const rollfix_options& options, const Course& course = Course()) {
    std::array<char, ROLLFIX_MESSAGE> message{};
    EXPECT_EQ(rollfix_start(course.handle, &options, &handle, message.data(), message.size()), ROLLFIX_OK)
        << message.data();
  }
  ~Locator() { rollfix_stop(handle); }
  Locator(const Locator&) = delete;
  Locator& operator=(const Locator&) = delete;

  void push(const NoisyIncrements& drive) const {
    const rollfix::FingerRows& rows = drive.log.fingers[0];
    for (std::size_t k = 0; k < rows.distance.size(); ++k) {
      ASSERT_EQ(rollfix_push(handle, drive.log.time[k], rows.distance[k], rows.dturn[k]), ROLLFIX_OK);
    }
  }
  rollfix_answer answer() const {
    rollfix_answer answer{};
    answer.struct_size = sizeof answer;
    EXPECT_EQ(rollfix_locate(handle, &answer), ROLLFIX_OK);
    return answer;
  }
  rollfix_place place(std::size_t index) const {
    rollfix_place place{};
    place.struct_size = sizeof place;
    EXPECT_EQ(rollfix_place_at(handle, index, &place), ROLLFIX_OK);
    return place;
  }

  rollfix_locator* handle = nullptr;
};

Part part(const char* name = kCourse) { return rollfix::load_part(name, {}).part; }

Noise noise_of(const Part& part) {
  Noise noise{2e-4 * part.perimeter(), 2e-3, 5e-3, 0};
  noise.gyro = 0.01;
  noise.drift = 1e-3;
  return noise;
}

rollfix_options options_of(const Noise& noise) {
  rollfix_options options = rollfix_default_options();
  options.distance = noise.contact;
  options.turn = noise.angle;
  options.slip = noise.slip;
  options.gyro_scale = noise.gyro;
  options.gyro_bias = noise.drift;
  options.gyro_walk = noise.walk;
  return options;
}

NoisyIncrements drive_on(const Part& part, double laps, std::uint64_t seed = 3) {
  const double P = part.perimeter();
  return rollfix::noisy_increments(part, 0.37 * P, laps * P, 300, noise_of(part), seed, 60);
}

/// The library's own answer.
rollfix::Belief belief_of(const Part& part, const NoisyIncrements& drive) {
  rollfix::BeliefOptions options;
  options.noise = noise_of(part);
  rollfix::Belief belief(part, rollfix::LogKind::increments, options);
  for (std::size_t row = 0; row < drive.log.rows(); ++row) {
    rollfix::Sample sample;
    sample.time = drive.log.time[row];
    sample.reading = {drive.log.fingers[0].length[row], drive.log.fingers[0].turn[row]};
    belief.add(sample);
  }
  return belief;
}

void expect_same(const Locator& locator, rollfix::Belief belief) {
  const rollfix_answer answer = locator.answer();
  const std::vector<Mode>& modes = belief.modes();
  ASSERT_EQ(answer.places, modes.size());
  EXPECT_EQ(answer.verdict, static_cast<int>(belief.verdict().name));
  EXPECT_EQ(answer.contradicts != 0, belief.verdict().fits_badly);
  EXPECT_EQ(answer.turn_scale, belief.fit().turn_scale);
  EXPECT_EQ(answer.gyro_bias, belief.fit().turn_bias);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const rollfix_place place = locator.place(k);
    EXPECT_EQ(place.probability, modes[k].probability);
    EXPECT_EQ(place.start, modes[k].start[0]);
    EXPECT_EQ(place.start_sd, modes[k].sd[0]);
    EXPECT_EQ(place.now, modes[k].end_mean[0]);
    EXPECT_EQ(place.now_sd, modes[k].end_sd[0]);
  }
}

std::string refusal_of(const rollfix_options& options, const Course& course = Course()) {
  std::array<char, ROLLFIX_MESSAGE> message{};
  rollfix_locator* locator = nullptr;
  EXPECT_EQ(rollfix_start(course.handle, &options, &locator, message.data(), message.size()), ROLLFIX_INPUT);
  EXPECT_EQ(locator, nullptr);
  return message.data();
}

rollfix_options usual() { return options_of(noise_of(part())); }

}  // namespace

TEST(CApi, says_to_the_bit_what_the_library_says) {
  for (const double laps : {0.05, 0.2, 0.5, 2.5}) {
    const NoisyIncrements drive = drive_on(part(), laps);
    const Locator locator(usual());
    locator.push(drive);
    expect_same(locator, belief_of(part(), drive));
  }
}

TEST(CApi, says_it_on_a_course_with_folds_and_corners) {
  const char* gear = "gallery:gear";
  const NoisyIncrements drive = drive_on(part(gear), 0.3);
  const Locator locator(options_of(noise_of(part(gear))), Course(gear));
  locator.push(drive);
  expect_same(locator, belief_of(part(gear), drive));
}

TEST(CApi, begins_anew_as_if_nothing_had_been) {
  const NoisyIncrements other = drive_on(part(), 0.5, 8);
  const Locator locator(usual());
  locator.push(drive_on(part(), 2.5));
  locator.answer();
  ASSERT_EQ(rollfix_restart(locator.handle), ROLLFIX_OK);
  locator.push(other);
  expect_same(locator, belief_of(part(), other));
}

TEST(CApi, tells_the_point_and_the_direction_now) {
  const Locator locator(usual());
  locator.push(drive_on(part(), 0.5));
  locator.answer();
  const rollfix_place place = locator.place(0);
  EXPECT_EQ(place.x, part().point(place.now).x());
  EXPECT_NEAR(std::cos(place.heading - part().tangent(place.now)), 1, 1e-12);
}

TEST(CApi, refuses_a_row_that_is_no_row_and_goes_on) {
  const Locator locator(usual());
  EXPECT_EQ(rollfix_push(locator.handle, 1, std::numeric_limits<double>::quiet_NaN(), 0), ROLLFIX_INPUT);
  EXPECT_EQ(rollfix_push(locator.handle, 1, 0.1, 0), ROLLFIX_OK);
  EXPECT_EQ(rollfix_push(locator.handle, 1, 0.1, 0), ROLLFIX_INPUT);  // the time does not grow
  EXPECT_EQ(locator.answer().rows, 1U);
}

TEST(CApi, has_no_answer_before_a_row) {
  const Locator locator(usual());
  rollfix_answer answer{};
  answer.struct_size = sizeof answer;
  EXPECT_EQ(rollfix_locate(locator.handle, &answer), ROLLFIX_NOTHING);
  rollfix_place place{};
  place.struct_size = sizeof place;
  EXPECT_EQ(rollfix_place_at(locator.handle, 0, &place), ROLLFIX_NOTHING);
}

TEST(CApi, says_why_it_does_not_start) {
  EXPECT_THAT(refusal_of(rollfix_default_options()), HasSubstr("expected a standard deviation"));
  rollfix_options few = usual();
  few.points = 3;
  EXPECT_THAT(refusal_of(few), HasSubstr("expected at least as many, found 3"));
}

TEST(CApi, says_why_there_is_no_part) {
  std::array<char, ROLLFIX_MESSAGE> message{};
  rollfix_part* none = nullptr;
  EXPECT_EQ(rollfix_part_load("nowhere.csv", nullptr, &none, message.data(), message.size()), ROLLFIX_INPUT);
  EXPECT_THAT(message.data(), HasSubstr("nowhere.csv"));
  std::array<char, 8> short_one{};
  EXPECT_EQ(rollfix_part_load("nowhere.csv", nullptr, &none, short_one.data(), short_one.size()), ROLLFIX_INPUT);
  EXPECT_EQ(std::strlen(short_one.data()), 7U);
}

TEST(CApi, of_nothing_there_is_nothing) {
  EXPECT_EQ(rollfix_part_length(nullptr), 0);
  EXPECT_EQ(rollfix_part_reversed(nullptr), 0);
  EXPECT_EQ(rollfix_bytes(nullptr), 0U);
}

TEST(CApi, takes_a_figure_eight_where_it_is_allowed) {
  std::vector<double> xy;
  for (int k = 0; k < 40; ++k) {
    const double t = 0.05 * k * 3.14159265358979;
    xy.insert(xy.end(), {40 * std::sin(t), 18 * std::sin(2 * t)});
  }
  rollfix_part* eight = nullptr;
  EXPECT_EQ(rollfix_part_from_points(xy.data(), 40, nullptr, &eight, nullptr, 0), ROLLFIX_INPUT);
  rollfix_part_options options = rollfix_default_part_options();
  options.allow_crossing = 1;
  ASSERT_EQ(rollfix_part_from_points(xy.data(), 40, &options, &eight, nullptr, 0), ROLLFIX_OK);
  EXPECT_GT(rollfix_part_length(eight), 200);
  rollfix_part_free(eight);
}

TEST(CApi, knows_structs_that_are_shorter_or_longer_than_its_own) {
  rollfix_options known_up_to_turn = usual();
  known_up_to_turn.struct_size = offsetof(rollfix_options, slip);
  const Locator locator(known_up_to_turn);
  locator.push(drive_on(part(), 0.5));
  struct {
    rollfix_answer known;
    double later = 17;
  } longer;
  longer.known.struct_size = sizeof longer;
  longer.known.rest = -1;
  EXPECT_EQ(rollfix_locate(locator.handle, &longer.known), ROLLFIX_OK);
  EXPECT_GE(longer.known.rest, 0);
  EXPECT_EQ(longer.later, 17);
  rollfix_answer shorter{};
  shorter.struct_size = offsetof(rollfix_answer, rest);
  shorter.rest = -1;
  EXPECT_EQ(rollfix_locate(locator.handle, &shorter), ROLLFIX_OK);
  EXPECT_EQ(shorter.rows, 300U);
  EXPECT_EQ(shorter.rest, -1);
  rollfix_answer of_no_size{};
  EXPECT_EQ(rollfix_locate(locator.handle, &of_no_size), ROLLFIX_INPUT);
}

TEST(CApi, with_few_points_tells_how_much_is_left_open) {
  rollfix_options few = usual();
  few.points = 80;
  const Locator locator(few);
  locator.push(drive_on(part(), 0.5));
  const rollfix_answer answer = locator.answer();
  EXPECT_EQ(answer.verdict, ROLLFIX_UNDECIDED);
  EXPECT_GT(answer.rest, 0.05);
  EXPECT_LE(answer.rest, 1);
}

}  // namespace c_api_test
