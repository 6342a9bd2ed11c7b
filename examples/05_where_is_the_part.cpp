// Where is the part? In the world, while two fingers roll on it and so move it.
//
//   c++ -std=c++20 examples/05_where_is_the_part.cpp $(pkg-config --cflags --libs rollfix) -o pose && ./pose
#include <cstdio>
#include <numbers>
#include <rollfix/rollfix.hpp>

using namespace rollfix;

/// A roll as a robot would log it: contacts, orientations and centres of both fingers. Here it is simulated.
NoisyRoll roll_of_two(const Part& part, const Noise& noise) {
  FreePlan plan;
  plan.fingers[0] = {disk(0.2), 1.0, 0.0, 1.5};   // finger a: radius, first contact, orientation, distance
  plan.fingers[1] = {disk(0.3), 4.5, 0.0, -1.0};  // finger b goes backwards
  plan.pose = {0.7, 0.3, 0.5};                    // of the part, at the start
  plan.part_rotation = 0.6;                       // and by how much it turns until the end
  return noisy_roll_free(part, plan, noise, 1);
}

void show(const char* who, const Pose& pose) {
  std::printf("  %-9s x = %6.3f, y = %6.3f, heading %5.1f deg\n", who, pose.x, pose.y,
              pose.heading * 180 / std::numbers::pi);
}

int main() {
  const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
  const Noise noise{.contact = 0.002, .angle = 0.002, .slip = 0.001};
  const NoisyRoll roll = roll_of_two(part, noise);

  const Answer answer = solve({part, roll.log, {disk(0.2), disk(0.3)}, noise});
  std::printf("%s\n", answer.verdict.text().c_str());
  for (const Placement& placement : answer.placements) {
    std::printf("probability %.3f\n", placement.probability);
    show("at first", placement.pose.front());
    show("in truth", roll.truth.pose.front());
    show("at last", placement.pose.back());
    show("in truth", roll.truth.pose.back());
  }
}
