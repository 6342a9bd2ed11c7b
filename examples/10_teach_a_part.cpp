// There is no drawing of my part: one roll around it teaches it.
//
//   c++ -std=c++20 examples/10_teach_a_part.cpp $(pkg-config --cflags --libs rollfix) -o teach && ./teach
#include <cstdio>
#include <rollfix/rollfix.hpp>
#include <string>

using namespace rollfix;

/// What a finger feels on a part that only the simulation knows.
Log roll_on_it(double start, double distance, const Noise& noise, std::uint64_t seed) {
  const Part unknown = load_part("gallery:cam");
  RollPlan plan;
  plan.start = start;
  plan.distance = distance;
  plan.rows = 401;
  return noisy_roll(unknown, disk(0.2), plan, noise, seed).log;
}

int main() {
  const Noise noise{.contact = 0.0005, .angle = 0.0005, .slip = 0.0002};

  TeachOptions options;
  options.finger = disk(0.2);
  options.noise = noise;
  const Taught taught = teach(roll_on_it(0, 9, noise, 1), options);  // once around and a little farther
  for (const std::string& note : taught.notes) std::printf("%s\n", note.c_str());

  const Part part(taught.outline);
  std::printf("the part: perimeter %.4f, in truth %.4f\n", part.perimeter(), load_part("gallery:cam").perimeter());

  const Answer answer = solve({part, roll_on_it(5, 1.5, noise, 2), {disk(0.2)}, noise});
  std::printf("another roll on it, which began at s = 5: %s\n", answer.verdict.text().c_str());
  for (const Placement& placement : answer.placements) {
    std::printf("  s = %.3f +- %.3f with probability %.3f\n", placement.mean[0], placement.sd[0],
                placement.probability);
  }
}
