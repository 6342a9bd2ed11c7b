// Where two fingers can have started on a free part, given a whole noisy log: probabilities, spreads and verdicts.
#include "rollfix/belief/belief.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "noisy_pairs.hpp"
#include "random.hpp"
#include "rollfix/contact/pose.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/gallery.hpp"
#include "shapes.hpp"

namespace pair_belief_test {

namespace {

using namespace noisy_pairs;
using free_rolls::part_of;
using rollfix::InputError;
using rollfix::Interval;
using rollfix::LogKind;
using rollfix::Prior;

const std::vector<std::string> kManyShapes{
    "cam",          "spline,n=9,seed=7,wobble=0.2", "limacon", "ellipse", "stadium",
    "superellipse", "spline,n=12,seed=5",           "naca"};

/// Of which nothing is known.
const rollfix::Contacts kTwoFingers{{0.0, 0.0}, {}};

BeliefOptions options_with(double contact, double angle, double slip) {
  BeliefOptions options;
  options.noise = {contact, angle, slip, 0};
  return options;
}

/// A roll of random length from a random place, by fingers that are small against the part.
Case random_pair(const Part& part, std::size_t rows, const Noise& noise, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double P = part.perimeter();
  const auto roll = [&] { return (0.15 + 0.5 * unit(generator)) * P * (unit(generator) < 0.5 ? -1 : 1); };
  const std::array<double, 2> start{unit(generator) * P, unit(generator) * P};
  const double La = roll();
  const double Lb = roll();
  return noisy_case(part, start, La, Lb, rows, 0.03 * P, 0.024 * P, noise, generator);
}

/// The modes whose region holds a pair.
std::vector<std::size_t> modes_at(const Part& part, const std::vector<Mode>& modes, const std::array<double, 2>& at) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (holds(part, modes[k].region[0], at[0]) && holds(part, modes[k].region[1], at[1])) found.push_back(k);
  }
  return found;
}

/// How often what a posterior claims comes true.
struct Calibration {
  int cases = 0;
  int held = 0;    // intervals that hold the truth; two for each case
  int listed = 0;  // cases whose truth is in a mode
  int top = 0;     // in the first
  double claimed = 0;
  double variance = 0;  // of how often the first is right, if it claims rightly

  void add(const Part& part, const Case& drawn, Belief belief) {
    const std::vector<Mode>& modes = belief.modes();
    const std::vector<std::size_t> at = modes_at(part, modes, drawn.start);
    ++cases;
    if (modes.empty()) return;
    claimed += modes.front().probability;
    variance += modes.front().probability * (1 - modes.front().probability);
    if (at.empty()) return;
    ++listed;
    top += at.front() == 0 ? 1 : 0;
    for (const std::size_t finger : {0U, 1U}) {
      held += holds(part, modes[at.front()].interval[finger], drawn.start[finger]) ? 1 : 0;
    }
  }
};

TEST(PairBelief, claims_what_comes_true_on_many_parts) {
  std::mt19937_64 generator = test_generator(1);
  Calibration all;
  for (const std::string& shape : kManyShapes) {
    const Part part = part_of(shape);
    const BeliefOptions options = options_with(0.0005 * part.perimeter(), 0.002, 0.003);
    for (int k = 0; k < test_count(12); ++k) {
      const Case drawn = random_pair(part, 80, options.noise, generator);
      all.add(part, drawn, belief_of(part, drawn, options));
    }
  }
  // Of 960 cases one or none was in no mode.
  EXPECT_LE(all.cases - all.listed, 1 + all.cases / 300) << "seed " << test_seed();
  // 95 % within four standard deviations; intervals of one roll hold or fail together.
  const double share = all.held / (2.0 * all.cases);
  EXPECT_NEAR(share, 0.95, 0.015 + 4 * std::sqrt(0.95 * 0.05 / all.cases)) << "seed " << test_seed();
  EXPECT_NEAR(all.top, all.claimed, 2 + 4 * std::sqrt(all.variance)) << "seed " << test_seed();
}

TEST(PairBelief, is_hardly_surer_than_it_may_be_where_a_part_has_corners) {
  std::mt19937_64 generator = test_generator(2);
  const Part part = part_of("reuleaux");
  const BeliefOptions options = options_with(0.001 * part.perimeter(), 0.003, 0.005);
  Calibration all;
  for (int k = 0; k < test_count(40); ++k) {
    const Case drawn = random_pair(part, 80, options.noise, generator);
    all.add(part, drawn, belief_of(part, drawn, options));
  }
  const double share = all.held / (2.0 * all.cases);
  EXPECT_GE(all.listed, 0.97 * all.cases - 1) << "seed " << test_seed();
  EXPECT_GT(share, 0.90 - 4 * std::sqrt(0.9 * 0.1 / all.cases)) << "seed " << test_seed();
}

/// The posterior density of a few rows on a fine grid over all pairs, each with all its errors' covariance at once.
class BruteForce {
 public:
  BruteForce(const Part& part, const Case& drawn, const Noise& noise) : part_(part), noise_(noise) {
    rows_ = rollfix::readings_as_given(drawn.log, drawn.pair());
    facing_ = *rollfix::facing(drawn.log, drawn.pair());
    curvature_ = {1 / drawn.fingers[0].radius, 1 / drawn.fingers[1].radius};
  }

  double log_likelihood(double s, double t) const {
    const auto count = static_cast<Eigen::Index>(rows_.size());
    // Errors: of each row's contact a and b and turn, then of both scales. Row 0's contacts are in all rows.
    Eigen::MatrixXd by_error = Eigen::MatrixXd::Zero(count, 3 * count + 2);
    Eigen::VectorXd off(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Reading& row = rows_[static_cast<std::size_t>(k)];
      const auto a = part_.turning().at(s + row.length[0]);
      const auto b = part_.turning().at(t + row.length[1]);
      off[k] = std::remainder(a.angle - b.angle - row.turn - facing_, 2 * std::numbers::pi);
      // A contact that was felt too far along lets the tangent be expected too far on, and its normal be felt turned.
      by_error(k, 3 * k) += a.curvature + curvature_[0];
      by_error(k, 0) -= a.curvature;
      by_error(k, 3 * k + 1) -= b.curvature + curvature_[1];
      by_error(k, 1) += b.curvature;
      by_error(k, 3 * k + 2) = 1;
      by_error(k, 3 * count) = a.curvature * row.length[0];
      by_error(k, 3 * count + 1) = -b.curvature * row.length[1];
    }
    Eigen::VectorXd variance(3 * count + 2);
    for (Eigen::Index k = 0; k < count; ++k) {
      variance[3 * k] = variance[3 * k + 1] = noise_.contact * noise_.contact;
      variance[3 * k + 2] = 2 * noise_.angle * noise_.angle;
    }
    variance.tail(2).setConstant(noise_.slip * noise_.slip);
    const Eigen::MatrixXd covariance = by_error * variance.asDiagonal() * by_error.transpose();
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    const Eigen::VectorXd white = factor.matrixL().solve(off);
    return -0.5 * white.squaredNorm() - factor.matrixLLT().diagonal().array().log().sum();
  }

  struct Moments {
    double share = 0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };

  /// Of the mass in a box, as a share of that in all boxes; offsets from a mode's mean.
  std::vector<Moments> moments(const std::vector<Mode>& modes, int points) const {
    std::vector<Moments> result;
    double total = 0;
    double best = -1e300;
    for (const Mode& mode : modes) best = std::max(best, log_likelihood(mode.start[0], mode.start[1]));
    for (const Mode& mode : modes) {
      Moments sum;
      Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
      const Interval& s = mode.region[0];
      const Interval& t = mode.region[1];
      const double area = s.width() * t.width() / (points * points);
      for (int i = 0; i < points; ++i) {
        for (int j = 0; j < points; ++j) {
          const double at_s = s.lo + s.width() * (i + 0.5) / points;
          const double at_t = t.lo + t.width() * (j + 0.5) / points;
          const double mass = area * std::exp(log_likelihood(at_s, at_t) - best);
          const Eigen::Vector2d off(part_.boundary().offset(mode.mean[0], at_s),
                                    part_.boundary().offset(mode.mean[1], at_t));
          sum.share += mass;
          sum.mean += mass * off;
          squares += mass * off * off.transpose();
        }
      }
      sum.mean /= sum.share;
      sum.covariance = squares / sum.share - sum.mean * sum.mean.transpose();
      total += sum.share;
      result.push_back(sum);
    }
    for (Moments& sum : result) sum.share /= total;
    return result;
  }

 private:
  const Part& part_;
  Noise noise_;
  std::vector<Reading> rows_;
  double facing_ = 0;
  std::array<double, 2> curvature_{};
};

/// Do the boxes around two of the modes overlap?
bool any_overlap(const Part& part, const std::vector<Mode>& modes) {
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      bool both = true;
      for (const std::size_t finger : {0U, 1U}) {
        const Interval& one = modes[i].region[finger];
        const Interval& other = modes[j].region[finger];
        both = both && (holds(part, one, other.lo) || holds(part, other, one.lo));
      }
      if (both) return true;
    }
  }
  return false;
}

TEST(PairBelief, is_the_density_that_all_covariances_give_on_a_fine_grid) {
  const Part part = part_of("cam");
  const BeliefOptions options = options_with(0.002, 0.002, 0.004);
  std::mt19937_64 generator = test_generator(3);
  for (int k = 0; k < test_count(4); ++k) {
    const Case drawn = random_pair(part, 7, options.noise, generator);
    Belief belief = belief_of(part, drawn, options);
    const std::vector<Mode>& modes = belief.modes();
    if (any_overlap(part, modes)) continue;  // then a box holds others' mass as well
    const auto truth = BruteForce(part, drawn, options.noise).moments(modes, 200);
    for (std::size_t m = 0; m < modes.size(); ++m) {
      SCOPED_TRACE(testing::Message() << "case " << k << ", mode " << m << ", seed " << test_seed());
      EXPECT_NEAR(modes[m].probability, truth[m].share, 0.03);
      if (modes[m].probability < 0.02) continue;
      for (const Eigen::Index i : {0, 1}) {
        const double sd = std::sqrt(truth[m].covariance(i, i));
        EXPECT_NEAR(truth[m].mean[i], 0, 0.08 * sd);
        EXPECT_NEAR(modes[m].sd[static_cast<std::size_t>(i)], sd, 0.08 * sd);
      }
      const double correlation =
          truth[m].covariance(0, 1) / std::sqrt(truth[m].covariance(0, 0) * truth[m].covariance(1, 1));
      EXPECT_NEAR(modes[m].covariance(0, 1) / (modes[m].sd[0] * modes[m].sd[1]), correlation, 0.05);
    }
  }
}

TEST(PairBelief, leaves_no_mode_out_that_a_grid_over_all_pairs_finds) {
  const Part part = part_of("cam");
  const BeliefOptions options = options_with(0.01, 0.006, 0.004);
  std::mt19937_64 generator = test_generator(4);
  const Case drawn = random_pair(part, 4, options.noise, generator);
  Belief belief = belief_of(part, drawn, options);
  const BruteForce brute(part, drawn, options.noise);
  constexpr int kPoints = 400;
  double inside = 0;
  double total = 0;
  const Mode& first = belief.modes().front();
  const double best = brute.log_likelihood(first.start[0], first.start[1]);
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const std::array<double, 2> at{part.perimeter() * i / kPoints, part.perimeter() * j / kPoints};
      const double mass = std::exp(brute.log_likelihood(at[0], at[1]) - best);
      total += mass;
      inside += modes_at(part, belief.modes(), at).empty() ? 0 : mass;
    }
  }
  EXPECT_GT(inside / total, 0.995) << "seed " << test_seed();
}

TEST(PairBelief, takes_both_halves_of_a_symmetric_part_as_equally_probable) {
  const Part part = part_of("ellipse");
  std::mt19937_64 generator = test_generator(5);
  const BeliefOptions options = options_with(0.002, 0.002, 0.002);
  const Case drawn = random_pair(part, 100, options.noise, generator);
  Belief belief = belief_of(part, drawn, options);
  ASSERT_EQ(belief.verdict().text(), "ambiguous (2)");
  EXPECT_NEAR(belief.modes()[0].probability, 0.5, 0.01);
  EXPECT_NEAR(part.boundary().distance(belief.modes()[0].start[0], belief.modes()[1].start[0]), part.perimeter() / 2,
              0.05 * belief.modes()[0].sd[0]);
}

TEST(PairBelief, takes_what_it_is_told_of_finger_a_before) {
  const Part part = part_of("ellipse");
  std::mt19937_64 generator = test_generator(6);
  BeliefOptions options = options_with(0.002, 0.002, 0.002);
  const Case drawn = random_pair(part, 100, options.noise, generator);
  options.prior = Prior{drawn.start[0], 0.5};
  Belief belief = belief_of(part, drawn, options);
  EXPECT_EQ(belief.verdict().text(), "unique");
  EXPECT_FALSE(modes_at(part, belief.modes(), drawn.start).empty());
}

TEST(PairBelief, a_prior_at_an_end_of_an_open_part_does_not_reach_around_to_the_other) {
  const Part part = shapes::open_waves();
  const double P = part.perimeter();
  std::mt19937_64 generator = test_generator(8);
  BeliefOptions options = options_with(0.01, 0.01, 0.002);
  options.prior = Prior{0, 0.06 * P};
  const Case drawn = noisy_case(part, {0.12 * P, 0.4 * P}, 0.1 * P, 0.1 * P, 100, 0.2, 0.2, options.noise, generator);
  Belief belief = belief_of(part, drawn, options);
  ASSERT_FALSE(belief.modes().empty());
  for (const Mode& mode : belief.modes()) EXPECT_LT(mode.start[0], 0.5 * P);
}

/// Some of the rows say anything.
void disturb(Case& drawn, double share, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t k = 1; k < drawn.log.rows(); ++k) {
    if (unit(generator) < share) drawn.log.fingers[0].psi[k] += 0.3 + unit(generator);
  }
}

TEST(PairBelief, does_not_follow_stray_rows_when_it_is_robust) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(7);
  BeliefOptions options = options_with(0.002, 0.002, 0.002);
  options.robust = true;
  Calibration all;
  for (int k = 0; k < test_count(30); ++k) {
    Case drawn = random_pair(part, 100, options.noise, generator);
    disturb(drawn, 0.05, generator);
    all.add(part, drawn, belief_of(part, drawn, options));
  }
  EXPECT_EQ(all.top, all.cases) << "seed " << test_seed();
  EXPECT_GT(all.held / (2.0 * all.cases), 0.95 - 0.015 - 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

TEST(PairBelief, calls_stray_rows_an_excess_when_it_is_not_robust) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(8);
  const BeliefOptions options = options_with(0.002, 0.002, 0.002);
  Case drawn = random_pair(part, 100, options.noise, generator);
  disturb(drawn, 0.05, generator);
  EXPECT_EQ(belief_of(part, drawn, options).verdict().text(), "inconsistent");
}

TEST(PairBelief, widens_by_noise_that_is_larger_than_said) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(9);
  const Case drawn = random_pair(part, 200, {0.004, 0.004, 0.002, 0}, generator);
  Belief belief = belief_of(part, drawn, options_with(0.002, 0.002, 0.001));
  EXPECT_NEAR(belief.excess(), 2, 0.4);
  EXPECT_FALSE(modes_at(part, belief.modes(), drawn.start).empty());
  Belief told = belief_of(part, drawn, options_with(0.004, 0.004, 0.002));
  EXPECT_NEAR(belief.modes().front().sd[0], told.modes().front().sd[0], 0.25 * told.modes().front().sd[0]);
}

TEST(PairBelief, of_another_part_fits_nothing) {
  std::mt19937_64 generator = test_generator(11);
  const BeliefOptions options = options_with(0.002, 0.002, 0.001);
  const Part felt = part_of("spline,n=9,seed=7,wobble=0.2");
  const Case drawn = noisy_case(felt, {1, 4}, 4, -3, 100, 0.2, 0.15, options.noise, generator);
  Belief belief = belief_of(part_of("limacon"), drawn, options);
  EXPECT_EQ(belief.verdict().text(), "inconsistent");
}

TEST(PairBelief, can_not_tell_a_circles_places_apart) {
  const Part part = part_of("circle");
  std::mt19937_64 generator = test_generator(12);
  const BeliefOptions options = options_with(0.002, 0.002, 0.002);
  Belief belief = belief_of(part, random_pair(part, 50, options.noise, generator), options);
  ASSERT_EQ(belief.verdict().text(), "unobservable");
  // Uniform around the circle.
  EXPECT_NEAR(belief.modes().front().sd[0], part.perimeter() / std::sqrt(12.0), 0.05 * part.perimeter());
}

TEST(PairBelief, is_a_stretch_where_95_percent_are_more_than_a_tenth_of_the_part) {
  const Part part = part_of("circle");
  const double P = part.perimeter();
  std::mt19937_64 generator = test_generator(31);
  BeliefOptions options = options_with(1e-4, 1e-4, 0);
  const Case drawn = random_pair(part, 50, options.noise, generator);
  // On a circle the place is known as it was before: 95 % are 3.92 standard deviations.
  const auto verdict = [&](double sd) {
    options.prior = Prior{drawn.start[0], sd};
    return belief_of(part, drawn, options).verdict().text();
  };
  EXPECT_EQ(verdict(0.09 / 3.92 * P), "unique");
  EXPECT_EQ(verdict(0.11 / 3.92 * P), "ambiguous (1 stretch)");
}

TEST(PairBelief, needs_no_facing) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(13);
  const BeliefOptions options = options_with(0.001, 0.001, 0.002);
  Calibration all;
  for (int k = 0; k < test_count(25); ++k) {
    const Case drawn = random_pair(part, 100, options.noise, generator);
    rollfix::Contacts contacts;
    contacts.finger_curvature = {1 / drawn.fingers[0].radius, 1 / drawn.fingers[1].radius};
    Belief belief(part, LogKind::contact, options, contacts);
    for (const Reading& row : rollfix::readings_as_given(drawn.log, drawn.pair())) belief.add(row);
    all.add(part, drawn, std::move(belief));
  }
  EXPECT_EQ(all.listed, all.cases) << "seed " << test_seed();
  EXPECT_NEAR(all.held / (2.0 * all.cases), 0.95, 0.02 + 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

/// Increments with noise, summed as a log of increments is.
std::vector<Reading> increments(const Part& part, const std::array<double, 2>& start, double La, double Lb, int rows,
                                const Noise& noise, std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0, 1);
  std::vector<Reading> result;
  double off_a = 0;
  double off_b = 0;
  double off_turn = 0;
  for (int k = 1; k <= rows; ++k) {
    const double share = static_cast<double>(k) / rows;
    off_a += noise.contact * normal(generator);
    off_b += noise.contact * normal(generator);
    off_turn += noise.angle * (normal(generator) + normal(generator));
    const auto turned = [&](double s, double length) {
      return part.turning().angle(s + length) - part.turning().angle(s);
    };
    result.push_back({share * La + off_a, share * Lb + off_b,
                      turned(start[0], share * La) - turned(start[1], share * Lb) + off_turn});
  }
  return result;
}

TEST(PairBelief, knows_that_increments_gather_errors) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(14);
  std::uniform_real_distribution<double> unit(0, 1);
  const BeliefOptions options = options_with(0.001, 0.0005, 0);
  Calibration all;
  for (int k = 0; k < test_count(25); ++k) {
    Case drawn;
    drawn.start = {unit(generator) * part.perimeter(), unit(generator) * part.perimeter()};
    Belief belief(part, LogKind::increments, options, kTwoFingers);
    const double La = (1 + 2 * unit(generator)) * (unit(generator) < 0.5 ? -1 : 1);
    for (const Reading& row : increments(part, drawn.start, La, 2.2, 60, options.noise, generator)) {
      belief.add(row);
    }
    all.add(part, drawn, std::move(belief));
  }
  EXPECT_EQ(all.listed, all.cases) << "seed " << test_seed();
  EXPECT_NEAR(all.held / (2.0 * all.cases), 0.95, 0.03 + 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

TEST(PairBelief, takes_long_logs_as_it_takes_short_ones) {
  const Part part = part_of("limacon");
  std::mt19937_64 generator = test_generator(15);
  const BeliefOptions options = options_with(0.01, 0.005, 0.002);
  Calibration all;
  for (int k = 0; k < test_count(15); ++k) {
    const Case drawn = random_pair(part, 3000, options.noise, generator);
    all.add(part, drawn, belief_of(part, drawn, options));
  }
  EXPECT_EQ(all.listed, all.cases) << "seed " << test_seed();
  EXPECT_NEAR(all.held / (2.0 * all.cases), 0.95, 0.02 + 4 * std::sqrt(0.95 * 0.05 / all.cases));
}

TEST(PairBelief, knows_how_sure_the_parts_pose_is) {
  const Part part = part_of("spline,n=9,seed=7,wobble=0.2");
  std::mt19937_64 generator = test_generator(16);
  const BeliefOptions options = options_with(0.003, 0.003, 0.002);
  double sum = 0;
  int cases = 0;
  for (int k = 0; k < test_count(30); ++k) {
    const Case drawn = random_pair(part, 100, options.noise, generator);
    // Fingers that touch at the same place would be in each other's way, and tell less than any pose.
    if (part.boundary().distance(drawn.start[0], drawn.start[1]) < 0.4) continue;
    Belief belief = belief_of(part, drawn, options);
    rollfix::PerFinger<rollfix::FeltContact> felt = {rollfix::FeltContact{}, rollfix::FeltContact{}};
    for (const std::size_t finger : {0U, 1U}) {
      const rollfix::FingerRows& rows = drawn.log.fingers[finger];
      const double radius = drawn.fingers[finger].radius;
      felt[finger] = {free_rolls::felt_contact(rows, radius, 0), rows.u[0] + rows.psi[0], 1 / radius};
    }
    const rollfix::PoseSpread spread = belief.pose_spread(0, felt);
    // free_rolls::by_distances puts the part there.
    const Eigen::Vector3d off(spread.mean.x - 0.4, spread.mean.y + 0.7,
                              std::remainder(spread.mean.heading - 2.1, 2 * std::numbers::pi));
    sum += off.dot(spread.covariance.inverse() * off);
    ++cases;
  }
  // The mean of chi-squares with three degrees of freedom.
  EXPECT_NEAR(sum / cases, 3, 0.3 + 4 * std::sqrt(6.0 / cases)) << "seed " << test_seed();
}

TEST(PairBelief, says_the_same_twice) {
  const Part part = part_of("cam");
  std::mt19937_64 generator = test_generator(17);
  const BeliefOptions options = options_with(0.005, 0.003, 0.002);
  const Case drawn = random_pair(part, 60, options.noise, generator);
  Belief one = belief_of(part, drawn, options);
  Belief other = belief_of(part, drawn, options);
  ASSERT_EQ(one.modes().size(), other.modes().size());
  EXPECT_EQ(one.modes().front().start, other.modes().front().start);
  EXPECT_EQ(one.modes().front().probability, other.modes().front().probability);
}

TEST(PairBelief, bounds_what_it_leaves_out) {
  const Part part = part_of("cam");
  std::mt19937_64 generator = test_generator(18);
  const BeliefOptions options = options_with(0.005, 0.003, 0.002);
  Belief belief = belief_of(part, random_pair(part, 60, options.noise, generator), options);
  double listed = 0;
  for (const Mode& mode : belief.modes()) listed += mode.probability;
  EXPECT_GE(listed + belief.rest(), 1);
  EXPECT_LT(belief.rest(), 0.002);
}

TEST(PairBelief, refuses_noise_that_is_none) {
  EXPECT_THROW(Belief(part_of("cam"), LogKind::contact, BeliefOptions{}, kTwoFingers), InputError);
  EXPECT_THROW(Belief(part_of("cam"), LogKind::contact, options_with(-1, 0.1, 0), kTwoFingers), InputError);
}

}  // namespace

}  // namespace pair_belief_test
