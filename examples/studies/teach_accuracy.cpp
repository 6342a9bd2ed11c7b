// How near a taught part comes to the true one: gallery shapes, driven around once in equal steps without noise.
// Prints docs/teach.md's table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/teach.hpp"

namespace {

using rollfix::Part;
using rollfix::Vec2;

rollfix::Log lap(const Part& part, int steps) {
  rollfix::Log log;
  log.name = "lap";
  log.kind = rollfix::LogKind::travelled;
  for (int k = 1; k <= steps; ++k) {
    const double s = part.perimeter() * k / steps;
    log.fingers[0].length.push_back(s);
    log.fingers[0].turn.push_back(part.turning().angle(s) - part.turning().angle(0));
  }
  return log;
}

/// The largest distance between places of equal arc length, as a share of the perimeter; both start at one place.
double error_of(const Part& taught, const Part& truth) {
  constexpr int kPlaces = 1000;
  const double turn = truth.tangent(0) - taught.tangent(0);
  double worst = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double share = static_cast<double>(k) / kPlaces;
    const Vec2 moved = taught.point(share * taught.perimeter()) - taught.point(0);
    const Vec2 turned(std::cos(turn) * moved.x() - std::sin(turn) * moved.y(),
                      std::sin(turn) * moved.x() + std::cos(turn) * moved.y());
    worst = std::max(worst, (truth.point(0) + turned - truth.point(share * truth.perimeter())).norm());
  }
  return worst / truth.perimeter();
}

}  // namespace

int main() {
  fmt::print("| rows | 100 | 400 | 1600 |\n| --- | --- | --- | --- |\n");
  for (const std::string name : {"ellipse", "limacon", "cam", "spline,seed=3", "stadium"}) {
    const Part truth(rollfix::gallery(name));
    fmt::print("| {} |", name);
    for (const int steps : {100, 400, 1600}) {
      fmt::print(" {:.0e} P |", error_of(Part(rollfix::teach(lap(truth, steps)).outline), truth));
    }
    fmt::print("\n");
  }
}
