// Certificates of two fingers: what the search answers is proved again by a program that knows nothing of it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "certificates.hpp"
#include "pair_cases.hpp"
#include "random.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace pair_certificate_test {
namespace {

using certificates::change_one;
using certificates::checked;
using certificates::drawn_plate;
using certificates::is_refused;
using certificates::Json;
using certificates::most_unproved;
using certificates::random_spline;
using certificates::uniform;
using pair_cases::reading_from;
using rollfix_verify::Verdict;
using shapes::kPi;

rollfix::LocateOptions options_of(double tolerance, std::optional<double> facing = {}) {
  rollfix::LocateOptions options;
  options.tolerance = tolerance;
  options.facing = facing;
  return options;
}

Json certificate(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings, double tolerance = 1e-9,
                 std::optional<double> facing = {}) {
  return Json::parse(format_certificate(certify_pair(part, readings, options_of(tolerance, facing))));
}

/// Two readings of rolls that begin at these shares of the perimeter, as long as fits an open outline.
std::vector<rollfix::Reading> two_readings(const rollfix::Part& part, double s, double t) {
  const double period = part.perimeter();
  const auto reading = [&](double a, double b) {
    return reading_from(part, {s * period, t * period}, a * period, b * period);
  };
  return {reading(0.13, -0.21), reading(0.31, 0.17)};
}

std::size_t count_of(const Json& certificate, const char* field, const std::string& value) {
  std::size_t count = 0;
  for (const Json& placement : certificate["placements"]) count += placement[field] == value ? 1 : 0;
  return count;
}

/// Each of its cells is excluded or some placement's, and each placement has a proof.
bool claims_all(const Json& certificate) {
  return certificate["cells"].get<std::string>().find('?') == std::string::npos &&
         count_of(certificate, "proof", "none") == 0;
}

/// Nothing in it is refused, and all that the search found stands in it: is all of it proved?
bool is_proved(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings, double tolerance = 1e-9,
               std::optional<double> facing = {}) {
  SCOPED_TRACE(fmt::format("{}, lengths {} and {}, turn {}, tolerance {}", part.name(), readings[0].length[0],
                           readings[0].length[1], readings[0].turn, tolerance));
  const Json found = certificate(part, readings, tolerance, facing);
  const Verdict verdict = checked(found);
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_EQ(verdict.placements, locate(part, readings, options_of(tolerance, facing)).placements.size());
  EXPECT_LT(found.dump().size(), 400000U);
  EXPECT_LT(verdict.share, 0.2);
  return claims_all(found);
}

void expect_proved(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings, double tolerance = 1e-9,
                   std::optional<double> facing = {}) {
  EXPECT_TRUE(is_proved(part, readings, tolerance, facing)) << part.name() << ", tolerance " << tolerance;
}

// ---- what is proved ----

class PairCertificateOfGallery : public testing::TestWithParam<std::string> {};

TEST_P(PairCertificateOfGallery, is_proved) {
  const rollfix::Part part(rollfix::gallery(GetParam()));
  expect_proved(part, two_readings(part, 0.37, 0.59));
}

INSTANTIATE_TEST_SUITE_P(Shapes, PairCertificateOfGallery, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& shape : rollfix::gallery_shapes()) names.push_back(shape.name);
                           for (std::string& name : names) {
                             if (name == "gear") name = "gear,teeth=5";
                           }
                           return names;
                         }()),
                         shapes::as_identifier);

TEST(PairCertificate, of_random_splines_is_proved) {
  std::mt19937_64 generator = test_generator();
  const int count = test_count(4);
  int unproved = 0;
  for (int k = 0; k < count; ++k) {
    const rollfix::Part part = random_spline(generator);
    const pair_cases::Case drawn = pair_cases::random_case(part, 2, generator);
    unproved += is_proved(part, drawn.readings, std::pow(10, uniform(generator, -11, -3))) ? 0 : 1;
  }
  EXPECT_LE(unproved, most_unproved(count));
}

TEST(PairCertificate, of_a_drawn_plate_is_proved_with_its_corners) {
  const rollfix::Part part = drawn_plate();
  std::mt19937_64 generator = test_generator();
  const pair_cases::Case drawn = pair_cases::random_case(part, 2, generator);
  expect_proved(part, drawn.readings);
}

TEST(PairCertificate, of_a_curve_that_starts_at_rest_claims_no_more_than_is_so) {
  rollfix::Outline outline;
  outline.name = "rest";
  outline.curves = {rollfix::BezierFromRest({{0, 0}, {0, 0}, {1.5, -0.8}, {3, 0}}),
                    rollfix::Bezier({{3, 0}, {4, 1}, {3, 3}, {1, 2}}), rollfix::Bezier({{1, 2}, {0, 1.5}, {0, 0}})};
  const rollfix::Part part(outline);
  const std::vector<rollfix::Reading> readings = {two_readings(part, 0.37, 0.59)[0]};
  const double facing = part.turning().angle(0.37 * part.perimeter()) - part.turning().angle(0.59 * part.perimeter());
  const Json found = certificate(part, readings, 1e-7, facing);
  const Verdict verdict = checked(found);
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_LT(verdict.share, 1e-3);
  EXPECT_EQ(verdict.placements, locate(part, readings, options_of(1e-7, facing)).placements.size());
  EXPECT_GE(count_of(found, "proof", "one"), 1U);
}

TEST(PairCertificate, of_crossings_says_that_each_is_the_only_one) {
  const rollfix::Part part(rollfix::gallery("ellipse"));
  const Json found = certificate(part, two_readings(part, 0.37, 0.59));
  EXPECT_EQ(count_of(found, "proof", "one"), found["placements"].size());
  EXPECT_EQ(count_of(found, "kind", "crossing"), found["placements"].size());
}

TEST(PairCertificate, says_of_how_many_pairs_it_proves_no_more_than_whose_they_are) {
  const rollfix::Part cam(rollfix::gallery("cam"));
  Json found = certificate(cam, two_readings(cam, 0.37, 0.59));
  EXPECT_EQ(checked(found).open, 0U);
  const Json first = found["placements"][0];
  found["placements"] = Json::array({first});
  found["placements"][0].erase("box");
  found["placements"][0]["proof"] = "fits";
  found["cells"] = "[0]";
  EXPECT_NEAR(checked(found).share, 1, 1e-9);
  EXPECT_FALSE(checked(found).is_complete());
  const rollfix::Part ellipse(rollfix::gallery("ellipse"));
  EXPECT_LT(checked(certificate(ellipse, {{0.5, 0.5, 0.0}, {1.5, 1.5, 0.0}})).share, 0.1);
  const rollfix::Part circle(rollfix::gallery("circle"));
  EXPECT_EQ(checked(certificate(circle, {{0.5, 0.2, 0.3}, {1.0, 0.4, 0.6}})).open, 0U);
}

TEST(PairCertificate, of_pivots_says_that_each_is_the_only_one) {
  const rollfix::Part part(rollfix::gallery("naca"));
  const Json found = certificate(part, two_readings(part, 0.21, 0.52));
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_GT(count_of(found, "kind", "corner"), 0U);
  EXPECT_EQ(count_of(found, "proof", "one"), found["placements"].size());
}

TEST(PairCertificate, that_nothing_fits_is_proved) {
  const rollfix::Part part(rollfix::gallery("cam"));
  expect_proved(part, {{0.7, 0.4, 3.0}, {1.5, 0.9, 0.1}});
  EXPECT_EQ(certificate(part, {{0.7, 0.4, 3.0}, {1.5, 0.9, 0.1}})["placements"].size(), 0U);
}

TEST(PairCertificate, with_the_facing_is_proved_by_one_reading_and_by_two) {
  const rollfix::Part part(rollfix::gallery("ellipse"));
  std::vector<rollfix::Reading> readings = two_readings(part, 0.37, 0.59);
  const double period = part.perimeter();
  const double facing = part.turning().angle(0.37 * period) - part.turning().angle(0.59 * period) + 2 * kPi;
  expect_proved(part, readings, 1e-9, facing);
  readings.pop_back();
  expect_proved(part, readings, 1e-9, facing);
}

TEST(PairCertificate, of_three_readings_is_proved) {
  const rollfix::Part part(rollfix::gallery("spline,n=9,seed=7,wobble=0.2"));
  expect_proved(part, {{0.58, 0.94, -0.725248}, {1.01, 1.92, -1.99849}, {1.25, 2.37, -1.966238}}, 6.36e-5);
}

/// The paper's Figure 8, and a reading that makes two of its pairs one.
TEST(PairCertificate, of_a_touching_pair_is_proved) {
  const rollfix::Part part(rollfix::gallery("spline,n=9,seed=7,wobble=0.2"));
  expect_proved(part, {{0.58, 0.94, -0.725248}, {1.01, 1.92, -1.99849}});
  const std::vector<rollfix::Reading> readings = {{0.58, 0.94, -0.725248}, {1.01, 1.92, -2.0357043232}};
  expect_proved(part, readings);
  EXPECT_EQ(count_of(certificate(part, readings), "kind", "touching"), 1U);
}

TEST(PairCertificate, of_equal_rolls_proves_all_but_the_lines_that_fit) {
  const rollfix::Part part(rollfix::gallery("ellipse"));
  const std::vector<rollfix::Reading> readings = {{0.5, 0.5, 0.0}, {1.5, 1.5, 0.0}};
  expect_proved(part, readings);
  EXPECT_GT(count_of(certificate(part, readings), "kind", "stretch"), 0U);
}

TEST(PairCertificate, of_no_roll_of_one_finger_is_proved) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const double t = 0.59 * part.perimeter();
  expect_proved(part, {reading_from(part, {1.0, t}, 0, 0.9), reading_from(part, {1.0, t}, 0, -1.7)});
}

TEST(PairCertificate, of_a_circle_says_that_all_of_it_fits) {
  const rollfix::Part part(rollfix::gallery("circle"));
  const Json found = certificate(part, {{0.5, 0.2, 0.3}, {1.0, 0.4, 0.6}});
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(found["cells"], "[0]");
}

TEST(PairCertificate, of_an_open_outline_covers_every_pair_that_leaves_room) {
  const rollfix::Part part(rollfix::gallery("exponential"));
  const Json found = certificate(part, two_readings(part, 0.3, 0.5));
  EXPECT_EQ(checked(found).refusal, "");
  Json shorter = found;
  shorter["to"] = found["placements"][0]["box"][1];
  EXPECT_NE(checked(shorter).refusal, "");
}

TEST(PairCertificate, of_a_wide_tolerance_is_proved) {
  for (const char* shape : {"cam", "polygon,n=5"}) {
    const rollfix::Part part(rollfix::gallery(shape));
    expect_proved(part, two_readings(part, 0.37, 0.59), 3e-3);
  }
}

// ---- what is not ----

TEST(PairCertificate, without_one_of_its_placements_is_refused) {
  for (const char* shape : {"cam", "stadium"}) {
    const rollfix::Part part(rollfix::gallery(shape));
    const Json found = certificate(part, two_readings(part, 0.37, 0.59));
    for (std::size_t k = 0; k < found["placements"].size(); ++k) {
      Json changed = found;
      changed["placements"].erase(k);
      EXPECT_NE(checked(changed).refusal, "") << shape << " " << k;
    }
  }
}

TEST(PairCertificate, with_a_placement_twice_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  Json found = certificate(part, two_readings(part, 0.37, 0.59));
  found["placements"].push_back(found["placements"][0]);
  EXPECT_NE(checked(found).refusal, "");
}

TEST(PairCertificate, of_one_continuum_said_to_be_two_is_refused) {
  const rollfix::Part part(rollfix::gallery("circle"));
  Json found = certificate(part, {{0.5, 0.2, 0.3}, {1.0, 0.4, 0.6}});
  ASSERT_TRUE(checked(found).is_complete());
  found["placements"].push_back(found["placements"][0]);
  found["cells"] = "s[0][1]";
  EXPECT_FALSE(checked(found).is_complete());
}

/// Each finger on either of the two flats.
TEST(PairCertificate, of_four_continua_said_to_be_one_says_that_it_is_not_proved) {
  const rollfix::Part part(rollfix::gallery("stadium"));
  Json found = certificate(part, {{0.2, 0.1, 0.0}, {0.3, 0.05, 0.0}});
  ASSERT_EQ(found["placements"].size(), 4U);
  ASSERT_TRUE(checked(found).is_complete());
  found["placements"] = Json::array({found["placements"][0]});
  found["cells"] = "[0]";
  EXPECT_EQ(checked(found).open, 0U);
  EXPECT_EQ(checked(found).unproved, 1U);
}

TEST(PairCertificate, of_a_kind_that_is_not_or_a_facing_without_digits_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, two_readings(part, 0.37, 0.59));
  Json kind = found;
  kind["placements"][0]["kind"] = "banana";
  EXPECT_NE(checked(kind).refusal, "");
  Json facing = certificate(part, two_readings(part, 0.37, 0.59), 1e-9, 0.3);
  facing["facing"] = 1e20;
  EXPECT_NE(checked(facing).refusal, "");
}

TEST(PairCertificate, that_leaves_a_root_s_cells_without_their_box_says_that_they_exclude_nothing) {
  const rollfix::Part part(rollfix::gallery("cam"));
  Json found = certificate(part, two_readings(part, 0.37, 0.59));
  found["placements"][0].erase("box");
  found["placements"][0]["proof"] = "fits";
  EXPECT_FALSE(checked(found).is_complete());
}

TEST(PairCertificate, that_calls_a_placement_s_cell_apart_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, two_readings(part, 0.37, 0.59));
  for (std::size_t k = 0; k < found["placements"].size(); ++k) {
    const std::string name = fmt::format("[{}]", k);
    std::string cells = found["cells"];
    for (std::size_t at = cells.find(name); at != std::string::npos; at = cells.find(name)) {
      cells.replace(at, name.size(), "Y");
    }
    Json changed = found;
    changed["cells"] = cells;
    EXPECT_NE(checked(changed).refusal, "") << k;
  }
}

TEST(PairCertificate, with_a_bound_that_is_too_good_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, two_readings(part, 0.37, 0.59));
  std::string cells = found["cells"];
  int tried = 0;
  for (std::size_t at = 0; at < cells.size() && tried < 5; ++at) {
    if (cells[at] < '5' || cells[at] > '9' || cells.find_first_of("[]st", at - 1) != at - 1) continue;
    Json changed = found;
    std::string other = cells;
    other[at] = '0';
    changed["cells"] = other;
    EXPECT_NE(checked(changed).refusal, "") << at;
    ++tried;
  }
  EXPECT_EQ(tried, 5);
}

TEST(PairCertificate, without_a_cell_or_with_one_more_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, two_readings(part, 0.37, 0.59));
  const std::string cells = found["cells"];
  for (const std::string& other : {cells.substr(0, cells.size() - 1), cells + "9", std::string(), std::string("s"),
                                   std::string("[0"), std::string("[-1]"), std::string("!")}) {
    Json changed = found;
    changed["cells"] = other;
    EXPECT_NE(checked(changed).refusal, "") << other.substr(0, 20);
  }
}

TEST(PairCertificate, with_a_larger_box_around_two_placements_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, two_readings(part, 0.37, 0.59));
  for (std::size_t k = 1; k < found["placements"].size(); ++k) {
    Json changed = found;
    changed["placements"][0]["box"][1] = found["placements"][k]["box"][1];
    EXPECT_NE(checked(changed).refusal, "") << k;
  }
}

TEST(PairCertificate, with_a_cell_that_claims_nothing_says_so) {
  const rollfix::Part part(rollfix::gallery("cam"));
  Json found = certificate(part, two_readings(part, 0.37, 0.59));
  found["cells"] = "?";
  for (Json& placement : found["placements"]) placement["proof"] = "none";
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(checked(found).open, 1U);
  EXPECT_EQ(checked(found).unproved, found["placements"].size());
}

TEST(PairCertificate, of_a_search_that_ran_out_of_budget_claims_no_more_than_is_so) {
  const rollfix::Part part(rollfix::gallery("cam"));
  rollfix::LocateOptions options = options_of(1e-9);
  options.budget = 0;
  const std::vector<rollfix::Reading> readings = two_readings(part, 0.37, 0.59);
  const rollfix::PairCertificate found = certify_pair(part, readings, options);
  const Verdict verdict = checked(Json::parse(format_certificate(found)));
  EXPECT_EQ(verdict.refusal, "");
  if (!found.is_complete()) {
    EXPECT_FALSE(verdict.is_complete());
  }
  EXPECT_EQ(found.is_complete(), locate(part, readings, options).status == rollfix::Status::complete);
}

TEST(PairCertificate, is_of_two_fingers) {
  const rollfix::Part part(rollfix::gallery("cam"));
  EXPECT_THROW(certify_pair(part, {{1.0, 1.0}}), rollfix::InputError);
  EXPECT_THROW(certify_pair(part, {}), rollfix::InputError);
  EXPECT_THROW(certify_pair(part, {{1.0, 1.0, 0.2}}), rollfix::InputError);  // without a facing
}

// ---- one number changed ----

TEST(PairCertificate, with_one_number_changed_is_refused) {
  std::mt19937_64 generator = test_generator();
  const rollfix::Part plate = drawn_plate();
  const rollfix::Part ellipse(rollfix::gallery("ellipse"));
  const rollfix::Part stadium(rollfix::gallery("stadium"));
  const rollfix::Part polygon(rollfix::gallery("polygon,n=5"));
  const rollfix::Part spiral(rollfix::gallery("exponential"));
  const rollfix::Part cam(rollfix::gallery("cam"));
  const std::vector<rollfix::Reading> readings = two_readings(ellipse, 0.37, 0.59);
  const double facing = ellipse.turning().angle(3.0) - ellipse.turning().angle(5.0);
  const std::vector<Json> all = {certificate(plate, two_readings(plate, 0.37, 0.59)),
                                 certificate(ellipse, readings),
                                 certificate(ellipse, {reading_from(ellipse, {3.0, 5.0}, 0.9, 1.7)}, 1e-9, facing),
                                 certificate(stadium, two_readings(stadium, 0.37, 0.59)),
                                 certificate(polygon, two_readings(polygon, 0.37, 0.59)),
                                 certificate(spiral, two_readings(spiral, 0.3, 0.5)),
                                 certificate(cam, {{0.7, 0.4, 3.0}, {1.5, 0.9, 0.1}})};
  const int count = test_count(20);
  for (int k = 0; k < count; ++k) {
    Json changed = all[static_cast<std::size_t>(k) % all.size()];
    const std::string what = change_one(changed, generator);
    EXPECT_TRUE(is_refused(changed)) << what;
  }
}

}  // namespace
}  // namespace pair_certificate_test
