#include "particle_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "rollfix/turning_function.hpp"
namespace bench {
namespace {

using rollfix::Noise;
using rollfix::Part;
using rollfix::Sample;

// Particles are drawn again when those that carry the weight are fewer than this share.
constexpr double kFew = 0.5;
// What is kept of a particle's own value when it is shaken: the usual choice.
constexpr double kKept = 0.98;
// Clouds are apart where there is no particle over this share of the perimeter.
constexpr double kGap = 0.01;
// Lighter clouds are not told of.
constexpr double kLightest = 0.01;

struct Particle {
  double s = 0;
  double scale = 0;
  double log_weight = 0;
};

double square(double x) { return x * x; }

/// The likelihood of a sample's turn for a finger that started there. Row 1's own error is in every row: its variance
/// is added, as if it were the row's own.
void weigh(const Part& part, const Sample& sample, const Noise& noise, std::vector<Particle>& particles) {
  for (Particle& particle : particles) {
    const double length = sample.reading.length[0] / (1 + particle.scale);
    const rollfix::Turning there = part.turning().at(particle.s + length);
    const double off = there.angle - part.turning().angle(particle.s) - sample.reading.turn;
    const double by_contact = (sample.finger_curvature[0] + there.curvature) * noise.contact;
    const double variance = 2 * (square(by_contact) + square(noise.angle));
    particle.log_weight -= 0.5 * (square(off) / variance + std::log(variance));
  }
}

/// Brings the largest weight to 1; how many particles carry the weight.
double normalize(std::vector<Particle>& particles) {
  double most = particles.front().log_weight;
  for (const Particle& particle : particles) most = std::max(most, particle.log_weight);
  double sum = 0;
  double squares = 0;
  for (Particle& particle : particles) {
    particle.log_weight -= most;
    const double weight = std::exp(particle.log_weight);
    sum += weight;
    squares += square(weight);
  }
  return square(sum) / squares;
}

/// Systematic drawing, and a shake as wide as the cloud that a particle is in.
void draw_again(const Part& part, const Noise& noise, std::mt19937_64& random, std::vector<Particle>& particles) {
  double total = 0;
  for (const Particle& particle : particles) total += std::exp(particle.log_weight);
  const double step = total / static_cast<double>(particles.size());
  double aim = std::uniform_real_distribution<double>(0, step)(random);
  double passed = 0;
  std::vector<Particle> drawn;
  for (const Particle& particle : particles) {
    passed += std::exp(particle.log_weight);
    for (; aim < passed && drawn.size() < particles.size(); aim += step)
      drawn.push_back({particle.s, particle.scale, 0});
  }
  while (drawn.size() < particles.size()) drawn.push_back(drawn.back());
  std::sort(drawn.begin(), drawn.end(), [](const Particle& a, const Particle& b) { return a.s < b.s; });
  const double P = part.perimeter();
  std::normal_distribution<double> normal;
  for (std::size_t begin = 0; begin < drawn.size();) {
    std::size_t end = begin + 1;
    while (end < drawn.size() && drawn[end].s - drawn[end - 1].s < kGap * P) ++end;
    double mean = 0;
    for (std::size_t k = begin; k < end; ++k) mean += drawn[k].s;
    mean /= static_cast<double>(end - begin);
    double variance = 0;
    for (std::size_t k = begin; k < end; ++k) variance += square(drawn[k].s - mean);
    variance /= static_cast<double>(end - begin);
    const double shake = std::sqrt((1 - square(kKept)) * variance) + 1e-6 * P;
    for (std::size_t k = begin; k < end; ++k) {
      drawn[k].s = mean + kKept * (drawn[k].s - mean) + shake * normal(random);
      drawn[k].s = part.boundary().base(drawn[k].s);
      drawn[k].scale += 0.1 * noise.slip * normal(random);
    }
    begin = end;
  }
  particles = std::move(drawn);
}

std::vector<Cloud> clouds_of(const Part& part, std::vector<Particle> particles) {
  std::sort(particles.begin(), particles.end(), [](const Particle& a, const Particle& b) { return a.s < b.s; });
  double total = 0;
  for (const Particle& particle : particles) total += std::exp(particle.log_weight);
  std::vector<Cloud> clouds;
  double last = -part.perimeter();
  for (const Particle& particle : particles) {
    const double weight = std::exp(particle.log_weight) / total;
    if (weight < 1e-3 / static_cast<double>(particles.size())) continue;
    if (particle.s - last >= kGap * part.perimeter()) clouds.emplace_back();
    Cloud& cloud = clouds.back();
    cloud.start = (cloud.start * cloud.weight + particle.s * weight) / (cloud.weight + weight);
    cloud.weight += weight;
    last = particle.s;
  }
  clouds.erase(std::remove_if(clouds.begin(), clouds.end(), [](const Cloud& c) { return c.weight < kLightest; }),
               clouds.end());
  std::sort(clouds.begin(), clouds.end(), [](const Cloud& a, const Cloud& b) { return a.weight > b.weight; });
  return clouds;
}

}  // namespace

std::vector<Cloud> filter_particles(const Part& part, const std::vector<Sample>& samples, const Noise& noise,
                                    std::size_t particles, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, part.perimeter());
  std::normal_distribution<double> normal;
  std::vector<Particle> all(particles);
  for (Particle& particle : all) particle = {place(random), noise.slip * normal(random), 0};
  for (std::size_t k = 1; k < samples.size(); ++k) {
    weigh(part, samples[k], noise, all);
    if (normalize(all) < kFew * static_cast<double>(particles)) draw_again(part, noise, random, all);
  }
  return clouds_of(part, all);
}

}  // namespace bench
