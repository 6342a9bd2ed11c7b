// Certificates of lines of pairs all of which fit, on curves that are no arcs: each pair of the line is proved, and
// that all that fits is beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "certificate_lies.hpp"
#include "certificates.hpp"
#include "pair_liar.hpp"
#include "random.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"
#include "told_lies.hpp"

namespace pair_family_certificate_test {
namespace {

using certificates::checked;
using certificates::Json;
using rollfix::Part;
using rollfix::Reading;
using rollfix_verify::Verdict;

Part gallery(const std::string& shape) { return Part(rollfix::gallery(shape)); }

Json certificate(const Part& part, const std::vector<Reading>& readings, double tolerance = 1e-9,
                 std::optional<double> facing = {}) {
  rollfix::LocateOptions options;
  options.tolerance = tolerance;
  options.facing = facing;
  return Json::parse(format_certificate(certify_pair(part, readings, options)));
}

/// Two equal rolls, as shares of the perimeter.
std::vector<Reading> equal_rolls(const Part& part, double first = 0.05, double second = 0.16) {
  const double a = first * part.perimeter();
  const double b = second * part.perimeter();
  return {{a, a, 0.0}, {b, b, 0.0}};
}

/// A spline that looks the same three times.
Part trefoil() {
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < 12; ++k) {
    const double angle = 2 * shapes::kPi * k / 12;
    const double radius = std::vector{1.0, 1.07, 1.12, 0.93}[static_cast<std::size_t>(k % 4)];
    points.push_back(radius * rollfix::Vec2(std::cos(angle), std::sin(angle)));
  }
  rollfix::Outline outline;
  outline.name = "trefoil";
  outline.curves = rollfix::spline_through(points, true);
  return Part(outline);
}

/// Two lobes that are the same, joined by curves that are not.
Part two_lobes() {
  const std::vector<rollfix::Vec2> lobe = {{1, 1}, {0.3, 1.6}, {-0.5, 1.6}, {-1, 1}};
  std::vector<rollfix::Vec2> other;
  for (const rollfix::Vec2& point : lobe) other.push_back(-point);
  const auto joint = [](const auto& before, const auto& after, double reach) {
    const rollfix::Vec2 from = before[3] + reach * (before[3] - before[2]);
    const rollfix::Vec2 to = after[0] - reach * (after[1] - after[0]);
    return rollfix::Bezier({before[3], from, to, after[0]});
  };
  rollfix::Outline outline;
  outline.name = "two lobes";
  outline.curves = {rollfix::Bezier(lobe), joint(lobe, other, 0.5), rollfix::Bezier(other), joint(other, lobe, 0.9)};
  return Part(outline);
}

std::size_t count_of_families(const Json& found) {
  return static_cast<std::size_t>(std::count_if(found["placements"].begin(), found["placements"].end(),
                                                [](const Json& one) { return one["proof"] == "family"; }));
}

void expect_families(const Json& found, std::size_t families) {
  const Verdict verdict = checked(found);
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_EQ(verdict.families, families);
  EXPECT_EQ(verdict.open, 0U);
  EXPECT_TRUE(verdict.is_complete());
}

TEST(PairFamilyCertificate, of_the_same_places_is_proved) {
  for (const char* shape : {"cam", "limacon", "exponential"}) {
    SCOPED_TRACE(shape);
    const Part part = gallery(shape);
    expect_families(certificate(part, equal_rolls(part)), 1);
  }
}

TEST(PairFamilyCertificate, past_a_corner_is_proved) {
  const Part part = gallery("naca");
  expect_families(certificate(part, equal_rolls(part, 0.098, 0.245)), 1);
}

TEST(PairFamilyCertificate, of_places_that_look_the_same_is_proved_for_each_of_them) {
  expect_families(certificate(gallery("ellipse"), equal_rolls(gallery("ellipse"))), 2);
  expect_families(certificate(trefoil(), equal_rolls(trefoil())), 3);
}

TEST(PairFamilyCertificate, with_the_facing_is_of_the_one_that_it_allows) {
  const Part part = gallery("ellipse");
  const std::vector<Reading> readings = {equal_rolls(part)[0]};
  const Json same = certificate(part, readings, 1e-9, 0.0);
  expect_families(same, 1);
  expect_families(certificate(part, readings, 1e-9, shapes::kPi), 1);
  expect_families(certificate(part, equal_rolls(part), 1e-9, shapes::kPi), 1);
}

TEST(PairFamilyCertificate, of_wide_and_of_narrow_tolerances_is_proved) {
  const Part part = gallery("ellipse");
  for (const double tolerance : {4e-12, 1e-6, 1e-3}) {
    const Verdict verdict = checked(certificate(part, equal_rolls(part), tolerance));
    EXPECT_EQ(verdict.refusal, "") << tolerance;
    EXPECT_EQ(verdict.families, 2U) << tolerance;
    EXPECT_TRUE(verdict.is_complete()) << tolerance;
  }
}

/// The program says nothing of lines that cross each other. What can be said is proved: each pair of one of them fits.
TEST(PairFamilyCertificate, of_fingers_that_move_against_each_other_is_of_the_line_only) {
  const Part part = gallery("ellipse");
  const Reading reading = equal_rolls(part)[0];
  Json found = certificate(part, {reading, reading});
  EXPECT_EQ(count_of_families(found), 0U);
  std::mt19937_64 generator = test_generator();
  pair_liar::Document document{{found, generator}, part};
  const double period = part.perimeter();
  const double sum = period - reading.length[0];  // of s and t: the mirrored roll, the other way
  Json& one = found["placements"][0];
  document.move(one, 1.0, sum - 1.0);
  one["proof"] = "family";
  one["extent"] = {{0.0, period}, {0.0, period}};
  one["family"] = {{0.0, sum}, {period, sum - period}};
  found["cells"] = "[0]";
  const Verdict verdict = checked(found);
  EXPECT_EQ(verdict.refusal, "");
  EXPECT_EQ(verdict.families, 1U);
  EXPECT_EQ(verdict.open, 1U);
  one["family"] = {{0.0, sum + 1e-7}, {period, sum + 1e-7 - period}};
  document.move(one, 1.0, sum + 1e-7 - 1.0);
  EXPECT_NE(checked(found).refusal, "");
}

/// Each finger on another lobe: the line ends where one of the last contacts leaves them.
TEST(PairFamilyCertificate, that_ends_on_the_part_is_proved_and_no_longer_one_is) {
  const Json found = certificate(two_lobes(), {{0.3, 0.3, 0.0}, {0.7, 0.7, 0.0}});
  expect_families(found, 3);  // that of the same places as well
  for (std::size_t k = 0; k < found["placements"].size(); ++k) {
    const Json& one = found["placements"][k];
    if (one["proof"] != "family" || one["extent"][0] == found["placements"][0]["extent"][0]) continue;
    Json longer = found;
    for (Json& place : longer["placements"][k]["family"][1]) place = place.get<double>() + 0.02;
    EXPECT_NE(checked(longer).refusal, "") << k;
    Json narrower = found;
    narrower["placements"][k]["extent"][1][1] = one["family"][1][1].get<double>() - 0.02;
    EXPECT_NE(checked(narrower).refusal, "") << k;
    break;  // the other one is the same with the fingers exchanged
  }
}

// ---- lies ----

/// Of an ellipse, whose two families are proved.
Json truth() { return certificate(gallery("ellipse"), equal_rolls(gallery("ellipse"))); }

/// One of them, changed.
void expect_refused(const std::string& lie, const std::function<void(Json& family, Json& all)>& change) {
  Json found = truth();
  change(found["placements"][1], found);
  EXPECT_NE(checked(found).refusal, "") << lie;
}

void shift(Json& pair, double ds, double dt) {
  pair[0] = pair[0].get<double>() + ds;
  pair[1] = pair[1].get<double>() + dt;
}

TEST(PairFamilyCertificate, with_a_line_that_does_not_fit_is_refused) {
  for (const double off : {1e-7, -1e-4, 0.1}) {
    expect_refused("shifted", [&](Json& one, Json& /*all*/) {
      for (Json& pair : one["family"]) shift(pair, 0, off);
    });
    expect_refused("its end shifted", [&](Json& one, Json& /*all*/) { shift(one["family"][1], 0, off); });
    expect_refused("along a finger", [&](Json& one, Json& /*all*/) { shift(one["family"][1], off, 0); });
  }
  expect_refused("of another slope", [](Json& one, Json& /*all*/) { shift(one["family"][1], 0, 0.5); });
  expect_refused("no line", [](Json& one, Json& /*all*/) { one["family"][1] = one["family"][0]; });
  expect_refused("far away", [](Json& one, Json& /*all*/) {
    for (Json& pair : one["family"]) shift(pair, 1e300, 1e300);
  });
  expect_refused("turned round", [](Json& one, Json& /*all*/) { std::swap(one["family"][0][1], one["family"][1][1]); });
  expect_refused("another one's", [](Json& one, Json& all) { one["family"] = all["placements"][0]["family"]; });
}

TEST(PairFamilyCertificate, with_its_place_shifted_and_all_that_belongs_to_it_is_refused) {
  const Part part = gallery("ellipse");
  Json found = certificate(part, equal_rolls(part));
  std::mt19937_64 generator = test_generator();
  pair_liar::Document lie{{found, generator}, part};
  Json& one = found["placements"][1];
  lie.move(one, one["start"][0].get<double>(), one["start"][1].get<double>() + 1e-3);
  for (Json& pair : one["family"]) shift(pair, 0, 1e-3);
  EXPECT_NE(checked(found).refusal, "");
}

TEST(PairFamilyCertificate, with_an_extent_that_is_too_narrow_is_refused) {
  for (const std::size_t finger : {0U, 1U}) {
    expect_refused("narrower", [&](Json& one, Json& all) {
      one["extent"][finger] = {0.0, 0.98 * all["perimeter"].get<double>()};
    });
  }
  const Part part = gallery("exponential");
  Json open = certificate(part, equal_rolls(part));
  open["placements"][0]["extent"][0][1] = 0.8 * part.perimeter();
  EXPECT_NE(checked(open).refusal, "");
}

TEST(PairFamilyCertificate, of_another_kind_or_with_a_box_is_refused) {
  expect_refused("a kind", [](Json& one, Json& /*all*/) { one["kind"] = "crossing"; });
  expect_refused("touching", [](Json& one, Json& /*all*/) { one["kind"] = "touching"; });
  expect_refused("a box", [](Json& one, Json& all) { one["box"] = {all["from"], all["from"]}; });
}

TEST(PairFamilyCertificate, of_a_root_said_to_be_a_family_is_refused) {
  const Part part = gallery("cam");
  Json found = certificate(part, equal_rolls(part));
  ASSERT_TRUE(checked(found).is_complete());
  for (Json& one : found["placements"]) {
    if (one["proof"] != "one") continue;
    one["kind"] = "stretch";
    one["proof"] = "family";
    one["extent"] = found["placements"][0]["extent"];
    one.erase("box");
    const double s = one["start"][0], t = one["start"][1];
    one["family"] = {{s, t}, {s + 0.1, t + 0.1}};
    break;
  }
  EXPECT_NE(checked(found).refusal, "");
}

TEST(PairFamilyCertificate, of_two_families_said_to_be_one_is_not_proved) {
  const Part part = gallery("ellipse");
  Json found = certificate(part, equal_rolls(part));
  std::mt19937_64 generator = test_generator();
  pair_liar::Document lie{{found, generator}, part};
  lie.remove(1, pair_liar::Document::cell_of(0));
  EXPECT_FALSE(checked(found).is_complete());
}

TEST(PairFamilyCertificate, without_a_line_says_no_more_than_that_its_cells_exclude_nothing) {
  const Part part = gallery("ellipse");
  Json found = certificate(part, equal_rolls(part));
  for (Json& one : found["placements"]) one["proof"] = "fits";
  const Verdict verdict = checked(found);
  EXPECT_EQ(verdict.families, 0U);
  EXPECT_GT(verdict.open, 0U);
}

TEST(PairFamilyCertificate, that_lies_like_any_other_one_is_not_proved) {
  std::mt19937_64 generator = test_generator();
  const Part part = gallery("exponential");
  const Json honest = certificate(part, equal_rolls(part));
  std::vector<int> told;
  const auto expect_unproved = [](const Json& lie, const std::string& name) {
    EXPECT_FALSE(certificate_lies::is_proved(lie)) << name;
  };
  told_lies::tell_each(pair_liar::all(), honest, generator, told, expect_unproved, part);
}

}  // namespace
}  // namespace pair_family_certificate_test
