// Many catalogs' worth of touches: bounds lose nothing, and the part that was touched is always among the answers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <string>
#include <vector>

#include "catalogs.hpp"
#include "random.hpp"
#include "rollfix/identify.hpp"
#include "touch/touch_cases.hpp"

namespace identify_touches_witness_test {

using namespace touch_cases;
using catalogs::Catalog;
using rollfix::IdentifiedByTouches;

/// Shares of the part's size. A continuum on a circle takes seconds: of few touches with normals.
const std::array<Making, 7> kKinds = {{{2, 2, 0, 0.001, 0.02},
                                       {3, 3, 0.03, 0.003, 0.02},
                                       {4, 4, 0.1, 0.001, 0.01},
                                       {4, 2, 0.05, 0.001, 0.02},
                                       {5, 0, 0.02, 0.0003, 0},
                                       {7, 0, 0, 0.001, 0},
                                       {5, 5, 0.02, 0.01, 0.05}}};

std::vector<std::string> shapes() {
  std::vector<std::string> shapes = {"cam", "polygon,n=6", "stadium", "reuleaux", "gear", "naca,digits=4415", "naca"};
  for (int k = 0; k < 13; ++k) {
    shapes.push_back("spline,n=" + std::to_string(7 + k % 5) + ",wobble=0.2,seed=" + std::to_string(k + 1));
  }
  return shapes;
}

TouchProblem face_down(TouchProblem problem) {
  for (MeasuredTouch& touch : problem.touches) {
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
  problem.mirrored = true;
  return problem;
}

class TouchesOnManyParts : public testing::Test {
 protected:
  TouchesOnManyParts() : catalog_(catalogs::of(shapes())) {}

  /// Calls `check` with the number of a part that was touched and what is known of it.
  template <class Check>
  void each_case(int count, const Check& check) {
    for (int k = 0; k < count; ++k) {
      std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k));
      const std::size_t number = std::uniform_int_distribution<std::size_t>(0, catalog_.size() - 1)(generator);
      const Part part = catalog_.part(number);
      const double size = diagonal(part);
      const Making& kind = kKinds[static_cast<std::size_t>(k) % kKinds.size()];
      TouchProblem problem =
          random_case(part, {kind.count, kind.normals, kind.radius * size, kind.place_sd * size, kind.angle_sd},
                      generator)
              .problem;
      if (k % 3 == 2) problem = face_down(problem);
      SCOPED_TRACE("case " + std::to_string(k) + ", part " + catalog_.entry(number).name);
      check(number, problem);
    }
  }

  cli::Folder folder_;
  Catalog catalog_;
};

TEST_F(TouchesOnManyParts, are_never_of_a_part_that_bounds_rule_out) {
  each_case(test_count(14), [&](std::size_t /*number*/, const TouchProblem& problem) {
    rollfix::IdentifyOptions without;
    without.use_index = false;
    IdentifiedByTouches all = identify(catalog_, problem, without);
    const IdentifiedByTouches quick = identify(catalog_, problem);
    EXPECT_LE(quick.searched, all.searched);
    all.searched = quick.searched;
    EXPECT_TRUE(format_identified(catalog_, quick) == format_identified(catalog_, all));
  });
}

TEST_F(TouchesOnManyParts, always_list_the_part_that_was_touched) {
  each_case(test_count(70), [&](std::size_t number, const TouchProblem& problem) {
    const IdentifiedByTouches found = identify(catalog_, problem);
    EXPECT_THAT(found.left, testing::Contains(number));
    EXPECT_TRUE(std::any_of(found.parts.begin(), found.parts.end(),
                            [&](const rollfix::PartTouched& part) { return part.part == number; }));
  });
}

TEST_F(TouchesOnManyParts, leave_the_heading_of_a_circle_open) {
  const Catalog round = catalogs::of({"circle,r=1", "cam"}, "round.db");
  std::mt19937_64 generator = test_generator(1);
  const TouchProblem problem = random_case(round.part(0), {5, 5, 0, 0.003, 0.01}, generator).problem;
  EXPECT_EQ(identify(round, problem).verdict, "unique part, any heading");
}

TEST_F(TouchesOnManyParts, are_as_often_of_a_part_as_its_probability_says) {
  double expected = 0, variance = 0;
  int first = 0, count = 0;
  each_case(test_count(70), [&](std::size_t number, const TouchProblem& problem) {
    const IdentifiedByTouches found = identify(catalog_, problem);
    if (found.parts.empty()) return;
    const double probability = found.parts.front().probability;
    expected += probability;
    variance += probability * (1 - probability);
    first += found.parts.front().part == number ? 1 : 0;
    ++count;
  });
  EXPECT_NEAR(first, expected, 4 * std::sqrt(variance) + 1) << "of " << count;
}

}  // namespace identify_touches_witness_test
