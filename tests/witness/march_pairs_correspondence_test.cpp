// Section 3.2: which pairs of intervals are rejected, and the maximal subintervals x, y and w, z of the others.

#include <set>

#include "march_pairs_pieces.hpp"
#include "march_shapes.hpp"
#include "random.hpp"

namespace march_pairs_correspondence_test {
namespace {

using namespace rollfix::march;
using namespace march_shapes;
using march_pairs::Exhaustive;
using march_pairs::Pieces;
using march_pairs::PlantedWithin;
using rollfix::Outline;

/// A random question about an outline, and the values of (8) that the oracle has for it.
struct Question {
  Exhaustive oracle;
  PlantedWithin planted;
  Pieces pieces;

  Question(const Outline& outline, std::mt19937_64& generator)
      : oracle(outline), planted(oracle, generator), pieces(outline, oracle.perimeter(), planted.readings) {}

  double phi_1(double s) const { return oracle.phi(s, planted.readings[0].length[0]); }
  double phi_3(double t) const { return oracle.phi(t, planted.readings[0].length[1]) + planted.readings[0].turn; }
};

template <class Look>
void each_of_some(int stream, const Look& look) {
  auto generator = test_generator(static_cast<std::uint64_t>(stream));
  for (int round = 0; round < full_count(3); ++round) {
    for (const Outline& outline : {egg(), amoeba(), random_spline(generator, 9)}) {
      Question question(outline, generator);
      question.pieces.each(
          [&](const MonotoneInterval& i, const MonotoneInterval& j, const auto& way) { look(question, i, j, way); });
    }
  }
}

bool inside(double place, const MonotoneInterval& interval) {
  return place >= interval.lo.s() && place <= interval.hi.s();
}

TEST(MarchPairsCorrespondence, a_pair_of_intervals_is_rejected_if_and_only_if_their_values_have_nothing_in_common) {
  int rejected = 0;
  each_of_some(51, [&](const Question& q, const MonotoneInterval& i, const MonotoneInterval& j, const auto& way) {
    const auto [low_1, high_1] = std::minmax({q.phi_1(i.lo.s()), q.phi_1(i.hi.s())});
    const auto [low_3, high_3] = std::minmax({q.phi_3(j.lo.s()), q.phi_3(j.hi.s())});
    const double overlap = std::min(high_1, high_3) - std::max(low_1, low_3);
    if (std::fabs(overlap) > 1e-10) {
      EXPECT_EQ(way.has_value(), overlap > 0);
    }
    rejected += way ? 0 : 1;
  });
  EXPECT_GT(rejected, 100);
}

TEST(MarchPairsCorrespondence, equation_8_holds_at_both_ends) {
  each_of_some(52, [](const Question& q, const MonotoneInterval& i, const MonotoneInterval& j, const auto& way) {
    if (!way) return;
    EXPECT_NEAR(q.phi_1(way->x()), q.phi_3(way->w()), 1e-10);
    EXPECT_NEAR(q.phi_1(way->y()), q.phi_3(way->z()), 1e-10);
    EXPECT_TRUE(inside(way->x(), i) && inside(way->y(), i) && inside(way->w(), j) && inside(way->z(), j));
  });
}

TEST(MarchPairsCorrespondence, phi_1_and_phi_3_increase_from_x_to_y_and_from_w_to_z) {
  each_of_some(53, [](const Question& q, const auto&, const auto&, const auto& way) {
    if (!way || std::fabs(way->y() - way->x()) < 1e-4 || std::fabs(way->z() - way->w()) < 1e-4) return;
    EXPECT_LT(q.phi_1(way->x()), q.phi_1(way->y()));
    EXPECT_LT(q.phi_3(way->w()), q.phi_3(way->z()));
  });
}

TEST(MarchPairsCorrespondence, the_subintervals_are_maximal_in_all_sixteen_cases) {
  std::set<std::array<bool, 4>> cases;
  each_of_some(54, [&](const Question&, const MonotoneInterval& i, const MonotoneInterval& j, const auto& way) {
    if (!way) return;
    const bool x_is_end = way->x() == i.bottom().s();
    const bool y_is_end = way->y() == i.top().s();
    EXPECT_TRUE(x_is_end || way->w() == j.bottom().s());
    EXPECT_TRUE(y_is_end || way->z() == j.top().s());
    cases.insert({i.trend[0] > 0, j.trend[0] > 0, x_is_end, y_is_end});
  });
  EXPECT_EQ(cases.size(), 16U);
}

TEST(MarchPairsCorrespondence, figure_5_is_the_case_of_falling_phi_1_and_rising_phi_3) {
  int seen = 0;
  each_of_some(55, [&](const Question& q, const MonotoneInterval& i, const MonotoneInterval& j, const auto& way) {
    const bool falls_and_rises = i.trend[0] < 0 && j.trend[0] > 0;
    const double a = i.lo.s(), a_next = i.hi.s(), b = j.lo.s(), b_next = j.hi.s();
    if (!way || !falls_and_rises || q.phi_1(a_next) <= q.phi_3(b) || q.phi_1(a) <= q.phi_3(b_next)) return;
    ++seen;
    EXPECT_EQ(way->x(), a_next);
    EXPECT_EQ(way->z(), b_next);
    EXPECT_NEAR(q.phi_3(way->w()), q.phi_1(a_next), 1e-10);
    EXPECT_NEAR(q.phi_1(way->y()), q.phi_3(b_next), 1e-10);
    EXPECT_GT(way->x(), way->y());  // s decreases
    EXPECT_LT(way->w(), way->z());  // t increases
  });
  EXPECT_GT(seen, 5);
}

}  // namespace
}  // namespace march_pairs_correspondence_test
