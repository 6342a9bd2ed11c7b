// What can the finger reach? The parts of a boundary on which a disk can roll at all.
//
//   c++ -std=c++20 examples/06_what_can_it_reach.cpp $(pkg-config --cflags --libs rollfix) -o reach && ./reach
#include <cstdio>
#include <rollfix/rollfix.hpp>

using namespace rollfix;

int main() {
  const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
  std::printf("perimeter %.3f; by its curvature a disk of radius %.3f rolls everywhere\n", part.perimeter(),
              largest_disk(part));

  for (const double radius : {0.1, 0.5, 2.0}) {
    const Reach reach = reach_of(part, disk(radius));
    std::printf("a disk of radius %.1f reaches %.1f %%\n", radius, 100 * reach.share());
    for (const Interval& gap : reach.gaps()) {
      const Hit hit = deepest_hit(part, reach.curvature, gap);  // what would be in the way
      std::printf("  not from s = %.3f to %.3f: it would hit the part at s = %.3f\n", gap.lo, gap.hi, hit.s);
    }
  }

  // A finger of this size could not make all the rolls that fit a reading.
  const Reading reading(0.9977, 0.9936);
  for (const Finger& finger : {disk(0.1), disk(2.0)}) {
    Problem problem{part, reading, {finger}};
    problem.tolerance = 1e-4;
    const Answer answer = solve(problem);
    std::printf("with a disk of radius %.1f: %s, %zu out of reach\n", finger.disk()->radius,
                answer.verdict.text().c_str(), answer.dropped.reach);
  }
}
