// The production search and the paper's march share nothing but the curves. They must answer the same.

#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "march_families.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/march.hpp"
#include "shapes.hpp"

namespace march_production_test {
namespace {

using namespace rollfix;

constexpr double kAgreement = 1e-7;  // of a start, in parts of the perimeter

double distance(const Part& part, double one, double two) { return part.boundary().distance(one, two); }

/// Of a closed outline up to two laps either way; of an open one what fits on it.
Reading random_reading(const Part& part, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double period = part.perimeter();
  const double start = unit(generator) * period;
  const double length = part.closed() ? (4 * unit(generator) - 2) * period : unit(generator) * period - start;
  return shapes::reading_from(part, start, length);
}

class MarchProduction : public testing::TestWithParam<std::string> {
 protected:
  Outline outline_ = gallery(GetParam());
  Part part_{outline_};
  march::March march_{outline_, march::curvature_density()};

  bool found_by_march(const march::Result& result, double root) const {
    for (const march::Segment& segment : result.segments) {
      if (distance(part_, segment.start, root) <= std::max(kAgreement * part_.perimeter(), 4 * segment.error))
        return true;
    }
    return false;
  }

  /// How far the next root is from this one: what the march's reset may pass over.
  double gap(const Search& search, double root) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Placement& placement : search.placements) {
      for (const PerFinger<double>& other : placement.roots) {
        if (other[0] != root) nearest = std::min(nearest, distance(part_, other[0], root));
      }
    }
    return nearest;
  }
};

INSTANTIATE_TEST_SUITE_P(Gallery, MarchProduction,
                         testing::ValuesIn(march_families::with_others(march_families::kOfOneFinger)),
                         shapes::as_identifier);

TEST(MarchFamilies, of_one_finger_are_all_that_the_march_takes) {
  const auto march = [](const Outline& outline) { march::March(outline, march::curvature_density()); };
  EXPECT_EQ(march_families::taken_by(march), march_families::kOfOneFinger);
}

TEST_P(MarchProduction, agrees_on_random_readings) {
  auto generator = test_generator();
  int readings = 0;
  int disagreements = 0;
  for (; readings < test_count(20); ++readings) {
    const Reading reading = random_reading(part_, generator);
    const Search search = locate(part_, reading);
    const march::Result result = march_.segments(reading.length[0], reading.turn);
    ASSERT_EQ(search.status, Status::complete);
    for (const march::Segment& segment : result.segments) {
      EXPECT_TRUE(shapes::holds(part_, search, segment.start, kAgreement * part_.perimeter() + 4 * segment.error))
          << "production lost s = " << segment.start << " of " << reading.length[0] << ", " << reading.turn;
    }
    for (const Placement& placement : search.placements) {
      for (const PerFinger<double>& roots : placement.roots) {
        const double root = roots[0];
        if (found_by_march(result, root)) continue;
        // What the march may lose: neighbours closer than its reset, and double roots, which it reports as doubts.
        ++disagreements;
        std::printf("%s L=%.17g theta=%.17g: the march lost s=%.12g, gap to the next root %.3g P, doubts %zu\n",
                    GetParam().c_str(), reading.length[0], reading.turn, root, gap(search, root) / part_.perimeter(),
                    result.doubts.size());
        EXPECT_TRUE(!result.complete() || gap(search, root) <= 1e-7 * part_.perimeter());
      }
    }
  }
  RecordProperty("readings", readings);
  RecordProperty("disagreements", disagreements);
}

}  // namespace
}  // namespace march_production_test
