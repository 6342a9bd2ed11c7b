#include "questions.hpp"

#include <random>

namespace bench {

using namespace rollfix;

std::vector<Reading> random_readings(const Part& part, std::size_t count) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Reading> readings;
  while (readings.size() < count) {
    const double start = unit(generator) * part.perimeter();
    const double length = (part.closed() ? 2 * unit(generator) - 1 : unit(generator)) * part.perimeter();
    if (!part.closed() && start + length > part.perimeter()) continue;
    const TurningFunction& turning = part.turning();
    readings.push_back({length, turning.angle(start + length) - turning.angle(start)});
  }
  return readings;
}

std::vector<Reading> readings_of_one_roll(const Part& part, std::size_t count) {
  const double start = 0.21 * part.perimeter();
  const double length = (part.closed() ? 0.9 : 0.5) * part.perimeter();
  std::vector<Reading> readings;
  for (std::size_t k = 1; k <= count; ++k) {
    const double rolled = length * static_cast<double>(k) / static_cast<double>(count);
    readings.push_back({rolled, part.turning().angle(start + rolled) - part.turning().angle(start)});
  }
  return readings;
}

std::vector<PairQuestion> random_pair_questions(const Part& part, std::size_t count) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(0, 1);
  const TurningFunction& turning = part.turning();
  const double period = part.perimeter();
  const auto length = [&](double from) {
    return part.closed() ? (2 * unit(generator) - 1) * period : unit(generator) * period - from;
  };
  const auto turn = [&](double from, double roll) { return turning.angle(from + roll) - turning.angle(from); };
  std::vector<PairQuestion> questions(count);
  for (PairQuestion& drawn : questions) {
    const double s = unit(generator) * period;
    const double t = unit(generator) * period;
    for (int k = 0; k < 2; ++k) {
      const double a = length(s);
      const double b = length(t);
      drawn.readings.push_back({a, b, turn(s, a) - turn(t, b)});
    }
    drawn.facing = turning.angle(s) - turning.angle(t);
  }
  return questions;
}

Search find(const Part& part, const PairQuestion& question) { return locate(part, question.readings); }

Search find_with_facing(const Part& part, const PairQuestion& question) {
  LocateOptions options;
  options.facing = question.facing;
  return locate(part, {question.readings.front()}, options);
}

}  // namespace bench
