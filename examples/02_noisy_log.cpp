// How sure can I be? From a log with noise in it to places with their probability.
//
//   c++ -std=c++20 examples/02_noisy_log.cpp $(pkg-config --cflags --libs rollfix) -o noisy && ./noisy
#include <cstdio>
#include <rollfix/rollfix.hpp>

using namespace rollfix;

int main() {
  // A wing's section in millimetres, and what a finger with a radius of 10 mm felt on it: where its skin was touched,
  // u, and how it was turned, psi, 33 times while it rolled.
  const Part part = load_part("examples/wing.csv");
  const Log log = read_log("examples/roll.csv");

  // How far the sensors are off, as standard deviations.
  const Noise noise{
      .contact = 0.05,  // mm: where the skin is touched
      .angle = 0.006,   // radians: how the finger is turned
      .slip = 0.004,    // per length: it does not roll quite without slip
  };

  const Answer answer = solve({part, log, {disk(10)}, noise});
  std::printf("%s, from %zu rows\n", answer.verdict.text().c_str(), log.rows());
  for (const Placement& placement : answer.placements) {
    std::printf("probability %.3f: started at s = %.1f +- %.1f mm, at the point (%.1f, %.1f)\n", placement.probability,
                placement.mean[0], placement.sd[0], placement.point[0].x(), placement.point[0].y());
  }
}
