#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace bench {

/// Keeps a result alive, so that the compiler does not leave out the work for it.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r,m"(&value) : "memory");
}

/// What several repetitions of one job took, or a ratio of such: not a number where nothing was timed.
struct Timing {
  double median = std::numeric_limits<double>::quiet_NaN();  // seconds of processor time
  double spread = 0;  // half the range that holds the middle half, by the median; not a number of one repetition
};
Timing operator/(const Timing& one, const Timing& other);
Timing operator-(const Timing& one, const Timing& other);
Timing operator*(double factor, const Timing& timing);

/// The geometric mean of what was added, but for what is not above 0 or was not timed.
class Mean {
 public:
  void add(double value);
  void add(const Timing& timing) { add(timing.median); }
  double value() const { return count_ > 0 ? std::exp(sum_ / count_) : std::nan(""); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

/// One program of the benchmarks: its jobs are run by Google Benchmark in one process, their repetitions in random
/// order, so that whatever else the machine does meets all of them alike.
///   --counts         nothing is timed, "?" stands for it: what is printed is the same every time
///   --quick          few repetitions of little work, to see that it runs
///   --figures=FILE   the figures that stand for the table, as JSON
///   --benchmark_...  as Google Benchmark takes them
class Program {
 public:
  using Job = std::size_t;

  Program(int argc, char** argv);

  bool counts_only() const { return counts_only_; }
  bool is_quick() const { return is_quick_; }
  /// Usual effort, or less where it has to be quick.
  std::size_t effort(std::size_t usual, std::size_t quick) const { return is_quick_ || counts_only_ ? quick : usual; }

  /// Work to be timed; `calls`: so many questions are answered in one go, the time is that of one of them.
  /// `repetitions`: of a job that takes long; 0 are the usual ones.
  Job add(const std::string& name, std::function<void()> work, std::size_t calls = 1, int repetitions = 0);
  /// Work that says itself how many seconds it took.
  Job add_stopped(const std::string& name, std::function<double()> work, std::size_t calls = 1, int repetitions = 0);
  /// Times all jobs that were added since.
  void run();
  Timing of(Job job) const;

  /// Goes to the file of figures when the program ends; what is not a number does not.
  void figure(const std::string& key, double value);
  void figure(const std::string& key, const Timing& timing) { figure(key, timing.median); }
  void write_figures() const;

 private:
  struct Work {
    std::string name;
    std::function<double()> run;
    bool is_stopped = false;
    std::size_t calls = 1;
    int repetitions = 0;
    std::vector<double> seconds;  // of one call, of each repetition
  };
  void register_with_library(std::size_t index);

  bool counts_only_ = false;
  bool is_quick_ = false;
  std::string figures_file_;
  std::vector<std::string> library_arguments_;
  std::vector<Work> work_;
  std::size_t done_ = 0;
  std::map<std::string, double> figures_;
};

}  // namespace bench
