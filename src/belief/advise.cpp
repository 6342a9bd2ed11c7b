#include "rollfix/belief/advise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "belief/posterior.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part/boundary.hpp"

namespace rollfix {

namespace {

using belief::square;

// Lengths that are looked at, each way.
constexpr std::size_t kSteps = 400;
// A wide placement is this many contenders.
constexpr std::size_t kOfAWidePlacement = 15;
// One is wide from this share of the perimeter on.
constexpr double kWidePlacement = 1e-3;
// A mode is wide from this standard deviation on, a share of the perimeter: it is this many contenders then, at the
// quantiles 1/14, 3/14, ... of a normal distribution.
constexpr double kWideSpread = 0.005;
constexpr std::array<double, 7> kSevenDeviates = {-1.465, -0.792, -0.366, 0, 0.366, 0.792, 1.465};
// A contender with less probability is not waited for, nor counted among those that remain.
constexpr double kContenderCounts = 0.01;
// The advised roll gains at least this share of what the best one does ...
constexpr double kNearlyAll = 0.98;
// ... and leaves no more than this many placements more.
constexpr double kNearlyAsFew = 0.02;
// A roll that gains less than this share of the bits wanted is no help.
constexpr double kHelp = 0.05;

double entropy(const std::vector<double>& weights) {
  double bits = 0;
  for (const double p : weights) {
    if (p > 0) bits -= p * std::log2(p);
  }
  return bits;
}

/// The lengths that every contender that counts can roll over.
Interval common_travel(const std::vector<PartContender>& contenders, const std::optional<Interval>& wanted) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const PartContender& one : contenders) shortest = std::min(shortest, one.part->perimeter());
  Interval travel = wanted.value_or(Interval{-shortest, shortest});
  for (const auto& [part, reach, contender] : contenders) {
    if (contender.probability < kContenderCounts && contenders.size() > 1) continue;
    if (!part->closed()) {
      travel.lo = std::max(travel.lo, -contender.place);
      travel.hi = std::min(travel.hi, part->perimeter() - contender.place);
    }
    if (reach == nullptr || reach->whole_loop) continue;
    const std::optional<Interval> arc = reach->arc_at(contender.place);
    if (!arc) continue;
    travel.lo = std::max(travel.lo, std::min(0.0, arc->lo - contender.place));
    travel.hi = std::min(travel.hi, std::max(0.0, arc->hi - contender.place));
  }
  return travel;
}

/// Contenders compared while they roll one way: the largest distances so far.
class Comparison {
 public:
  Comparison(const std::vector<PartContender>& contenders, const AdviceOptions& options)
      : contenders_(contenders), options_(options) {
    const std::size_t n = contenders.size();
    distance_.assign(n * n, 0);
    for (const PartContender& one : contenders) start_.push_back(one.part->turning().at(one.contender.place));
  }

  /// Rolls on to x and says what is to be expected then.
  Prospect roll_to(double x) {
    const std::size_t n = contenders_.size();
    std::vector<double> turn(n);
    std::vector<double> variance(n);
    const double length_variance = square(options_.length_sd) + square(options_.length_share_sd * x);
    for (std::size_t i = 0; i < n; ++i) {
      const auto& [part, reach, contender] = contenders_[i];
      const Turning now = part->turning().at(contender.place + x);
      turn[i] = now.angle - start_[i].angle;
      variance[i] = square(options_.turn_sd) + length_variance * square(now.curvature) +
                    square(contender.sd * (now.curvature - start_[i].curvature));
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double squared = square(turn[i] - turn[j]) / (variance[i] + variance[j]);
        double& most = distance_[i * n + j];
        most = std::max(most, squared);
        distance_[j * n + i] = most;
      }
    }
    return expected(x);
  }

 private:
  Prospect expected(double x) const {
    const std::size_t n = contenders_.size();
    std::vector<double> prior(n);
    for (std::size_t i = 0; i < n; ++i) prior[i] = contenders_[i].contender.probability;
    Prospect prospect{x, 0, entropy(prior)};
    std::vector<double> left(n);
    for (std::size_t i = 0; i < n; ++i) {
      // Contender i is the true one: what the others are worth then.
      double total = 0;
      for (std::size_t j = 0; j < n; ++j) total += left[j] = prior[j] * std::exp(-0.5 * distance_[i * n + j]);
      std::vector<double> of_label;
      for (std::size_t j = 0; j < n; ++j) {
        left[j] /= total;
        const std::size_t label = contenders_[j].contender.label;
        if (label >= of_label.size()) of_label.resize(label + 1, 0);
        of_label[label] += left[j];
      }
      prospect.bits -= prior[i] * entropy(left);
      const auto counts =
          std::count_if(of_label.begin(), of_label.end(), [](double p) { return p >= kContenderCounts; });
      prospect.placements += prior[i] * static_cast<double>(counts);
    }
    return prospect;
  }

  const std::vector<PartContender>& contenders_;
  const AdviceOptions& options_;
  std::vector<double> distance_;  // squared, of each pair
  std::vector<Turning> start_;
};

void require_valid(const std::vector<PartContender>& contenders, const AdviceOptions& options) {
  if (contenders.empty()) throw InputError("advise: expected at least one place where the contact may be, found none");
  if (!(options.turn_sd > 0)) {
    throw InputError(fmt::format("advise: the turn's standard deviation is {}, expected one above 0", options.turn_sd));
  }
  if (options.travel && !(options.travel->lo <= 0 && options.travel->hi >= 0)) {
    throw InputError(fmt::format("advise: the travel goes from {} to {}, expected it to hold 0: where the finger is",
                                 options.travel->lo, options.travel->hi));
  }
}

bool is_better(const Prospect& one, const Prospect& other) {
  if (one.placements != other.placements) return one.placements < other.placements;
  return one.bits > other.bits;
}

/// All alike, of a wide placement several.
std::vector<Contender> without_noise(const Part& part, const std::vector<Placement>& placements) {
  const double P = part.perimeter();
  std::vector<Contender> contenders;
  for (std::size_t k = 0; k < placements.size(); ++k) {
    const Interval& extent = placements[k].extent[0];
    const double end = placements[k].end[0];
    const double share = 1 / static_cast<double>(placements.size());
    const double rolled = end - placements[k].start[0];
    if (extent.width() < kWidePlacement * P) {
      contenders.push_back({end, 0, share, k});
      continue;
    }
    for (std::size_t i = 0; i < kOfAWidePlacement; ++i) {
      const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(kOfAWidePlacement);
      const double s = extent.lo + t * extent.width() + rolled;
      contenders.push_back({part.boundary().on_first_lap(s), 0, share / static_cast<double>(kOfAWidePlacement), k});
    }
  }
  return contenders;
}

/// `Remaining`: a placement or a mode, of which the samples say how probable it is.
template <class Remaining>
std::vector<Contender> with_noise(const Part& part, const std::vector<Remaining>& all) {
  std::vector<Contender> contenders;
  double total = 0;
  for (const Remaining& one : all) total += one.probability;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double mean = all[k].end_mean[0];
    const double sd = all[k].end_sd[0];
    const double share = all[k].probability / total;
    if (sd < kWideSpread * part.perimeter()) {
      contenders.push_back({mean, sd, share, k});
      continue;
    }
    // As many places of the same probability, as if it were normal.
    for (const double deviate : kSevenDeviates) {
      const double s = mean + deviate * sd;
      const double place = part.boundary().base(s);
      contenders.push_back({place, sd / kSevenDeviates.size(), share / kSevenDeviates.size(), k});
    }
  }
  return contenders;
}

}  // namespace

std::vector<Contender> contenders_of(const Part& part, const std::vector<Placement>& placements) {
  const bool has_noise = !placements.empty() && !std::isnan(placements.front().probability);
  return has_noise ? with_noise(part, placements) : without_noise(part, placements);
}

std::vector<Contender> contenders_of(const Part& part, const std::vector<Mode>& modes) {
  return with_noise(part, modes);
}

Advice advise(const Part& part, const std::vector<Contender>& contenders, const AdviceOptions& options) {
  std::vector<PartContender> on_part;
  for (const Contender& contender : contenders) on_part.push_back({&part, options.reach, contender});
  return advise(on_part, options);
}

Advice advise(const std::vector<PartContender>& contenders, const AdviceOptions& options) {
  require_valid(contenders, options);
  const Interval travel = common_travel(contenders, options.travel);
  Advice advice;
  std::vector<double> prior;
  for (const PartContender& one : contenders) prior.push_back(one.contender.probability);
  advice.bits_wanted = entropy(prior);

  Comparison back(contenders, options);
  for (std::size_t k = 1; k <= kSteps && travel.lo < 0; ++k) {
    advice.prospects.push_back(back.roll_to(travel.lo * static_cast<double>(k) / kSteps));
  }
  std::reverse(advice.prospects.begin(), advice.prospects.end());
  Comparison forward(contenders, options);
  const std::size_t here = advice.prospects.size();
  for (std::size_t k = 0; k <= kSteps && (k == 0 || travel.hi > 0); ++k) {
    advice.prospects.push_back(forward.roll_to(travel.hi * static_cast<double>(k) / kSteps));
  }

  Prospect most = advice.prospects[here];
  for (const Prospect& prospect : advice.prospects) {
    if (is_better(prospect, most)) most = prospect;
  }
  advice.best = here;
  for (std::size_t k = 0; k < advice.prospects.size(); ++k) {
    const Prospect& prospect = advice.prospects[k];
    const bool is_enough =
        prospect.bits >= kNearlyAll * most.bits && prospect.placements <= most.placements + kNearlyAsFew;
    if (!is_enough) continue;
    const bool is_first = advice.best == here && here != k;
    if (is_first || std::abs(prospect.length) < std::abs(advice.advised().length)) advice.best = k;
  }
  advice.helps = most.bits > kHelp * advice.bits_wanted && advice.best != here;
  return advice;
}

}  // namespace rollfix
