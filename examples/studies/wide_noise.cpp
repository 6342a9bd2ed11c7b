// How often the 95 % interval holds the true start where angles are very noisy, and after short rolls of many rows.
// And of the places that are claimed with some probability, how many are true.
// Prints docs/belief.md's two tables: study_wide_noise 40, with as many logs of each of nine families of parts; left
// out 1, and without the longest ones. Fails where far too few or too many are within.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

#include "families.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/turning_function.hpp"

namespace {

using rollfix::Part;

constexpr double kContactShare = 1e-3;  // of the perimeter: standard deviation
constexpr double kSlip = 5e-3;
constexpr double kSlipsHere = 5;  // times as much, on its own over each hundredth of the perimeter
constexpr double kSigmas = 5;     // of a binomial count

struct Line {
  double angle;  // noise, radians
  std::size_t rows;
  double length_share;  // of the roll, of the perimeter
};
constexpr std::array<Line, 12> kLines = {{{0.005, 100, 0.4},
                                          {0.005, 1000, 0.4},
                                          {0.1, 10, 0.02},
                                          {0.1, 100, 0.02},
                                          {0.1, 100, 0.4},
                                          {0.1, 1000, 1.5},
                                          {0.1, 10000, 0.4},
                                          {0.5, 10, 0.02},
                                          {0.5, 100, 0.02},
                                          {0.5, 100, 0.4},
                                          {0.5, 1000, 1.5},
                                          {0.5, 10000, 0.4}}};
constexpr std::size_t kManyRows = 10000;

/// Of places by the probability that they are claimed with, in tenths.
struct Claims {
  void add(double probability, bool is_true) {
    const auto tenth = std::min<std::size_t>(places.size() - 1, static_cast<std::size_t>(10 * probability));
    ++places.at(tenth);
    claimed.at(tenth) += probability;
    variance.at(tenth) += probability * (1 - probability);
    right.at(tenth) += is_true ? 1 : 0;
  }
  bool are_true() const {
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (std::abs(right.at(k) - claimed.at(k)) > 0.03 * places.at(k) + kSigmas * std::sqrt(variance.at(k) + 1))
        return false;
    }
    return true;
  }
  void print() const {
    fmt::print("\n| claimed | places | claimed on average | true |\n| --- | --- | --- | --- |\n");
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places.at(k) == 0) continue;
      fmt::print("| {} to {} % | {} | {:.1f} % | {:.1f} % |\n", 10 * k, 10 * (k + 1), places.at(k),
                 100 * claimed.at(k) / places.at(k), 100 * right.at(k) / places.at(k));
    }
  }

  std::array<int, 10> places{};
  std::array<double, 10> claimed{};
  std::array<double, 10> variance{};
  std::array<double, 10> right{};
};

/// What slips leaves the normal where it is.
void slip_here_and_there(rollfix::NoisyRoll& roll, const Part& part, double radius, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  double slipped = 0;
  for (std::size_t row = 1; row < roll.log.rows(); ++row) {
    const double length = std::abs(roll.truth.s[0][row] - roll.truth.s[0][row - 1]);
    slipped += kSlipsHere * kSlip * std::sqrt(0.01 * part.perimeter() * length) * normal(random);
    roll.log.fingers[0].u[row] += slipped / radius;
    roll.log.fingers[0].psi[row] -= slipped / radius;
  }
}

/// Whether the interval of the place that holds the truth does so.
bool is_within(const Part& part, double radius, const Line& line, std::mt19937_64& random, Claims& claims) {
  std::uniform_real_distribution<double> share;
  const double P = part.perimeter();
  rollfix::RollPlan plan;
  plan.start = share(random) * P;
  plan.distance = (share(random) < 0.5 ? -1 : 1) * line.length_share * P;
  plan.rows = line.rows;
  rollfix::BeliefOptions options;
  options.noise = {kContactShare * P, line.angle, kSlip, 0};
  const rollfix::DiskFinger finger{radius};
  rollfix::NoisyRoll roll = rollfix::noisy_roll(part, finger, plan, options.noise, random());
  slip_here_and_there(roll, part, radius, random);
  rollfix::Belief belief(part, rollfix::LogKind::contact, options);
  for (const rollfix::Reading& reading : rollfix::readings_as_given(roll.log, {finger})) {
    rollfix::Sample sample;
    sample.reading = reading;
    sample.finger_curvature = 1 / radius;
    belief.add(sample);
  }
  bool is_within = false;
  for (const rollfix::Mode& mode : belief.modes()) {
    const bool is_true = part.boundary().contains(mode.region[0], plan.start);
    claims.add(mode.probability, is_true);
    is_within = is_within || (is_true && part.boundary().contains(mode.interval[0], plan.start));
  }
  return is_within;
}

}  // namespace

int main(int count, char** values) {
  const int logs = count > 1 ? std::atoi(values[1]) : 1;
  std::mt19937_64 random(20010529);
  bool is_right = true;
  Claims claims;
  fmt::print("| angle [rad] | rows | roll | in 95 % |\n| --- | --- | --- | --- |\n");
  for (const Line& line : kLines) {
    if (count <= 1 && line.rows >= kManyRows) continue;
    int cases = 0;
    int within = 0;
    for (const Family& family : kFamilies) {
      const Part part(rollfix::gallery(family.shape));
      for (int k = 0; k < logs; ++k, ++cases) {
        within += is_within(part, family.radius_share * part.perimeter(), line, random, claims) ? 1 : 0;
      }
    }
    const double off = std::abs(within - 0.95 * cases) - 0.03 * cases;
    is_right = is_right && off <= kSigmas * std::sqrt(0.95 * 0.05 * cases);
    fmt::print("| {} | {} | {} P | {:.1f} % |\n", line.angle, line.rows, line.length_share, 100.0 * within / cases);
    std::fflush(stdout);
  }
  claims.print();
  return is_right && claims.are_true() ? 0 : 1;
}
