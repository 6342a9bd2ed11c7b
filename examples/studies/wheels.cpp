// A wheel with a gyroscope on closed courses, half of them figures of eight, from anywhere and not knowing where: how
// often what is told holds the truth, how far it has to drive, how soon it is noticed that it was carried elsewhere,
// and what a row costs. Prints docs/wheels.md's tables: study_wheels 300, with as many courses; left out 6. By the C
// interface, which says what `watch` says; the drives are drawn by noisy_increments, which knows nothing of beliefs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rollfix.h"
#include "rollfix/rolling.hpp"
#include "rollfix/turning_function.hpp"

namespace {

using rollfix::Noise;
using rollfix::NoisyIncrements;
using rollfix::Part;
using rollfix::Vec2;

constexpr std::size_t kPoints = 48;
constexpr std::size_t kRowsOfLap = 400;
constexpr double kSecondsOfLap = 60;
constexpr double kSigmas = 4;  // of a binomial count
constexpr double kPi = std::numbers::pi;

/// Two hundred metres or so, around or as an eight, with bends that are drawn at random.
std::vector<double> course(std::mt19937_64& random, bool is_eight) {
  std::normal_distribution<double> normal;
  std::vector<double> wave(12);
  for (double& each : wave) each = 1.5 * normal(random);
  std::vector<double> xy;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double t = 2 * kPi * static_cast<double>(k) / kPoints;
    double x = 40 * std::sin(t);
    double y = is_eight ? 20 * std::sin(2 * t) : 25 * std::cos(t);
    for (std::size_t j = 0; j < 3; ++j) {
      const double phase = static_cast<double>(j + 2) * t;
      x += wave[4 * j] * std::cos(phase) + wave[4 * j + 1] * std::sin(phase);
      y += wave[4 * j + 2] * std::cos(phase) + wave[4 * j + 3] * std::sin(phase);
    }
    xy.insert(xy.end(), {x, y});
  }
  return xy;
}

Part part_through(const std::vector<double>& xy) {
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < xy.size(); k += 2) points.emplace_back(xy[k], xy[k + 1]);
  return Part(rollfix::outline_through(points, "a course"), {.allow_crossing = true});
}

Noise noise() {
  Noise noise{.contact = 0.02, .angle = 2e-3, .slip = 5e-3};
  noise.gyro = 0.01;
  noise.drift = 0.05 * kPi / 180;  // 180 deg/h
  return noise;
}

void require(bool is_so, const char* what) {
  if (is_so) return;
  std::fprintf(stderr, "study_wheels: %s\n", what);
  std::exit(1);
}

/// A locator that knows where it is, by the C interface.
class Driver {
 public:
  explicit Driver(const std::vector<double>& xy) {
    rollfix_part_options crossing = rollfix_default_part_options();
    crossing.allow_crossing = 1;
    rollfix_options options = rollfix_default_options();
    options.distance = noise().contact;
    options.turn = noise().angle;
    options.slip = noise().slip;
    options.gyro_scale = noise().gyro;
    options.gyro_bias = noise().drift;
    rollfix_part* part = nullptr;
    require(rollfix_part_from_points(xy.data(), xy.size() / 2, &crossing, &part, nullptr, 0) == ROLLFIX_OK,
            "no course");
    require(rollfix_start(part, &options, &locator_, nullptr, 0) == ROLLFIX_OK, "no start");
    rollfix_part_free(part);
    answer.struct_size = sizeof answer;
  }
  ~Driver() { rollfix_stop(locator_); }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  void push(const NoisyIncrements& drive, std::size_t row) {
    time_ += kSecondsOfLap / kRowsOfLap;
    require(rollfix_push(locator_, time_, drive.log.fingers[0].distance[row], drive.log.fingers[0].dturn[row]) ==
                ROLLFIX_OK,
            "a row was refused");
  }
  void locate() {
    const double start = cpu_seconds();
    require(rollfix_locate(locator_, &answer) == ROLLFIX_OK, "no answer");
    locate_seconds += cpu_seconds() - start;
    ++looks;
  }
  /// What its rows alone take, all of them at once.
  void push_again(const NoisyIncrements& drive) {
    restart();
    const double start = cpu_seconds();
    for (std::size_t row = 0; row < drive.s.size(); ++row) push(drive, row);
    push_seconds += cpu_seconds() - start;
    rows += static_cast<double>(drive.s.size());
  }
  rollfix_place place(std::size_t index) const {
    rollfix_place place{};
    place.struct_size = sizeof place;
    require(rollfix_place_at(locator_, index, &place) == ROLLFIX_OK, "no place");
    return place;
  }
  bool is_unique() const { return answer.verdict == ROLLFIX_UNIQUE && answer.contradicts == 0; }
  bool is_contradicted() const { return answer.verdict == ROLLFIX_INCONSISTENT || answer.contradicts != 0; }
  void restart() { require(rollfix_restart(locator_) == ROLLFIX_OK, "no new start"); }
  double megabytes() const { return static_cast<double>(rollfix_bytes(locator_)) / 1e6; }

  rollfix_answer answer{};
  double push_seconds = 0, locate_seconds = 0;
  double rows = 0, looks = 0;

 private:
  /// Of this process: others may be busy as well.
  static double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

  rollfix_locator* locator_ = nullptr;
  double time_ = 0;
};

struct Share {
  double of = 0, all = 0;
  void add(bool is_in) {
    of += is_in ? 1 : 0;
    all += 1;
  }
  double value() const { return all > 0 ? of / all : 0; }
};

bool is_within(const rollfix_place& place, double s, double P) {
  const double above = std::fmod(std::fmod(s - place.start_lo, P) + P, P);
  return above <= place.start_hi - place.start_lo;
}

/// After so many laps from a cold start.
struct Line {
  double laps;
  Share listed{}, wrong_and_sure{}, start{}, now{}, scale{}, bias{};
  std::vector<double> now_sd{}, scale_sd{}, bias_sd{};
};

double median(std::vector<double> values) {
  require(!values.empty(), "nothing to take a median of");
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void measure(Line& line, const Driver& driver, const NoisyIncrements& drive, double start, double now, double P) {
  constexpr double kOf95 = 1.96;
  const rollfix_answer& answer = driver.answer;
  bool is_listed = false;
  for (std::size_t k = 0; k < answer.places; ++k) is_listed = is_listed || is_within(driver.place(k), start, P);
  line.listed.add(is_listed);
  if (!driver.is_unique()) return line.wrong_and_sure.add(false);
  const rollfix_place place = driver.place(0);
  const double off = rollfix::periodic_distance(place.now, now, P);
  line.wrong_and_sure.add(off > 5 * place.now_sd);
  line.start.add(is_within(place, start, P));
  line.now.add(off <= kOf95 * place.now_sd);
  line.scale.add(std::abs(answer.turn_scale - drive.turn_scale) <= kOf95 * answer.turn_scale_sd);
  line.bias.add(std::abs(answer.gyro_bias - drive.turn_bias) <= kOf95 * answer.gyro_bias_sd);
  line.now_sd.push_back(place.now_sd);
  line.scale_sd.push_back(answer.turn_scale_sd);
  line.bias_sd.push_back(answer.gyro_bias_sd * 180 / kPi * 3600);
}

/// What all courses together say.
struct Tally {
  std::vector<Line> lines{{0.5}, {1}, {2}, {5}};
  std::vector<double> until_unique, until_noticed, until_found;
  Share false_alarms, noticed, found;
  double push_seconds = 0, locate_seconds = 0, rows = 0, looks = 0, megabytes = 0;
};

void drive_from_anywhere(const std::vector<double>& xy, std::mt19937_64& random, Tally& tally) {
  const Part part = part_through(xy);
  const double P = part.perimeter();
  const double start = std::uniform_real_distribution<double>(0, P)(random);
  const double laps = tally.lines.back().laps;
  const auto rows = static_cast<std::size_t>(laps * kRowsOfLap);
  const NoisyIncrements drive = noisy_increments(part, start, laps * P, rows, noise(), random(), laps * kSecondsOfLap);
  Driver driver(xy);
  bool is_unique = false;
  bool is_alarmed = false;
  for (std::size_t row = 0; row < rows; ++row) {
    driver.push(drive, row);
    if ((row + 1) % 4 != 0) continue;  // each hundredth of a lap
    driver.locate();
    is_alarmed = is_alarmed || (row > 16 && driver.is_contradicted());
    if (!is_unique && driver.is_unique()) tally.until_unique.push_back(static_cast<double>(row + 1) / kRowsOfLap);
    is_unique = is_unique || driver.is_unique();
    for (Line& line : tally.lines) {
      if (row + 1 == static_cast<std::size_t>(line.laps * kRowsOfLap))
        measure(line, driver, drive, start, drive.s[row], P);
    }
  }
  tally.false_alarms.add(is_alarmed);
  driver.push_again(drive);
  tally.push_seconds += driver.push_seconds;
  tally.locate_seconds += driver.locate_seconds;
  tally.rows += driver.rows;
  tally.looks += driver.looks;
  tally.megabytes = std::max(tally.megabytes, driver.megabytes());
}

/// After one lap it is carried to any other place, where it drives on; it begins anew where the rows contradict.
void carry(const std::vector<double>& xy, std::mt19937_64& random, Tally& tally) {
  const Part part = part_through(xy);
  const double P = part.perimeter();
  std::uniform_real_distribution<double> anywhere(0.1 * P, 0.9 * P);
  const double start = anywhere(random);
  const double elsewhere = start + anywhere(random);
  const NoisyIncrements before = noisy_increments(part, start, P, kRowsOfLap, noise(), random(), kSecondsOfLap);
  const NoisyIncrements after =
      noisy_increments(part, elsewhere, 2 * P, 2 * kRowsOfLap, noise(), random(), 2 * kSecondsOfLap);
  Driver driver(xy);
  for (std::size_t row = 0; row < kRowsOfLap; ++row) driver.push(before, row);
  bool is_noticed = false;
  for (std::size_t row = 0; row < 2 * kRowsOfLap; ++row) {
    driver.push(after, row);
    if ((row + 1) % 4 != 0) continue;
    driver.locate();
    const double laps = static_cast<double>(row + 1) / kRowsOfLap;
    if (!is_noticed && driver.is_contradicted()) {
      is_noticed = true;
      tally.until_noticed.push_back(laps);
      driver.restart();
    } else if (is_noticed && driver.is_unique()) {
      const rollfix_place place = driver.place(0);
      tally.found.add(rollfix::periodic_distance(place.now, after.s[row], P) <= 5 * place.now_sd);
      tally.until_found.push_back(laps);
      break;
    }
  }
  tally.noticed.add(is_noticed);
}

void print(const Tally& tally) {
  fmt::print(
      "| laps | listed | unique | wrong and sure | start in its 95 % | now | scale of turns | bias | sd now [m] | sd "
      "scale "
      "| sd bias [deg/h] |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Line& line : tally.lines) {
    fmt::print(
        "| {} | {:.1f} % | {:.1f} % | {:.0f} | {:.1f} % | {:.1f} % | {:.1f} % | {:.1f} % | {:.3f} | {:.4f} | {:.1f} "
        "|\n",
        line.laps, 100 * line.listed.value(), 100 * line.start.all / line.listed.all, line.wrong_and_sure.of,
        100 * line.start.value(), 100 * line.now.value(), 100 * line.scale.value(), 100 * line.bias.value(),
        median(line.now_sd), median(line.scale_sd), median(line.bias_sd));
  }
  fmt::print("\nunique after {:.2f} laps (median), {:.2f} (95 % of {} drives)\n", quantile(tally.until_unique, 0.5),
             quantile(tally.until_unique, 0.95), tally.false_alarms.all);
  fmt::print("contradicted without reason, of drives of {} laps, {} looks each: {} of {}\n", tally.lines.back().laps,
             100 * tally.lines.back().laps, tally.false_alarms.of, tally.false_alarms.all);
  fmt::print(
      "carried elsewhere after a lap: noticed in {} of {}, after {:.2f} laps (median), {:.2f} (95 %); unique again "
      "after "
      "{:.2f}, {:.2f}; at the right place {} of {}\n",
      tally.noticed.of, tally.noticed.all, quantile(tally.until_noticed, 0.5), quantile(tally.until_noticed, 0.95),
      quantile(tally.until_found, 0.5), quantile(tally.until_found, 0.95), tally.found.of, tally.found.all);
  fmt::print("a row takes {:.2f} us, an answer {:.0f} us; {:.1f} MB\n", 1e6 * tally.push_seconds / tally.rows,
             1e6 * tally.locate_seconds / tally.looks, tally.megabytes);
}

}  // namespace

int main(int count, char** words) {
  const int courses = count > 1 ? std::atoi(words[1]) : 6;
  std::mt19937_64 random(1);
  Tally tally;
  for (int k = 0; k < courses; ++k) {
    const std::vector<double> xy = course(random, k % 2 == 0);
    drive_from_anywhere(xy, random, tally);
    carry(xy, random, tally);
  }
  print(tally);
  for (const Line& line : tally.lines) {
    const double lost = kSigmas * std::sqrt(0.05 * 0.95 / std::max(1.0, line.start.all));
    require(line.start.value() >= 0.95 - lost, "starts are outside of their intervals too often");
  }
}
