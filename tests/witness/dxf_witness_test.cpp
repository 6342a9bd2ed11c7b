// DXF: drawings that ezdxf writes have the lengths and areas that closed forms and ezdxf's own curves say.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "cli.hpp"
#include "drawing_helpers.hpp"
#include "dxf_text.hpp"
#include "paths.hpp"
#include "random.hpp"

namespace dxf_witness_test {
namespace {

using drawings::area_of;
using drawings::length_of;
using drawings::numbers_of;
using drawings::perimeter_of;
using rollfix::Drawing;
using rollfix::files::parse_dxf;

/// As the witness counts, and to the same share of the length's square.
constexpr double kAgreement = 1e-9;

/// Debian's Python, which has ezdxf, or ROLLFIX_PYTHON.
std::string python() {
  const char* const named = std::getenv("ROLLFIX_PYTHON");
  return named != nullptr ? named : "/usr/bin/python3";
}

/// Writes the drawings into the current folder and tells what they should be.
cli::Json written_drawings(int random_drawings) {
  const std::string command = fmt::format("{} {} . {} {}", python(), checked_out("tests/dxf/write_with_ezdxf.py"),
                                          test_seed(), random_drawings);
  const cli::Ran ran = cli::shell(command);
  EXPECT_EQ(ran.code, 0) << "needs python3-ezdxf (script/bootstrap): " << ran.err;
  return cli::Json::parse(cli::read("drawings.json"));
}

Drawing read(const std::string& file) { return parse_dxf(cli::read(file), file); }

void expect_measures(const Drawing& drawing, const cli::Json& expected) {
  const double length = expected["length"];
  const double area = expected["area"];
  EXPECT_NEAR(length_of(drawing), length, kAgreement * length);
  EXPECT_NEAR(area_of(drawing), area, kAgreement * length * length);
  EXPECT_EQ(drawing.unit, expected["unit"]);
  if (expected["closed"]) {
    EXPECT_NEAR(perimeter_of(drawing), length, kAgreement * length);
  }
}

TEST(DxfWitness, lengths_areas_and_units_agree) {
  const cli::Folder folder;
  for (const cli::Json& expected : written_drawings(test_count(8))) {
    const std::string file = expected["file"];
    SCOPED_TRACE(file);
    expect_measures(read(file), expected);
  }
}

TEST(DxfWitness, binary_and_ascii_give_the_same_bits) {
  const cli::Folder folder;
  int pairs = 0;
  for (const cli::Json& expected : written_drawings(test_count(8))) {
    const std::string binary = expected["file"];
    const std::size_t mark = binary.find("_binary");
    if (mark == std::string::npos) continue;
    const std::string ascii = binary.substr(0, mark) + ".dxf";
    SCOPED_TRACE(ascii);
    EXPECT_EQ(numbers_of(read(binary)), numbers_of(read(ascii)));
    EXPECT_EQ(read(binary).unit, read(ascii).unit);
    EXPECT_EQ(read(binary).notes, read(ascii).notes);
    ++pairs;
  }
  EXPECT_GE(pairs, 10);
}

}  // namespace
}  // namespace dxf_witness_test
