// DXF: a file that LibreCAD wrote, see tests/dxf/README.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"
#include "drawing_helpers.hpp"
#include "files/formats.hpp"
#include "paths.hpp"
#include "shapes.hpp"

namespace dxf_librecad_test {
namespace {

using rollfix::Drawing;
using shapes::kPi;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

Drawing librecad_drawing() {
  return rollfix::files::parse_dxf(cli::read(checked_out("tests/dxf/librecad.dxf")), "librecad.dxf");
}

TEST(DxfLibrecad, lines_arcs_and_circle_are_what_was_drawn) {
  const Drawing drawing = librecad_drawing();
  EXPECT_THAT(drawings::kinds_of(drawing), UnorderedElementsAre("line", "arc", "line", "arc", "arc"));
  EXPECT_NEAR(drawings::length_of(drawing), 6 + kPi + 4 * kPi, 1e-12);
  EXPECT_NEAR(drawings::area_of(drawing), 3 + kPi / 4 + 4 * kPi, 1e-12);
}

TEST(DxfLibrecad, unit_is_in_the_header) {
  EXPECT_EQ(librecad_drawing().unit, "mm");
  EXPECT_THAT(librecad_drawing().notes, IsEmpty());
}

}  // namespace
}  // namespace dxf_librecad_test
