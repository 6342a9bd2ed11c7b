// A stranger's program that is compiled for its own machine, with vectors that the library was not: what it passes and
// gets has the same layout all the same.
#include <cmath>
#include <cstdio>

#include <rollfix/rollfix.hpp>

using namespace rollfix;

// What the library's own compiler gives them.
constexpr std::size_t kMostAlignment = 16;
static_assert(alignof(Placement) <= kMostAlignment && alignof(Mode) <= kMostAlignment);
static_assert(alignof(Answer) <= kMostAlignment && alignof(Search) <= kMostAlignment);
static_assert(alignof(Problem) <= kMostAlignment && alignof(Sample) <= kMostAlignment);
static_assert(alignof(PoseSpread) <= kMostAlignment && alignof(Weighing) <= kMostAlignment);
static_assert(alignof(Jet) <= kMostAlignment && alignof(Curve) <= kMostAlignment && alignof(Part) <= kMostAlignment);
static_assert(alignof(Powers) <= kMostAlignment && alignof(TurningFunction) <= kMostAlignment);

int main() {
  const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  const Noise noise{.contact = 0.01, .angle = 0.01};
  FreePlan plan;
  plan.fingers[0].finger = plan.fingers[1].finger = disk(0.1);
  plan.fingers[0].start = 0.8;
  plan.fingers[0].distance = 1.25;
  plan.fingers[1].start = 4.1;
  plan.fingers[1].distance = 2.37;
  const Answer answer = solve({part, noisy_roll_free(part, plan, noise, 1).log, {disk(0.1)}, noise});
  if (answer.placements.empty()) return 1;
  for (const Placement& one : answer.placements) {
    const double variance = one.covariance(0, 0);
    if (!(std::abs(std::sqrt(variance) - one.sd[0]) <= 1e-9)) return 1;
    std::printf("%.3f: s = %.3f, t = %.3f\n", one.probability, one.start[0], one.start[1]);
  }
  return 0;
}
