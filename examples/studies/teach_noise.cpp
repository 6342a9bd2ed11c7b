// How near a taught part comes to the true one where the rows are noisy, what `teach` says of that, and how often the
// 95 % interval of a later noisy roll holds the true place. Prints docs/teach.md's tables.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/teach.hpp"

namespace {

using rollfix::Noise;
using rollfix::Part;

constexpr double kRadiusShare = 0.03;  // of the perimeter: the finger's
constexpr double kStart = 0.3;
constexpr double kNearCorner = 0.005;  // of the perimeter: a corner a little to the side is no wrong direction
constexpr double kDegree = std::numbers::pi / 180;

struct Lap {
  std::string shape;
  double laps;
  std::size_t rows;
  Noise noise;
};

rollfix::NoisyRoll roll_on(const Part& part, double start, double length, std::size_t rows, const Noise& noise,
                           std::uint64_t seed) {
  rollfix::RollPlan plan;
  plan.start = start;
  plan.distance = length;
  plan.rows = rows;
  return rollfix::noisy_roll(part, rollfix::disk(kRadiusShare * part.perimeter()), plan, noise, seed);
}

struct Error {
  double root_mean_square = 0;
  double most = 0;
};

/// Of tangents at equal shares of the perimeter, less the one that they have in common.
Error error_of(const Part& taught, const Part& truth) {
  constexpr int kPlaces = 1000;
  std::vector<double> off;
  double mean = 0;
  const auto is_near_corner = [&](double s) {
    return std::any_of(truth.corners().begin(), truth.corners().end(), [&](const rollfix::Corner& corner) {
      return truth.boundary().distance(corner.s, s) < kNearCorner * truth.perimeter();
    });
  };
  for (int k = 0; k < kPlaces; ++k) {
    const double share = (k + 0.5) / kPlaces;
    if (is_near_corner(kStart + share * truth.perimeter())) continue;
    off.push_back(taught.turning().angle(share * taught.perimeter()) -
                  truth.turning().angle(kStart + share * truth.perimeter()));
    mean += off.back();
  }
  mean /= static_cast<double>(off.size());
  Error error;
  for (const double each : off) {
    error.root_mean_square += (each - mean) * (each - mean) / static_cast<double>(off.size());
    error.most = std::max(error.most, std::abs(each - mean));
  }
  error.root_mean_square = std::sqrt(error.root_mean_square);
  return error;
}

rollfix::Taught teach_lap(const Lap& lap, const Part& truth, std::uint64_t seed) {
  const rollfix::NoisyRoll roll = roll_on(truth, kStart, lap.laps * truth.perimeter(), lap.rows, lap.noise, seed);
  // The first contact is where s = 0 is: with noise there, the places of both outlines could not be compared.
  rollfix::Log log = roll.log;
  log.fingers[0].u[0] = roll.truth.log.fingers[0].u[0];
  log.fingers[0].psi[0] = roll.truth.log.fingers[0].psi[0];
  rollfix::TeachOptions options;
  options.finger = rollfix::disk(kRadiusShare * truth.perimeter());
  if (lap.noise.angle > 0) options.noise = lap.noise;
  return rollfix::teach(log, options);
}

struct Coverage {
  int cases = 0;
  int within = 0;
};

/// Later rolls of random starts and lengths on a part taught from one lap.
void cover(const Lap& lap, const Part& truth, const Part& taught, int count, std::uint64_t seed, Coverage& sum) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  const double P = truth.perimeter();
  for (int k = 0; k < count; ++k) {
    const double start = P * share(random);
    const double length = P * (0.1 + 0.5 * share(random));
    const rollfix::NoisyRoll roll = roll_on(truth, start, length, 200, lap.noise, random());
    const rollfix::Answer answer = rollfix::solve({taught, roll.log, {rollfix::disk(kRadiusShare * P)}, lap.noise});
    const double place = std::fmod(start - kStart + P, P) * taught.perimeter() / P;
    ++sum.cases;
    const rollfix::Placement* nearest = nullptr;
    const auto off = [&](const rollfix::Placement& placement) {
      return taught.boundary().distance(placement.start[0], place);
    };
    for (const rollfix::Placement& placement : answer.placements) {
      if (nearest == nullptr || off(placement) < off(*nearest)) nearest = &placement;
    }
    if (nearest != nullptr) sum.within += taught.boundary().contains(nearest->interval[0], place) ? 1 : 0;
  }
}

}  // namespace

int main(int count, char** values) {
  const std::uint64_t parts = count > 1 ? std::stoul(values[1]) : 2;
  const int rolls = count > 2 ? std::stoi(values[2]) : 2;
  fmt::print("| part | laps | rows | angle [deg] | Theta off, rms [deg] | largest | said, sd | in 95 % |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const std::string shape :
       {"ellipse,a=2,b=1", "cam", "limacon", "spline,n=9,seed=7,wobble=0.2", "stadium", "reuleaux"}) {
    const Part truth(rollfix::gallery(shape));
    for (const Lap& lap : {Lap{shape, 1, 1000, {1e-4 * truth.perimeter(), kDegree, 0, 0}},
                           Lap{shape, 1.5, 1000, {1e-4 * truth.perimeter(), kDegree, 0, 0}},
                           Lap{shape, 1, 1000, {1e-4 * truth.perimeter(), 0.1 * kDegree, 0.002, 0}}}) {
      Error error;
      double said = 0;
      Coverage coverage;
      int taught_parts = 0;
      for (std::uint64_t k = 0; k < parts; ++k) {
        const rollfix::Taught taught = teach_lap(lap, truth, 100 + k);
        if (taught.closing != rollfix::Closing::spread) continue;
        const Part part(taught.outline);
        const Error one = error_of(part, truth);
        error.root_mean_square += one.root_mean_square * one.root_mean_square;
        error.most = std::max(error.most, one.most);
        said += taught.outline.accuracy.turn * taught.outline.accuracy.turn;
        cover(lap, truth, part, rolls, 1000 + k, coverage);
        ++taught_parts;
      }
      fmt::print("| {} | {} | {} | {:.2g} | {:.3f} | {:.3f} | {:.3f} | {:.1f} % |\n", shape, lap.laps, lap.rows,
                 lap.noise.angle / kDegree, std::sqrt(error.root_mean_square / taught_parts) / kDegree,
                 error.most / kDegree, std::sqrt(said / taught_parts) / kDegree,
                 100.0 * coverage.within / std::max(1, coverage.cases));
    }
  }
}
