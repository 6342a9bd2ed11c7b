// Bounds rule parts out without looking at them, and lose none: with them and without them the answer is the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "catalog/bounds/bounds.hpp"
#include "catalogs.hpp"
#include "random.hpp"
#include "rollfix/rolling.hpp"

namespace identify_bounds_test {
namespace {

using namespace catalogs;
using namespace rollfix::catalog;

class Bounds : public testing::Test {
 protected:
  Bounds() : catalog_(of(mixed_shapes(27))), random_(test_generator()) {}

  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  Part any_part() { return catalog_.part(std::uniform_int_distribution<std::size_t>(0, catalog_.size() - 1)(random_)); }

  /// Lengths that a roll from s can have had, up to two laps either way.
  std::vector<double> lengths_from(const Part& part, double s, int count) {
    std::vector<double> lengths;
    for (int k = 0; k < count; ++k) {
      const double P = part.perimeter();
      lengths.push_back(part.closed() ? uniform(-2 * P, 2 * P) : uniform(-s, P - s));
    }
    return lengths;
  }

  /// Over 60 % of the boundary. `share`: of the perimeter, and radians.
  Problem noisy_roll_on(const Part& part, const Noise& share, int rows = 30) {
    std::normal_distribution<double> normal;
    const double P = part.perimeter();
    const double s = part.closed() ? uniform(0, P) : uniform(0, 0.4 * P);
    std::vector<double> lengths;
    for (int row = 1; row <= rows; ++row) lengths.push_back(0.6 * P * row / rows);
    Problem problem{part, roll_on(part, s, lengths)};
    problem.noise = Noise{share.contact * P, share.angle};
    for (Reading& reading : problem.measured.readings) {
      reading.length[0] += problem.noise->contact * normal(random_);
      reading.turn += problem.noise->angle * normal(random_);
    }
    return problem;
  }

  static std::vector<std::pair<std::size_t, double>> probabilities_of(const Identified& found) {
    std::vector<std::pair<std::size_t, double>> all;
    for (const PartFound& part : found.parts) all.emplace_back(part.weight.part, part.probability);
    return all;
  }

  void expect_same(const Problem& problem) {
    IdentifyOptions without;
    without.use_index = false;
    const Identified all = identify(catalog_, problem, without);
    const Identified quick = identify(catalog_, problem);
    EXPECT_EQ(all_of(catalog_, quick), all_of(catalog_, all));
    EXPECT_EQ(quick.rest, all.rest);
    looked_at_ += static_cast<double>(quick.searched) / static_cast<double>(all.searched);
  }

  cli::Folder folder_;
  Catalog catalog_;
  std::mt19937_64 random_;
  double looked_at_ = 0;  // share of the parts, of all queries together
};

TEST_F(Bounds, lose_nothing_of_one_finger) {
  const int count = test_count(150);
  for (int k = 0; k < count; ++k) {
    const Part part = any_part();
    const double s = uniform(0, part.perimeter());
    Problem problem{part, roll_on(part, s, lengths_from(part, s, 1 + k % 7))};
    if (k % 3 != 0) problem.tolerance = std::pow(10, uniform(-9, -1));
    problem.mirrored = k % 5 == 0;
    problem.either_way = k % 4 == 1;
    expect_same(problem);
  }
  EXPECT_LT(looked_at_, 0.6 * count);
}

TEST_F(Bounds, lose_nothing_of_digits_that_were_rounded) {
  for (int k = 0; k < test_count(40); ++k) {
    const Part part = any_part();
    const double s = uniform(0, part.perimeter());
    Problem problem{part, roll_on(part, s, lengths_from(part, s, 3))};
    problem.measured.roundings.assign(3, {uniform(0, 0.01), uniform(0, 0.01)});
    expect_same(problem);
  }
}

TEST_F(Bounds, lose_nothing_of_a_finger_that_starts_in_a_corner) {
  const Part square = catalog_.part(4);
  for (int k = 0; k < test_count(20); ++k) {
    Problem problem{square, roll_on(square, 0, {uniform(0.1, 5), uniform(0.1, 5)})};
    problem.measured.readings[0].turn -= 0.3;  // the tangent pivots before the roll
    problem.measured.readings[1].turn -= 0.3;
    expect_same(problem);
  }
}

TEST_F(Bounds, lose_nothing_of_two_fingers) {
  for (int k = 0; k < test_count(6); ++k) {
    const Part part = catalog_.part(13 + static_cast<std::size_t>(k) % 20);
    const double s = uniform(0, part.perimeter());
    const double t = uniform(0, part.perimeter());
    Problem problem{part, rolls_on(part, s, t, {{uniform(-1, 1), uniform(-1, 1)}, {uniform(-2, 2), uniform(-2, 2)}})};
    if (k % 2 == 0) problem.facing = part.turning().angle(s) - part.turning().angle(t);
    expect_same(problem);
  }
}

TEST_F(Bounds, keep_the_part_that_a_noisy_roll_was_on) {
  for (int k = 0; k < test_count(12); ++k) {
    const std::size_t number = std::uniform_int_distribution<std::size_t>(10, catalog_.size() - 1)(random_);
    const Problem problem = noisy_roll_on(catalog_.part(number), {1e-3, 0.01});
    EXPECT_THAT(names_of(catalog_, identify(catalog_, problem)), testing::Contains(catalog_.entry(number).name));
  }
}

TEST_F(Bounds, lose_nothing_that_is_probable_of_noisy_rolls) {
  for (int k = 0; k < test_count(8); ++k) {
    const Noise share{std::pow(10, uniform(-4, -2.5)), std::pow(10, uniform(-3, -1))};
    const int rows = k % 2 == 0 ? 30 : 150;  // more are joined before a glance at them
    Problem problem = noisy_roll_on(any_part(), share, rows);
    problem.either_way = k % 4 == 1;
    problem.mirrored = k % 4 == 2;
    IdentifyOptions without;
    without.use_index = false;
    EXPECT_EQ(probabilities_of(identify(catalog_, problem)), probabilities_of(identify(catalog_, problem, without)));
  }
}

TEST_F(Bounds, lose_nothing_where_even_the_best_part_fits_badly) {
  for (int k = 0; k < test_count(2); ++k) {
    Problem problem = noisy_roll_on(any_part(), {1e-3, 0.01});
    problem.noise->angle /= 3;
    problem.noise->contact /= 3;
    IdentifyOptions without;
    without.use_index = false;
    const Identified all = identify(catalog_, problem, without);
    const Identified quick = identify(catalog_, problem);
    EXPECT_EQ(quick.verdict, all.verdict);
    EXPECT_EQ(names_of(catalog_, quick), names_of(catalog_, all));
  }
}

/// Theta where the cells say that it is, everywhere on the part.
template <std::size_t N>
void expect_to_hold_theta(const Profile<N>& profile, const Part& part) {
  for (int k = 0; k < 10000; ++k) {
    const double s = (k + 0.5) / 10000 * part.perimeter();
    const auto cell = static_cast<std::size_t>(s / part.perimeter() * N);
    EXPECT_LE(profile.least[cell], part.turning().angle(s));
    EXPECT_GE(profile.most[cell], part.turning().angle(s));
  }
}

TEST(Profile, holds_theta_wherever_it_is_looked_at) {
  for (const std::string shape : {"cam", "gear", "polygon,n=5", "log-spiral", "spline,n=16,seed=3,wobble=0.2"}) {
    const Part part = load_part("gallery:" + shape);
    const Profile<kFineCells> fine = profile_of(part);
    const Profile<kCells> cells = coarser(fine);
    expect_to_hold_theta(fine, part);
    expect_to_hold_theta(cells, part);
    expect_to_hold_theta(coarser(cells), part);
    expect_to_hold_theta(*fine_profile_from(fine_bytes_of(fine, cells), cells), part);
  }
}

TEST(Profile, is_read_back_as_it_was_written) {
  const Profile<kCells> profile = coarser(profile_of(load_part("gallery:cam")));
  EXPECT_EQ(profile_from(bytes_of(profile))->least, profile.least);
  EXPECT_EQ(profile_from(bytes_of(profile))->most, profile.most);
}

TEST(Profile, of_fine_cells_loses_a_255th_of_a_larger_one_when_it_is_written) {
  const Profile<kFineCells> fine = profile_of(load_part("gallery:gear"));
  const Profile<kCells> cells = coarser(fine);
  const Profile<kFineCells> read = *fine_profile_from(fine_bytes_of(fine, cells), cells);
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const double step = 1.01 * (cells.most[k / 4] - cells.least[k / 4]) / 255;
    EXPECT_NEAR(read.least[k], fine.least[k], step);
    EXPECT_NEAR(read.most[k], fine.most[k], step);
    EXPECT_LE(read.least[k], fine.least[k]);
    EXPECT_GE(read.most[k], fine.most[k]);
  }
}

TEST(Profile, that_was_damaged_is_not_taken) {
  const Profile<kFineCells> fine = profile_of(load_part("gallery:cam"));
  const Profile<kCells> cells = coarser(fine);
  for (const std::size_t place : {0U, 100U, 511U, 519U}) {
    std::string bytes = bytes_of(cells);
    bytes[place] = static_cast<char>(bytes[place] ^ 1);
    EXPECT_FALSE(profile_from(bytes));
    bytes = fine_bytes_of(fine, cells);
    bytes[place] = static_cast<char>(bytes[place] ^ 1);
    EXPECT_FALSE(fine_profile_from(bytes, cells));
  }
  EXPECT_FALSE(profile_from("too short"));
  EXPECT_FALSE(fine_profile_from("too short", cells));
}

// Its likelihood is flat until a row's end reaches the corner, and then falls by thousands.
TEST(Glance, loses_no_part_whose_roll_starts_just_before_a_corner) {
  const cli::Folder folder;
  const Catalog catalog = of({"naca,digits=5431", "naca,digits=7331"});
  Problem problem{catalog.part(1), std::vector<Reading>{}};
  const double P = problem.part.perimeter();
  problem.fingers = {DiskFinger{0.025 * P}};
  problem.noise = Noise{1e-4 * P, 0.005};
  RollPlan plan;
  plan.start = 0.99526 * P;
  plan.distance = 0.3 * P;
  plan.rows = 200;
  problem.measured.log = noisy_roll(problem.part, problem.fingers[0], plan, *problem.noise, 18329657575484428161U).log;
  EXPECT_EQ(names_of(catalog, identify(catalog, problem)).front(), "naca,digits=7331");
}

}  // namespace
}  // namespace identify_bounds_test
