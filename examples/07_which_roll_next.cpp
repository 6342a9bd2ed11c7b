// Several places are left: which roll tells them apart?
//
//   c++ -std=c++20 examples/07_which_roll_next.cpp $(pkg-config --cflags --libs rollfix) -o advise && ./advise
#include <cstdio>
#include <rollfix/rollfix.hpp>

using namespace rollfix;

int main() {
  const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
  Problem problem{part, Reading(0.9977, 0.9936)};
  problem.tolerance = 1e-3;
  const Answer answer = solve(problem);
  std::printf("so far: %s\n", answer.verdict.text().c_str());

  AdviceOptions options;
  options.turn_sd = 0.05;        // radians: how well a turn will be read
  options.length_sd = 0.02;      // and a length
  options.travel = {-0.5, 0.5};  // the robot's arm gets no farther, back and forth
  const Advice advice = advise(part, hypotheses_of(part, answer.placements), options);

  const ExpectedGain& next = advice.advised();
  std::printf("roll %s by %.3f: then %.2f places remain on average\n", next.length < 0 ? "back" : "on",
              next.length < 0 ? -next.length : next.length, next.placements);
  std::printf("that gains %.2f of the %.2f bits wanted\n", next.bits, advice.bits_wanted);
}
