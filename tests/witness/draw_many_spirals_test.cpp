// Figures of a part with very many spirals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "draw_helpers.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"

namespace draw_many_spirals_test {
namespace {

using draw_test::nesting_error;
using rollfix::draw_part;
using rollfix::Part;

}  // namespace

TEST(PartFigure, of_a_boundary_with_very_many_spirals_stays_small) {
  const Part part = draw_test::bumpy_part(20000);
  const rollfix::Svg svg = draw_part({&part, "", 640});
  EXPECT_EQ(nesting_error(svg.str()), "");
  EXPECT_LT(svg.str().size(), 1500000U);
}

}  // namespace draw_many_spirals_test
