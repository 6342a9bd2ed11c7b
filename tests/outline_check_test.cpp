// check(outline) finds what a curve's author got wrong, in any of the gallery's shapes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

namespace outline_check_test {
namespace {

using rollfix::check;
using rollfix::Curve;
using rollfix::gallery;
using rollfix::GalleryShape;
using rollfix::Interval;
using rollfix::Jet;
using rollfix::Line;
using rollfix::Outline;
using rollfix::Vec2;
using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A curve with a bump added to one derivative that the derivative below knows nothing of.
struct WrongDerivative {
  Curve right;
  int order;

  Interval domain() const { return right.domain(); }
  Jet jet(double u) const {
    Jet jet = right.jet(u);
    const double width = domain().width();
    const Vec2 bump = 1e-4 * jet.first.norm() / std::pow(width, order - 1) * Vec2(1, 1);
    (order == 1 ? jet.first : order == 2 ? jet.second : jet.third) += bump;
    return jet;
  }
};

/// The same points by a parameter v with u = middle + v^3: all derivatives are right, and the first vanishes at v = 0.
struct Standstill {
  Curve regular;

  double reach() const { return std::cbrt(0.5 * regular.domain().width()); }
  Interval domain() const { return {-reach(), reach()}; }
  Jet jet(double v) const {
    const Jet j = regular.jet(regular.domain().middle() + v * v * v);
    const double u1 = 3 * v * v, u2 = 6 * v, u3 = 6;
    return {j.position, u1 * j.first, u2 * j.first + u1 * u1 * j.second,
            u3 * j.first + 3 * u1 * u2 * j.second + u1 * u1 * u1 * j.third};
  }
};

struct Shifted {
  Curve original;
  Vec2 offset;

  Interval domain() const { return original.domain(); }
  Jet jet(double u) const {
    Jet jet = original.jet(u);
    jet.position += offset;
    return jet;
  }
};

/// y = x^2, with one derivative that is not a number at the end.
struct HoleAtTheEnd {
  Interval domain() const { return {0, 1}; }
  Jet jet(double u) const {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {{u, u * u}, {1, 2 * u}, {0, 2}, {0, u == 1 ? nan : 0}};
  }
};

struct WrongVelocity {
  Line line;
  Interval domain() const { return line.domain(); }
  Jet jet(double u) const { return line.jet(u); }
  Vec2 velocity(double u) const { return 2 * line.velocity(u); }
};

Outline open_outline(std::vector<Curve> curves) { return {"test", std::move(curves), false, false}; }

class CheckOfShape : public testing::TestWithParam<GalleryShape> {
 protected:
  Outline outline_ = gallery(GetParam().name);
};

INSTANTIATE_TEST_SUITE_P(Gallery, CheckOfShape, testing::ValuesIn(rollfix::gallery_shapes()),
                         [](const testing::TestParamInfo<GalleryShape>& shape) {
                           std::string name = shape.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST_P(CheckOfShape, finds_a_wrong_third_derivative) {
  outline_.curves.back() = WrongDerivative{outline_.curves.back(), 3};
  EXPECT_THAT(check(outline_), ElementsAre(AllOf(HasSubstr("the third derivative is ("),
                                                 HasSubstr("but differences of the second derivative give ("))));
}

TEST_P(CheckOfShape, finds_a_wrong_second_derivative) {
  outline_.curves.front() = WrongDerivative{outline_.curves.front(), 2};
  EXPECT_THAT(check(outline_), testing::Contains(HasSubstr("curve 0 at u = ")));
  EXPECT_THAT(check(outline_), testing::Contains(HasSubstr("the second derivative is (")));
}

TEST_P(CheckOfShape, finds_a_wrong_first_derivative) {
  outline_.curves.front() = WrongDerivative{outline_.curves.front(), 1};
  EXPECT_THAT(check(outline_), testing::Contains(HasSubstr("but differences of the position give (")));
}

TEST_P(CheckOfShape, finds_a_cusp) {
  outline_.curves.back() = Standstill{outline_.curves.back()};
  EXPECT_THAT(check(outline_), ElementsAre(HasSubstr("expected it not to vanish")));
}

TEST_P(CheckOfShape, finds_a_gap) {
  // Twice the curve, the second time a little off: it fits to neither end of the first.
  outline_.curves.push_back(Shifted{outline_.curves.front(), Vec2(1e-9, 0)});
  EXPECT_THAT(check(outline_), testing::Contains(AllOf(HasSubstr("a gap of "), HasSubstr("the end of curve "),
                                                       HasSubstr("the start of curve "))));
}

TEST_P(CheckOfShape, accepts_it_reversed) {
  const Outline backwards = reversed(outline_);
  EXPECT_TRUE(backwards.reversed);
  EXPECT_EQ(backwards.name, outline_.name);
  EXPECT_THAT(check(backwards), IsEmpty());
}

TEST(Check, gap_is_given_with_its_size_and_place) {
  const Outline outline = open_outline({Line({0, 0}, {1, 0}), Line({1, 0.25}, {1, 1})});
  EXPECT_THAT(check(outline),
              ElementsAre("a gap of 0.25 between the end of curve 0 at (1, 0) and the start of curve 1 at (1, 0.25)"));
}

TEST(Check, open_ends_need_not_meet) {
  Outline outline = open_outline({Line({0, 0}, {1, 0}), Line({1, 0}, {1, 1})});
  EXPECT_THAT(check(outline), IsEmpty());
  outline.closed = true;
  EXPECT_THAT(check(outline),
              ElementsAre(HasSubstr("the end of curve 1 at (1, 1) and the start of curve 0 at (0, 0)")));
}

TEST(Check, value_that_is_not_finite_is_found_at_an_end) {
  EXPECT_THAT(check(open_outline({HoleAtTheEnd{}})),
              ElementsAre("curve 0 at u = 1: the position or a derivative is not finite"));
}

TEST(Check, velocity_must_be_the_first_derivative) {
  EXPECT_THAT(check(open_outline({WrongVelocity{Line({0, 0}, {1, 0})}})),
              ElementsAre(HasSubstr("velocity(u) is (2, 0), but jet(u).first is (1, 0)")));
}

TEST(Check, outline_without_curves_is_refused) {
  EXPECT_THAT(check(open_outline({})), ElementsAre(HasSubstr("no curves")));
}

TEST(Check, outline_far_from_the_origin_is_accepted) {
  Outline outline = gallery("ellipse");
  outline.curves[0] = Shifted{outline.curves[0], Vec2(1e6, -1e6)};
  EXPECT_THAT(check(outline), IsEmpty());
}

}  // namespace
}  // namespace outline_check_test
