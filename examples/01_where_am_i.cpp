// Where on the part is the finger? All places that fit one reading, and the one that fits two.
//
//   c++ -std=c++20 examples/01_where_am_i.cpp $(pkg-config --cflags --libs rollfix) -o where && ./where
#include <cstdio>
#include <numbers>
#include <rollfix/rollfix.hpp>
#include <vector>

using namespace rollfix;

constexpr double kDegree = std::numbers::pi / 180;

void show(const Answer& answer) {
  std::printf("%s\n", answer.verdict.text().c_str());
  for (const Placement& placement : answer.placements) {
    std::printf("  started at s = %.3f, is now at s = %.3f\n", placement.start[0], placement.end[0]);
  }
}

int main() {
  const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
  // A reading: how far the contact has travelled on the part, and how much the part's tangent has turned on the way.
  const Reading first(0.9977, 56.93 * kDegree);
  const Reading second(1.9500, 131.20 * kDegree);  // of the same roll, later: from the same first contact

  Problem problem{part, first};
  problem.tolerance = 0.02 * kDegree;  // how well the turns are known
  show(solve(problem));

  problem.measured = std::vector{first, second};
  show(solve(problem));
}
