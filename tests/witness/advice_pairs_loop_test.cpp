// Two fingers: locate, advise, roll, locate. Does the loop close, and sooner than with random rolls?
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <string>

#include "random.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/turning_function.hpp"

namespace advice_pairs_loop_test {
namespace {

using rollfix::Advice;
using rollfix::Belief;
using rollfix::Mode;
using rollfix::Part;
using rollfix::PerFinger;

constexpr std::size_t kRows = 60;      // of a roll
constexpr std::size_t kMostRolls = 8;  // after the first one
constexpr double kFirstRoll = 0.03;    // of the perimeter
constexpr double kRandomRoll = 0.25;   // the longest, either way, of each finger
constexpr double kContact = 2e-4;      // of the perimeter
constexpr double kAngle = 3e-3;

/// Two fingers on a part that turns as it likes: both lengths and the difference of the turns, with errors of each row
/// and of the first contacts. Written apart from the library, of which it takes the tangent's angle alone.
class Hand {
 public:
  Hand(const Part& part, const PerFinger<double>& start, std::uint64_t seed)
      : part_(part), start_(start), random_(seed), first_{error(), error(), angle()} {}

  void roll(const PerFinger<double>& by, Belief& belief) {
    const PerFinger<double> from = rolled_;
    for (std::size_t k = 1; k <= kRows; ++k) {
      const double share = static_cast<double>(k) / kRows;
      for (const std::size_t finger : {0U, 1U}) rolled_[finger] = from[finger] + share * by[finger];
      const auto turn = [&](std::size_t finger) {
        const auto& turning = part_.turning();
        return turning.angle(start_[finger] + rolled_[finger]) - turning.angle(start_[finger]);
      };
      belief.add(rollfix::Reading(rolled_[0] + error() - first_[0], rolled_[1] + error() - first_[1],
                                  turn(0) - turn(1) + angle() - first_[2]));
    }
  }

 private:
  double error() { return kContact * part_.perimeter() * normal_(random_); }
  double angle() { return std::sqrt(2.0) * kAngle * normal_(random_); }

  const Part& part_;
  PerFinger<double> start_;
  PerFinger<double> rolled_{0.0, 0.0};
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::array<double, 3> first_;
};

struct Loop {
  bool resolved = false;
  bool wrong = false;
  std::size_t rolls = 0;  // after the first one
  double travel = 0;      // of the finger that goes farther, in perimeters
};

rollfix::AdviceOptions how(const Part& part) {
  rollfix::AdviceOptions options;
  options.turn_sd = 2 * kAngle;  // of two rows, of two fingers each
  options.length_sd = std::sqrt(2.0) * kContact * part.perimeter();
  options.rows = 6;
  return options;
}

Loop close_loop(const Part& part, const PerFinger<double>& start, bool advised, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-kRandomRoll, kRandomRoll);
  rollfix::BeliefOptions options;
  options.noise = {kContact * part.perimeter(), kAngle, 0, 0};
  rollfix::FingerGeometry contacts;
  contacts.finger_curvature = PerFinger<double>(0.0, 0.0);
  Belief belief(part, rollfix::LogKind::travelled, options, contacts);
  Hand hand(part, start, seed);
  const double P = part.perimeter();
  hand.roll(PerFinger<double>(kFirstRoll * P, -kFirstRoll * P), belief);
  Loop loop;
  while (true) {
    if (belief.verdict().name == rollfix::Verdict::unique) {
      const Mode& best = belief.modes().front();
      loop.resolved = true;
      for (const std::size_t k : {0U, 1U}) {
        loop.wrong |= part.boundary().distance(best.mean[k], start[k]) > 5 * best.sd[k] + 1e-6 * P;
      }
      return loop;
    }
    if (loop.rolls == kMostRolls) return loop;
    PerFinger<double> next(any(random) * P, any(random) * P);
    if (advised) {
      const Advice advice = advise(part, rollfix::hypotheses_of(part, belief.modes()), how(part));
      if (!advice.helps) return loop;
      next = advice.lengths();
    }
    hand.roll(next, belief);
    ++loop.rolls;
    loop.travel += std::max(std::abs(next[0]), std::abs(next[1])) / P;
  }
}

struct Sum {
  void add(const Loop& loop) {
    resolved += loop.resolved ? 1 : 0;
    wrong += loop.wrong ? 1 : 0;
    rolls += static_cast<double>(loop.rolls);
    travel += loop.travel;
  }
  int resolved = 0;
  int wrong = 0;
  double rolls = 0;
  double travel = 0;
};

}  // namespace

TEST(AdvicePairsLoop, advised_rolls_leave_one_pair_sooner_than_random_ones) {
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> unit;
  const int count = test_count(2);
  Sum advised;
  Sum drawn;
  int cases = 0;
  for (const char* shape : {"cam", "limacon", "naca", "spline,n=9,seed=7,wobble=0.2", "spline,n=12,seed=5",
                            "spline,n=9,seed=4,wobble=0.25", "spline,seed=3"}) {
    const Part part(rollfix::gallery(shape));
    Sum of_advised;
    Sum of_drawn;
    for (int k = 0; k < count; ++k, ++cases) {
      const PerFinger<double> start(unit(random) * part.perimeter(), unit(random) * part.perimeter());
      const std::uint64_t seed = random();
      of_advised.add(close_loop(part, start, true, seed));
      of_drawn.add(close_loop(part, start, false, seed));
    }
    for (const auto& [name, sum] : {std::pair("advised", of_advised), std::pair("random", of_drawn)}) {
      std::cout << shape << ", " << name << ": " << sum.resolved << " of " << count << " end in one pair, " << sum.wrong
                << " wrong, " << sum.rolls / count << " rolls, " << sum.travel / count << " P\n";
    }
    advised.resolved += of_advised.resolved;
    advised.wrong += of_advised.wrong;
    advised.rolls += of_advised.rolls;
    advised.travel += of_advised.travel;
    drawn.resolved += of_drawn.resolved;
    drawn.rolls += of_drawn.rolls;
    drawn.travel += of_drawn.travel;
  }
  std::cout << "all, advised: " << advised.resolved << " of " << cases << ", " << advised.rolls / cases << " rolls, "
            << advised.travel / cases << " P; random: " << drawn.resolved << ", " << drawn.rolls / cases << " rolls, "
            << drawn.travel / cases << " P\n";
  EXPECT_GE(advised.resolved, 0.9 * cases);
  EXPECT_LE(advised.wrong, 0.05 * cases + 1);
  EXPECT_LT(advised.travel, drawn.travel);
}

}  // namespace advice_pairs_loop_test
