// A Locator that has had its answers before allocates nothing for one finger's reading. A program of its own, because
// it counts every operator new.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "rollfix/locate/locator.hpp"
#include "rollfix/outline/gallery.hpp"
#include "rollfix/outline/points.hpp"

namespace {

std::size_t allocations = 0;

void* take(std::size_t size) {
  ++allocations;
  void* const block = std::malloc(size > 0 ? size : 1);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}

}  // namespace

void* operator new(std::size_t size) { return take(size); }
void* operator new[](std::size_t size) { return take(size); }
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }

namespace {

using namespace rollfix;

constexpr std::size_t kReadings = 200;

/// Of rolls that parts of the gallery, and one through many points, can have made: of up to a lap, of none, of a whole
/// one.
struct Questions {
  std::vector<Part> parts;
  std::vector<std::vector<Reading>> readings;

  Questions() {
    for (const GalleryShape& shape : gallery_shapes()) add(Part(gallery(shape.name)));
    std::vector<Vec2> points;
    const Part wing(gallery("naca,digits=2412"));
    for (int k = 0; k < 160; ++k) points.push_back(wing.point(wing.perimeter() * k / 160));
    PartOptions trusted;
    trusted.allow_crossing = true;
    add(Part({"points", spline_through(points, true), true}, trusted));
  }

  void add(const Part& part) {
    std::mt19937_64 random(parts.size());
    std::uniform_real_distribution<double> place(0, part.perimeter());
    const TurningFunction& turning = part.turning();
    std::vector<Reading> some{{0.0, 0.0}};
    if (part.closed()) some.push_back({part.perimeter(), turning.period_turn()});
    while (some.size() < kReadings) {
      const double s = place(random);
      const double t = place(random);
      some.push_back({t - s, turning.angle(t) - turning.angle(s)});
    }
    parts.push_back(part);
    readings.push_back(some);
  }

  /// How many placements there are, and unless it is null how many of them are not what locate() finds.
  std::size_t ask(Locator& locator, std::size_t* others = nullptr) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for (const Reading& reading : readings[k]) {
        const Search& found = locator.locate(parts[k], reading);
        count += found.placements.size();
        if (others != nullptr) *others += differences(found, locate(parts[k], reading));
      }
    }
    return count;
  }

  static std::size_t differences(const Search& one, const Search& other) {
    if (one.status != other.status || one.placements.size() != other.placements.size()) return 1;
    std::size_t count = 0;
    for (std::size_t k = 0; k < one.placements.size(); ++k) {
      const Placement& a = one.placements[k];
      const Placement& b = other.placements[k];
      const bool same = a.kind == b.kind && a.start == b.start && a.end == b.end && a.residual == b.residual &&
                        a.error == b.error && a.roots.size() == b.roots.size() &&
                        a.pivot.has_value() == b.pivot.has_value();
      count += same ? 0 : 1;
    }
    return count;
  }
};

TEST(Locator, that_has_had_such_answers_allocates_nothing_for_a_reading_of_one_finger) {
  const Questions questions;
  Locator locator;
  const std::size_t placements = questions.ask(locator);
  const std::size_t before = allocations;
  EXPECT_EQ(questions.ask(locator), placements);
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_GT(placements, kReadings * questions.parts.size());
}

TEST(Locator, spares_what_a_search_without_it_allocates) {
  const Part part(gallery("ellipse"));
  const Reading reading{1.0, 0.625};
  const std::size_t before = allocations;
  EXPECT_FALSE(locate(part, reading).placements.empty());
  EXPECT_GT(allocations, before);
}

TEST(Locator, says_what_locate_says_whatever_it_was_asked_before) {
  const Questions questions;
  Locator locator;
  std::size_t others = 0;
  EXPECT_GT(questions.ask(locator, &others), 0U);
  EXPECT_EQ(others, 0U);
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
