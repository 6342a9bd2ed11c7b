// Two fingers hold a part that is free to move: where on it are they?
//
//   c++ -std=c++20 examples/04_two_fingers.cpp $(pkg-config --cflags --libs rollfix) -o pinch && ./pinch
#include <cstdio>
#include <rollfix/rollfix.hpp>
#include <vector>

using namespace rollfix;

int main() {
  const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");

  // Of each instant: how far finger a has travelled on the part, how far finger b, and by how much more the part's
  // tangent has turned under a than under b. How the part itself moved meanwhile need not be known.
  const std::vector<Reading> readings{
      {0.58, 0.94, -0.725248},
      {1.01, 1.92, -1.998490},
      {1.25, 2.37, -1.966238},
  };

  for (std::size_t count = 2; count <= readings.size(); ++count) {
    const auto end = readings.begin() + static_cast<std::ptrdiff_t>(count);
    Problem problem{part, std::vector<Reading>(readings.begin(), end)};
    problem.tolerance = 1e-5;  // radians
    const Answer answer = solve(problem);
    std::printf("%zu readings: %s\n", count, answer.verdict.text().c_str());
    for (const Placement& placement : answer.placements) {
      std::printf("  a started at s = %.4f, b at %.4f\n", placement.start[0], placement.start[1]);
    }
  }
}
