// Units on the command line: a part in one, a length in another, and the same answer.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli.hpp"
#include "paths.hpp"

namespace cli_units_test {
namespace {

using cli::Json;
using cli::run;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A rectangle with rounded corners, 4 x 3 in inches.
constexpr const char* kPlate = R"({"unit": "in", "curves": [
 {"type": "line", "from": [1, 0], "to": [3, 0]},
 {"type": "arc", "centre": [3, 1], "radius": 1, "from": "-90deg", "sweep": "90deg"},
 {"type": "line", "from": [4, 1], "to": [4, 2]},
 {"type": "arc", "centre": [3, 2], "radius": 1, "from": "0deg", "sweep": "90deg"},
 {"type": "line", "from": [3, 3], "to": [1, 3]},
 {"type": "arc", "centre": [1, 2], "radius": 1, "from": "90deg", "sweep": "90deg"},
 {"type": "line", "from": [0, 2], "to": [0, 1]},
 {"type": "arc", "centre": [1, 1], "radius": 1, "from": "180deg", "sweep": "90deg"}]})";
constexpr double kPlatePerimeter = 6 + 2 * 3.14159265358979323846;  // inches

TEST(CliUnits, a_part_that_states_its_unit_is_converted) {
  const cli::Folder folder;
  folder.write("plate.json", kPlate);
  const Json own = run("inspect plate.json --json").json();
  EXPECT_EQ(own["part"]["unit"], "in");
  EXPECT_NEAR(own["part"]["perimeter"], kPlatePerimeter, 1e-9);
  const cli::Ran ran = run("inspect plate.json --unit mm --json");
  EXPECT_EQ(ran.json()["part"]["unit"], "mm");
  EXPECT_EQ(ran.json()["unit"], "mm");
  EXPECT_NEAR(ran.json()["part"]["perimeter"], 25.4 * kPlatePerimeter, 1e-8);
  EXPECT_THAT(ran.err, HasSubstr("converted from in to mm"));
}

TEST(CliUnits, a_part_that_states_none_is_in_the_one_that_is_stated) {
  const Json found = run("inspect gallery:ellipse,a=2,b=1 --unit mm --json").json();
  EXPECT_EQ(found["part"]["unit"], "mm");
  EXPECT_EQ(found["part"]["perimeter"], run("inspect gallery:ellipse,a=2,b=1 --json").json()["part"]["perimeter"]);
  EXPECT_EQ(run("inspect gallery:ellipse --json").json()["part"]["unit"], nullptr);
}

TEST(CliUnits, lengths_in_any_unit_give_the_same_answer) {
  const std::string locate = "locate gallery:cam --unit cm --json --tolerance 1e-6 --reading ";
  const Json plain = run(locate + "0.9,40deg").json();
  ASSERT_FALSE(plain["placements"].empty());
  for (const char* const reading : {"9mm,40deg", "0.9cm,40deg", "0.009m,40deg"}) {
    const Json found = run(locate + reading).json();
    ASSERT_EQ(found["placements"].size(), plain["placements"].size()) << reading;
    for (std::size_t k = 0; k < plain["placements"].size(); ++k) {
      EXPECT_NEAR(found["placements"][k]["start"][0], plain["placements"][k]["start"][0], 1e-9) << reading;
    }
  }
}

TEST(CliUnits, digits_of_a_length_count_in_its_own_unit) {
  const auto tolerance = [](const std::string& reading) {
    return run("locate gallery:cam --unit cm --json --reading " + reading).json()["tolerance"].get<double>();
  };
  // 40.1deg decides the decimals: 0.05 of a cm, or of a mm, and of a degree.
  EXPECT_GT(tolerance("0.9cm,40.1deg"), 3 * tolerance("9mm,40.1deg"));
}

TEST(CliUnits, a_roll_in_two_units_is_one_roll) {
  const cli::Folder folder;
  folder.write("plate.json", kPlate);
  const std::string roll = "simulate plate.json --finger disk,r=0.5in --start 1in --length ";
  EXPECT_EQ(run(roll + "2.5in").out, run(roll + "63.5mm").out);
  ASSERT_EQ(run(roll + "63.5mm -o roll.csv").code, 0);
  const std::string locate = " --log roll.csv --noise contact=0.01in,angle=0.1deg --prior 1in,2in --json";
  const Json inches = run("locate plate.json --finger disk,r=12.7mm" + locate).json();
  ASSERT_FALSE(inches["placements"].empty()) << inches;
  EXPECT_NEAR(inches["placements"][0]["start"][0], 1, 0.2);
  EXPECT_EQ(inches["part"]["unit"], "in");
}

TEST(CliUnits, the_unit_stands_in_the_text) {
  const std::string text = run("locate gallery:cam --unit mm --reading 0.9,40deg --verbose").out;
  EXPECT_THAT(text, AllOf(HasSubstr("perimeter 7.558250 mm"), HasSubstr("start [mm]"), HasSubstr("x [mm]"),
                          HasSubstr("[mm/deg]"), HasSubstr("length 0.900000 mm")));
  EXPECT_THAT(run("locate gallery:cam --reading 0.9,40deg").out, Not(HasSubstr("mm")));
}

TEST(CliUnits, a_length_for_a_part_of_no_known_unit_is_told_the_cure) {
  for (const char* const command :
       {"locate gallery:cam --reading 9mm,40deg", "locate gallery:cam --reading 1,1 --finger disk,r=8mm",
        "simulate gallery:cam --finger disk,r=0.2 --start 1mm --length 1",
        "advise gallery:cam --reading 0.4,20.1deg --travel 3mm"}) {
    const cli::Ran ran = run(command);
    EXPECT_EQ(ran.code, 2) << command;
    EXPECT_THAT(ran.err, AllOf(HasSubstr("mm"), HasSubstr("--unit mm"))) << command;
  }
  EXPECT_THAT(run("inspect gallery:cam --unit parsec").err, HasSubstr("expected a unit of length: mm, cm, m, in"));
}

TEST(CliUnits, a_smoothing_tolerance_takes_a_unit) {
  const cli::Folder folder;
  std::string points = "x [mm],y [mm]\n";
  for (int k = 0; k < 60; ++k) {
    points +=
        fmt::format("{},{}\n", 50 * std::cos(k * 6.283185307179586 / 60), 30 * std::sin(k * 6.283185307179586 / 60));
  }
  folder.write("egg.csv", points);
  EXPECT_EQ(run("inspect egg.csv --smooth 0.1mm --json").out, run("inspect egg.csv --smooth 0.01cm --json").out);
  EXPECT_EQ(run("inspect egg.csv --json").json()["unit"], "mm");
}

TEST(CliUnits, a_saved_part_keeps_its_unit_and_is_converted) {
  const cli::Folder folder;
  folder.write("plate.json", kPlate);
  ASSERT_EQ(run("inspect plate.json -o saved.json").code, 0);
  EXPECT_EQ(run("inspect saved.json --json").json()["part"]["unit"], "in");
  const Json found = run("inspect saved.json --unit cm --json").json();
  EXPECT_NEAR(found["part"]["perimeter"], 2.54 * kPlatePerimeter, 1e-9);
  ASSERT_EQ(run("inspect saved.json --unit cm -o again.json").code, 0);
  EXPECT_EQ(run("inspect again.json --json").json()["part"]["unit"], "cm");
}

TEST(CliUnits, a_dxf_is_converted_with_all_its_loops) {
  const std::string inspect = "inspect " + checked_out("examples/bracket.dxf") + " --json";
  const Json own = run(inspect).json();
  EXPECT_EQ(own["unit"], "mm");
  const Json found = run(inspect + " --unit in --gap 0.01mm").json();
  ASSERT_EQ(found["loops"].size(), own["loops"].size());
  for (std::size_t k = 0; k < found["loops"].size(); ++k) {
    EXPECT_NEAR(25.4 * found["loops"][k]["length"].get<double>(), own["loops"][k]["length"], 1e-9);
  }
  EXPECT_EQ(found["part"]["corners"], own["part"]["corners"]);
}

TEST(CliUnits, pixels_of_an_svg_are_what_is_stated) {
  const cli::Folder folder;
  folder.write("a.svg", R"(<svg xmlns="http://www.w3.org/2000/svg"><circle cx="0" cy="0" r="10"/></svg>)");
  EXPECT_EQ(run("inspect a.svg --json").json()["unit"], "px");
  EXPECT_THAT(run("locate a.svg --reading 3mm,1").err, AllOf(HasSubstr("'px'"), HasSubstr("--unit")));
  const cli::Ran ran = run("inspect a.svg --unit mm --json");
  EXPECT_NEAR(ran.json()["part"]["perimeter"], 20 * 3.14159265358979323846, 1e-9);
  EXPECT_THAT(ran.err, HasSubstr("a.svg: its lengths, px, are taken as mm"));
}

TEST(CliUnits, a_fingers_drawing_is_converted_to_the_parts_unit) {
  const cli::Folder folder;
  const auto ring = [](const std::string& radius, const std::string& unit) {
    return R"({"curves": [{"type": "arc", "centre": [0, 0], "radius": )" + radius +
           R"(, "from": 0, "sweep": "360deg"}], "unit": ")" + unit + "\"}";
  };
  folder.write("mm.json", ring("5", "mm"));
  folder.write("cm.json", ring("0.5", "cm"));
  const auto last_u = [](const std::string& finger) {
    const std::string log =
        run("simulate gallery:cam --unit cm --start 1 --length 1 --samples 5 --finger " + finger).out;
    const std::size_t row = log.rfind('\n', log.size() - 2);
    return std::stod(log.substr(log.find(',', row) + 1));
  };
  EXPECT_NEAR(last_u("mm.json"), last_u("cm.json"), 1e-9);
  EXPECT_NEAR(last_u("mm.json"), -1, 1e-9);  // as far as it rolled, in the part's unit
}

TEST(CliUnits, columns_are_told_and_taken) {
  const cli::Folder folder;
  folder.write("own.csv", "stamp_ms,contact_deg,yaw_deg\n0,0,0\n250,-40,70\n500,-80,140\n");
  const std::string locate = "locate gallery:cam --log own.csv --finger disk,r=1 --json";
  const cli::Ran refused = run(locate);
  EXPECT_EQ(refused.code, 2);
  const std::size_t start = refused.err.find("--columns ");
  ASSERT_NE(start, std::string::npos) << refused.err;
  const std::string option = refused.err.substr(start, refused.err.find(" (the header") - start);
  folder.write("plain.csv", "time,u,psi\n0,0deg,0deg\n0.25,-40deg,70deg\n0.5,-80deg,140deg\n");
  const cli::Ran taken = run(locate + " " + option);
  EXPECT_EQ(taken.out, run("locate gallery:cam --log plain.csv --finger disk,r=1 --json").out) << taken.err;
  EXPECT_FALSE(taken.json()["placements"].empty());
  EXPECT_EQ(run("watch gallery:cam --log own.csv --once --finger disk,r=1 --noise angle=1deg " + option).code, 0);
}

TEST(CliUnits, columns_without_a_log_are_refused) {
  EXPECT_THAT(run("locate gallery:cam --reading 1,1 --columns u=a").err, HasSubstr("--columns is about a log"));
}

TEST(CliUnits, a_taught_part_is_in_the_unit_of_its_roll) {
  const cli::Folder folder;
  ASSERT_EQ(run("simulate gallery:cam --finger disk,r=0.2 --start 0 --length 7.6 --samples 600 -o around.csv").code, 0);
  const cli::Ran taught = run("teach around.csv --finger disk,r=2mm --unit cm -o taught.json --json");
  ASSERT_EQ(taught.code, 0) << taught.err;
  EXPECT_EQ(taught.json()["part"]["unit"], "cm");
  EXPECT_EQ(run("inspect taught.json --unit mm --json").json()["part"]["unit"], "mm");
}

TEST(CliUnits, corners_made_of_a_sparse_curve_are_told) {
  const cli::Folder folder;
  const auto ellipse = [&](int count) {
    std::string points;
    for (int k = 0; k < count; ++k) {
      const double angle = k * 6.283185307179586 / count;
      points += fmt::format("{},{}\n", 5 * std::cos(angle), std::sin(angle));
    }
    return points;
  };
  folder.write("sparse.csv", ellipse(12));
  const cli::Ran sparse = run("locate sparse.csv --reading 1,0.5 --corner-angle 59deg");
  EXPECT_THAT(sparse.err,
              AllOf(HasSubstr("sparse.csv: made 2 corners"), HasSubstr("s = 0, "), HasSubstr("--corner-angle 110deg")));
  EXPECT_EQ(run("inspect sparse.csv --json").json()["part"]["corners"], 0);
  EXPECT_EQ(run("inspect sparse.csv --corner-angle 110deg --json").json()["part"]["corners"], 0);
  EXPECT_EQ(run("inspect sparse.csv --corner-angle 110deg --json").err, "");
  folder.write("dense.csv", ellipse(60));
  EXPECT_EQ(run("inspect dense.csv --json").err, "");
}

TEST(CliUnits, corners_that_a_curve_rounds_are_told) {
  const cli::Folder folder;
  folder.write("octagon.csv", "1 0\n0.7 0.7\n0 1\n-0.7 0.7\n-1 0\n-0.7 -0.7\n0 -1\n0.7 -0.7\n");
  folder.write("chamfer.csv", "0 0\n1 0\n2 0\n2.5 0.5\n2.5 1\n2.5 2\n0 2\n0 1\n");
  EXPECT_THAT(run("inspect octagon.csv --json").err, HasSubstr("a smooth curve runs through 8 points"));
  EXPECT_THAT(run("inspect chamfer.csv --json").err,
              AllOf(HasSubstr("through 2 points whose chords turn by 45deg or more, first (2, 0)"),
                    HasSubstr("--corner-angle 40deg keeps them")));
  const cli::Ran kept = run("inspect chamfer.csv --corner-angle 40deg --json");
  EXPECT_EQ(kept.json()["part"]["corners"], 5);
  EXPECT_EQ(kept.err, "");
}

TEST(CliUnits, bends_of_a_sparse_curve_are_not_told) {
  const cli::Folder folder;
  std::string wave = "";  // neighbours turn by up to 37 degrees to and fro
  for (int k = 0; k <= 30; ++k) wave += fmt::format("{},{}\n", k, 0.5 * std::sin(k * 1.2));
  folder.write("wave.csv", wave);
  EXPECT_EQ(run("inspect wave.csv --open --json").err, "");
}

TEST(CliUnits, corners_that_are_meant_are_not_told) {
  const cli::Folder folder;
  folder.write("square.csv", "0 0\n1 0\n1 1\n0 1\n");
  folder.write("sides.csv", "0 0\n0.5 0\n1 0\n1 0.5\n1 1\n0.5 1\n0 1\n0 0.5\n");
  std::string half = "";
  for (int k = 0; k <= 18; ++k) half += fmt::format("{},{}\n", std::cos(k * 0.17453), std::sin(k * 0.17453));
  folder.write("half.csv", half);
  for (const char* const name : {"square.csv", "sides.csv", "half.csv"}) {
    const cli::Ran ran = run(std::string("inspect ") + name + " --json");
    EXPECT_GT(ran.json()["part"]["corners"], 0) << name;
    EXPECT_EQ(ran.err, "") << name;
  }
}

}  // namespace
}  // namespace cli_units_test
