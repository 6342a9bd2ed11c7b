#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "outline/turn.hpp"
#include "random.hpp"
#include "touch/touch_cases.hpp"

// One mistake at a time is planted in touches that were right: is it told, and is anything told of right ones?
namespace touch_planted_mistakes_test {

using namespace touch_cases;
using rollfix::TouchCause;
using rollfix::TouchDiagnosis;

constexpr double kPlaceShare = 0.001;  // of the diagonal
constexpr double kRadiusShare = 0.04;

/// What is told of one mistake.
struct Told {
  int cases = 0;
  int noticed = 0;     // the verdict says that something is wrong
  int first = 0;       // the mistake is the likeliest, or as likely as that
  int listed = 0;      // it is among those told
  int another = 0;     // another is told, and it is not
  int sure_wrong = 0;  // one pose, no word of a contradiction, and it is not the true one

  void print(const char* mistake, const char* touches) const {
    std::printf("| %s | %s | %d | %.0f | %.0f | %.0f | %.0f | %.0f |\n", mistake, touches, cases, share(noticed),
                share(first), share(listed), share(another), share(sure_wrong));
    std::fflush(stdout);
  }
  double share(int count) const { return 100.0 * count / std::max(cases, 1); }
};

/// Whether the truth is within what one pose says of itself, widened to about one in 10,000.
bool holds(const TouchPose& pose, const Pose& truth) {
  const auto near = [](const rollfix::Interval& interval, double off) {
    return std::abs(off) <= 1.2 * interval.width();
  };
  return near(pose.interval[0], truth.x - pose.interval[0].middle()) &&
         near(pose.interval[1], truth.y - pose.interval[1].middle()) &&
         near(pose.interval[2], rollfix::nearest_angle(truth.heading - pose.interval[2].middle()));
}

void add(Told& told, const TouchAnswer& answer, const Pose& truth, TouchCause cause) {
  ++told.cases;
  const bool is_odd = answer.verdict.fits_badly || answer.poses.empty();
  told.noticed += is_odd ? 1 : 0;
  const auto is_it = [&](const TouchDiagnosis& one) { return one.cause == cause; };
  const auto found = std::find_if(answer.diagnoses.begin(), answer.diagnoses.end(), is_it);
  const bool is_listed = found != answer.diagnoses.end();
  told.listed += is_listed ? 1 : 0;
  told.first +=
      is_listed && (found == answer.diagnoses.begin() || found->fit.p >= answer.diagnoses.front().fit.p) ? 1 : 0;
  told.another += !is_listed && !answer.diagnoses.empty() ? 1 : 0;
  const bool is_sure = !is_odd && answer.verdict.name == rollfix::Verdict::unique;
  told.sure_wrong += is_sure && !holds(answer.poses.front(), truth) ? 1 : 0;
}

Part part_of(int which, bool is_open, std::mt19937_64& generator) {
  if (is_open) return rollfix::load_part(which % 2 == 0 ? "gallery:log-spiral" : "gallery:exponential");
  const std::string seed = std::to_string(which + 1);
  switch (which % 4) {
    case 0:
      return rollfix::load_part("gallery:spline,n=9,seed=" + seed + ",wobble=0.25");
    case 1:
      return random_polygon(generator);
    case 2:
      return bracket();
    default:
      return rollfix::load_part("gallery:spline,n=15,seed=" + seed + ",wobble=0.2");
  }
}

using Planting = void (*)(Case& one, const Making& making, std::mt19937_64& generator);

struct Mistake {
  const char* name;
  TouchCause cause;
  Planting plant;
  bool is_open = false;
};

void flip(Case& one) {
  for (MeasuredTouch& touch : one.problem.touches) {
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
}

const Mistake kMistakes[] = {
    {"none", TouchCause::noise, [](Case&, const Making&, std::mt19937_64&) {}},
    {"noise understated 4 times", TouchCause::noise,
     [](Case& one, const Making&, std::mt19937_64&) {
       one.problem.noise->position /= 4;
       one.problem.noise->angle /= 4;
     }},
    {"radius 10 % too large", TouchCause::radius,
     [](Case& one, const Making& making, std::mt19937_64&) {
       one.problem.finger = rollfix::disk(1.1 * making.radius);
     }},
    {"finger forgotten", TouchCause::radius,
     [](Case& one, const Making&, std::mt19937_64&) { one.problem.finger.reset(); }},
    {"x and y swapped", TouchCause::swapped,
     [](Case& one, const Making&, std::mt19937_64&) {
       for (MeasuredTouch& touch : one.problem.touches) std::swap(touch.at.x(), touch.at.y());
     }},
    {"part face down", TouchCause::mirrored, [](Case& one, const Making&, std::mt19937_64&) { flip(one); }},
    {"heading 30 deg off", TouchCause::pose,
     [](Case& one, const Making&, std::mt19937_64&) {
       one.problem.pose.emplace();
       one.problem.pose->mean.heading = one.truth.heading + 30 * rollfix::kDegree;
       one.problem.pose->heading_sd = 2 * rollfix::kDegree;
     }},
    {"one touch 1 % off", TouchCause::outlier,
     [](Case& one, const Making& making, std::mt19937_64& generator) {
       MeasuredTouch& touch = one.problem.touches[generator() % one.problem.touches.size()];
       const double angle = touch.normal.value_or(uniform(generator, 0, 2 * std::numbers::pi));
       touch.at += 10 * making.place_sd * Vec2(std::cos(angle), std::sin(angle));
     }},
    {"inches for millimetres", TouchCause::unit,
     [](Case& one, const Making&, std::mt19937_64&) {
       for (MeasuredTouch& touch : one.problem.touches) touch.at /= 25.4;
     }},
    {"left side of an open outline", TouchCause::other_side,
     [](Case& one, const Making&, std::mt19937_64&) {
       one.problem.part = Part(rollfix::reversed(one.problem.part.outline()));
     },
     true},
};

/// So many touches, with normals or without.
Told tally(const Mistake& mistake, bool with_normals, std::size_t least, std::size_t most, const char* touches) {
  Told told;
  for (int c = 0; c < test_count(1); ++c) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(c) + 900);
    const Part part = part_of(c, mistake.is_open, generator);
    const double size = diagonal(part);
    const std::size_t count = least + static_cast<std::size_t>(c) % (most - least + 1);
    const Making making{count, with_normals ? count : 0, kRadiusShare * size, kPlaceShare * size, rollfix::kDegree};
    Case one = random_case(part, making, generator);
    mistake.plant(one, making, generator);
    // Without normals swapped coordinates are those of a mirror image.
    const bool is_image = mistake.cause == TouchCause::swapped && !with_normals;
    add(told, rollfix::solve(one.problem), one.truth, is_image ? TouchCause::mirrored : mistake.cause);
  }
  told.print(mistake.name, touches);
  return told;
}

TEST(TouchPlantedMistakes, AreToldFromFiveTouchesWithNormalsOn) {
  int noticed = 0, listed = 0, sure_wrong = 0, cases = 0;
  for (const Mistake& mistake : kMistakes) {
    const Told told = tally(mistake, true, 5, 6, "5 to 6, normals");
    if (&mistake == kMistakes) {
      EXPECT_LE(told.noticed, 1 + told.cases / 100) << "false alarms";
      continue;
    }
    cases += told.cases;
    noticed += told.noticed;
    listed += told.listed;
    sure_wrong += told.sure_wrong;
  }
  EXPECT_GE(noticed, 0.75 * cases - 1) << "of " << cases;
  EXPECT_GE(listed, 0.85 * noticed - 1) << "of " << noticed;
  EXPECT_LE(sure_wrong, 1 + 0.1 * cases) << "of " << cases;
}

TEST(TouchPlantedMistakes, NeverGiveFalseAlarms) {
  for (const bool with_normals : {true, false}) {
    const Told told = tally(kMistakes[0], with_normals, 3, 6, with_normals ? "3 to 6, normals" : "3 to 6, places");
    EXPECT_LE(told.noticed, 1 + told.cases / 100);
  }
}

/// The table of docs/touch.md: --count=40.
TEST(TouchPlantedMistakes, AreSeldomSureAndWrongWhereFewTouchesCheckEachOther) {
  int cases = 0, sure_wrong = 0;
  const auto count = [&](const Told& told) {
    cases += told.cases;
    sure_wrong += told.sure_wrong;
  };
  for (const Mistake& mistake : kMistakes) {
    count(tally(mistake, true, 3, 4, "3 to 4, normals"));
    if (mistake.cause == TouchCause::unit)
      continue;  // places on one spot: nearly all poses fit, and take long to weigh
    count(tally(mistake, false, 4, 4, "4, places"));
    count(tally(mistake, false, 5, 6, "5 to 6, places"));
  }
  EXPECT_LE(sure_wrong, 1 + 0.35 * cases) << "of " << cases;
}

}  // namespace touch_planted_mistakes_test
