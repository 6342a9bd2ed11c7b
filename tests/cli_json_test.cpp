// What --json says: the fields that scripts depend on, and numbers that survive being printed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <numbers>

#include "cli.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace cli_json_test {
namespace {

using cli::Json;
using cli::run;
using testing::ElementsAre;
using testing::IsSupersetOf;

Json json_of(const std::string& command) { return run(command + " --json").json(); }

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

}  // namespace

TEST(LocateJson, has_every_field_of_the_contract) {
  const Json found = json_of("locate gallery:ellipse,a=2,b=1 --reading 1.5,1.25");
  EXPECT_EQ(found["schema"], "rollfix/locate/1");
  EXPECT_EQ(found["status"], "complete");
  EXPECT_EQ(found["verdict"], "ambiguous (4)");
  EXPECT_EQ(found["fingers"], 1);
  EXPECT_EQ(found["dropped"], Json::object());
  EXPECT_EQ(found["unresolved"], Json::array());
  EXPECT_EQ(found["placements"].size(), 4U);
  EXPECT_THAT(keys(found["part"]),
              IsSupersetOf({"name", "perimeter", "closed", "reversed", "turns", "inflections", "vertices", "corners"}));
  EXPECT_THAT(keys(found["placements"][0]),
              IsSupersetOf({"kind", "start", "end", "extent", "roots", "error", "point", "tangent", "residual",
                            "sensitivity", "probability", "pose"}));
}

TEST(LocateJson, says_what_the_part_is) {
  const Json part = json_of("locate gallery:ellipse,a=2,b=1 --reading 1,1")["part"];
  const double eccentricity = std::sqrt(1 - 0.25);
  EXPECT_EQ(part["name"], "gallery:ellipse,a=2,b=1");
  EXPECT_NEAR(part["perimeter"], 4 * 2 * boost::math::ellint_2(eccentricity), 1e-11);
  EXPECT_EQ(part["closed"], true);
  EXPECT_EQ(part["reversed"], false);
  EXPECT_EQ(part["turns"], 1);
  EXPECT_EQ(part["inflections"], 0);
  EXPECT_EQ(part["vertices"], 4);
  EXPECT_EQ(part["corners"], 0);
}

TEST(LocateJson, gives_one_entry_per_finger) {
  const Json placement =
      json_of("locate gallery:ellipse --reading 0.5,0.25 --reading 0.25,0.125 --tolerance 0.5")["placements"][0];
  for (const char* field : {"start", "end", "extent", "point", "tangent"})
    EXPECT_EQ(placement[field].size(), 1U) << field;
  EXPECT_EQ(placement["extent"][0].size(), 2U);
  EXPECT_EQ(placement["point"][0].size(), 2U);
}

TEST(LocateJson, gives_the_sensitivity_by_finger_and_reading) {
  const Json placement =
      json_of("locate gallery:spline --reading 0.5,0.25 --reading 0.25,0.125 --tolerance 0.1")["placements"][0];
  ASSERT_EQ(placement["sensitivity"]["per_turn"].size(), 1U);
  EXPECT_EQ(placement["sensitivity"]["per_turn"][0].size(), 2U);
  ASSERT_EQ(placement["sensitivity"]["per_length"].size(), 1U);
  ASSERT_EQ(placement["sensitivity"]["per_length"][0].size(), 2U);
  EXPECT_EQ(placement["sensitivity"]["per_length"][0][0].size(), 1U);
}

TEST(LocateJson, numbers_read_back_as_the_same_bits) {
  for (const std::string name : {"gallery:spline", "gallery:limacon", "gallery:naca", "gallery:exponential"}) {
    const rollfix::Part part(rollfix::load_outline(name));
    const rollfix::Reading reading{0.7, part.turning().angle(1.3) - part.turning().angle(0.6)};
    const rollfix::Search search = rollfix::locate(part, reading);
    const Json found =
        json_of("locate " + name + " --reading " + cli::exact(reading.length[0]) + "," + cli::exact(reading.turn));
    EXPECT_EQ(found["readings"][0]["turn"], reading.turn);
    ASSERT_EQ(found["placements"].size(), search.placements.size()) << name;
    for (std::size_t i = 0; i < search.placements.size(); ++i) {
      const Json& placement = found["placements"][i];
      EXPECT_EQ(placement["start"][0], search.placements[i].start[0]);
      EXPECT_EQ(placement["extent"][0][1], search.placements[i].extent[0].hi);
      EXPECT_EQ(placement["point"][0][1], search.placements[i].point[0].y());
      EXPECT_EQ(placement["tangent"][0], search.placements[i].tangent[0]);
    }
  }
}

TEST(LocateJson, says_null_where_a_number_is_infinite_or_not_defined) {
  const Json whole = json_of("locate gallery:circle,r=2 --reading 1,0.5")["placements"][0];
  EXPECT_EQ(whole["kind"], "stretch");
  EXPECT_TRUE(whole["error"].is_null());
  EXPECT_TRUE(whole["sensitivity"].is_null());
  EXPECT_TRUE(whole["pivot"].is_null());
  EXPECT_TRUE(whole["probability"].is_null());
  EXPECT_TRUE(whole["pose"].is_null());
  EXPECT_NEAR(whole["extent"][0][1], 4 * std::numbers::pi, 1e-11);
}

TEST(LocateJson, shows_the_sides_of_a_square_as_stretches) {
  const Json found = json_of("locate gallery:polygon,n=4,r=1 --reading 1,0");
  ASSERT_EQ(found["placements"].size(), 4U);
  for (int side = 0; side < 4; ++side) {
    const Json& placement = found["placements"][static_cast<std::size_t>(side)];
    EXPECT_EQ(placement["kind"], "stretch");
    EXPECT_NEAR(placement["extent"][0][0], side * std::numbers::sqrt2, 1e-11);
    EXPECT_NEAR(placement["extent"][0][1], (side + 1) * std::numbers::sqrt2 - 1, 1e-11);
  }
}

TEST(LocateJson, shows_between_which_directions_the_tangent_pivots_at_a_corner) {
  // From one corner of a square to the next, turning by half a right angle: split in any way between the two.
  const Json found = json_of("locate gallery:polygon,n=4,r=1 --reading " + cli::exact(std::numbers::sqrt2) + ",45deg");
  ASSERT_EQ(found["placements"].size(), 4U);
  const Json& placement = found["placements"][0];
  EXPECT_EQ(placement["kind"], "corner");
  EXPECT_TRUE(placement["sensitivity"].is_null());
  const double quarter = std::numbers::pi / 4;
  EXPECT_NEAR(placement["pivot"][0][1].get<double>() - placement["pivot"][0][0].get<double>(), quarter, 1e-11);
  EXPECT_NEAR(placement["pivot"][1][1].get<double>() - placement["pivot"][1][0].get<double>(), quarter, 1e-11);
}

TEST(LocateJson, says_of_each_finger_whether_it_may_be_anywhere_on_the_loop) {
  // A finger that rolls round all of the part each time can have begun anywhere.
  const rollfix::Part part(rollfix::load_outline("gallery:ellipse,a=2,b=1"));
  const double P = part.perimeter();
  const auto turn = [&](double length) { return part.turning().angle(1 + length) - part.turning().angle(1); };
  std::string a_round = "locate gallery:ellipse,a=2,b=1";
  std::string b_round = a_round;
  for (const double length : {0.7, 1.4}) {
    a_round += fmt::format(" --reading {:.17g},{:.17g},{:.17g}", P, length, 2 * std::numbers::pi - turn(length));
    b_round += fmt::format(" --reading {:.17g},{:.17g},{:.17g}", length, P, turn(length) - 2 * std::numbers::pi);
  }
  EXPECT_THAT(json_of(a_round)["placements"].at(0)["whole_loop"], ElementsAre(true, false));
  EXPECT_THAT(json_of(b_round)["placements"].at(0)["whole_loop"], ElementsAre(false, true));
}

TEST(LocateJson, lists_what_a_small_budget_left_open) {
  const cli::Ran ran = run("locate gallery:ellipse --reading 4.844,3.1415 --budget 2 --json");
  EXPECT_EQ(ran.code, 3);
  EXPECT_EQ(ran.json()["status"], "incomplete");
  EXPECT_EQ(ran.json()["verdict"], "undecided");
  EXPECT_FALSE(ran.json()["unresolved"].empty());
}

TEST(InspectJson, says_of_an_ellipse_what_the_formulas_say) {
  const Json part = json_of("inspect gallery:ellipse,a=3,b=2");
  EXPECT_EQ(part["schema"], "rollfix/inspect/1");
  const double P = 4 * 3 * boost::math::ellint_2(std::sqrt(1 - 4.0 / 9));
  EXPECT_NEAR(part["part"]["perimeter"], P, 1e-11);
  EXPECT_NEAR(part["total_turn"], 2 * std::numbers::pi, 1e-11);
  EXPECT_NEAR(part["curvature"][0], 2.0 / 9, 1e-11);
  EXPECT_NEAR(part["curvature"][1], 3.0 / 4, 1e-11);
  EXPECT_TRUE(part["largest_disk"].is_null());
  EXPECT_EQ(part["symmetry"], 2);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(part["vertices"][i], P / 4 * static_cast<double>(i), 1e-10);
  EXPECT_NEAR(part["box"][0][0], -3, 1e-11);
  EXPECT_NEAR(part["box"][1][1], 2, 1e-11);
}

TEST(InspectJson, measures_a_tilted_shape_by_its_outermost_points) {
  // A limacon's largest y: d/du (a + b cos u) sin u = 0, so cos u = (-a + sqrt(a^2 + 8 b^2)) / 4b.
  const Json part = json_of("inspect gallery:limacon,a=2,b=1");
  const double c = (-2 + std::sqrt(4.0 + 8)) / 4;
  const double top = (2 + c) * std::sqrt(1 - c * c);
  EXPECT_NEAR(part["box"][1][1], top, 1e-11);
  EXPECT_NEAR(part["box"][0][1], -top, 1e-11);
  EXPECT_NEAR(part["box"][1][0], 3, 1e-11);
}

TEST(InspectJson, finds_how_many_places_look_alike) {
  EXPECT_EQ(json_of("inspect gallery:gear,teeth=7")["symmetry"], 7);
  EXPECT_EQ(json_of("inspect gallery:polygon,n=6")["symmetry"], 6);
  EXPECT_EQ(json_of("inspect gallery:stadium")["symmetry"], 2);
  EXPECT_EQ(json_of("inspect gallery:spline")["symmetry"], 1);
  EXPECT_TRUE(json_of("inspect gallery:circle")["symmetry"].is_null());
}

TEST(InspectJson, finds_the_largest_disk_that_fits_a_concavity) {
  // Where a limacon is most concave, at u = pi, its curvature is (a - 2b) / (a - b)^2 with a < 2b.
  const Json part = json_of("inspect gallery:limacon,a=3,b=2");
  EXPECT_NEAR(part["largest_disk"], 1, 1e-10);
  EXPECT_EQ(part["part"]["inflections"], 2);
}

}  // namespace cli_json_test
