// The table of one finger: building the part, all placements of a reading, and the paper's own algorithm.

#include <fmt/format.h>

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/march/march.hpp"
#include "stopwatch.hpp"
#include "tables.hpp"

namespace bench {
namespace {

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

struct Row {
  std::string name;
  double unit = 0;         // W in seconds
  double build = 0;        // in W
  double locate = 0;       // in W
  double march = 0;        // in W; 0 where the march refuses
  double placements = 0;   // per reading
  double evaluations = 0;  // of the turning function, per reading
};

class Turn {
 public:
  explicit Turn(std::size_t count) : count_(count) {}
  std::size_t next() { return at_++ % count_; }

 private:
  std::size_t count_;
  std::size_t at_ = 0;
};

Row measure(const Family& family, int rounds) {
  const PartOptions trusted{true};  // W doesn't look for crossings either
  const Part part(family.outline, trusted);
  const std::vector<Reading> readings = random_readings(part, 500);
  Row row;
  row.name = family.name;
  for (const Reading& reading : readings) {
    const Search search = locate(part, reading);
    row.placements += static_cast<double>(search.placements.size()) / static_cast<double>(readings.size());
    row.evaluations += static_cast<double>(search.counts.evaluations) / static_cast<double>(readings.size());
  }
  std::optional<march::March> reference;
  try {
    reference.emplace(family.outline, march::curvature_density());
    reference->segments(readings[0].length[0], readings[0].turn);
  } catch (const InputError&) {
    reference.reset();  // lines, arcs, corners: not for the paper's algorithm
  }
  std::vector<double> unit;
  std::vector<double> build;
  std::vector<double> find;
  std::vector<double> march;
  Turn turn(readings.size());
  Turn march_turn(readings.size());
  for (int round = 0; round < rounds; ++round) {
    unit.push_back(seconds_per_call([&] { keep(perimeter_by_quadrature(family.outline)); }));
    build.push_back(seconds_per_call([&] { keep(Part(family.outline, trusted)); }));
    find.push_back(seconds_per_call([&] { keep(locate(part, readings[turn.next()])); }));
    if (reference && round < 3) {
      march.push_back(seconds_per_call([&] {
        const Reading& reading = readings[march_turn.next()];
        keep(reference->segments(reading.length[0], reading.turn));
      }));
    }
  }
  row.unit = least(unit);
  row.build = least(build) / row.unit;
  row.locate = least(find) / row.unit;
  row.march = reference ? least(march) / row.unit : 0;
  return row;
}

void print(const Row& row) {
  fmt::print("{:<14}{:>9}{:>10}{:>10}{:>11}{:>12.2f}{:>14.1f}\n", row.name, cell(1e6 * row.unit, 2), cell(row.build, 1),
             cell(row.locate, 2), row.march == 0 ? "refused" : cell(row.march, 0), row.placements, row.evaluations);
}

}  // namespace

void one_finger(int rounds) {
  fmt::print("{:<14}{:>9}{:>10}{:>10}{:>11}{:>12}{:>14}\n", "outline", "W [us]", "build/W", "locate/W", "march/W",
             "placements", "evaluations");
  Mean build;
  Mean find;
  Mean march;
  std::vector<Row> trivial;
  for (const Family& family : families()) {
    const Row row = measure(family, rounds);
    if (is_trivial(Part(family.outline))) {
      trivial.push_back(row);
      continue;
    }
    print(row);
    build.add(row.build);
    find.add(row.locate);
    march.add(row.march);
  }
  fmt::print("{:<14}{:>9}{:>10}{:>10}{:>11}\n", "geometric mean", "", cell(build.value(), 1), cell(find.value(), 2),
             cell(march.value(), 0));
  if (!trivial.empty()) fmt::print("\noutlines whose W is next to nothing, lines and arcs alone:\n");
  for (const Row& row : trivial) print(row);
}

}  // namespace bench
