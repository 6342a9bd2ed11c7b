// Where is the finger now? Rows that a robot sends, one by one, and what is new after each.
//
//   c++ -std=c++20 examples/08_live.cpp $(pkg-config --cflags --libs rollfix) -o live && ./live
#include <cstdio>
#include <fstream>
#include <rollfix/rollfix.hpp>
#include <string>

using namespace rollfix;

int main() {
  const Part part = load_part("examples/wing.csv");
  Tracker tracker(part, {disk(10)}, {.contact = 0.05, .angle = 0.006, .slip = 0.004});  // mm, radians, per length

  std::ifstream robot("examples/roll.csv");  // in place of a serial line or a socket
  for (std::string line; std::getline(robot, line);) {
    for (const Tracked& now : tracker.push(line)) {  // or tracker.push(time, u, psi)
      if (now.modes.empty()) continue;               // nothing fits
      const Mode& likeliest = now.modes.front();
      std::printf("%4.2f s, after %5.2f mm: %s; most likely at s = %.1f +- %.1f mm now, with probability %.3f\n",
                  now.sample.time.value_or(0), now.sample.reading.length[0], now.verdict.text().c_str(),
                  likeliest.end_mean[0], likeliest.end_sd[0], likeliest.probability);
    }
    for (const std::string& why : tracker.messages()) std::printf("%s\n", why.c_str());
  }
  for (const Tracked& last : tracker.finish()) std::printf("in the end: %s\n", last.verdict.text().c_str());
}
