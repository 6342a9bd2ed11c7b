#include "advise/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "belief/posterior.hpp"
#include "locate/remaining.hpp"
#include "rollfix/turning_function.hpp"

// Notation:
//   i, j, p_i       places that are left, and their probabilities: Hypothesis
//   x               length of a roll on a way; y_i, V_i: the turn that place i would measure then, and its variance:
//                   Seen
//   d_ij^2          the largest (y_i - y_j)^2 / (V_i + V_j) on the way: `distance_`. The row's own noise is in both:
//                   exp(-d^2 / 2) is the mean of j's likelihood over what may be measured where i is true
//   q_j             p_j exp(-d_ij^2 / 2) over their sum: what j is worth where i is true: `posterior`
//   bits            H(p) - sum over i of p_i H(q), H being the entropy
//   f_ij, b_ij      the travel on and back that tells j from a true i: `told`, Other
//   left            where i is true, on to the last f and back to the last b, the shorter way twice: `shorter_way`
// Follows docs/belief.md, "The next roll", and docs/two_fingers.md, "The next roll".
// Idea: a roll is read all along, so that what has told two places apart stays told: their largest distance counts.
// Which place is the true one is not known by whoever decides to roll on or back: one way for all, by the mean of
// `left`.
namespace rollfix::advising {
namespace {

// Of two fingers: one alone, which is the least to do, both, or one half as far as the other.
constexpr std::array<std::array<double, 2>, 8> kWaysOfTwo = {
    {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {1, 0.5}, {1, -0.5}, {0.5, 1}, {-0.5, 1}}};
// Places along a way, to either side, at which it is looked whether two disks overlap.
constexpr std::size_t kLooks = 64;

/// The lengths over which this finger can roll in every hypothesis that counts.
Interval common_travel(const std::vector<PartHypothesis>& hypotheses, const std::optional<Interval>& wanted,
                       std::size_t finger) {
  // One lap either way, if nothing else is said.
  const double shortest = shortest_perimeter(hypotheses);
  Interval travel = wanted.value_or(Interval{-shortest, shortest});
  const double least = least_that_counts(hypotheses);
  for (const PartHypothesis& one : hypotheses) {
    if (one.hypothesis.probability < least) continue;
    const double place = one.hypothesis.place[finger];
    // An open part ends.
    if (!one.part->closed()) {
      travel.lo = std::max(travel.lo, -place);
      travel.hi = std::min(travel.hi, one.part->perimeter() - place);
    }
    // Within the arc of the part that holds the place; a place off every arc sets no bound, as it is not known better.
    const Reach* const reach = one.reach[finger];
    if (reach == nullptr || reach->whole_loop) continue;
    const std::optional<Interval> arc = reach->arc_at(place);
    if (!arc) continue;
    travel.lo = std::max(travel.lo, std::min(0.0, arc->lo - place));
    travel.hi = std::min(travel.hi, std::max(0.0, arc->hi - place));
  }
  return travel;
}

/// A disk's centre in the part's frame.
Vec2 disk_at(const Part& part, double s, double radius) {
  const double tangent = part.turning().angle(s);
  return part.point(s) + radius * Vec2(std::sin(tangent), -std::cos(tangent));
}

/// Whether two disks would be in one another after a roll to x from a hypothesis. Exact at x, nothing in between.
bool overlap(const PartHypothesis& one, const PerFinger<double>& disks, const Way& way, double x) {
  const auto centre = [&](std::size_t finger) {
    return disk_at(*one.part, one.hypothesis.place[finger] + x * way.direction[finger], disks[finger]);
  };
  return (centre(0) - centre(1)).norm() < disks[0] + disks[1];
}

/// As far as no hypothesis that counts has one disk in the other. Where they overlap from the start it is not known
/// better.
void stop_at_overlap(const std::vector<PartHypothesis>& hypotheses, const PerFinger<double>& disks, Way& way) {
  const double least = least_that_counts(hypotheses);
  for (const PartHypothesis& one : hypotheses) {
    if (one.hypothesis.probability < least || overlap(one, disks, way, 0)) continue;
    // From 0 outwards: the last step before the first overlap.
    for (double* const end : {&way.travel.lo, &way.travel.hi}) {
      const double whole = *end;
      for (std::size_t k = 1; k <= kLooks; ++k) {
        const double x = whole * static_cast<double>(k) / kLooks;
        if (!overlap(one, disks, way, x)) continue;
        *end = whole * static_cast<double>(k - 1) / kLooks;
        break;
      }
    }
  }
}

/// Over which both fingers have travel left.
Interval travel_on(const PerFinger<double>& direction, const std::array<Interval, 2>& each) {
  Interval travel{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const std::size_t finger : {0U, 1U}) {
    if (direction[finger] == 0) continue;
    // In x: each finger's travel over its share of the roll; a direction below 0 exchanges the ends.
    const double a = each[finger].lo / direction[finger];
    const double b = each[finger].hi / direction[finger];
    travel = {std::max(travel.lo, std::min(a, b)), std::min(travel.hi, std::max(a, b))};
  }
  return travel;
}

// What tells two places apart only in part, at this share of the squared distance that is wanted, is still gone for
// where nothing within the travel tells more.
constexpr double kInPart = 0.5;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Squared: from there on a place is left with less probability, beside the true one, than counts.
/// From p_other exp(-d^2 / 2) < kLeastProbability p_true. At least slightly above 0 where the other counts for nothing.
double distance_wanted(double of_true, double of_other) {
  return 2 * std::log(std::max(of_other / (kLeastProbability * of_true), 1 + kLeastProbability));
}

/// What has less probability, of these in any order, does not count.
double least_of(std::vector<double> probabilities) {
  std::sort(probabilities.begin(), probabilities.end(), std::greater<>());
  return rollfix::least_that_counts(probabilities);
}

/// Finger a's turn counts with this sign, finger b's with the other.
double sign_of(std::size_t finger) { return finger == 0 ? 1 : -1; }

// Of a wide placement, what is nearer to each other than this share of the perimeter need not be told apart: a region
// of a posterior that is twice as long is called a stretch.
constexpr double kOnePlace = 0.05;
constexpr double kNotTold = std::numeric_limits<double>::infinity();

}  // namespace

double least_that_counts(const std::vector<PartHypothesis>& hypotheses) {
  std::vector<double> each;
  for (const PartHypothesis& one : hypotheses) each.push_back(one.hypothesis.probability);
  return least_of(std::move(each));
}

/// Of two fingers kWaysOfTwo, each as far as both can roll; other motions as the options give them.
std::vector<Way> ways_of(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options) {
  if (options.foresees) {
    std::vector<Way> given;
    for (const auto& [direction, travel] : options.ways) given.push_back({direction, travel});
    return given;
  }
  // One finger has one way: on and back.
  const Interval of_a = common_travel(hypotheses, options.travel, 0);
  if (hypotheses.front().hypothesis.place.size() == 1) return {Way{1.0, of_a}};
  const std::array<Interval, 2> each = {of_a, common_travel(hypotheses, options.travel, 1)};
  std::vector<Way> ways;
  for (const std::array<double, 2>& direction : kWaysOfTwo) {
    Way way{direction, travel_on(direction, each)};
    if (options.disks) stop_at_overlap(hypotheses, *options.disks, way);
    ways.push_back(way);
  }
  return ways;
}

/// H in bits.
double entropy(const std::vector<double>& weights) {
  double bits = 0;
  for (const double p : weights) {
    if (p > 0) bits -= p * std::log2(p);
  }
  return bits;
}

double shortest_perimeter(const std::vector<PartHypothesis>& hypotheses) {
  double shortest = kNever;
  for (const PartHypothesis& one : hypotheses) shortest = std::min(shortest, one.part->perimeter());
  return shortest;
}

Comparison::Comparison(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options,
                       const PerFinger<double>& direction)
    : hypotheses_(hypotheses), options_(options), direction_(direction) {
  const std::size_t n = hypotheses.size();
  distance_.assign(n * n, 0);
  // not told at any travel yet
  told_.assign(n * n, {kNever, kNever});
  for (const PartHypothesis& one : hypotheses) {
    PerFinger<Turning>& start = start_.emplace_back(PerFinger<Turning>::of(direction.size()));
    for (std::size_t k = 0; k < direction.size(); ++k) start[k] = one.part->turning().at(one.hypothesis.place[k]);
  }
}

/// Places on the way are asked for in order, from 0 outwards: what was told stays told.
ExpectedGain Comparison::roll_to(double x) {
  compare_at(x);
  note_told(std::abs(x));
  return expected(x);
}

/// What this hypothesis would read at x, and how badly that is known.
Comparison::Seen Comparison::seen_by(std::size_t hypothesis, double x) const {
  const PartHypothesis& one = hypotheses_[hypothesis];
  if (options_.foresees) {
    const Foreseen foreseen = options_.foresees(one, Way{direction_, {}}.rolled(x));
    return {foreseen.value, foreseen.variance};
  }
  // The turn's own error, averaged over the rows read at about the same place.
  Seen seen{0, belief::square(options_.turn_sd) / options_.rows};
  PerFinger<double> by_place = PerFinger<double>::of(direction_.size());
  for (std::size_t k = 0; k < direction_.size(); ++k) {
    const double length = x * direction_[k];
    // y_i = Theta(p_i + x) - Theta(p_i): what this place would measure.
    const Turning now = one.part->turning().at(one.hypothesis.place[k] + length);
    const Turning& start = start_[hypothesis][k];
    seen.turn += sign_of(k) * (now.angle - start.angle);
    // d turn / d place
    by_place[k] = sign_of(k) * (now.curvature - start.curvature);
    // A length that is off turns the tangent by kappa times as much; a place that is off, by kappa at the end less that
    // at the start.
    seen.variance +=
        (belief::square(options_.length_sd) / options_.rows + belief::square(options_.length_share_sd * length)) *
            belief::square(now.curvature) +
        belief::square(one.hypothesis.sd[k] * by_place[k]);
  }
  // The places of both fingers are off together.
  if (direction_.size() == 2) seen.variance += 2 * by_place[0] * by_place[1] * one.hypothesis.covariance;
  return seen;
}

/// Adds x to the distances: d_ij^2 only grows.
void Comparison::compare_at(double x) {
  const std::size_t n = hypotheses_.size();
  std::vector<Seen> seen;
  seen.reserve(n);
  for (std::size_t i = 0; i < n; ++i) seen.push_back(seen_by(i, x));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double squared = belief::square(seen[i].turn - seen[j].turn) / (seen[i].variance + seen[j].variance);
      double& most = distance_[i * n + j];
      most = std::max(most, squared);
      distance_[j * n + i] = most;
    }
  }
}

/// Notes the travel for each pair (i, j) the first time that its distance is enough: in full, and in part.
void Comparison::note_told(double travel) {
  const std::size_t n = hypotheses_.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      // [0] for sure, [1] in part
      std::array<double, 2>& told = told_[i * n + j];
      if (told[0] < kNever) continue;
      const double wanted =
          distance_wanted(hypotheses_[i].hypothesis.probability, hypotheses_[j].hypothesis.probability);
      const double distance = distance_[i * n + j];
      if (distance >= wanted) told[0] = travel;
      if (distance >= kInPart * wanted) told[1] = std::min(told[1], travel);
    }
  }
}

/// bits and placements, each the mean over the place that is the true one.
ExpectedGain Comparison::expected(double x) const {
  const std::size_t n = hypotheses_.size();
  std::vector<double> prior(n);
  // one more than the largest label
  std::size_t labels = 0;
  for (std::size_t i = 0; i < n; ++i) {
    prior[i] = hypotheses_[i].hypothesis.probability;
    labels = std::max(labels, hypotheses_[i].hypothesis.label + 1);
  }
  ExpectedGain gain{x, 0, entropy(prior)};
  // q_j, and their sums over each placement
  std::vector<double> posterior(n);
  std::vector<double> of_label(labels);
  for (std::size_t i = 0; i < n; ++i) {
    // Hypothesis i is the true one: what the others are worth then.
    double total = 0;
    for (std::size_t j = 0; j < n; ++j) total += posterior[j] = prior[j] * std::exp(-0.5 * distance_[i * n + j]);
    std::fill(of_label.begin(), of_label.end(), 0);
    for (std::size_t j = 0; j < n; ++j) {
      posterior[j] /= total;
      of_label[hypotheses_[j].hypothesis.label] += posterior[j];
    }
    // What is left of the entropy if i is the true one, weighed by p_i.
    gain.bits -= prior[i] * entropy(posterior);
    // Placements and not hypotheses: of a wide placement several places are one.
    const double least = least_of(of_label);
    // how many placements remain if i is the true one
    const auto counts = std::count_if(of_label.begin(), of_label.end(), [&](double p) { return p >= least; });
    gain.placements += prior[i] * static_cast<double>(counts);
  }
  return gain;
}

/// The lists of all places that have to be told from each true one, with the travel that tells them.
WayToTell::WayToTell(const std::vector<PartHypothesis>& hypotheses, const Comparison& back, const Comparison& forward)
    : hypotheses_(hypotheses), back_(back), forward_(forward) {
  const std::size_t n = hypotheses.size();
  others_.resize(n);
  // Probabilities of placements: whether one counts is decided by the placement, not by its parts.
  for (const PartHypothesis& one : hypotheses) of_label_[one.hypothesis.label] += one.hypothesis.probability;
  std::vector<double> each;
  for (const auto& [label, probability] : of_label_) each.push_back(probability);
  least_ = least_of(std::move(each));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) add_other(i, j);
  }
}

bool WayToTell::tells_any() const {
  return std::any_of(others_.begin(), others_.end(), [](const auto& others) { return !others.empty(); });
}

/// The mean over the true place, first on and then back, or the reverse: whoever decides does not know which it is.
double WayToTell::after(double x) const {
  double on = 0;
  double back = 0;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    const auto [if_on, if_back] = left_after(i, x);
    on += hypotheses_[i].hypothesis.probability * if_on;
    back += hypotheses_[i].hypothesis.probability * if_back;
  }
  return std::abs(x) + std::min(on, back);
}

double WayToTell::open_after(double x) const {
  double open = 0;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    if (is_open_after(i, x)) open += hypotheses_[i].hypothesis.probability;
  }
  return open;
}

bool WayToTell::matters(std::size_t i, std::size_t j) const { return i != j && !are_one_place(i, j) && counts(j); }

/// For sure, if some travel tells it so; else in part; else it can't be told on this way and is left out.
void WayToTell::add_other(std::size_t i, std::size_t j) {
  if (!matters(i, j)) return;
  for (std::size_t how = 0; how < 2; ++how) {
    const Other other{forward_.told(i, j)[how], back_.told(i, j)[how]};
    if (std::min(other.forward, other.back) == kNotTold) continue;
    others_[i].push_back(other);
    return;
  }
}

/// Of one placement, which need not get narrower than that.
bool WayToTell::are_one_place(std::size_t i, std::size_t j) const {
  const Part& part = *hypotheses_[i].part;
  const Hypothesis& one = hypotheses_[i].hypothesis;
  const Hypothesis& other = hypotheses_[j].hypothesis;
  // Two placements always have to be told apart, however near to each other.
  if (one.label != other.label) return false;
  for (std::size_t k = 0; k < one.place.size(); ++k) {
    if (part.boundary().distance(one.place[k], other.place[k]) >= kOnePlace * part.perimeter()) return false;
  }
  return true;
}

/// On the side that was rolled: what the other side would tell is still open.
bool WayToTell::is_open_after(std::size_t i, double x) const {
  return std::any_of(others_[i].begin(), others_[i].end(),
                     [&](const Other& other) { return x == 0 || (x > 0 ? other.forward : other.back) > std::abs(x); });
}

/// If i is the true one, the travel that is left: as far on as it takes and back only for what that alone tells, and
/// the reverse.
std::array<double, 2> WayToTell::left_after(std::size_t i, double x) const {
  const double rolled = std::abs(x);
  std::vector<Other> left;  // seen from here: those not told yet, on the same way and on the other one
  Other only{0, 0};         // ... those that one way alone tells
  for (Other other : others_[i]) {
    // Seen in the direction of the roll, `forward` is on.
    if (x < 0) std::swap(other.forward, other.back);
    if (x != 0 && other.forward <= rolled) continue;
    left.push_back(other);
    if (other.back == kNotTold) only.forward = std::max(only.forward, other.forward);
    if (other.forward == kNotTold) only.back = std::max(only.back, other.back);
  }
  if (left.empty()) return {0, 0};
  // Both ends have to be visited for `only`. What either way tells is added to the one end, and to the other.
  Other mostly_on = only;
  Other mostly_back = only;
  for (const Other& other : left) {
    if (other.back > only.back) mostly_on.forward = std::max(mostly_on.forward, other.forward);
    if (other.forward > only.forward) mostly_back.back = std::max(mostly_back.back, other.back);
  }
  return {shorter_way(mostly_on, rolled), shorter_way(mostly_back, rolled)};
}

/// To both ends, from a place that far ahead of where both are counted from.
/// The way to the nearer end counts twice: there and back.
double WayToTell::shorter_way(const Other& ends, double rolled) {
  // Both ends are counted from where the roll began; the finger is `rolled` ahead of it, and has that much back to go.
  const double on = std::max(ends.forward - rolled, 0.0);
  const double back = ends.back > 0 ? ends.back + rolled : 0;
  return on + back + std::min(on, back);
}

}  // namespace rollfix::advising
