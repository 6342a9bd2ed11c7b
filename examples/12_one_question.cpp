// A finger rolled on a part, was lifted, and rolled elsewhere: how does the part lie?
//
//   c++ -std=c++20 examples/12_one_question.cpp $(pkg-config --cflags --libs rollfix) -o again && ./again
#include <cstdio>
#include <rollfix/rollfix.hpp>

using namespace rollfix;

namespace {

/// The log of a short roll from s on; the part lies as it was drawn.
Log rolled_from(double s, const Part& part, const Finger& finger, const Noise& noise) {
  RollPlan plan;
  plan.start = s;
  plan.distance = 0.3;
  return noisy_roll(part, finger, plan, noise, 1).log;
}

void show(const char* what, const Question& question) {
  const Solution solution = solve(question);  // the library knows which search this takes
  std::printf("%s: %s\n", what, solution.verdict_text().c_str());
  if (solution.roll() != nullptr) {
    for (const Placement& one : solution.roll()->placements) {
      std::printf("  it began at s = %.2f, probability %.3f\n", one.start[0], one.probability);
    }
  }
  if (solution.at_rest() != nullptr) {
    for (const TouchPose& one : solution.at_rest()->poses) {
      std::printf("  the part's heading is %.3f, probability %.3f\n", one.pose.heading, one.probability);
    }
  }
}

}  // namespace

int main() {
  const Part part = load_part("gallery:spline,n=9,seed=4,wobble=0.25");
  const Finger finger = disk(0.1);
  const Noise noise{.contact = 0.01, .angle = 0.02};

  Measurements measured;
  measured.rolls = {rolled_from(1, part, finger, noise)};
  Question question(part, measured, {finger}, noise);
  show("one roll", question);

  question.measured.rolls.push_back(rolled_from(4, part, finger, noise));
  question.measured.at_rest = true;  // else these were two fingers on a part that moves
  show("two rolls", question);
}
