#include "program.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <utility>

namespace bench {
namespace {

/// Takes what the library measured, and prints nothing: tables do.
class Collector : public benchmark::BenchmarkReporter {
 public:
  using Taker = std::function<void(const std::string& name, double seconds)>;
  explicit Collector(Taker take) : take_(std::move(take)) {}

  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      // Work that stops its own watch has it in the place of the clock on the wall.
      const bool is_stopped = run.run_name.time_type == "manual_time";
      take_(run.run_name.function_name, is_stopped ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime());
    }
  }

 private:
  Taker take_;
};

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Timing operator/(const Timing& one, const Timing& other) {
  return {one.median / other.median, std::hypot(one.spread, other.spread)};
}

Timing operator-(const Timing& one, const Timing& other) {
  const double rest = one.median - other.median;
  return {rest, std::hypot(one.spread * one.median, other.spread * other.median) / rest};
}

Timing operator*(double factor, const Timing& timing) { return {factor * timing.median, timing.spread}; }

void Mean::add(double value) {
  if (!(value > 0)) return;
  sum_ += std::log(value);
  ++count_;
}

Program::Program(int argc, char** argv) {
  constexpr std::string_view kFigures = "--figures=";
  std::vector<std::string> given;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument == "--counts") {
      counts_only_ = true;
    } else if (argument == "--quick") {
      is_quick_ = true;
    } else if (argument.rfind(kFigures, 0) == 0) {
      figures_file_ = argument.substr(kFigures.size());
    } else if (argument.rfind("--benchmark_", 0) == 0) {
      given.push_back(argument);
    } else {
      fmt::print(stderr, "{}: unknown option {}; there are --counts, --quick, --figures=FILE, --benchmark_...\n",
                 argv[0], argument);
      std::exit(2);
    }
  }
  library_arguments_ = {argv[0], "--benchmark_enable_random_interleaving=true",
                        is_quick_ ? "--benchmark_repetitions=2" : "--benchmark_repetitions=9",
                        is_quick_ ? "--benchmark_min_time=0.0001" : "--benchmark_min_time=0.01"};
  library_arguments_.insert(library_arguments_.end(), given.begin(), given.end());
}

Program::Job Program::add(const std::string& name, std::function<void()> work, std::size_t calls, int repetitions) {
  const auto run = [work = std::move(work)] {
    work();
    return 0.0;
  };
  work_.push_back({name, run, false, calls, repetitions, {}});
  return work_.size() - 1;
}

Program::Job Program::add_stopped(const std::string& name, std::function<double()> work, std::size_t calls,
                                  int repetitions) {
  work_.push_back({name, std::move(work), true, calls, repetitions, {}});
  return work_.size() - 1;
}

void Program::register_with_library(std::size_t index) {
  const auto run = [this, index](benchmark::State& state) {
    const Work& work = work_[index];
    for (auto _ : state) {
      const double seconds = work.run();
      if (work.is_stopped) state.SetIterationTime(seconds);
    }
  };
  // The index makes the name unique, and says whose measurement it is.
  auto* const job = benchmark::RegisterBenchmark(fmt::format("{}#{}", work_[index].name, index).c_str(), run);
  job->Unit(benchmark::kSecond);
  if (work_[index].is_stopped) job->UseManualTime();
  if (work_[index].repetitions > 0) job->Repetitions(is_quick_ ? 1 : work_[index].repetitions);
}

void Program::run() {
  if (counts_only_) return;
  std::vector<char*> arguments;
  for (std::string& argument : library_arguments_) arguments.push_back(argument.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  benchmark::ClearRegisteredBenchmarks();
  for (; done_ < work_.size(); ++done_) register_with_library(done_);
  Collector collector([&](const std::string& name, double seconds) {
    Work& work = work_[std::stoul(name.substr(name.rfind('#') + 1))];
    work.seconds.push_back(seconds / static_cast<double>(work.calls));
  });
  benchmark::RunSpecifiedBenchmarks(&collector);
}

Timing Program::of(Job job) const {
  std::vector<double> sorted = work_[job].seconds;
  if (sorted.empty()) return {};
  std::sort(sorted.begin(), sorted.end());
  const double median = quantile(sorted, 0.5);
  if (sorted.size() == 1) return {median, std::nan("")};
  return {median, 0.5 * (quantile(sorted, 0.75) - quantile(sorted, 0.25)) / median};
}

void Program::figure(const std::string& key, double value) {
  if (std::isfinite(value)) figures_[key] = value;
}

void Program::write_figures() const {
  if (figures_file_.empty()) return;
  std::ofstream file(figures_file_);
  std::string separator = "{";
  for (const auto& [key, value] : figures_) {
    file << separator << fmt::format("\"{}\": {:.6g}", key, value);
    separator = ", ";
  }
  file << (figures_.empty() ? "{}" : "}") << "\n";
  if (!file) {
    fmt::print(stderr, "cannot write {}\n", figures_file_);
    std::exit(1);
  }
}

}  // namespace bench
