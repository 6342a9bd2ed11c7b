// An extent of two fingers is the box of all pairs that fit: also of those beside a line that leaves its curves at a
// slant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pair_cases.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace pair_extents_test {
namespace {

using random_outlines::uniform;
using rollfix::Part;
using rollfix::Placement;
using rollfix::Reading;
using rollfix::Vec2;

// What fits by more than this share of the tolerance is in, whatever flat boxes are taken for.
constexpr double kSurely = 0.74;

std::vector<Placement> found(const Part& part, const std::vector<Reading>& readings, double tolerance) {
  rollfix::LocateOptions options;
  options.tolerance = tolerance;
  return locate(part, readings, options).placements;
}

/// The largest |f_k| by the tangents' angles, away from corners.
double residual(const Part& part, const std::vector<Reading>& readings, double s, double t) {
  const auto turned = [&](double from, double length) {
    return part.turning().angle(from + length) - part.turning().angle(from);
  };
  double largest = 0;
  for (const Reading& reading : readings) {
    const double f = turned(s, reading.length[0]) - turned(t, reading.length[1]) - reading.turn;
    largest = std::max(largest, std::abs(f));
  }
  return largest;
}

bool is_in_an_extent(const Part& part, const std::vector<Placement>& placements, double s, double t) {
  const double slack = 1e-9 * part.perimeter();
  return std::any_of(placements.begin(), placements.end(), [&](const Placement& one) {
    return part.boundary().distance(one.extent[0], s) <= slack && part.boundary().distance(one.extent[1], t) <= slack;
  });
}

/// An open outline of a slot's end and an edge, and a start at which both readings are off by less than the tolerance.
TEST(PairExtents, hold_what_fits_beside_a_line_that_ends_at_a_joint) {
  rollfix::Outline outline;
  outline.closed = false;
  outline.curves = {
      rollfix::Arc({0.05616591505589951, 0.056165915055899504}, 0.09463538783335237, -2.5061944901923447, 0.3),
      rollfix::Line({-3.673940397442059e-18, -0.02}, {0.02, 0.0})};
  const Part part(outline);
  const std::vector<Reading> readings = {{0.03054363734943128, -0.026992315577761883, 2.8832937443181432},
                                         {-0.0010358095913857966, -0.004541222196026935, -0.01094526704122356}};
  EXPECT_TRUE(is_in_an_extent(part, found(part, readings, 0.03), 0.0260, 0.0515));
}

TEST(PairExtents, hold_what_fits_beside_a_line_that_ends_where_an_outline_does) {
  rollfix::Outline outline;
  outline.closed = false;
  outline.curves = {
      rollfix::Arc({0.8039933097079901, 0.42353277989761384}, 0.0001, -0.9019040149183847, 2.057397079412779),
      rollfix::Line({0.8040336564512023, 0.4236242792982248}, {-0.6399616825400343, 1.060355326199691}),
      rollfix::Arc({-0.6601350541461324, 1.0146056258941996}, 0.05, 1.1554930644940677, 2.0823600203125676),
      rollfix::Line({-0.7099035812005761, 1.009800033856676}, {-0.5499601600967736, -0.6466344737397157}),
      rollfix::Arc({-0.5498606230426647, -0.6466248625556407}, 0.0001, -3.045332222372927, 2.1434282074542397)};
  const Part part(outline);
  const std::vector<Reading> readings = {{-0.21711970745447662, -1.7474061218368266, 0.0},
                                         {1.5460977762070627, -1.407095488607267, 2.0823600203125676}};
  EXPECT_TRUE(is_in_an_extent(part, found(part, readings, 0.01), 0.2171199, 3.32661));
}

/// Pairs drawn in and around the extents.
TEST(PairExtents, hold_all_that_fits_on_random_lines_and_arcs) {
  std::mt19937_64 generator = test_generator();
  const int count = test_count(40);
  int fitting = 0;
  int outside = 0;
  for (int k = 0; k < count; ++k) {
    random_outlines::Question question = random_outlines::question_of_two(generator);
    const double tolerance = std::pow(10, uniform(generator, -3, -1.3));
    const auto placements = found(question.part, question.readings, tolerance);
    int missed = 0;
    for (const Placement& placement : placements) {
      for (int draw = 0; draw < 400; ++draw) {
        const auto drawn = [&](std::size_t finger) {
          const rollfix::Interval& extent = placement.extent[finger];
          return extent.lo + uniform(generator, -0.3, 1.3) * std::max(extent.width(), 0.01 * question.part.perimeter());
        };
        const double s = drawn(0);
        const double t = drawn(1);
        const auto is_on_part = [&](double start, std::size_t finger) {
          return std::all_of(question.readings.begin(), question.readings.end(), [&](const Reading& reading) {
            const double end = start + reading.length[finger];
            return std::min(start, end) > 0 && std::max(start, end) < question.part.perimeter();
          });
        };
        if (!question.part.closed() && !(is_on_part(s, 0) && is_on_part(t, 1))) continue;
        if (residual(question.part, question.readings, s, t) > kSurely * tolerance) continue;
        ++fitting;
        missed += is_in_an_extent(question.part, placements, s, t) ? 0 : 1;
      }
    }
    outside += missed;
    EXPECT_EQ(missed, 0) << "question " << k << ", tolerance " << tolerance;
  }
  std::printf("%d pairs that fit, %d outside\n", fitting, outside);
  EXPECT_GT(fitting, count);
}

}  // namespace
}  // namespace pair_extents_test
