// With a wide tolerance a placement is a large set, found in many boxes: put together it is one placement.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pair_cases.hpp"
#include "pair_oracle.hpp"
#include "random.hpp"
#include "shapes.hpp"

namespace pair_components_test {
namespace {

using namespace rollfix;
using pair_cases::Case;

// A box is in or out as its middle is where f varies by a quarter of the tolerance: sets are known to within an eighth.
constexpr double kSurelyInside = 0.85;

/// By how much a pair misses the readings, by the check's own angles.
double miss(const pair_oracle::Boundary& boundary, const Case& drawn, const LocateOptions& options, double s,
            double t) {
  const double start_s = boundary.rough(s).angle, start_t = boundary.rough(t).angle;
  double most = options.facing ? std::fabs(std::remainder(start_s - start_t - *options.facing, 2 * shapes::kPi)) : 0;
  for (const Reading& r : drawn.readings) {
    const double turn_a = boundary.rough(s + r.length[0]).angle - start_s;
    most = std::max(most, std::fabs(turn_a - (boundary.rough(t + r.length[1]).angle - start_t) - r.turn));
  }
  return most;
}

/// Where two placements' extents have an edge or a part of one in common, no pair on it fits: it would join them.
void expect_apart(const pair_oracle::Boundary& boundary, const Case& drawn, const LocateOptions& options,
                  const Placement& one, const Placement& two) {
  constexpr int kSamples = 400;
  Interval common[2];
  for (std::size_t k = 0; k < 2; ++k) {
    common[k] = {std::max(one.extent[k].lo, two.extent[k].lo), std::min(one.extent[k].hi, two.extent[k].hi)};
  }
  const double thin = 1e-9 * boundary.perimeter();
  if (common[0].width() < -thin || common[1].width() < -thin) return;
  if (common[0].width() > thin && common[1].width() > thin) return;  // extents may overlap where the sets don't
  double least = 1e300;
  for (int k = 0; k <= kSamples; ++k) {
    const auto at = [&](const Interval& interval) { return interval.lo + interval.width() * k / kSamples; };
    least = std::min(least, miss(boundary, drawn, options, at(common[0]), at(common[1])));
  }
  EXPECT_GT(least, kSurelyInside * options.tolerance) << "these two are one: starts " << one.start[0] << " "
                                                      << one.start[1] << " and " << two.start[0] << " " << two.start[1];
}

class PairComponents : public testing::TestWithParam<std::string> {
 protected:
  Outline outline_ = gallery(GetParam());
  Part part_{outline_};
  pair_oracle::Boundary boundary_{outline_};

  void expect_all_apart(const Case& drawn, const LocateOptions& options) const {
    const Search search = locate(part_, drawn.readings, options);
    for (std::size_t i = 0; i < search.placements.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        expect_apart(boundary_, drawn, options, search.placements[i], search.placements[j]);
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Gallery, PairComponents,
                         testing::Values("ellipse", "limacon", "cam,base=2,lift=0.12", "gear,teeth=4,depth=0.03",
                                         "spline"),
                         shapes::as_identifier);

TEST_P(PairComponents, no_placement_is_cut_at_the_edge_of_a_box) {
  auto generator = test_generator(72);
  for (int k = 0; k < test_count(20); ++k) {
    SCOPED_TRACE(testing::Message() << "case " << k);
    LocateOptions options;
    options.tolerance = std::pow(10, -1 - k % 3);
    const Case drawn = pair_cases::random_case(part_, 1 + static_cast<std::size_t>(k % 2), generator);
    if (k % 2 == 0) options.facing = drawn.facing;
    expect_all_apart(drawn, options);
  }
}

TEST(PairSliver, that_runs_through_dozens_of_boxes_is_one_placement) {
  const Part part(gallery("cam,base=2.13,lift=0.127"));
  LocateOptions options;
  options.tolerance = 1e-3;
  options.facing = -0.86901839567384442;
  const Search search = locate(part, {{7.43918898608554, -5.904109502083676, 6.1149298195681743}}, options);
  EXPECT_EQ(search.placements.size(), 3U);
}

}  // namespace
}  // namespace pair_components_test
