// Where on the track is the car? Its wheel counts the way, its gyroscope the turn: the same problem.
//
//   c++ -std=c++20 examples/11_wheel_and_gyro.cpp $(pkg-config --cflags --libs rollfix) -o car && ./car
#include <cstdio>
#include <rollfix/rollfix.hpp>

using namespace rollfix;

int main() {
  // A track, and every 5 m what wheel and gyroscope added: `distance,dturn` in a file, here simulated.
  const Part track = load_part("examples/track.csv");
  const Noise noise{
      .contact = 0.5,  // m: of each distance
      .angle = 0.03,   // radians: of each turn
      .slip = 0.02,    // the tyre's size is known to a fiftieth
  };
  std::printf("a track of %.0f m\n", track.perimeter());

  for (const std::size_t rows : {10U, 20U, 40U, 80U}) {
    const NoisyIncrements drive = noisy_increments(track, 700, 5.0 * static_cast<double>(rows), rows, noise, 3);
    const Answer answer = solve({track, drive.log, {}, noise});  // no finger
    std::printf("after %3zu m: %s\n", 5 * rows, answer.verdict.text().c_str());
    for (const Placement& placement : answer.placements) {
      if (placement.probability < 0.05) continue;
      std::printf("  now at %.0f m +- %.0f m with probability %.2f; in truth %.0f m\n", placement.end_mean[0],
                  placement.end_sd[0], placement.probability, drive.s.back());
    }
  }
}
