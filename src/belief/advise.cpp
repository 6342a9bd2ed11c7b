#include "rollfix/belief/advise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

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
// What tells two places apart only in part, at this share of the squared distance that is wanted, is still gone for
// where nothing within the travel tells more.
constexpr double kInPart = 0.5;
// A roll counts as this much travel more, a share of the perimeter: to stop, to locate and to start again is not free.
constexpr double kOneRoll = 0.01;
// It leaves open at most this share of the probability that some roll can settle: the travel that is expected of a
// shorter one is too good, as it takes the finger to know when to turn round.
constexpr double kMostOpen = 0.9;
// Where no roll tells any two places apart, the advised roll gains at least this share of what the best one does ...
constexpr double kNearlyAll = 0.98;
// ... and leaves no more than this many placements more.
constexpr double kNearlyAsFew = 0.02;
// A roll that gains less than this share of the bits wanted is no help.
constexpr double kHelp = 0.05;
// Of a wide placement, what is nearer to each other than this share of the perimeter need not be told apart: a region
// of a posterior that is twice as long is called a stretch.
constexpr double kOnePlace = 0.05;
constexpr double kNever = std::numeric_limits<double>::infinity();

double entropy(const std::vector<double>& weights) {
  double bits = 0;
  for (const double p : weights) {
    if (p > 0) bits -= p * std::log2(p);
  }
  return bits;
}

double shortest_perimeter(const std::vector<PartContender>& contenders) {
  double shortest = kNever;
  for (const PartContender& one : contenders) shortest = std::min(shortest, one.part->perimeter());
  return shortest;
}

/// The lengths that every contender that counts can roll over.
Interval common_travel(const std::vector<PartContender>& contenders, const std::optional<Interval>& wanted) {
  const double shortest = shortest_perimeter(contenders);
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
    told_.assign(n * n, {kNever, kNever});
    for (const PartContender& one : contenders) start_.push_back(one.part->turning().at(one.contender.place));
  }

  /// Rolls on to x and says what is to be expected then.
  Prospect roll_to(double x) {
    compare_at(x);
    note_told(std::abs(x));
    return expected(x);
  }

  /// After which travel j is told from i, if i is the true one: for sure, and in part.
  const std::array<double, 2>& told(std::size_t i, std::size_t j) const { return told_[i * contenders_.size() + j]; }

 private:
  void compare_at(double x) {
    const std::size_t n = contenders_.size();
    std::vector<double> turn(n);
    std::vector<double> variance(n);
    const double length_variance = square(options_.length_sd) / options_.rows + square(options_.length_share_sd * x);
    for (std::size_t i = 0; i < n; ++i) {
      const auto& [part, reach, contender] = contenders_[i];
      const Turning now = part->turning().at(contender.place + x);
      turn[i] = now.angle - start_[i].angle;
      variance[i] = square(options_.turn_sd) / options_.rows + length_variance * square(now.curvature) +
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
  }

  void note_told(double travel) {
    const std::size_t n = contenders_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        std::array<double, 2>& told = told_[i * n + j];
        if (told[0] < kNever) continue;
        const double wanted =
            distance_wanted(contenders_[i].contender.probability, contenders_[j].contender.probability);
        const double distance = distance_[i * n + j];
        if (distance >= wanted) told[0] = travel;
        if (distance >= kInPart * wanted) told[1] = std::min(told[1], travel);
      }
    }
  }

  /// Squared: from there on a place is left with less probability, beside the true one, than counts.
  static double distance_wanted(double of_true, double of_other) {
    return 2 * std::log(std::max(of_other / (kContenderCounts * of_true), 1 + kContenderCounts));
  }

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
  std::vector<double> distance_;             // squared, of each pair
  std::vector<std::array<double, 2>> told_;  // of each pair, the first of which is the true one
  std::vector<Turning> start_;
};

/// What is still to be travelled after a roll, for the place where the contact is to be told from the others.
class Travel {
 public:
  Travel(const std::vector<PartContender>& contenders, const Comparison& back, const Comparison& forward)
      : contenders_(contenders), back_(back), forward_(forward) {
    const std::size_t n = contenders.size();
    others_.resize(n);
    for (const PartContender& one : contenders) of_label_[one.contender.label] += one.contender.probability;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) add_other(i, j);
    }
  }

  bool tells_any() const {
    return std::any_of(others_.begin(), others_.end(), [](const auto& others) { return !others.empty(); });
  }

  /// After a roll to x: what is to be expected until all are told apart that can be, this roll included. Which of the
  /// others is the true one is not known by whoever decides to roll on, or back: one way for all.
  double after(double x) const {
    double on = 0;
    double back = 0;
    for (std::size_t i = 0; i < contenders_.size(); ++i) {
      const auto [if_on, if_back] = left_after(i, x);
      on += contenders_[i].contender.probability * if_on;
      back += contenders_[i].contender.probability * if_back;
    }
    return std::abs(x) + std::min(on, back);
  }
  /// The probability that not all are told apart then.
  double open_after(double x) const {
    double open = 0;
    for (std::size_t i = 0; i < contenders_.size(); ++i) {
      if (is_open_after(i, x)) open += contenders_[i].contender.probability;
    }
    return open;
  }

 private:
  /// Another place, and the travel forward and back that tells it from a true one.
  struct Other {
    double forward = 0;
    double back = 0;
  };

  void add_other(std::size_t i, std::size_t j) {
    if (i == j || are_one_place(i, j) || !counts(j)) return;
    for (std::size_t how = 0; how < 2; ++how) {
      const Other other{forward_.told(i, j)[how], back_.told(i, j)[how]};
      if (std::min(other.forward, other.back) == kNever) continue;
      others_[i].push_back(other);
      return;
    }
  }

  /// Of one placement, which need not get narrower than that.
  bool are_one_place(std::size_t i, std::size_t j) const {
    const auto& [part, reach, one] = contenders_[i];
    const Contender& other = contenders_[j].contender;
    return one.label == other.label &&
           part->boundary().distance(one.place, other.place) < kOnePlace * part->perimeter();
  }

  bool counts(std::size_t j) const { return of_label_.at(contenders_[j].contender.label) >= kContenderCounts; }

  bool is_open_after(std::size_t i, double x) const {
    return std::any_of(others_[i].begin(), others_[i].end(), [&](const Other& other) {
      return x == 0 || (x > 0 ? other.forward : other.back) > std::abs(x);
    });
  }

  /// If i is the true one, the travel that is left: as far on as it takes and back only for what that alone tells, and
  /// the reverse.
  std::array<double, 2> left_after(std::size_t i, double x) const {
    const double rolled = std::abs(x);
    std::vector<Other> left;  // seen from here: those not told yet, on the same way and on the other one
    Other only{0, 0};         // ... those that one way alone tells
    for (Other other : others_[i]) {
      if (x < 0) std::swap(other.forward, other.back);
      if (x != 0 && other.forward <= rolled) continue;
      left.push_back(other);
      if (other.back == kNever) only.forward = std::max(only.forward, other.forward);
      if (other.forward == kNever) only.back = std::max(only.back, other.back);
    }
    if (left.empty()) return {0, 0};
    Other mostly_on = only;
    Other mostly_back = only;
    for (const Other& other : left) {
      if (other.back > only.back) mostly_on.forward = std::max(mostly_on.forward, other.forward);
      if (other.forward > only.forward) mostly_back.back = std::max(mostly_back.back, other.back);
    }
    return {shorter_way(mostly_on, rolled), shorter_way(mostly_back, rolled)};
  }

  /// To both ends, from a place that far ahead of where both are counted from.
  static double shorter_way(const Other& ends, double rolled) {
    const double on = std::max(ends.forward - rolled, 0.0);
    const double back = ends.back > 0 ? ends.back + rolled : 0;
    return on + back + std::min(on, back);
  }

  const std::vector<PartContender>& contenders_;
  const Comparison& back_;
  const Comparison& forward_;
  std::map<std::size_t, double> of_label_;  // probability
  std::vector<std::vector<Other>> others_;  // of each contender, those that can be told from it
};

void require_valid(const std::vector<PartContender>& contenders, const AdviceOptions& options) {
  if (contenders.empty()) throw InputError("advise: expected at least one place where the contact may be, found none");
  if (!(options.turn_sd > 0)) {
    throw InputError(fmt::format("advise: the turn's standard deviation is {}, expected one above 0", options.turn_sd));
  }
  if (!(options.rows > 0)) {
    throw InputError(
        fmt::format("advise: {} rows are read at about the same place, expected more than 0", options.rows));
  }
  if (options.travel && !(options.travel->lo <= 0 && options.travel->hi >= 0)) {
    throw InputError(fmt::format("advise: the travel goes from {} to {}, expected it to hold 0: where the finger is",
                                 options.travel->lo, options.travel->hi));
  }
}

/// Index of the roll after which, itself included, the least travel is to be expected, of those that may be enough.
std::size_t least_travel(const Travel& to_go, double one_roll, const std::vector<Prospect>& prospects) {
  std::vector<double> open;
  for (const Prospect& prospect : prospects) open.push_back(to_go.open_after(prospect.length));
  const double least_open = *std::min_element(open.begin(), open.end());
  std::size_t best = 0;
  double least = kNever;
  for (std::size_t k = 0; k < prospects.size(); ++k) {
    const double cost = prospects[k].travel + one_roll * (1 + open[k]);
    if (prospects[k].length == 0 || open[k] > least_open + kMostOpen * (1 - least_open) || cost >= least) continue;
    least = cost;
    best = k;
  }
  return best;
}

/// Index of the shortest roll that gains nearly as much as the best one.
std::size_t shortest_as_good_as(const Prospect& most, const std::vector<Prospect>& prospects, std::size_t here) {
  std::size_t best = here;
  for (std::size_t k = 0; k < prospects.size(); ++k) {
    const Prospect& prospect = prospects[k];
    const bool is_enough =
        prospect.bits >= kNearlyAll * most.bits && prospect.placements <= most.placements + kNearlyAsFew;
    if (!is_enough) continue;
    const bool is_first = best == here && here != k;
    if (is_first || std::abs(prospect.length) < std::abs(prospects[best].length)) best = k;
  }
  return best;
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
  const Travel to_go(contenders, back, forward);
  for (Prospect& prospect : advice.prospects) prospect.travel = to_go.after(prospect.length);
  advice.best = to_go.tells_any() ? least_travel(to_go, kOneRoll * shortest_perimeter(contenders), advice.prospects)
                                  : shortest_as_good_as(most, advice.prospects, here);
  advice.helps = most.bits > kHelp * advice.bits_wanted && advice.best != here;
  return advice;
}

}  // namespace rollfix
