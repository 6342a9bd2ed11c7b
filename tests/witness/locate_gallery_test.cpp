// One finger on the gallery's shapes: the place that was rolled from is found, what is found fits, and how it moves
// with the reading. That there is no other place says tests/oracle/.

#include <gtest/gtest.h>

#include "random.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace locate_gallery_test {
namespace {

using namespace rollfix;

std::vector<std::string> specifications(bool smooth_only) {
  std::vector<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) {
    if (shape.name == "circle" || (smooth_only && !shape.smooth)) continue;
    names.push_back(shape.name);
  }
  for (const char* more : {"ellipse,a=1,b=0.05", "limacon,a=1.05,b=1", "spline,n=12,seed=5,wobble=0.4",
                           "spline,n=40,seed=8,wobble=0.1", "gear,teeth=12,r=1,depth=0.12"}) {
    names.emplace_back(more);
  }
  return names;
}

/// A start and a length in either direction, on a closed outline up to two laps.
struct Roll {
  double start;
  double length;
};

Roll random_roll(const Part& part, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double period = part.perimeter();
  if (part.closed()) return {unit(generator) * period, (4 * unit(generator) - 2) * period};
  const double start = unit(generator) * period;
  return {start, unit(generator) * period - start};
}

class Locate : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Gallery, Locate, testing::ValuesIn(specifications(false)), shapes::as_identifier);

TEST_P(Locate, finds_the_place_where_the_reading_was_taken) {
  const Part part(gallery(GetParam()));
  auto generator = test_generator();
  for (int k = 0; k < test_count(300); ++k) {
    const Roll roll = random_roll(part, generator);
    const Search search = locate(part, shapes::reading_from(part, roll.start, roll.length));
    EXPECT_EQ(search.status, Status::complete);
    EXPECT_TRUE(shapes::holds(part, search, roll.start, 1e-9 * part.perimeter())) << roll.start << " " << roll.length;
  }
}

TEST_P(Locate, answers_with_places_that_fit) {
  const Part part(gallery(GetParam()));
  auto generator = test_generator(1);
  for (int k = 0; k < test_count(300); ++k) {
    const Roll roll = random_roll(part, generator);
    const Reading reading = shapes::reading_from(part, roll.start, roll.length);
    for (const Placement& placement : locate(part, reading).placements) {
      EXPECT_LE(placement.residual, 1e-9 * (1 + 1e-9));
      if (placement.kind == Kind::corner) continue;
      const double inside = placement.kind == Kind::stretch ? placement.extent[0].middle() : placement.start[0];
      const Reading there = shapes::reading_from(part, inside, reading.length[0]);
      EXPECT_NEAR(there.turn, reading.turn, 1.1e-9) << placement.start[0];
    }
  }
}

class LocateSmooth : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Gallery, LocateSmooth, testing::ValuesIn(specifications(true)), shapes::as_identifier);

TEST_P(LocateSmooth, gives_sensitivities_that_finite_differences_confirm) {
  const Part part(gallery(GetParam()));
  auto generator = test_generator(3);
  const double step = 1e-6;
  for (int k = 0; k < test_count(20); ++k) {
    const Roll roll = random_roll(part, generator);
    const Reading reading = shapes::reading_from(part, roll.start, roll.length);
    for (const Placement& placement : locate(part, reading).placements) {
      if (placement.sensitivity.per_turn[0].empty()) continue;
      const double per_turn = placement.sensitivity.per_turn[0][0];
      if (placement.kind != Kind::crossing || std::abs(per_turn) > part.perimeter()) continue;
      const auto moved = [&](const Reading& other) {
        double nearest = part.perimeter();
        for (const double start : shapes::starts(locate(part, other))) {
          const double move = part.boundary().offset(placement.start[0], start);
          if (std::abs(move) < std::abs(nearest)) nearest = move;
        }
        return nearest;
      };
      const double by_turn =
          moved({reading.length[0], reading.turn + step}) - moved({reading.length[0], reading.turn - step});
      if (std::abs(by_turn) > 1e-3 * part.perimeter()) continue;  // an open curve's end
      EXPECT_NEAR(by_turn / (2 * step), per_turn, 1e-2 * std::abs(per_turn) + 1e-6);
    }
  }
}

}  // namespace
}  // namespace locate_gallery_test
