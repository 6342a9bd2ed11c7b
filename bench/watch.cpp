// The table of watch: what a sample of a growing log costs, from its line to what it means. The program is run as a
// user runs it: nothing of it is part of this one.

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files/saved_part.hpp"
#include "stopwatch.hpp"
#include "tables.hpp"

namespace bench {
namespace {

constexpr double kContactShare = 2e-4;  // the noise of a contact's place, as a share of the perimeter
constexpr double kAngle = 0.003;        // of a turn, radians

rollfix::Noise noise_on(const rollfix::Part& part) { return {kContactShare * part.perimeter(), kAngle, 0, 0}; }

/// The lines of a roll over one and a half perimeters, of an open part over half of it.
std::vector<std::string> noisy_roll(const rollfix::Part& part, int rows) {
  const double P = part.perimeter();
  const double start = 0.21 * P;
  const double length = (part.closed() ? 1.5 : 0.5) * P;
  const rollfix::Noise noise = noise_on(part);
  std::mt19937_64 random(20010529);
  std::normal_distribution<double> off;
  std::vector<std::string> lines = {"time,length,turn"};
  for (int k = 1; k <= rows; ++k) {
    const double L = length * k / rows;
    const double theta = part.turning().angle(start + L) - part.turning().angle(start);
    lines.push_back(
        fmt::format("{:.3f},{:.9g},{:.6f}", 0.01 * k, L + noise.contact * off(random), theta + kAngle * off(random)));
  }
  return lines;
}

struct Watched {
  double seconds = 0;
  int told = 0;
  std::string verdict;
};

double seconds_of_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// `rollfix watch --once` of this part and log, as a user starts it.
class Program {
 public:
  explicit Program(const rollfix::Part& part) : noise_(noise_on(part)) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "part.json") << rollfix::format_part(part);
  }
  ~Program() { std::filesystem::remove_all(folder_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  Watched watch(const std::vector<std::string>& lines) const {
    std::ofstream(folder_ / "roll.csv") << fmt::format("{}\n", fmt::join(lines, "\n"));
    const double before = seconds_of_children();
    const std::string command = fmt::format(
        "cd '{}' && '{}' watch part.json --once --jsonl --noise contact={:.17g},angle={:.17g} --log roll.csv > told",
        folder_.string(), ROLLFIX_PROGRAM, noise_.contact, noise_.angle);
    if (std::system(command.c_str()) != 0) throw rollfix::InternalError("bench: failed: " + command);
    Watched watched;
    watched.seconds = seconds_of_children() - before;
    std::ifstream told(folder_ / "told");
    for (std::string line; std::getline(told, line);) {
      const nlohmann::json event = nlohmann::json::parse(line);
      if (event["event"] == "placements") ++watched.told;
      if (event.contains("verdict")) watched.verdict = event["verdict"];
    }
    return watched;
  }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / fmt::format("rollfix_bench.{}", getpid());
  rollfix::Noise noise_;
};

double parsing(const rollfix::Part& part, const std::vector<std::string>& lines) {
  const double seconds = seconds_per_call([&] {
    rollfix::LogStream stream("bench", part, std::vector<rollfix::Finger>{}, noise_on(part));
    for (const std::string& line : lines) keep(stream.push(line));
  });
  return 1e6 * seconds / static_cast<double>(lines.size());
}

}  // namespace

void watch(int rounds) {
  fmt::print("outline          1000 rows [us]  10000 rows [us]  reading alone [us]  told  verdict\n");
  Mean short_rolls;
  Mean long_rolls;
  for (const Family& family : families()) {
    const rollfix::Part part(family.outline);
    const Program program(part);
    const std::vector<std::string> few = noisy_roll(part, 1000);
    const std::vector<std::string> many = noisy_roll(part, 10000);
    const Watched all = program.watch(many);
    std::vector<double> start;  // of the program: what it takes for a single row
    std::vector<double> of_few;
    std::vector<double> of_many;
    std::vector<double> reading;
    for (int round = 0; 5 * round < rounds; ++round) {
      start.push_back(program.watch({many.begin(), many.begin() + 2}).seconds);
      of_few.push_back(program.watch(few).seconds);
      of_many.push_back(round == 0 ? all.seconds : program.watch(many).seconds);
      reading.push_back(parsing(part, few));
    }
    const double per_short = (least(of_few) - least(start)) / 1000;
    const double per_long = (least(of_many) - least(start)) / 10000;
    short_rolls.add(per_short);
    long_rolls.add(per_long);
    fmt::print("{:<16} {:>14}  {:>15}  {:>18}  {:4}  {}\n", family.name, cell(1e6 * per_short, 1),
               cell(1e6 * per_long, 1), cell(least(reading), 2), all.told, all.verdict);
  }
  fmt::print("{:<16} {:>14}  {:>15}\n", "geometric mean", cell(1e6 * short_rolls.value(), 1),
             cell(1e6 * long_rolls.value(), 1));
}

}  // namespace bench
