#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "corner_fingers.hpp"
#include "random.hpp"
#include "rollfix/part.hpp"
#include "rollfix/solve.hpp"

// Noisy rolls of fingers with corners: whether the intervals hold the truth as often as they say. The simulator steps
// along the part by its points and tangents alone, and pivots wherever a corner of the polygon comes up.
namespace finger_corners_coverage_test {

using corner_fingers::Polygon;
using rollfix::Noise;
using rollfix::Part;

struct Rolled {
  rollfix::Log log;
  std::vector<double> s;  // of each row
};

class Simulation {
 public:
  Simulation(const Part& part, const Polygon& polygon, const Noise& noise, std::mt19937_64& generator)
      : part_(part), polygon_(polygon), noise_(noise), generator_(generator), slip_(normal(noise.slip)) {}

  /// From s with u on the finger, over this length; below 0 backwards.
  Rolled run(double s, double u, double length) {
    const double way = length > 0 ? 1 : -1;
    const double step = std::abs(length) / 60;
    s_ = s;
    u_ = u;
    normal_ = polygon_.normal(u);
    tangent_ = corner_fingers::tangent_of(part_, s);
    record();
    for (double left = std::abs(length); left > 0;) {
      const double to_corner = (1 + slip_) * gap(way);
      const double here = std::min(step, to_corner);
      s_ += way * here;
      u_ -= way * here / (1 + slip_);
      left -= here;
      follow_tangent();
      record();
      if (here == to_corner) pivot(way);
    }
    rolled_.log.fingers[0].u_period = polygon_.around();
    return rolled_;
  }

 private:
  double normal(double sd) { return sd > 0 ? std::normal_distribution<double>(0, sd)(generator_) : 0; }
  /// How far u has to go to the next corner.
  double gap(double way) const {
    double least = polygon_.around();
    for (const double place : polygon_.places()) {
      const double off = std::fmod(way * (u_ - place) + 3 * polygon_.around(), polygon_.around());
      if (off > 1e-9) least = std::min(least, off);
    }
    return least;
  }
  void follow_tangent() {
    tangent_ += std::remainder(corner_fingers::tangent_of(part_, s_) - tangent_, 2 * std::numbers::pi);
  }
  void pivot(double way) {
    constexpr int kRows = 12;
    const double before = polygon_.normal(u_ + way * 1e-7);
    const double after = polygon_.normal(u_ - way * 1e-7);
    const double turn = std::remainder(after - before, 2 * std::numbers::pi);
    for (int k = 0; k < kRows; ++k) {
      normal_ += turn / kRows;
      record();
    }
  }
  void record() {
    rolled_.s.push_back(s_);
    rolled_.log.fingers[0].u.push_back(u_ + normal(noise_.contact));
    rolled_.log.fingers[0].psi.push_back(tangent_ + std::numbers::pi / 2 - normal_ + normal(noise_.angle));
  }

  const Part& part_;
  const Polygon& polygon_;
  Noise noise_;
  std::mt19937_64& generator_;
  double slip_;
  double s_ = 0;
  double u_ = 0;
  double normal_ = 0;
  double tangent_ = 0;
  Rolled rolled_;
};

/// Rows from this one to the one before that.
Rolled between(Rolled rolled, std::size_t first, std::size_t last) {
  const auto cut = [&](std::vector<double>& column) {
    column.erase(column.begin() + static_cast<long>(last), column.end());
    column.erase(column.begin(), column.begin() + static_cast<long>(first));
  };
  cut(rolled.s);
  cut(rolled.log.fingers[0].u);
  cut(rolled.log.fingers[0].psi);
  return rolled;
}

/// Every n-th row alone.
Rolled thinned(const Rolled& rolled, std::size_t every) {
  Rolled few{rolled.log, {}};
  rollfix::FingerRows& rows = few.log.fingers[0];
  rows.u.clear();
  rows.psi.clear();
  for (std::size_t k = 0; k < rolled.s.size(); k += every) {
    few.s.push_back(rolled.s[k]);
    rows.u.push_back(rolled.log.fingers[0].u[k]);
    rows.psi.push_back(rolled.log.fingers[0].psi[k]);
  }
  return few;
}

/// Whether at least two rows are surely off the corners: else the log is refused.
bool is_taken(const Rolled& rolled, const Polygon& polygon, const Noise& noise) {
  const std::vector<double>& u = rolled.log.fingers[0].u;
  return std::count_if(u.begin(), u.end(), [&](double at) { return polygon.gap_to_corner(at) > 5 * noise.contact; }) >
         1;
}

struct Tally {
  int cases = 0;
  int listed = 0;
  int held = 0;
  int ends = 0;
  int first = 0;
  int others = 0;  // that are listed besides
  double claimed = 0;
  int wrong = 0;  // unique, and elsewhere
  int bad = 0;    // said to contradict their noise
  int on_corner = 0;

  void add(const rollfix::Answer& answer, const Rolled& rolled) {
    const Part& part = answer.part;
    ++cases;
    on_corner += answer.corner_rows.first ? 1 : 0;
    bad += answer.verdict.fits_badly || answer.placements.empty() ? 1 : 0;
    if (!answer.placements.empty()) claimed += answer.placements.front().probability;
    const rollfix::Placement* found = nullptr;
    for (const rollfix::Placement& placement : answer.placements) {
      if (part.distance(placement.mean[0], rolled.s.front()) < 6 * placement.sd[0]) found = &placement;
    }
    wrong += found == nullptr && answer.verdict.name == rollfix::Verdict::unique ? 1 : 0;
    if (found == nullptr) return;
    ++listed;
    others += static_cast<int>(answer.placements.size()) - 1;
    first += found == answer.placements.data() ? 1 : 0;
    held += found->contains(part.boundary(), part.boundary().canonical(rolled.s.front())) ? 1 : 0;
    ends += part.distance(found->end_mean[0], rolled.s.back()) < 1.96 * found->end_sd[0] ? 1 : 0;
  }

  /// Within four standard deviations of a count, and three in a hundred.
  void expect_calibrated(const std::string& what) const {
    const double count = listed;
    std::printf(
        "%s: %d of %d listed, %d of them start on a corner; within 95 %%: starts %.1f %%, ends %.1f %%; first %.1f %%, "
        "claimed %.1f %%; others listed %d; unique and wrong %d; contradictions %d\n",
        what.c_str(), listed, cases, on_corner, 100 * held / count, 100 * ends / count, 100 * first / count,
        100 * claimed / cases, others, wrong, bad);
    const double spread = 4 * std::sqrt(0.05 * 0.95 / count) + 0.03;
    EXPECT_GE(listed, cases - 1 - cases / 50);
    EXPECT_NEAR(held / count, 0.95, spread);
    EXPECT_NEAR(ends / count, 0.95, spread);
    EXPECT_LE(wrong, cases / 100);
    EXPECT_LE(bad, 1 + cases / 100);
  }
};

void expect_calibrated_on(const std::string& name, const Noise& noise_by_perimeter, std::size_t every = 1) {
  const Part part = rollfix::load_part(name);
  const double P = part.perimeter();
  Noise noise = noise_by_perimeter;
  noise.contact *= P;
  std::mt19937_64 generator = test_generator(7);
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(generator); };
  Tally tally;
  for (int k = 0; tally.cases < test_count(60); ++k) {
    const double size = P * uniform(0.03, 0.08);
    const Polygon polygon = k % 3 == 0 ? corner_fingers::chamfered(size) : corner_fingers::square(size);
    const double length = P * uniform(0.2, 0.7) * (k % 2 == 0 ? 1 : -1);
    Rolled rolled =
        Simulation(part, polygon, noise, generator).run(uniform(0, P), uniform(0, polygon.around()), length);
    rolled = between(rolled, generator() % 20, rolled.s.size() - generator() % 10);
    rolled = thinned(rolled, every);
    if (!is_taken(rolled, polygon, noise)) continue;
    tally.add(rollfix::solve({part, rolled.log, {polygon.finger()}, noise}), rolled);
  }
  tally.expect_calibrated(name);
}

constexpr Noise kUsual{.contact = 0.001, .angle = 0.005, .slip = 0.003};
constexpr Noise kNoSlip{.contact = 0.0005, .angle = 0.003};
constexpr std::size_t kFew = 12;  // every twelfth row: 6 to 14 of them

TEST(FingerCornersCoverage, an_ellipse) { expect_calibrated_on("gallery:ellipse", kUsual); }
TEST(FingerCornersCoverage, a_cam) { expect_calibrated_on("gallery:cam", kUsual); }
TEST(FingerCornersCoverage, a_limacon) { expect_calibrated_on("gallery:limacon,a=1,b=0.4", kUsual); }
TEST(FingerCornersCoverage, an_ellipse_with_few_rows) { expect_calibrated_on("gallery:ellipse", kUsual, kFew); }
TEST(FingerCornersCoverage, a_cam_with_few_rows) { expect_calibrated_on("gallery:cam", kUsual, kFew); }
TEST(FingerCornersCoverage, a_limacon_with_few_rows) {
  expect_calibrated_on("gallery:limacon,a=1,b=0.4", kUsual, kFew);
}
TEST(FingerCornersCoverage, a_cam_without_slip) { expect_calibrated_on("gallery:cam", kNoSlip); }
TEST(FingerCornersCoverage, a_limacon_without_slip) { expect_calibrated_on("gallery:limacon,a=1,b=0.4", kNoSlip); }

}  // namespace finger_corners_coverage_test
