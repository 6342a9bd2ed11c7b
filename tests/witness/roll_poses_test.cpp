#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/locate.hpp"
#include "touch/roll_cases.hpp"

// Several rolls on one part: against the pair search of two fingers, a scan of the heading, and the truth.
namespace roll_poses_test {

using namespace roll_cases;
using rollfix::Interval;
using rollfix::Reading;

const std::vector<std::string> kParts = {"gallery:spline,n=9,wobble=0.25,seed=%",
                                         "gallery:spline,n=15,wobble=0.2,seed=%",
                                         "gallery:spline,n=30,wobble=0.12,seed=%",
                                         "gallery:naca,digits=2412",
                                         "polygon",
                                         "bracket"};

Part part_of(int number, std::mt19937_64& generator) {
  return part_named(kParts[static_cast<std::size_t>(number) % kParts.size()], 1 + number / 6, generator);
}

/// Length and turn of a roll from its first row to its last one.
Reading reading_of(const Log& log, double radius) {
  const rollfix::FingerRows& rows = log.fingers.front();
  const double turn = rows.u.back() - rows.u.front();
  return {-radius * turn, turn + rows.psi.back() - rows.psi.front()};
}

double facing_of(const Log& log) { return log.fingers.front().u.front() + log.fingers.front().psi.front(); }

bool in_arc(const Part& part, const Interval& arc, double s, double slack) {
  return part.boundary().contains(arc, part.boundary().canonical(s), slack * part.perimeter());
}

bool holds_starts(const TouchPose& pose, const Part& part, const std::vector<double>& starts, double slack) {
  for (std::size_t k = 0; k < starts.size(); ++k) {
    if (!in_arc(part, *pose.contacts[k].extent, starts[k], slack)) return false;
  }
  return true;
}

bool is_at_corner(const Part& part, double s) {
  return std::any_of(part.corners().begin(), part.corners().end(), [&](const rollfix::Corner& corner) {
    return part.boundary().distance(corner.s, s) <= 1e-6 * part.perimeter();
  });
}

/// A roll of two rows and the other one: the pair search sees no more of them.
RollCase short_case(int number, std::mt19937_64& generator) {
  const Part part = part_of(number, generator);
  Rolling rolling;
  rolling.length = 0.06;
  rolling.rows = 1;
  rolling.radius = 0.02;
  rolling.centres = false;
  return random_rolls(part, rolling, generator);
}

TEST(RollPoses, TwoRollsWithoutCentresAreThePairSearchWithFacing) {
  for (int number = 0; number < test_count(60); ++number) {
    SCOPED_TRACE(number);
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 8100);
    RollCase one = short_case(number, generator);
    const Part& part = one.problem.part;
    const double radius = one.problem.finger->disk()->radius;
    one.problem.tolerance = {0, 1e-5};
    const TouchAnswer answer = rollfix::solve(one.problem);
    const Reading a = reading_of(one.problem.rolls[0], radius);
    const Reading b = reading_of(one.problem.rolls[1], radius);
    rollfix::LocateOptions options;
    options.tolerance = 1e-5;
    options.facing = facing_of(one.problem.rolls[0]) - facing_of(one.problem.rolls[1]);
    const rollfix::Search pairs =
        rollfix::locate(part, {Reading(a.length[0], 0, a.turn), Reading(0, b.length[0], -b.turn)}, options);
    ASSERT_EQ(answer.status, rollfix::Status::complete);
    for (const TouchPose& pose : answer.poses) {
      EXPECT_TRUE(std::any_of(pairs.placements.begin(), pairs.placements.end(),
                              [&](const auto& pair) {
                                return in_arc(part, pair.extent[0], pose.contacts[0].s, 1e-4) &&
                                       in_arc(part, pair.extent[1], pose.contacts[1].s, 1e-4);
                              }))
          << "only by rolls: " << pose.contacts[0].s << ", " << pose.contacts[1].s;
    }
    const std::vector<Vec2> boundary = dense(part);
    for (const rollfix::Placement& pair : pairs.placements) {
      // The pair search lets a finger that does not travel pivot at its corner: a roll of the other one does not.
      if (is_at_corner(part, pair.start[0]) || is_at_corner(part, pair.start[1])) continue;
      if (!can_roll(part, pair.start[0], a.length[0], radius, boundary)) continue;
      if (!can_roll(part, pair.start[1], b.length[0], radius, boundary)) continue;
      EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(),
                              [&](const TouchPose& pose) {
                                return holds_starts(pose, part, {pair.start[0], pair.start[1]}, 1e-4);
                              }))
          << "only by pairs: " << pair.start[0] << ", " << pair.start[1];
    }
  }
}

/// Whether a roll can have begun somewhere with the part at this heading, as far as a grid of places tells: with a
/// tolerance that is `slack` larger.
class Scan {
 public:
  Scan(const Part& part, const Log& log, double radius) : part_(part), log_(log), reading_(reading_of(log, radius)) {
    for (int k = 0; k < kPlaces; ++k) {
      const double s = part.perimeter() * k / kPlaces;
      tangent_.push_back(part.tangent(s));
      miss_.push_back(std::abs(turned(s, reading_.length[0]) - reading_.turn));
    }
  }

  bool fits(double heading, double tolerance, double slack) const {
    const double tangent = facing_of(log_) - 0.5 * std::numbers::pi;
    for (std::size_t k = 0; k < tangent_.size(); ++k) {
      if (miss_[k] > tolerance + slack) continue;
      if (std::abs(rollfix::nearest_angle(tangent - tangent_[k] - heading)) <= 0.5 * tolerance + slack) return true;
    }
    return false;
  }

 private:
  static constexpr int kPlaces = 6000;

  double turned(double s, double length) const {
    double tangent = part_.tangent(s);
    const double first = tangent;
    for (int k = 1; k <= 50; ++k) tangent = follow(part_, s + length * k / 50, tangent);
    return tangent - first;
  }

  const Part& part_;
  const Log& log_;
  Reading reading_;
  std::vector<double> tangent_;
  std::vector<double> miss_;
};

TEST(RollPoses, ThreeRollsAreWhatAScanOfTheHeadingFinds) {
  constexpr double kTolerance = 0.03;
  constexpr int kHeadings = 2000;
  for (int number = 0; number < test_count(12); ++number) {
    SCOPED_TRACE(number);
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 8300);
    const Part part = rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=" + std::to_string(number + 1));
    Rolling rolling;
    rolling.count = 3;
    rolling.rows = 1;
    rolling.radius = 0.005;
    rolling.centres = false;
    RollCase one = random_rolls(part, rolling, generator);
    one.problem.tolerance = {0, kTolerance};
    const TouchAnswer answer = rollfix::solve(one.problem);
    std::vector<Scan> scans;
    for (const Log& log : one.problem.rolls) scans.emplace_back(part, log, one.problem.finger->disk()->radius);
    const auto all_fit = [&](double heading, double slack) {
      return std::all_of(scans.begin(), scans.end(),
                         [&](const Scan& scan) { return scan.fits(heading, kTolerance, slack); });
    };
    for (int k = 0; k < kHeadings; ++k) {
      const double heading = 2 * std::numbers::pi * k / kHeadings;
      const bool is_listed = std::any_of(answer.poses.begin(), answer.poses.end(), [&](const TouchPose& pose) {
        return holds_heading(pose.extent[2], heading, 1e-9);
      });
      EXPECT_TRUE(is_listed || !all_fit(heading, -2e-3)) << heading;
    }
    for (const TouchPose& pose : answer.poses) EXPECT_TRUE(all_fit(pose.pose.heading, 5e-3)) << pose.pose.heading;
  }
}

TEST(RollPoses, TwoShortRollsAreUniqueOnSmoothPartsWhereOneIsNot) {
  int unique = 0;
  double alone = 0;
  const int count = test_count(40);
  for (int number = 0; number < count; ++number) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 8400);
    const Part part = rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=" + std::to_string(1 + number % 10));
    Rolling rolling;
    rolling.length = 0.06;
    rolling.rows = 1;
    rolling.centres = false;
    RollCase one = random_rolls(part, rolling, generator);
    one.problem.tolerance = {0, 1e-4};
    const TouchAnswer answer = rollfix::solve(one.problem);
    unique += answer.verdict.name == rollfix::Verdict::unique ? 1 : 0;
    alone += static_cast<double>(answer.rolls.front().placements) / count;
  }
  std::printf("unique %.1f %%; one roll alone has %.2f placements\n", 100.0 * unique / count, alone);
  EXPECT_GE(unique, 0.9 * count);
  EXPECT_GE(alone, 3);
}

TEST(RollPoses, TheTrueStartsAreAmongTheAnswersOfExactLogs) {
  for (int number = 0; number < test_count(90); ++number) {
    SCOPED_TRACE(number);
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 8500);
    Rolling rolling;
    rolling.count = 2 + static_cast<std::size_t>(number % 2);
    rolling.centres = number % 3 != 0;
    const RollCase one = random_rolls(part_of(number, generator), rolling, generator);
    const TouchAnswer answer = rollfix::solve(one.problem);
    EXPECT_EQ(answer.status, rollfix::Status::complete);
    EXPECT_TRUE(std::any_of(answer.poses.begin(), answer.poses.end(), [&](const TouchPose& pose) {
      const bool heading = holds_heading(pose.extent[2], one.truth.heading, 1e-7);
      return heading && holds_starts(pose, one.problem.part, one.starts, 1e-6);
    })) << answer.verdict_text();
  }
}

TEST(RollPoses, TheTruePoseIsAmongTheAnswersOfNoisyLogs) {
  const int count = test_count(60);
  int missed = 0;
  for (int number = 0; number < count; ++number) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(number) + 8600);
    Rolling rolling;
    rolling.count = 2 + static_cast<std::size_t>(number % 2);
    rolling.centres = number % 4 != 0;
    rolling.touches = rolling.centres && number % 3 == 0 ? 1 : 0;
    rolling.contact_sd = rolling.place_sd = 0.002;
    rolling.angle_sd = 0.005;
    const RollCase one = random_rolls(part_of(number, generator), rolling, generator);
    const TouchAnswer answer = rollfix::solve(one.problem);
    const bool is_in = std::any_of(answer.poses.begin(), answer.poses.end(), [&](const TouchPose& pose) {
      return holds_heading(pose.extent[2], one.truth.heading) && holds_starts(pose, one.problem.part, one.starts, 1e-6);
    });
    missed += is_in ? 0 : 1;
    if (!is_in) std::printf("%d missed: %s\n", number, answer.verdict_text().c_str());
  }
  EXPECT_LE(missed, 1 + count / 200) << "of " << count;
}

}  // namespace roll_poses_test
