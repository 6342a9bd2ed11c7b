// What do other methods cost where one finger's placements are asked for, and how many of them do they find? The
// paper's march, dense sampling, and root isolation with proof.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "peers/proved_roots.hpp"
#include "peers/sign_changes.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "rollfix/error.hpp"
#include "rollfix/march.hpp"
#include "rollfix/outline.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kReadings = 20;
constexpr std::size_t kFewReadings = 2;
constexpr int kRepetitions = 3;
constexpr double kSamePlace = 1e-6;   // of the perimeter
constexpr double kBeside = 1e-7;      // rad: of near doubles
constexpr std::size_t kLooked = 200;  // places between which an extremum is looked for
constexpr double kSmooth = 1e-6;      // of the largest curvature

using Starts = std::vector<double>;
using Method = std::function<Starts(const Reading& reading)>;

struct Column {
  Method method;  // empty: it refuses the outline
  double recall = 0;
  double hard_recall = 0;
  bench::Program::Job job = 0;
};

struct Row {
  bench::Family family;
  Part part;
  std::vector<Reading> readings;
  std::vector<Reading> hard;  // not timed
  std::vector<Column> columns;
  std::size_t lost = 0;  // that some other method has, and `locate` has not
  bench::Program::Job unit = 0;
  bench::Program::Job locate = 0;
};

Method by_march(const Row& row) {
  try {
    const march::March march(row.family.outline, march::curvature_density());
    march.segments(row.readings[0].length[0], row.readings[0].turn);
    return [march](const Reading& reading) {
      Starts starts;
      for (const march::Segment& segment : march.segments(reading.length[0], reading.turn).segments) {
        starts.push_back(segment.start);
      }
      return starts;
    };
  } catch (const InputError&) {
    return {};  // corners, lines, arcs: not for the paper's algorithm
  }
}

Method by_sign_changes(const Row& row, std::size_t samples) {
  return [&row, samples](const Reading& reading) { return bench::locate_by_sign_changes(row.part, reading, samples); };
}

bool holds(const Part& part, const Placement& placement, double s) {
  return placement.whole_loop[0] || part.boundary().contains(placement.extent[0], s) ||
         part.boundary().distance(placement.start[0], s) <= kSamePlace * part.perimeter();
}

/// The share of all placements that each method has; what `locate` has not is counted.
std::vector<double> recalls(Row& row, const std::vector<Reading>& readings) {
  double all = 0;
  std::vector<double> hits(row.columns.size());
  for (const Reading& reading : readings) {
    const std::vector<Placement> placements = locate(row.part, reading).placements;
    all += static_cast<double>(placements.size());
    for (std::size_t k = 0; k < row.columns.size(); ++k) {
      if (!row.columns[k].method) continue;
      const Starts starts = row.columns[k].method(reading);
      for (const Placement& placement : placements) {
        const bool is_found =
            std::any_of(starts.begin(), starts.end(), [&](double s) { return holds(row.part, placement, s); });
        hits[k] += is_found ? 1 : 0;
      }
      row.lost += static_cast<std::size_t>(std::count_if(starts.begin(), starts.end(), [&](double s) {
        return std::none_of(placements.begin(), placements.end(),
                            [&](const Placement& placement) { return holds(row.part, placement, s); });
      }));
    }
  }
  for (double& hit : hits) hit /= all;
  return hits;
}

void compare(Row& row) {
  const std::vector<double> easy = recalls(row, row.readings);
  const std::vector<double> hard = recalls(row, row.hard);
  for (std::size_t k = 0; k < row.columns.size(); ++k) {
    row.columns[k].recall = easy[k];
    row.columns[k].hard_recall = hard[k];
  }
}

/// Readings that fit two places close together: kBeside short of where the turn over that length is largest or least.
std::vector<Reading> near_doubles(const Part& part, const std::vector<Reading>& like) {
  const TurningFunction& turning = part.turning();
  std::vector<Reading> readings;
  for (const Reading& reading : like) {
    const double length = reading.length[0];
    const auto turn = [&](double s) { return turning.angle(s + length) - turning.angle(s); };
    const auto slope = [&](double s) { return turning.curvature(s + length) - turning.curvature(s); };
    const double lo = part.closed() ? 0 : std::max(0.0, -length);
    const double hi = part.perimeter() - (part.closed() ? 0 : std::max(0.0, length));
    for (std::size_t k = 0; k < kLooked; ++k) {
      double one = lo + (hi - lo) * static_cast<double>(k) / kLooked;
      double two = lo + (hi - lo) * static_cast<double>(k + 1) / kLooked;
      const bool rises = slope(one) > 0;
      if (rises == (slope(two) > 0)) continue;
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (one + two);
        ((slope(middle) > 0) == rises ? one : two) = middle;
      }
      if (std::abs(slope(one)) > kSmooth * turning.most_curvature()) continue;  // a jump, not an extremum
      readings.push_back({length, turn(one) + (rises ? -kBeside : kBeside)});
      break;
    }
  }
  return readings;
}

void add_jobs(bench::Program& program, Row& row) {
  row.columns.push_back({by_march(row)});
  for (const std::size_t samples : {1000U, 10000U, 100000U}) row.columns.push_back({by_sign_changes(row, samples)});
  const std::string& name = row.family.name;
  row.unit = program.add("W " + name, [&row] { bench::keep(bench::perimeter_by_quadrature(row.family.outline)); });
  const auto locate_all = [&row] {
    for (const Reading& reading : row.readings) bench::keep(locate(row.part, reading));
  };
  row.locate = program.add("locate " + name, locate_all, row.readings.size());
  for (Column& column : row.columns) {
    if (!column.method) continue;
    const auto ask_all = [&row, &column] {
      for (const Reading& reading : row.readings) bench::keep(column.method(reading));
    };
    column.job = program.add(name, ask_all, row.readings.size(), kRepetitions);
  }
}

/// An ellipse of which Arb proves what it finds.
struct Proved {
  double a = 0;
  Part part;
  std::vector<Reading> readings;
  std::size_t placements = 0;
  std::size_t proved = 0;
  std::size_t agreed = 0;  // placements that start where one was proved
  std::size_t undecided = 0;
  bench::Program::Job locate = 0;
  bench::Program::Job arb = 0;
};

Proved proved_on(double a, std::size_t readings) {
  const Part part = bench::trusted_part(gallery(fmt::format("ellipse,a={},b=1", a)));
  Proved row{a, part, bench::random_readings(part, readings)};
  for (const Reading& reading : row.readings) {
    const bench::ProvedRoots found = bench::locate_by_arb(a, 1, reading);
    row.proved += found.starts.size();
    row.undecided += static_cast<std::size_t>(found.undecided);
    for (const Placement& placement : locate(part, reading).placements) {
      ++row.placements;
      const auto is_there = [&](const Interval& start) { return part.boundary().contains(start, placement.start[0]); };
      row.agreed += std::any_of(found.starts.begin(), found.starts.end(), is_there) ? 1 : 0;
    }
  }
  return row;
}

void add_jobs(bench::Program& program, Proved& row) {
  row.locate = program.add(
      "locate",
      [&row] {
        for (const Reading& reading : row.readings) bench::keep(locate(row.part, reading));
      },
      row.readings.size());
  row.arb = program.add(
      "arb",
      [&row] {
        for (const Reading& reading : row.readings) bench::keep(bench::locate_by_arb(row.a, 1, reading));
      },
      row.readings.size(), kRepetitions);
}

/// A plain mean of shares, of those that are there.
struct Share {
  double sum = 0;
  int count = 0;
  void add(double share) {
    if (std::isnan(share)) return;
    sum += share;
    ++count;
  }
  double mean() const { return sum / count; }
};

/// An outline without extrema has no near doubles.
std::string hard_share(double recall) { return std::isnan(recall) ? "none" : bench::share(recall); }

void print(const bench::Program& program, const std::vector<Row>& rows) {
  bench::Table table(
      {"outline", "locate/W", "march/W", "1,000 samples/W", "10,000 samples/W", "100,000 samples/W", "locate lost"});
  std::vector<bench::Mean> means(rows.front().columns.size());
  std::vector<Share> shares(means.size());
  std::vector<Share> hard_shares(means.size());
  bench::Mean found;
  for (const Row& row : rows) {
    const bench::Timing unit = program.of(row.unit);
    found.add(program.of(row.locate) / unit);
    std::vector<std::string> line = {row.family.name, bench::cell(program.of(row.locate) / unit, 2)};
    for (std::size_t k = 0; k < row.columns.size(); ++k) {
      const Column& column = row.columns[k];
      const bench::Timing timing = column.method ? program.of(column.job) / unit : bench::Timing{};
      line.push_back(column.method ? fmt::format("{} ({}, {})", bench::cell(timing, 0), bench::share(column.recall),
                                                 hard_share(column.hard_recall))
                                   : "refused");
      if (!column.method) continue;
      means[k].add(timing);
      shares[k].add(column.recall);
      hard_shares[k].add(column.hard_recall);
    }
    line.push_back(std::to_string(row.lost));
    table.add(line);
  }
  std::vector<std::string> line = {"mean", bench::cell(found.value(), 2)};
  for (std::size_t k = 0; k < means.size(); ++k) {
    line.push_back(fmt::format("{} ({}, {})", bench::cell(means[k].value(), 0), bench::share(shares[k].mean()),
                               bench::share(hard_shares[k].mean())));
  }
  table.add(line);
  table.print();
}

void print(const bench::Program& program, const std::vector<Proved>& rows) {
  bench::Table table({"ellipse a : b", "locate [us]", "Arb [ms]", "Arb/locate", "placements", "proved by Arb",
                      "in the same place", "undecided"});
  for (const Proved& row : rows) {
    const bench::Timing ours = program.of(row.locate);
    const bench::Timing theirs = program.of(row.arb);
    table.add({fmt::format("{} : 1", row.a), bench::cell(1e6 * ours, 2), bench::cell(1e3 * theirs, 1),
               bench::cell((theirs / ours).median, 0), std::to_string(row.placements), std::to_string(row.proved),
               std::to_string(row.agreed), std::to_string(row.undecided)});
  }
  table.print();
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const std::size_t readings = program.effort(kReadings, kFewReadings);
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) {
    const Part part = bench::trusted_part(family.outline);
    if (bench::is_trivial(part)) continue;
    const std::vector<Reading> drawn = bench::random_readings(part, readings);
    rows.push_back({family, part, drawn, near_doubles(part, drawn), {}});
  }
  std::vector<Proved> proved;
  for (const double a : {2.0, 5.0}) proved.push_back(proved_on(a, readings));
  for (Row& row : rows) add_jobs(program, row);
  for (Row& row : rows) compare(row);
  for (Proved& row : proved) add_jobs(program, row);
  program.run();
  print(program, rows);
  print(program, proved);
  program.write_figures();
}
