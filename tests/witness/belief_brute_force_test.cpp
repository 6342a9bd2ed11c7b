// The posterior over the whole boundary: against a brute computation, and against itself where it is asked along the
// way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "belief/nodes.hpp"
#include "belief_cases.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "shapes.hpp"

namespace belief_brute_force_test {
namespace {

using namespace belief_cases;
using rollfix::LogKind;
using rollfix::Reading;

/// The posterior's mean and standard deviation about a place, computed another way: in terms of turns, with the whole
/// covariance of all rows written out and decomposed, on a dense and even grid.
struct Brute {
  double mean = 0;
  double sd = 0;
};

/// Of what slips here and there: a random walk in lengths.
Eigen::MatrixXd slip_here_and_there(const Part& part, const std::vector<Reading>& rows, double s, double slip) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double Li = rows[static_cast<std::size_t>(i)].length[0];
      const double Lj = rows[static_cast<std::size_t>(j)].length[0];
      covariance(i, j) = 25 * slip * slip * 0.01 * part.perimeter() * std::min(std::abs(Li), std::abs(Lj)) *
                         part.turning().curvature(s + Li) * part.turning().curvature(s + Lj);
    }
  }
  return covariance;
}

Brute brute_posterior(const Part& part, const std::vector<Reading>& rows, double radius, const Noise& noise,
                      double about, double reach) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  const double k = 1 / radius;
  constexpr int kPoints = 2001;
  std::vector<double> logs(kPoints);
  std::vector<double> places(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double s = about + reach * (2.0 * i / (kPoints - 1) - 1);
    Eigen::VectorXd f(n);
    Eigen::VectorXd by_first(n);
    Eigen::VectorXd by_scale(n);
    Eigen::VectorXd own(n);
    for (Eigen::Index r = 0; r < n; ++r) {
      const Reading& row = rows[static_cast<std::size_t>(r)];
      const double kappa = part.turning().curvature(s + row.length[0]);
      f[r] = part.turning().angle(s + row.length[0]) - part.turning().angle(s) - row.turn;
      by_first[r] = (k + kappa) * noise.contact;
      by_scale[r] = kappa * row.length[0] * noise.slip;
      own[r] = std::pow((k + kappa) * noise.contact, 2) + std::pow(noise.angle, 2);
    }
    Eigen::MatrixXd covariance = own.asDiagonal();
    covariance += by_first * by_first.transpose() + by_scale * by_scale.transpose() +
                  slip_here_and_there(part, rows, s, noise.slip);
    covariance.array() += noise.angle * noise.angle;
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const double log_volume = 2 * factor.matrixLLT().diagonal().array().log().sum();
    double by_rotation = 0;  // the finger is turned, and the length is what comes out: the density is of lengths
    for (Eigen::Index r = 0; r < n; ++r) {
      by_rotation += std::log(k + part.turning().curvature(s + rows[static_cast<std::size_t>(r)].length[0]));
    }
    places[static_cast<std::size_t>(i)] = s;
    logs[static_cast<std::size_t>(i)] = -0.5 * (f.dot(factor.solve(f)) + log_volume) + by_rotation;
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double total = 0;
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double weight = std::exp(logs[i] - most);
    total += weight;
    sum += weight * (places[i] - about);
    squares += weight * std::pow(places[i] - about, 2);
  }
  const double mean = sum / total;
  return {about + mean, std::sqrt(squares / total - mean * mean)};
}

}  // namespace

TEST(Belief, is_what_the_whole_covariance_of_all_rows_gives) {
  const Part part = part_of("cam");
  const double radius = 0.2;
  const Noise noise = noise_on(part, 2e-4, 1e-3, 1e-3);
  std::mt19937_64 random = test_generator();
  std::uniform_real_distribution<double> unit;
  for (int k = 0; k < test_count(6); ++k) {
    const double start = unit(random) * part.perimeter();
    const NoisyRoll roll = roll_on(part, radius, start, 0.35 * part.perimeter(), 40, noise, random());
    Belief belief = belief_in(part, roll.log, radius, with(noise));
    const Mode& mode = belief.modes().front();
    std::vector<Reading> rows = rollfix::readings_as_given(roll.log, {DiskFinger{radius}});
    rows.erase(rows.begin());
    const Brute brute = brute_posterior(part, rows, radius, noise, mode.start[0], 8 * mode.sd[0]);
    EXPECT_NEAR(distance(part, mode.mean[0], brute.mean), 0, 0.05 * brute.sd);
    EXPECT_NEAR(mode.sd[0], brute.sd, 0.03 * brute.sd);
  }
}

TEST(Belief, asked_along_the_way_it_ends_where_it_does_without) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  const Noise noise = noise_on(part, 1e-3, 5e-3, 5e-3);
  const rollfix::Log log = roll_on(part, 0.1, 2, 2, 700, noise, 1).log;
  Belief at_once = belief_in(part, log, 0.1, with(noise));
  Belief asked(part, LogKind::contact, with(noise));
  for (const Reading& reading : rollfix::readings_as_given(log, {DiskFinger{0.1}})) {
    asked.add(sample_of(reading, 10));
    asked.modes();
  }
  const Mode& one = at_once.modes().front();
  const Mode& other = asked.modes().front();
  EXPECT_LT(distance(part, one.mean[0], other.mean[0]), 0.05 * one.sd[0]);
  EXPECT_NEAR(one.sd[0], other.sd[0], 0.05 * one.sd[0]);
}

}  // namespace belief_brute_force_test
