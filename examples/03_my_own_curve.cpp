// My part is a formula: how do I tell? A type with `domain` and `jet`, whose derivatives are checked.
//
//   c++ -std=c++20 examples/03_my_own_curve.cpp $(pkg-config --cflags --libs rollfix) -o curve && ./curve
#include <cmath>
#include <cstdio>
#include <numbers>
#include <rollfix/rollfix.hpp>
#include <string>

using namespace rollfix;

/// x = 3 cos u, y = 2 sin u + 0.7 cos 2u: an oval, dented at the top.
struct Bean {
  Interval domain() const { return {0, 2 * std::numbers::pi}; }
  Jet jet(double u) const {
    const double c = std::cos(u), s = std::sin(u), c2 = std::cos(2 * u), s2 = std::sin(2 * u);
    return {{3 * c, 2 * s + 0.7 * c2},    // the place, and its derivatives by u:
            {-3 * s, 2 * c - 1.4 * s2},   // the first,
            {-3 * c, -2 * s - 2.8 * c2},  // the second
            {3 * s, -2 * c + 5.6 * s2}};  // and the third
  }
};

int main() {
  const Outline outline{"bean", {Curve(Bean{})}};
  for (const std::string& fault : check(outline)) std::printf("wrong: %s\n", fault.c_str());

  const Part part(outline);
  std::printf("perimeter %.6f, %zu inflections\n", part.perimeter(), part.inflections().size());

  const Answer answer = solve({part, Reading(2.0, 0.5)});
  std::printf("a roll over 2.0 that turned by 0.5 rad: %s\n", answer.verdict.text().c_str());
  for (const Placement& placement : answer.placements) {
    std::printf("  s = %.6f, at (%.4f, %.4f)\n", placement.start[0], placement.point[0].x(), placement.point[0].y());
  }
}
