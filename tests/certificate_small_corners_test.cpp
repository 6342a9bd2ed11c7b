// A corner that turns by no more than some tolerances is a corner: all of its pivot is near to fitting.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "certificates.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"

namespace certificate_small_corners_test {
namespace {

constexpr double kTurn = 0.012;  // of the corner, about

/// A rectangle whose lower edge has a corner in its middle.
rollfix::Part plate() {
  const std::vector<rollfix::Vec2> points = {{0, 0}, {1, -0.5 * kTurn}, {2, 0}, {2, 1}, {0, 1}};
  rollfix::Outline outline;
  for (std::size_t k = 0; k < points.size(); ++k) {
    outline.curves.emplace_back(rollfix::Line(points[k], points[(k + 1) % points.size()]));
  }
  return rollfix::Part(outline);
}

/// It rolls over half of the corner's turn.
certificates::Json certificate_of(double tolerance) {
  return certificates::certificate(plate(), {{0.5, 0.5 * kTurn}}, tolerance);
}

TEST(CertificateSmallCorners, of_some_tolerances_are_proved_to_be_passed_once) {
  for (const double tolerances : {2.1, 3.0, 6.0, 15.0, 17.0, 100.0}) {
    const certificates::Json found = certificate_of(kTurn / tolerances);
    EXPECT_EQ(certificates::count_of(found, "corner"), 10U) << tolerances;  // a start and an end at each
    const certificates::Verdict verdict = certificates::checked(found);
    EXPECT_EQ(verdict.refusal, "") << tolerances;
    EXPECT_TRUE(verdict.is_complete()) << tolerances;
  }
}

TEST(CertificateSmallCorners, beside_which_it_fits_as_well_are_not_said_to_be_the_only_place) {
  certificates::Json found = certificate_of(kTurn / 1.9);  // fits before and after it
  EXPECT_GT(certificates::count_of(found, "within"), 0U);
  for (certificates::Json& row : found["rows"]) {
    if (row["then"] == "within") row["then"] = "corner";
  }
  EXPECT_NE(certificates::checked(found).refusal, "");
}

}  // namespace
}  // namespace certificate_small_corners_test
