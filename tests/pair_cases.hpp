#pragma once

// Random cases for two fingers, and what it means that a search holds a pair.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/turning_function.hpp"

namespace pair_cases {

using rollfix::Part;
using rollfix::PerFinger;
using rollfix::Placement;
using rollfix::Reading;

/// What two fingers read that start at s and t, by the production turning function.
inline Reading reading_from(const Part& part, const PerFinger<double>& start, double length_a, double length_b) {
  const auto turn = [&](double s, double length) { return part.turning().angle(s + length) - part.turning().angle(s); };
  return {length_a, length_b, turn(start[0], length_a) - turn(start[1], length_b)};
}

/// Two first contacts and what is read from there.
struct Case {
  PerFinger<double> start{0.0, 0.0};
  std::vector<Reading> readings;
  double facing = 0;  // Theta(s) - Theta(t)
};

/// Rolls of up to a lap and a quarter in either direction; on an open part within it.
inline Case random_case(const Part& part, std::size_t readings, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double period = part.perimeter();
  const auto length = [&](double from) {
    return part.closed() ? (2.5 * unit(generator) - 1.25) * period : unit(generator) * period - from;
  };
  Case drawn;
  for (double& start : drawn.start) start = unit(generator) * period;
  for (std::size_t k = 0; k < readings; ++k) {
    const double length_a = length(drawn.start[0]);
    drawn.readings.push_back(reading_from(part, drawn.start, length_a, length(drawn.start[1])));
  }
  drawn.facing = part.turning().angle(drawn.start[0]) - part.turning().angle(drawn.start[1]);
  return drawn;
}

/// Cases that symmetry makes special: rolls of equal or opposite length, of none, of half a lap or a whole one. Closed
/// parts only.
inline Case special_case(const Part& part, std::size_t readings, std::mt19937_64& generator) {
  std::uniform_int_distribution<int> which(0, 5);
  Case drawn = random_case(part, readings, generator);
  for (Reading& reading : drawn.readings) {
    const double half = 0.5 * part.perimeter();
    const double others[] = {reading.length[1], reading.length[0], -reading.length[0], 0, half, 2 * half};
    reading = reading_from(part, drawn.start, reading.length[0], others[which(generator)]);
  }
  return drawn;
}

/// Cases in which about a third of all contacts are at convex corners, the finger somewhere in its pivot. Closed parts
/// with corners only.
inline Case corner_case(const Part& part, std::size_t readings, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<rollfix::Corner> convex;
  for (const rollfix::Corner& corner : part.corners()) {
    if (corner.turn > 0) convex.push_back(corner);
  }
  const double period = part.perimeter();
  struct Contact {
    double s;
    double direction;
  };
  const auto contact = [&](double winding) -> Contact {
    const double loops = winding * part.turning().period_turn();
    if (unit(generator) < 0.35) {
      const rollfix::Corner& corner =
          convex[std::uniform_int_distribution<std::size_t>(0, convex.size() - 1)(generator)];
      const double after = part.turning().angle(corner.s, rollfix::Side::after);
      return {corner.s + winding * period, after - unit(generator) * corner.turn + loops};
    }
    const double s = unit(generator) * period;
    return {s + winding * period, part.turning().angle(s) + loops};
  };
  const Contact s = contact(0), t = contact(0);
  Case drawn{{s.s, t.s}, {}, s.direction - t.direction};
  for (std::size_t k = 0; k < readings; ++k) {
    const Contact a = contact(std::floor(2 * unit(generator)) - 1), b = contact(std::floor(2 * unit(generator)) - 1);
    drawn.readings.push_back({a.s - s.s, b.s - t.s, (a.direction - s.direction) - (b.direction - t.direction)});
  }
  return drawn;
}

/// Two readings with a root where det J is 0 to rounding: the last length is moved until it is. None where it can't be.
inline std::optional<Case> double_root_case(const Part& part, std::mt19937_64& generator) {
  Case drawn = random_case(part, 2, generator);
  const auto gain = [&](double s, double length) {
    return part.turning().curvature(s + length) - part.turning().curvature(s);
  };
  const double s = drawn.start[0];
  const double t = drawn.start[1];
  const Reading& first = drawn.readings[0];
  Reading& second = drawn.readings[1];
  const auto determinant = [&](double length_b) {
    return gain(s, second.length[0]) * gain(t, first.length[1]) - gain(s, first.length[0]) * gain(t, length_b);
  };
  double lo = second.length[1], hi = lo + 0.3 * part.perimeter();
  const bool rises = determinant(hi) > 0;
  if ((determinant(lo) > 0) == rises) return {};
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (lo + hi);
    ((determinant(middle) > 0) == rises ? hi : lo) = middle;
  }
  second = reading_from(part, drawn.start, second.length[0], lo);
  return drawn;
}

inline double distance(const Part& part, double a, double b) { return part.boundary().distance(a, b); }

inline double distance(const Part& part, const PerFinger<double>& a, const PerFinger<double>& b) {
  return std::max(distance(part, a[0], b[0]), distance(part, a[1], b[1]));
}

/// How far a pair is from the line through a stretch, whichever way round.
inline double distance_to_family(const Part& part, const std::vector<PerFinger<double>>& family,
                                 const PerFinger<double>& pair) {
  double least = 1e300;
  for (std::size_t i = 0; i < family.size(); ++i) {
    const PerFinger<double>& from = family[i];
    const PerFinger<double>& to = family[std::min(i + 1, family.size() - 1)];
    double along[2], off[2];
    for (std::size_t finger = 0; finger < 2; ++finger) {
      along[finger] = to[finger] - from[finger];
      const double middle = from[finger] + 0.5 * along[finger];
      off[finger] = part.boundary().offset(middle, pair[finger]);
    }
    const double square = along[0] * along[0] + along[1] * along[1];
    const double share = square > 0 ? std::clamp((off[0] * along[0] + off[1] * along[1]) / square, -0.5, 0.5) : 0.0;
    least = std::min(least, std::hypot(off[0] - share * along[0], off[1] - share * along[1]));
  }
  return least;
}

/// Is there a placement with this pair in its extent, give or take `slack`; of a stretch also near its line?
inline bool holds(const Part& part, const Placement& placement, const PerFinger<double>& pair, double slack) {
  for (std::size_t finger = 0; finger < 2; ++finger) {
    const bool inside = part.boundary().contains(placement.extent[finger], pair[finger], slack);
    if (!inside && !placement.whole_loop[finger]) return false;
  }
  return placement.family.empty() || distance_to_family(part, placement.family, pair) <= placement.family_error + slack;
}

inline bool holds(const Part& part, const rollfix::Search& search, const PerFinger<double>& pair, double slack) {
  return std::any_of(search.placements.begin(), search.placements.end(),
                     [&](const Placement& placement) { return holds(part, placement, pair, slack); });
}

}  // namespace pair_cases
