// Where is the finger now? A log that grows line by line, as a robot sends it, and what is known after each.
//
//   c++ -std=c++20 examples/08_live.cpp $(pkg-config --cflags --libs rollfix) -o live && ./live
#include <cstdio>
#include <fstream>
#include <rollfix/rollfix.hpp>
#include <string>

using namespace rollfix;

int main() {
  const Part part = load_part("examples/wing.csv");
  const Noise noise{.contact = 0.05, .angle = 0.006, .slip = 0.004};  // mm, radians, per length

  LogStream stream("robot", part, {disk(10)}, noise);
  Belief belief(part, LogKind::contact, {noise});

  std::ifstream robot("examples/roll.csv");  // in place of a serial line or a socket
  for (std::string line; std::getline(robot, line);) {
    const LogLine row = stream.push(line);  // or stream.push(time, u, psi)
    if (!row.message.empty()) std::printf("%s\n", row.message.c_str());
    if (row.kind == LineKind::lost || row.kind == LineKind::jump) break;        // this roll is over
    if (row.kind != LineKind::first && row.kind != LineKind::sample) continue;  // a comment, the header, ...

    belief.add(row.sample);
    if (row.kind == LineKind::first || belief.samples() % 8 != 0) continue;
    const Mode& likeliest = belief.modes().front();
    std::printf("%4.2f s, after %5.2f mm: %s; most likely at s = %.1f +- %.1f mm now, with probability %.3f\n",
                row.sample.time.value_or(0), row.sample.reading.length[0], belief.verdict().text().c_str(),
                likeliest.end_mean[0], likeliest.end_sd[0], likeliest.probability);
  }
}
