// What an answer with noise may depend on, whatever the log: not on how often a roll is sampled, and not on noise that
// is said too large, but that it is wider.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "belief_cases.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/rolling.hpp"

namespace belief_laws_test {
namespace {

using rollfix::Belief;
using rollfix::BeliefOptions;
using rollfix::LogKind;
using rollfix::Mode;
using rollfix::Noise;
using rollfix::Part;
using rollfix::Reading;

/// Increments of a roll along a part, summed: each with errors of its own.
std::vector<Reading> increments(const Part& part, double start, double length, std::size_t rows, const Noise& noise,
                                std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double step = length / static_cast<double>(rows);
  std::vector<Reading> sums;
  Reading sum(0, 0);
  for (std::size_t k = 0; k < rows; ++k) {
    const double s = start + step * static_cast<double>(k);
    sum.length[0] += step + noise.contact * normal(random);
    sum.turn += part.turning().angle(s + step) - part.turning().angle(s) + noise.angle * normal(random);
    sums.push_back(sum);
  }
  return sums;
}

/// Straight sides and fillets, as drawn for a workshop: counter-clockwise corners, all convex but where a side turns
/// back.
Part plate() {
  using rollfix::Vec2;
  const std::vector<Vec2> corners{{0, 0}, {5, -0.4}, {5.5, 1.2}, {3.6, 1.7}, {3.4, 3.1}, {0.3, 3.4}};
  const std::vector<double> radii{0.6, 0.3, 0.25, 0.9, 0.5, 0.35};
  const std::size_t count = corners.size();
  std::vector<Vec2> begins;
  std::vector<Vec2> ends;
  std::vector<rollfix::Curve> arcs;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec2 in = (corners[k] - corners[(k + count - 1) % count]).normalized();
    const Vec2 out = (corners[(k + 1) % count] - corners[k]).normalized();
    const double turn = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
    const double back = radii[k] * std::tan(0.5 * std::abs(turn));
    begins.push_back(corners[k] - back * in);
    ends.push_back(corners[k] + back * out);
    const double side = turn > 0 ? 1 : -1;
    const Vec2 centre = begins.back() + side * radii[k] * Vec2(-in.y(), in.x());
    const Vec2 from = begins.back() - centre;
    arcs.emplace_back(rollfix::Arc(centre, radii[k], std::atan2(from.y(), from.x()), turn));
  }
  rollfix::Outline outline{"plate", {}, true};
  for (std::size_t k = 0; k < count; ++k) {
    outline.curves.push_back(arcs[k]);
    outline.curves.emplace_back(rollfix::Line(ends[k], begins[(k + 1) % count]));
  }
  return Part(outline);
}

Noise times(const Noise& noise, double factor) {
  return {factor * noise.contact, factor * noise.angle, factor * noise.slip, factor * noise.radius};
}

Belief belief_of(const Part& part, LogKind kind, const std::vector<Reading>& rows, const Noise& noise) {
  BeliefOptions options;
  options.noise = noise;
  Belief belief(part, kind, options);
  for (const Reading& row : rows) belief.add(row);
  return belief;
}

/// The truth stays where it can be, and if anything is sure it is that.
void expect_never_another(Belief& belief, double start, const Part& part, double factor) {
  const Mode* truth = belief_cases::mode_at(belief.modes(), start, part);
  EXPECT_NE(truth, nullptr) << "noise said " << factor << " times";
  const bool is_sure = belief.modes().front().probability >= 0.95;
  EXPECT_TRUE(!is_sure || truth == &belief.modes().front()) << "noise said " << factor << " times";
}

}  // namespace

TEST(BeliefLaws, noise_of_increments_that_is_said_too_large_makes_no_other_place_sure) {
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> unit;
  // None looks the same twice: there a wrong place can be sure.
  for (const char* shape : {"cam", "spline,n=9,seed=7,wobble=0.2", "spline,n=20,seed=2,wobble=0.1"}) {
    const Part part = belief_cases::part_of(shape);
    const double P = part.perimeter();
    const Noise noise{1e-4 * P, 5e-3, 0.02, 0};
    for (int k = 0; k < test_count(5); ++k) {
      const double start = unit(random) * P;
      const std::vector<Reading> rows = increments(part, start, 0.4 * P, 300, noise, random);
      for (const double factor : {1.0, 2.0, 5.0, 20.0}) {
        Belief belief = belief_of(part, LogKind::increments, rows, times(noise, factor));
        expect_never_another(belief, start, part, factor);
      }
    }
  }
}

TEST(BeliefLaws, noise_of_increments_that_is_said_too_large_leaves_the_true_place_the_likeliest) {
  const Part part = plate();
  const double P = part.perimeter();
  const Noise noise{1e-4 * P, 5e-3, 5e-3, 0};
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> unit;
  const int count = test_count(60);
  int first = 0;
  for (int k = 0; k < count; ++k) {
    const double start = unit(random) * P;
    Belief belief =
        belief_of(part, LogKind::increments, increments(part, start, 0.4 * P, 300, noise, random), times(noise, 20));
    first += belief_cases::mode_at(belief.modes(), start, part) == &belief.modes().front() ? 1 : 0;
  }
  EXPECT_GE(first, 0.8 * count) << "of " << count;
}

TEST(BeliefLaws, noise_of_a_finger_that_is_said_too_large_makes_no_other_place_sure) {
  const Part part = belief_cases::part_of("spline,n=9,seed=7,wobble=0.2");
  const double P = part.perimeter();
  const Noise noise = belief_cases::noise_on(part, 1e-3, 5e-3, 0.02);
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> unit;
  for (int k = 0; k < test_count(8); ++k) {
    const double start = unit(random) * P;
    const rollfix::Log log = belief_cases::roll_on(part, 0.1, start, 0.4 * P, 2000, noise, random()).log;
    double before = 0;
    for (const double factor : {1.0, 2.0, 5.0}) {
      BeliefOptions options;
      options.noise = times(noise, factor);
      Belief belief = belief_cases::belief_in(part, log, 0.1, options);
      expect_never_another(belief, start, part, factor);
      EXPECT_GT(belief.modes().front().sd[0], before) << "noise said " << factor << " times";
      before = belief.modes().front().sd[0];
    }
  }
}

TEST(BeliefLaws, rows_that_say_the_same_in_more_pieces_change_nothing) {
  const Part part = belief_cases::part_of("cam");
  const double P = part.perimeter();
  const Noise noise{1e-3 * P, 5e-3, 5e-3, 0};
  std::mt19937_64 random = test_generator();
  std::normal_distribution<double> normal;
  std::vector<Reading> once;
  for (Reading row : increments(part, 2, 0.4 * P, 200, {}, random)) {
    row.length[0] += noise.contact * normal(random);
    row.turn += noise.angle * normal(random);
    once.push_back(row);
  }
  std::vector<Reading> in_pieces;
  constexpr int kPieces = 10;
  for (const Reading& row : once) in_pieces.insert(in_pieces.end(), kPieces, row);
  Belief one = belief_of(part, LogKind::travelled, once, noise);
  // Each row's own errors larger, so that all of its pieces together are as good as it was. The offset that all rows
  // share is said as large as one row's, and so is wider.
  const double factor = std::sqrt(kPieces);
  Belief many =
      belief_of(part, LogKind::travelled, in_pieces, {factor * noise.contact, factor * noise.angle, noise.slip});
  ASSERT_EQ(one.verdict().text(), "unique");
  const Mode& first = one.modes().front();
  EXPECT_LT(belief_cases::distance(part, many.modes().front().mean[0], first.mean[0]), 2 * first.sd[0]);
  EXPECT_GT(many.modes().front().sd[0], 0.9 * first.sd[0]);
}

}  // namespace belief_laws_test
