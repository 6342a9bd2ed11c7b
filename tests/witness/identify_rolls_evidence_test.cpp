// How probable each part is by rolls and touches, against a plain sum over headings and over all first contacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catalogs.hpp"
#include "outline/turn.hpp"
#include "random.hpp"
#include "rollfix/identify.hpp"
#include "touch/roll_cases.hpp"

namespace identify_rolls_evidence_test {

using namespace roll_cases;
using catalogs::Catalog;

constexpr int kPlaces = 800;
constexpr int kHeadings = 480;
constexpr double kNothing = 22;  // exp(-this) of the largest

/// What one row says if a contact is at some place: the tangent's angle in the part less that in the world, and the
/// centre in both.
struct Row {
  double turn = 0;
  Vec2 centre = Vec2::Zero();
  Vec2 at = Vec2::Zero();
};

/// One contact, or a roll, with its first contact on a grid of places.
struct Contact {
  std::vector<std::vector<Row>> places;
};

Row row_at(const Part& part, double s, double radius, double tangent, const Vec2& at) {
  return {tangent - part.tangent(s), part.point(s) + radius * outward(part.tangent(s)), at};
}

Contact of_roll(const Part& part, const Log& log, double radius) {
  const rollfix::FingerRows& rows = log.fingers.front();
  Contact contact;
  for (int k = 0; k < kPlaces; ++k) {
    const double s = part.perimeter() * k / kPlaces;
    std::vector<Row> all;
    for (std::size_t j = 0; j < rows.u.size(); ++j) {
      const double gone = -radius * (rows.u[j] - rows.u.front());
      all.push_back(
          row_at(part, s + gone, radius, rows.u[j] + rows.psi[j] - 0.5 * std::numbers::pi, {rows.x[j], rows.y[j]}));
    }
    contact.places.push_back(all);
  }
  return contact;
}

Contact of_touch(const Part& part, const MeasuredTouch& touch, double radius) {
  Contact contact;
  for (int k = 0; k < kPlaces; ++k) {
    const double s = part.perimeter() * k / kPlaces;
    contact.places.push_back({row_at(part, s, radius, *touch.normal + 0.5 * std::numbers::pi, touch.at)});
  }
  return contact;
}

/// Sums of what rows say with the part at some heading: their number, of how far it has to be moved, and of squares.
struct Sums {
  double count = 0;
  Vec2 moved = Vec2::Zero();
  double squares = 0;  // of moved, and of turns, in their standard deviations
};

Sums sums_of(const std::vector<Row>& rows, double heading, double place_sd, double angle_sd) {
  Sums sums;
  for (const Row& row : rows) {
    const Vec2 moved = row.at - Pose{0, 0, heading}.turned(row.centre);
    const double turn = rollfix::nearest_angle(row.turn - heading);
    sums.count += 1;
    sums.moved += moved;
    sums.squares += moved.squaredNorm() / (place_sd * place_sd) + turn * turn / (angle_sd * angle_sd);
  }
  return sums;
}

/// Whatever the place of the part is.
double square_of(const Sums& sums, double place_sd) {
  return sums.squares - sums.moved.squaredNorm() / (sums.count * place_sd * place_sd);
}

/// The likelihood of two contacts, averaged over the first contacts of both and summed over all poses, as a logarithm.
double log_evidence(const Contact& one, const Contact& other, double place_sd, double angle_sd) {
  std::vector<double> logs;
  const auto likely = [&](const Contact& contact, double heading) {
    std::vector<Sums> kept;
    for (const std::vector<Row>& rows : contact.places) {
      const Sums sums = sums_of(rows, heading, place_sd, angle_sd);
      if (square_of(sums, place_sd) < 6 * kNothing) kept.push_back(sums);
    }
    return kept;
  };
  for (int h = 0; h < kHeadings; ++h) {
    const double heading = kFullTurn * h / kHeadings;
    const std::vector<Sums> of_other = likely(other, heading);
    for (const Sums& a : likely(one, heading)) {
      for (const Sums& b : of_other) {
        logs.push_back(-0.5 * square_of({a.count + b.count, a.moved + b.moved, a.squares + b.squares}, place_sd));
      }
    }
  }
  if (logs.empty()) return -1e300;
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double log : logs) sum += std::exp(log - most);
  return most + std::log(sum);
}

/// Each part's share, as the sum says.
std::vector<double> shares(const Catalog& catalog, const TouchProblem& problem) {
  const double radius = problem.finger->disk()->radius;
  std::vector<double> logs;
  for (std::size_t k = 0; k < catalog.size(); ++k) {
    const Part part = catalog.part(k);
    std::vector<Contact> contacts;
    for (const Log& log : problem.rolls) contacts.push_back(of_roll(part, log, radius));
    for (const MeasuredTouch& touch : problem.touches) contacts.push_back(of_touch(part, touch, radius));
    logs.push_back(log_evidence(contacts[0], contacts[1], problem.noise->position, problem.noise->angle));
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (double& log : logs) sum += log = std::exp(log - most);
  for (double& log : logs) log /= sum;
  return logs;
}

/// How many parts are neither likely nor unlikely: which are a test.
int expect_shares(const Catalog& catalog, const TouchProblem& problem) {
  const std::vector<double> expected = shares(catalog, problem);
  double listed = 0;
  for (const rollfix::PartTouched& part : identify(catalog, problem).parts) {
    EXPECT_NEAR(part.probability, expected[part.part], 0.04) << catalog.entry(part.part).name;
    listed += expected[part.part];
  }
  EXPECT_NEAR(listed, 1, 0.02);
  return static_cast<int>(
      std::count_if(expected.begin(), expected.end(), [](double share) { return share > 0.1 && share < 0.9; }));
}

/// Two contacts with noise so wide that several parts are likely; lengths are all but exact.
TouchProblem wide_case(const Part& part, std::size_t rolls, std::mt19937_64& generator) {
  Rolling rolling;
  rolling.count = rolls;
  rolling.touches = 2 - rolls;
  rolling.length = 0.05;
  rolling.rows = 6;
  rolling.radius = 0.02;
  rolling.contact_sd = 1e-5;
  rolling.angle_sd = 0.08;
  rolling.place_sd = 0.02;
  return random_rolls(part, rolling, generator).problem;
}

TEST(PartByRolls, IsAsProbableAsASumOverAllPosesSays) {
  const cli::Folder folder;
  const Catalog catalog = catalogs::of({"spline,n=9,wobble=0.1,seed=1", "spline,n=9,wobble=0.1,seed=2",
                                        "ellipse,a=1.1,b=0.9", "circle,r=1.05", "ellipse,a=2.2,b=1.8"});
  int in_doubt = 0;
  for (int k = 0; k < test_count(4); ++k) {
    SCOPED_TRACE(k);
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k) + 500);
    const Part part = catalog.part(static_cast<std::size_t>(k) % 3);
    in_doubt += expect_shares(catalog, wide_case(part, k % 2 == 0 ? 2 : 1, generator));
  }
  EXPECT_GE(in_doubt, 2);
}

}  // namespace identify_rolls_evidence_test
