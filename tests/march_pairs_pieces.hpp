#pragma once

// The march's own parts for one question, to look at one pair of intervals at a time.

#include <optional>
#include <vector>

#include "march/pairs.hpp"
#include "march_pairs.hpp"

namespace march_pairs {

struct Pieces {
  rollfix::march::March rate;
  rollfix::march::Path path;
  rollfix::march::Segments a;
  rollfix::march::Segments b;
  rollfix::march::PairProblem problem;
  rollfix::march::Tally tally;
  rollfix::march::PairSteps steps;
  rollfix::march::Partition divided_a;
  rollfix::march::Partition divided_b;

  /// REQUIRES lengths between 0 and P.
  Pieces(const rollfix::Outline& outline, double perimeter, const Readings& readings)
      : rate(outline, rollfix::march::curvature_rate_density()),
        path(outline, rollfix::march::curvature_density(), 0),
        a{{readings[0].length[0], readings[1].length[0]}, {}},
        b{{readings[0].length[1], readings[1].length[1]}, {}},
        problem{{readings[0].turn, readings[1].turn}, 1e-13},
        divided_a(divide({path, rate, perimeter}, a, tally, steps)),
        divided_b(divide({path, rate, perimeter}, b, tally, steps)) {}
  Pieces(const Pieces&) = delete;
  Pieces& operator=(const Pieces&) = delete;

  /// Calls `look` with each pair of intervals and its correspondence, if it has one.
  template <class Look>
  void each(const Look& look) {
    for (const auto& i : divided_a.intervals) {
      for (const auto& j : divided_b.intervals) look(i, j, correspond(i, j, problem, tally));
    }
  }
};

/// Planted readings with lengths between 0 and P.
struct PlantedWithin {
  Point at;
  Readings readings;

  PlantedWithin(const Exhaustive& oracle, std::mt19937_64& generator) {
    const double perimeter = oracle.perimeter();
    std::uniform_real_distribution<double> part(0.02, 0.98);
    at = {part(generator) * perimeter, part(generator) * perimeter};
    for (Reading& reading : readings) {
      reading.length[0] = part(generator) * perimeter;
      reading.length[1] = part(generator) * perimeter;
      reading.turn = oracle.phi(at.s, reading.length[0]) - oracle.phi(at.t, reading.length[1]);
    }
  }
};

}  // namespace march_pairs
