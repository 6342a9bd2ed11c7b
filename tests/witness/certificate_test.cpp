// Certificates: what the search answers is proved again by a program that knows nothing of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "certificates.hpp"
#include "random.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace certificate_test {
namespace {

using certificates::change_one;
using certificates::checked;
using certificates::count_of;
using certificates::drawn_plate;
using certificates::is_proved;
using certificates::is_refused;
using certificates::Json;
using certificates::most_unproved;
using certificates::random_spline;
using certificates::uniform;
using rollfix_verify::Verdict;
using shapes::kPi;

Json certificate(const rollfix::Part& part, const rollfix::Reading& reading, double tolerance = 1e-9) {
  return certificates::certificate(part, {reading}, tolerance);
}

/// It is proved, and all that the search found stands in it.
void expect_proved(const rollfix::Part& part, const rollfix::Reading& reading, double tolerance = 1e-9) {
  certificates::expect_proved(part, {reading}, tolerance);
}

// ---- what is proved ----

class CertificateOfGallery : public testing::TestWithParam<std::string> {};

TEST_P(CertificateOfGallery, is_proved) {
  const rollfix::Part part(rollfix::gallery(GetParam()));
  const double period = part.perimeter();
  expect_proved(part, shapes::reading_from(part, 0.21 * period, 0.13 * period));
  if (part.closed()) expect_proved(part, shapes::reading_from(part, 0.77 * period, -0.4 * period));
  expect_proved(part, {0.1 * period, 50.0});  // nothing fits
}

INSTANTIATE_TEST_SUITE_P(Shapes, CertificateOfGallery, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto& shape : rollfix::gallery_shapes()) names.push_back(shape.name);
                           names.insert(names.end(), {"superellipse,n=3", "naca,digits=0012", "ellipse,a=1,b=1.7"});
                           return names;
                         }()),
                         shapes::as_identifier);

TEST(Certificate, of_random_splines_is_proved) {
  std::mt19937_64 generator = test_generator();
  const int count = test_count(6);
  int unproved = 0;
  for (int k = 0; k < count; ++k) {
    const rollfix::Part part = random_spline(generator);
    const double period = part.perimeter();
    const double tolerance = std::pow(10, uniform(generator, -11, -2));
    const double length = uniform(generator, -1.5, 1.5) * period;
    const rollfix::Reading reading = shapes::reading_from(part, uniform(generator, 0, period), length);
    unproved += is_proved(part, {reading}, tolerance) ? 0 : 1;
  }
  EXPECT_LE(unproved, most_unproved(count));
}

TEST(Certificate, of_a_drawn_plate_is_proved_with_its_corners) {
  const rollfix::Part part = drawn_plate();
  for (const double length : {0.4, 1.7, -2.5, 9.0}) expect_proved(part, shapes::reading_from(part, 3.1, length));
  const double turn = part.corners().front().turn;
  const Json pivot = certificate(part, {0.3, 0.6 * turn});
  EXPECT_EQ(checked(pivot).refusal, "");
}

TEST(Certificate, of_a_polygon_proves_the_pivots_at_its_corners) {
  const rollfix::Part part(rollfix::gallery("polygon,n=5"));
  const Json found = certificate(part, {0.3, 0.5});
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(checked(found).placements, 10U);  // a start and an end at each corner
  EXPECT_EQ(count_of(found, "corner"), 10U);
}

TEST(Certificate, of_curves_that_start_or_end_at_rest_is_proved) {
  const rollfix::Part part = shapes::drawn_with_rests();
  for (const rollfix::Reading& reading :
       {shapes::reading_from(part, 1.3, 0.9), shapes::reading_from(part, 4, -2.1), {1e-4, 0.01}, {0, 0}}) {
    expect_proved(part, reading);
  }
}

TEST(Certificate, of_lines_and_arcs_proves_stretches) {
  const rollfix::Part part(rollfix::gallery("stadium"));
  const Json found = certificate(part, {0.2, 0.0});
  EXPECT_EQ(checked(found).refusal, "");
  EXPECT_EQ(count_of(found, "stretch"), 2U);
}

TEST(Certificate, of_a_symmetric_part_proves_that_all_of_it_fits) {
  for (const char* shape : {"ellipse", "circle", "gear,teeth=5"}) {
    const rollfix::Part part(rollfix::gallery(shape));
    const double fold = shape[0] == 'g' ? 5 : 2;
    const Json found = certificate(part, {part.perimeter() / fold, 2 * kPi / fold});
    EXPECT_EQ(checked(found).refusal, "") << shape;
    EXPECT_EQ(count_of(found, "stretch"), found["rows"].size()) << shape;
  }
}

/// An ellipse's turn by L is largest at one place: readings just short of that have two roots close together, just
/// beyond it none, and within the tolerance of it one placement.
TEST(Certificate, of_near_double_roots_is_proved) {
  const rollfix::Part part(rollfix::gallery("ellipse"));
  const double length = 1;
  const double most = shapes::reading_from(part, part.perimeter() - 0.5 * length, length).turn;
  for (const double off : {1e-3, 1e-5, 1e-7, 3e-9, 5e-10, 0.0, -5e-10, -3e-9, -1e-7, -1e-5}) {
    expect_proved(part, {length, most - off});
  }
}

TEST(Certificate, of_an_open_outline_covers_every_start_that_leaves_room) {
  const rollfix::Part part(rollfix::gallery("exponential"));
  for (const double share : {0.2, -0.5, 0.9}) {
    const double length = share * part.perimeter();
    expect_proved(part,
                  shapes::reading_from(part, share > 0 ? 0.05 * part.perimeter() : 0.95 * part.perimeter(), length));
  }
}

TEST(Certificate, of_a_wide_tolerance_is_proved) {
  for (const char* shape : {"cam", "naca", "polygon,n=6", "reuleaux"}) {
    const rollfix::Part part(rollfix::gallery(shape));
    expect_proved(part, shapes::reading_from(part, 0.3 * part.perimeter(), 0.2 * part.perimeter()), 3e-3);
  }
}

// ---- what is not ----

TEST(Certificate, without_one_of_its_placements_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  Json found = certificate(part, shapes::reading_from(part, 2, 1));
  found["placements"].erase(1);
  EXPECT_NE(checked(found).refusal, "");
}

TEST(Certificate, that_calls_a_root_s_cell_apart_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, shapes::reading_from(part, 2, 1));
  for (std::size_t k = 0; k < found["rows"].size(); ++k) {
    Json changed = found;
    if (changed["rows"][k]["then"] == "apart") continue;
    changed["rows"][k]["then"] = "apart";
    EXPECT_NE(checked(changed).refusal, "") << k;
  }
}

TEST(Certificate, without_one_of_its_rows_is_refused) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, shapes::reading_from(part, 2, 1));
  for (std::size_t k = 0; k < found["rows"].size(); ++k) {
    Json changed = found;
    changed["rows"].erase(k);
    EXPECT_NE(checked(changed).refusal, "") << k;
  }
}

TEST(Certificate, with_a_cell_that_claims_nothing_says_so) {
  const rollfix::Part part(rollfix::gallery("cam"));
  Json found = certificate(part, shapes::reading_from(part, 2, 1));
  found["rows"][1]["then"] = "unproved";
  EXPECT_EQ(checked(found).open, 1U);
  EXPECT_GT(checked(found).share, 0);
}

TEST(Certificate, of_a_search_that_ran_out_of_budget_claims_nothing_there) {
  const rollfix::Part part(rollfix::gallery("ellipse"));
  rollfix::LocateOptions options;
  options.budget = 0;
  const double length = 1;
  const rollfix::Reading hard{length, shapes::reading_from(part, part.perimeter() - 0.5 * length, length).turn};
  const rollfix::Search search = locate(part, hard, options);
  const rollfix::Certificate found = certify(part, {hard}, options);
  EXPECT_EQ(found.is_complete(), search.unresolved.empty());
  const Verdict verdict = checked(Json::parse(format_certificate(found)));
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_EQ(verdict.is_complete(), search.unresolved.empty());
}

TEST(Certificate, is_of_one_finger_on_curves_that_have_a_formula) {
  const rollfix::Part part(rollfix::gallery("cam"));
  EXPECT_THROW(certify(part, {rollfix::Reading(1.0, 1.0, 0.2)}), rollfix::InputError);
  struct Parabola {
    rollfix::Interval domain() const { return {0, 1}; }
    rollfix::Jet jet(double u) const { return {{u, u * u}, {1, 2 * u}, {0, 2}, {0, 0}}; }
  };
  const rollfix::Part own(rollfix::Outline{"own", {Parabola{}}, false});
  EXPECT_THROW(certify(own, {rollfix::Reading(0.5, 0.1)}), rollfix::InputError);
}

TEST(Certificate, of_an_outline_that_takes_too_long_is_not_decided) {
  const rollfix::Part part(rollfix::gallery("cam"));
  const Json found = certificate(part, shapes::reading_from(part, 2, 1));
  Json changed = found;
  std::vector<double> points(6000);
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = static_cast<double>(k * 7919 % 100) / 10;
  changed["curves"][0] = {{"kind", "bezier"}, {"numbers", points}};
  EXPECT_EQ(checked(changed).refusal, "not decided within the budget of work");
  changed["curves"][0] = {{"kind", "line"}, {"numbers", {0, 0, 0, 0}}};
  EXPECT_EQ(checked(changed).refusal, "not decided within the budget of work");
  changed = found;
  for (int k = 0; k < 14; ++k)
    changed["curves"][0]["kind"] = "reversed " + changed["curves"][0]["kind"].get<std::string>();
  EXPECT_EQ(checked(changed).refusal, "");
}

// ---- one number changed ----

TEST(Certificate, with_one_number_changed_is_refused) {
  std::mt19937_64 generator = test_generator();
  const rollfix::Part plate = drawn_plate();
  const rollfix::Part cam(rollfix::gallery("cam"));
  const rollfix::Part naca(rollfix::gallery("naca"));
  const rollfix::Part polygon(rollfix::gallery("polygon,n=5"));
  const rollfix::Part spline = random_spline(generator);
  const std::vector<Json> all = {
      certificate(plate, shapes::reading_from(plate, 3.1, 1.7)), certificate(cam, shapes::reading_from(cam, 2, 1)),
      certificate(naca, shapes::reading_from(naca, 0.3, 0.5)), certificate(polygon, {0.3, 0.5}),
      certificate(spline, shapes::reading_from(spline, 1, 0.8))};
  const int count = test_count(12);
  for (int k = 0; k < count; ++k) {
    const Json& original = all[static_cast<std::size_t>(k) % all.size()];
    Json changed = original;
    const std::string what = change_one(changed, generator);
    EXPECT_TRUE(is_refused(changed)) << what;
  }
}

}  // namespace
}  // namespace certificate_test
