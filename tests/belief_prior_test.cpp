// A prior's product with what the rows say, by quadrature.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "belief_cases.hpp"

namespace belief_prior_test {
namespace {

using belief_cases::belief_in;
using rollfix::Belief;
using rollfix::BeliefOptions;
using rollfix::Density;
using rollfix::DensityPiece;
using rollfix::NoisyRoll;
using rollfix::Part;
using rollfix::Prior;

/// A density of offsets from a place, finer than its pieces: the logarithm is straight between their middles.
struct Fine {
  std::vector<double> offset;
  std::vector<double> below;  // as much of the probability, up to there
};

constexpr int kParts = 40;  // of each piece

/// `weight`: what the density is multiplied with, by the offset from the place.
template <class Weight>
Fine fine(const Density& density, double place, const Part& part, const Weight& weight) {
  struct Middle {
    double offset;
    double half;
    double height;
  };
  std::vector<Middle> middles;
  for (const DensityPiece& piece : density) {
    if (piece.s.width() <= 0 || piece.probability <= 0) continue;
    middles.push_back(
        {part.boundary().offset(place, piece.s.middle()), 0.5 * piece.s.width(), piece.probability / piece.s.width()});
  }
  std::sort(middles.begin(), middles.end(), [](const Middle& a, const Middle& b) { return a.offset < b.offset; });
  Fine fine;
  double sum = 0;
  for (std::size_t k = 0; k < middles.size(); ++k) {
    const Middle& here = middles[k];
    for (int n = 0; n < kParts; ++n) {
      const double x = here.half * ((2 * n + 1.0) / kParts - 1);
      const Middle& other = middles[x < 0 ? std::max<std::size_t>(k, 1) - 1 : std::min(k + 1, middles.size() - 1)];
      const double apart = std::abs(other.offset - here.offset);
      const bool is_beside = apart > 0 && apart < 1.01 * (here.half + other.half);
      const double rise = is_beside ? std::log(other.height / here.height) * std::abs(x) / apart : 0;
      fine.offset.push_back(here.offset + x);
      fine.below.push_back(sum += here.height * std::exp(rise) * here.half * weight(here.offset + x));
    }
  }
  for (double& share : fine.below) share /= sum;
  return fine;
}

double below(const Fine& fine, double offset) {
  const auto above = std::upper_bound(fine.offset.begin(), fine.offset.end(), offset) - fine.offset.begin();
  return above == 0 ? 0 : fine.below[static_cast<std::size_t>(above) - 1];
}

/// Where a share of it is below.
double quantile(const Fine& fine, double share) {
  const auto k = std::lower_bound(fine.below.begin(), fine.below.end(), share) - fine.below.begin();
  return fine.offset[std::min(static_cast<std::size_t>(k), fine.offset.size() - 1)];
}

/// A log, and what its rows say without a prior.
struct Case {
  Case(const std::string& shape, double share, double angle)
      : part(belief_cases::part_of(shape)), radius(0.03 * part.perimeter()) {
    const double P = part.perimeter();
    options.noise = belief_cases::noise_on(part, 1e-3, angle, 0);
    log = belief_cases::roll_on(part, radius, 0.23 * P, share * P, 40, options.noise, 3).log;
    Belief belief = belief_in(part, log, radius, options);
    rows_alone = belief.density()[0];
    mean = belief.modes().front().mean[0];
    sd = belief.modes().front().sd[0];
  }

  /// How far the answer is from the product, in shares of the probability: at the nine deciles.
  double off(const Prior& prior) const {
    BeliefOptions with = options;
    with.prior = prior;
    Belief belief = belief_in(part, log, radius, with);
    EXPECT_NEAR(belief.fit().widened, 1, 0.02);
    const Fine said = fine(belief.density()[0], prior.s, part, [](double) { return 1.0; });
    const Fine product = fine(rows_alone, prior.s, part,
                              [&](double offset) { return std::exp(-0.5 * offset * offset / (prior.sd * prior.sd)); });
    double most = 0;
    for (int decile = 1; decile < 10; ++decile) {
      const double share = 0.1 * decile;
      most = std::max(most, std::abs(below(said, quantile(product, share)) - share));
    }
    return most;
  }

  Part part;
  double radius;
  BeliefOptions options;
  rollfix::Log log;
  Density rows_alone;
  double mean = 0;
  double sd = 0;
};

}  // namespace

TEST(BeliefPrior, is_multiplied_with_what_the_rows_say_however_wide_it_is) {
  for (const char* shape : {"spline,seed=3", "cam", "limacon"}) {
    const Case rolled(shape, 0.05, 0.05);
    for (const double sd : {0.1, 0.3, 1.0, 3.0, 10.0}) {
      for (const double off : {-1.0, 0.0, 2.0}) {
        const Prior prior{rolled.mean + off * rolled.sd, sd * rolled.sd};
        EXPECT_LE(rolled.off(prior), 0.03) << shape << ": a prior " << sd << " times as wide, off by " << off;
      }
    }
  }
}

}  // namespace belief_prior_test
