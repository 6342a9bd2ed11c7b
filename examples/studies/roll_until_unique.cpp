// How far does one have to roll until one of N parts, and one place on it, is left? By N and by noise, on closed
// splines that differ by nothing but their random knots.
// Prints docs/identify.md's table: study_roll_until_unique 20, with as many rolls for each line; left out 1, and
// without the large catalogs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "rollfix/identify.hpp"

namespace {

using rollfix::Catalog;
using rollfix::Part;

constexpr std::size_t kReadings = 24;
constexpr double kDegree = 3.14159265358979323846 / 180;

Catalog splines(std::size_t count, const std::string& file) {
  std::vector<rollfix::CatalogSource> sources;
  for (std::size_t k = 1; k <= count; ++k) {
    const std::string shape = fmt::format("gallery:spline,n=9,wobble=0.2,seed={}", k);
    sources.push_back({shape, shape});
  }
  rollfix::build_catalog(file, sources);
  return Catalog(file);
}

/// A roll from s, with noise that is the same share of each length of it: what is drawn does not depend on the length.
rollfix::Problem roll(const Part& part, double s, double length, const rollfix::Noise& noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  rollfix::Problem problem{part, std::vector<rollfix::Reading>{}};
  for (std::size_t k = 1; k <= kReadings; ++k) {
    const double exact = length * static_cast<double>(k) / kReadings;
    const double turn = part.turning().angle(s + exact) - part.turning().angle(s);
    const double travelled = exact + noise.contact * normal(random);
    problem.measured.readings.emplace_back(travelled, turn + noise.angle * normal(random));
  }
  problem.noise = noise;
  return problem;
}

/// The shortest roll, a share of the perimeter, from which on one place on one part is left; to a hundredth.
double shortest(const Catalog& catalog, const rollfix::Noise& share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Part part = catalog.part(std::uniform_int_distribution<std::size_t>(0, catalog.size() - 1)(random));
  const double P = part.perimeter();
  const double s = std::uniform_real_distribution<double>(0, P)(random);
  const rollfix::Noise noise{share.contact * P, share.angle};
  double lo = 0;
  double hi = 1;
  while (hi - lo > 0.01) {
    const double middle = 0.5 * (lo + hi);
    const rollfix::Identified found = rollfix::identify(catalog, roll(part, s, middle * P, noise, seed));
    (found.verdict == "unique part, unique place" ? hi : lo) = middle;
  }
  return hi;
}

}  // namespace

int main(int count, char** values) {
  const std::size_t rolls = count > 1 ? std::stoul(values[1]) : 1;
  fmt::print("| parts | angle [deg] | contact, share of P | half of the rolls need | 9 of 10 need |\n");
  fmt::print("| --- | --- | --- | --- | --- |\n");
  for (const std::size_t parts : {1U, 10U, 100U, 1000U}) {
    if (rolls == 1 && parts > 10) break;
    const std::string file = (std::filesystem::temp_directory_path() / fmt::format("rollfix-{}.db", parts)).string();
    std::filesystem::remove(file);
    const Catalog catalog = splines(parts, file);
    for (const rollfix::Noise& noise : {rollfix::Noise{1e-5, 0.01 * kDegree}, rollfix::Noise{1e-4, 0.1 * kDegree},
                                        rollfix::Noise{1e-3, 1 * kDegree}}) {
      std::vector<double> lengths;
      for (std::size_t k = 0; k < rolls; ++k) lengths.push_back(shortest(catalog, noise, 1000 * parts + k));
      std::sort(lengths.begin(), lengths.end());
      fmt::print("| {} | {:g} | {:g} | {:.0f} % of P | {:.0f} % |\n", parts, noise.angle / kDegree, noise.contact,
                 100 * lengths[rolls / 2], 100 * lengths[std::min(rolls - 1, 9 * rolls / 10)]);
      std::fflush(stdout);
    }
    std::filesystem::remove(file);
  }
}
