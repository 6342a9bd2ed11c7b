// Several readings of one finger against the oracle of one: what fits each of them beyond doubt is answered, and what
// is answered is in a cluster of each. --count and --seed say how many random cases, and which.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "oracle/arcs.hpp"
#include "oracle/doubt.hpp"
#include "oracle/one_finger.hpp"
#include "oracle/one_finger_cases.hpp"
#include "random.hpp"
#include "rollfix/locate.hpp"

namespace oracle_readings_test {
namespace {

using namespace oracle;
using rollfix::Search;

/// Rolls from one place, each felt to within the tolerance or exactly.
struct Rolls {
  double start = 0;
  double tolerance = 0;
  std::vector<rollfix::Reading> readings;
};

Rolls random_rolls(const Boundary& boundary, RandomShapes& random) {
  RandomReadings lengths(boundary, random);
  Rolls rolls;
  const auto perimeter = static_cast<double>(boundary.perimeter());
  rolls.tolerance = lengths.reading().tolerance;
  // Not at a concave corner: on which side of it a roll starts and ends rounding would decide.
  const bool at_corner = !boundary.corners().empty() && boundary.corners().front().turn > 0 && random.chance(0.2);
  rolls.start = at_corner ? static_cast<double>(boundary.corners().front().s) : random.uniform(0, 1) * perimeter;
  const bool is_exact = random.chance(0.5);
  const auto count = static_cast<std::size_t>(random.whole(2, 5));
  while (rolls.readings.size() < count) {
    const double length = lengths.reading().length;
    const double end = rolls.start + length;
    if (!boundary.closed() && (end < 0 || end > perimeter)) continue;
    const Real turn = boundary.contact(end).angle - boundary.contact(rolls.start).angle;
    const double off = is_exact ? 0 : random.uniform(-0.8, 0.8) * rolls.tolerance;
    rolls.readings.emplace_back(length, static_cast<double>(turn) + off);
  }
  return rolls;
}

class ReadingsAgreement : Arcs {
 public:
  ReadingsAgreement(const Boundary& boundary, const Rolls& rolls, const Search& search)
      : Arcs(boundary), search_(search) {
    for (const rollfix::Reading& reading : rolls.readings) {
      questions_.push_back(
          {reading.length[0], reading.turn, std::max(rolls.tolerance, rollfix::kLeastTolerance), doubt(boundary)});
      truths_.emplace_back(boundary, questions_.back());
    }
  }

  /// The places that fit every reading beyond doubt, of those tried: the start, and the roots of each reading.
  std::vector<Real> fitting(const Rolls& rolls) const {
    std::vector<Real> places{rolls.start};
    for (const OneFinger& truth : truths_) {
      for (const Cluster& cluster : truth.clusters()) {
        for (const Interval& root : cluster.roots) places.push_back((root.lo + root.hi) / 2);
      }
    }
    places.erase(std::remove_if(places.begin(), places.end(), [&](Real s) { return !fits_all(s); }), places.end());
    return places;
  }

  bool is_answered(Real s) const {
    const auto at_s = [&](const rollfix::Interval& arc) { return meets(extent(arc), {s, s}); };
    return std::any_of(search_.placements.begin(), search_.placements.end(),
                       [&](const rollfix::Placement& placement) { return at_s(placement.extent[0]); }) ||
           std::any_of(search_.unresolved.begin(), search_.unresolved.end(),
                       [&](const auto& open) { return at_s(open[0]); });
  }

  /// In a cluster of each reading.
  bool may_fit(const rollfix::Placement& placement) const {
    return std::all_of(truths_.begin(), truths_.end(), [&](const OneFinger& truth) {
      return std::any_of(truth.clusters().begin(), truth.clusters().end(), [&](const Cluster& cluster) {
        return covers(cluster.starts, shrunk(extent(placement.extent[0])));
      });
    });
  }

 private:
  bool fits_all(Real s) const {
    for (std::size_t k = 0; k < truths_.size(); ++k) {
      const Real end = s + questions_[k].length;
      if (!boundary_.closed() && (end < 0 || end > boundary_.perimeter())) return false;
      const Real most = questions_[k].tolerance - questions_[k].doubt;
      if (std::max(std::abs(truths_[k].f(s)), std::abs(truths_[k].f(s, Side::before))) > most) return false;
    }
    return true;
  }

  const Search& search_;
  std::vector<Question> questions_;
  std::vector<OneFinger> truths_;
};

TEST(OracleReadings, all_that_fits_each_is_found_and_nothing_that_does_not_fit_one) {
  const int count = test_count(150);
  std::size_t places = 0;
  int incomplete = 0;
  for (int k = 0; k < count; ++k) {
    std::mt19937_64 generator = test_generator(5000 + static_cast<std::uint64_t>(k));
    RandomShapes random(generator);
    const Shape shape = random.shape(static_cast<std::size_t>(k));
    const Boundary known = shape.boundary();
    const Rolls rolls = random_rolls(known, random);
    SCOPED_TRACE(fmt::format("outline {} ({}), {} readings, tolerance {}", k, shape.name, rolls.readings.size(),
                             rolls.tolerance));
    rollfix::LocateOptions options;
    options.tolerance = rolls.tolerance;
    const Search search = locate(shape.part(), rolls.readings, options);
    const ReadingsAgreement agreement(known, rolls, search);
    for (const Real s : agreement.fitting(rolls)) {
      ++places;
      EXPECT_TRUE(agreement.is_answered(s)) << static_cast<double>(s);
    }
    for (const rollfix::Placement& placement : search.placements) {
      EXPECT_TRUE(agreement.may_fit(placement)) << placement.extent[0].lo << " " << placement.extent[0].hi;
    }
    incomplete += search.status == rollfix::Status::incomplete ? 1 : 0;
  }
  EXPECT_GE(places, static_cast<std::size_t>(count));
  EXPECT_LE(100 * incomplete, count);
}

}  // namespace
}  // namespace oracle_readings_test
