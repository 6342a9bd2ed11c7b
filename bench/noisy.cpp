// How often is the true place of a noisy log found, and how far off, beside particle filters on the same logs, and what
// does it cost?

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "logs.hpp"
#include "outlines.hpp"
#include "peers/particle_filter.hpp"
#include "program.hpp"
#include "rollfix/belief.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kLogs = 49;
constexpr std::size_t kFewLogs = 3;
constexpr double kFound = 0.02;   // nearer than this share of the perimeter is the place
constexpr double kListed = 0.01;  // places that are less probable are not told
constexpr int kRepetitions = 3;
constexpr std::size_t kManyParticles = 10000;  // take long: they are timed once

/// A way of localizing: starts, the likeliest first.
struct Method {
  std::function<std::vector<double>(const Part& part, const bench::NoisyLog& log)> starts;
  int repetitions = kRepetitions;
};

std::vector<double> by_posterior(const Part& part, const bench::NoisyLog& log) {
  BeliefOptions options;
  options.noise = bench::log_noise(part);
  Belief belief(part, LogKind::contact, options);
  for (const Sample& sample : log.samples) belief.add(sample);
  std::vector<double> starts;
  for (const Mode& mode : belief.modes()) {
    if (mode.probability >= kListed) starts.push_back(mode.start[0]);
  }
  return starts;
}

Method by_particles(std::size_t count) {
  const auto starts = [count](const Part& part, const bench::NoisyLog& log) {
    std::vector<double> means;
    for (const bench::Cloud& cloud :
         bench::filter_particles(part, log.samples, bench::log_noise(part), count, log.seed)) {
      means.push_back(cloud.start);
    }
    return means;
  };
  return {starts, count < kManyParticles ? kRepetitions : 1};
}

/// What one way of localizing makes of many logs.
struct Record {
  std::size_t cases = 0;
  std::size_t listed = 0;
  std::size_t first = 0;
  std::vector<double> off;  // of the listed place, as a share of the perimeter

  void add(const Part& part, double truth, const std::vector<double>& starts) {
    ++cases;
    const double P = part.perimeter();
    if (!starts.empty() && part.boundary().distance(starts.front(), truth) < kFound * P) ++first;
    double least = P;
    for (const double start : starts) least = std::min(least, part.boundary().distance(start, truth));
    if (least >= kFound * P) return;
    ++listed;
    off.push_back(least / P);
  }
  void add(const Record& other) {
    cases += other.cases;
    listed += other.listed;
    first += other.first;
    off.insert(off.end(), other.off.begin(), other.off.end());
  }
  double share_listed() const { return static_cast<double>(listed) / static_cast<double>(cases); }
  double share_first() const { return static_cast<double>(first) / static_cast<double>(cases); }
  double median_off() const {
    std::vector<double> sorted = off;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? std::nan("") : sorted[sorted.size() / 2];
  }
};

struct Row {
  bench::Family family;
  Part part;
  std::vector<bench::NoisyLog> logs;
  std::vector<Record> records;            // of each method
  std::vector<bench::Program::Job> jobs;  // likewise
};

void add_jobs(bench::Program& program, const std::vector<Method>& methods, Row& row) {
  row.records.resize(methods.size());
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const auto localize_all = [&row, k, localize = methods[k].starts] {
      row.records[k] = {};
      for (const bench::NoisyLog& log : row.logs) row.records[k].add(row.part, log.start, localize(row.part, log));
    };
    row.jobs.push_back(program.add(row.family.name, localize_all, row.logs.size(), methods[k].repetitions));
  }
}

std::vector<std::string> cells(const Record& record, const std::string& time) {
  return {bench::share(record.share_listed()), bench::share(record.share_first()),
          bench::cell(100 * record.median_off(), 3), time};
}

void append(std::vector<std::string>& row, const std::vector<std::string>& more) {
  row.insert(row.end(), more.begin(), more.end());
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const std::vector<Method> methods = {{by_posterior}, by_particles(1000), by_particles(kManyParticles)};
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) {
    const Part part(family.outline);
    rows.push_back({family, part, bench::noisy_logs(part, program.effort(kLogs, kFewLogs)), {}, {}});
  }
  for (Row& row : rows) add_jobs(program, methods, row);
  program.run();

  bench::Table table({"outline", "all places: listed", "first", "off [% P]", "[ms]", "1,000 particles: listed", "first",
                      "off [% P]", "[ms]", "10,000: listed", "first", "off [% P]", "[ms]"});
  std::vector<Record> sums(methods.size());
  std::vector<double> times(methods.size());
  for (const Row& row : rows) {
    std::vector<std::string> line = {row.family.name};
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const bench::Timing timing = 1e3 * program.of(row.jobs[k]);
      append(line, cells(row.records[k], bench::cell(timing, 2)));
      sums[k].add(row.records[k]);
      times[k] += timing.median / static_cast<double>(rows.size());
    }
    table.add(line);
  }
  std::vector<std::string> line = {"all"};
  for (std::size_t k = 0; k < methods.size(); ++k) append(line, cells(sums[k], bench::cell(times[k], 2)));
  table.add(line);
  table.print();
  program.write_figures();
}
