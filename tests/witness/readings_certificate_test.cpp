// Certificates of several readings of one finger: of each start some reading says that it does not fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "certificates.hpp"
#include "random.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace readings_certificate_test {
namespace {

using certificates::certificate;
using certificates::checked;
using certificates::count_of;
using certificates::expect_proved;
using certificates::is_proved;
using certificates::Json;
using certificates::most_unproved;
using certificates::uniform;
using rollfix::Part;
using rollfix::Reading;
using shapes::kPi;

/// What a finger reads that starts there and stops after each of these shares of the perimeter.
std::vector<Reading> readings(const Part& part, double start_share, const std::vector<double>& length_shares) {
  const double period = part.perimeter();
  std::vector<Reading> result;
  for (const double share : length_shares) {
    result.push_back(shapes::reading_from(part, start_share * period, share * period));
  }
  return result;
}

class ReadingsCertificateOfGallery : public testing::TestWithParam<std::string> {};

TEST_P(ReadingsCertificateOfGallery, is_proved) {
  const Part part(rollfix::gallery(GetParam()));
  expect_proved(part, readings(part, 0.21, {0.13, 0.29}));
  expect_proved(part, readings(part, 0.52, {0.05, 0.11, 0.17, -0.08}));
  if (part.closed()) expect_proved(part, readings(part, 0.77, {-0.4, 0.7, 1.3}));
  expect_proved(part, {{0.1 * part.perimeter(), 50.0}, {0.2 * part.perimeter(), 0.1}});  // nothing fits
}

INSTANTIATE_TEST_SUITE_P(Shapes, ReadingsCertificateOfGallery, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& shape : rollfix::gallery_shapes()) names.push_back(shape.name);
                           return names;
                         }()),
                         shapes::as_identifier);

TEST(ReadingsCertificate, of_random_splines_is_proved) {
  std::mt19937_64 generator = test_generator();
  const int count = test_count(6);
  int unproved = 0;
  for (int k = 0; k < count; ++k) {
    const Part part = certificates::random_spline(generator);
    std::vector<double> lengths(std::uniform_int_distribution<std::size_t>(2, 5)(generator));
    for (double& length : lengths) length = uniform(generator, -1.5, 1.5);
    const std::vector<Reading> drawn = readings(part, uniform(generator, 0, 1), lengths);
    unproved += is_proved(part, drawn, std::pow(10, uniform(generator, -11, -2))) ? 0 : 1;
  }
  EXPECT_LE(unproved, most_unproved(count));
}

/// Off by up to a third of the tolerance each, so that nothing fits exactly.
TEST(ReadingsCertificate, of_turns_that_are_off_by_less_than_the_tolerance_is_proved) {
  std::mt19937_64 generator = test_generator();
  const int count = test_count(6);
  int unproved = 0;
  for (int k = 0; k < count; ++k) {
    const Part part = certificates::random_spline(generator);
    std::vector<Reading> off = readings(part, uniform(generator, 0, 1), {0.11, 0.23, 0.34});
    for (Reading& reading : off) reading.turn += uniform(generator, -1e-3, 1e-3);
    unproved += is_proved(part, off, 3e-3) ? 0 : 1;
  }
  EXPECT_LE(unproved, most_unproved(count));
}

TEST(ReadingsCertificate, of_a_drawn_plate_is_proved_with_its_corners) {
  const Part part = certificates::drawn_plate();
  expect_proved(part, readings(part, 0.27, {0.04, 0.17, -0.23}));
  const double turn = part.corners().front().turn;
  expect_proved(part, {{0.3, 0.6 * turn}, {0.4, 0.6 * turn + 0.01}}, 1e-3);
}

/// f is beyond the tolerance before it comes to the corner, but not by half of it.
TEST(ReadingsCertificate, of_a_placement_close_behind_a_corner_is_proved) {
  const Part part = certificates::drawn_plate();
  for (const rollfix::Corner& corner : part.corners()) {
    const double start = (corner.s + 1e-3) / part.perimeter();
    const Reading reading = readings(part, start, {0.11}).front();
    const double at_corner = part.turning().angle(corner.s + reading.length[0]) -
                             part.turning().angle(corner.s, rollfix::Side::after) - reading.turn;
    if (std::abs(at_corner) > 1e-6) expect_proved(part, {reading}, std::abs(at_corner) / 1.2);
  }
}

TEST(ReadingsCertificate, of_readings_that_fit_at_different_places_proves_that_none_fits_both) {
  const Part part(rollfix::gallery("spline,n=12,seed=4"));
  const std::vector<Reading> apart = {readings(part, 0.2, {0.15})[0], readings(part, 0.6, {0.3})[0]};
  EXPECT_EQ(checked(certificate(part, {apart[0]})).placements, locate(part, apart[0]).placements.size());
  expect_proved(part, apart);
  EXPECT_EQ(checked(certificate(part, apart)).placements, 0U);
}

TEST(ReadingsCertificate, of_a_polygon_proves_pivots_that_both_readings_share) {
  const Part part(rollfix::gallery("polygon,n=5"));
  const Json found = certificate(part, {{0.3, 0.5}, {0.4, 0.5}});
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(checked(found).open, 0U);
  EXPECT_EQ(checked(found).placements, locate(part, std::vector<Reading>{{0.3, 0.5}, {0.4, 0.5}}).placements.size());
}

TEST(ReadingsCertificate, of_a_stretch_that_readings_share_proves_what_they_share) {
  const Part part(rollfix::gallery("stadium"));
  const Json found = certificate(part, {{0.2, 0.0}, {0.5, 0.0}});
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(checked(found).placements, 2U);
  EXPECT_EQ(count_of(found, "stretch"), 2U);
}

TEST(ReadingsCertificate, of_a_symmetric_part_proves_that_all_of_it_fits) {
  const Part part(rollfix::gallery("ellipse"));
  const double half = 0.5 * part.perimeter();
  const Json found = certificate(part, {{half, kPi}, {2 * half, 2 * kPi}, {-half, -kPi}});
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(count_of(found, "stretch"), found["rows"].size());
}

TEST(ReadingsCertificate, of_no_roll_at_all_beside_another_is_proved) {
  const Part part(rollfix::gallery("cam"));
  std::vector<Reading> both = readings(part, 0.3, {0.2});
  both.push_back({0.0, 0.0});
  expect_proved(part, both);
}

TEST(ReadingsCertificate, of_an_open_outline_covers_every_start_that_leaves_room_for_all) {
  const Part part(rollfix::gallery("exponential"));
  expect_proved(part, readings(part, 0.3, {0.2, 0.6, -0.25}));
}

TEST(ReadingsCertificate, of_64_rows_is_proved) {
  const Part part(rollfix::gallery("limacon"));
  std::vector<double> lengths;
  for (int k = 1; k <= 64; ++k) lengths.push_back(0.9 * k / 64);
  expect_proved(part, readings(part, 0.4, lengths));
}

// ---- what is not ----

TEST(ReadingsCertificate, without_its_placement_is_refused) {
  const Part part(rollfix::gallery("cam"));
  Json found = certificate(part, readings(part, 0.3, {0.1, 0.25}));
  found["placements"].erase(0);
  EXPECT_NE(checked(found).refusal, "");
}

TEST(ReadingsCertificate, that_takes_a_reading_to_exclude_what_fits_it_is_refused) {
  const Part part(rollfix::gallery("cam"));
  const std::vector<Reading> both = readings(part, 0.3, {0.1, 0.25});
  Json found = certificate(part, both);
  for (Json& row : found["rows"]) {
    if (row["then"] == "apart") row["by"] = {0};
  }
  ASSERT_GT(locate(part, both[0]).placements.size(), locate(part, both).placements.size());
  EXPECT_NE(checked(found).refusal, "");
}

TEST(ReadingsCertificate, that_names_a_reading_that_is_not_there_is_refused) {
  const Part part(rollfix::gallery("cam"));
  Json found = certificate(part, readings(part, 0.3, {0.1, 0.25}));
  found["rows"][0]["by"] = {2};
  EXPECT_NE(checked(found).refusal, "");
}

TEST(ReadingsCertificate, without_one_of_its_rows_is_refused) {
  const Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, readings(part, 0.3, {0.1, 0.25}));
  for (std::size_t k = 0; k < found["rows"].size(); ++k) {
    Json changed = found;
    changed["rows"].erase(k);
    if (checked(changed).refusal.empty()) ADD_FAILURE() << k;
  }
}

TEST(ReadingsCertificate, is_of_one_finger) {
  const Part part(rollfix::gallery("cam"));
  EXPECT_THROW(certify(part, {Reading(0.5, 0.1), Reading(1.0, 1.0, 0.2)}), rollfix::InputError);
  EXPECT_THROW(certify(part, {}), rollfix::InputError);
}

TEST(ReadingsCertificate, with_one_number_changed_is_refused) {
  std::mt19937_64 generator = test_generator();
  std::vector<Json> all;
  for (const char* shape : {"cam", "naca", "polygon,n=5", "spline"}) {
    const Part part(rollfix::gallery(shape));
    all.push_back(certificate(part, readings(part, 0.31, {0.12, 0.27})));
  }
  const int count = test_count(8);
  for (int k = 0; k < count; ++k) {
    Json changed = all[static_cast<std::size_t>(k) % all.size()];
    const std::string what = certificates::change_one(changed, generator);
    EXPECT_TRUE(certificates::is_refused(changed)) << what;
  }
}

}  // namespace
}  // namespace readings_certificate_test
