#include "steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "explanations.hpp"
#include "rollfix/error.hpp"

// Notation:
//   k               lengths are k times what was measured: `scale`, of one finger or of both
//   chi^2(k)        of a few rows, k being open about its value by a standard deviation of `kOpenScale`: `by_cost`
//   valley          a k that fits no worse than its neighbours
// Follows docs/belief.md, "What may be wrong".
// Idea: scales are tried so near together that the true one is within reach of an open scale about one of them. From
// the best valleys on each belief says by how much more lengths are off, until it says none.
namespace rollfix::answer {
namespace {

// Scales of lengths are tried as far apart as this, each with an open scale about it of `kOpenScale`.
constexpr double kScaleStep = 1.08;
// From a thousandth of what was measured, a unit that is taken for another, to where the turn forbids it.
constexpr double kLeastScale = 0.9e-3;
constexpr double kMostScale = 1.1e3;
// Of two fingers' lengths: units that are taken for others, beside `kScalesAboutOne`.
constexpr std::array<double, 8> kUnitsOfTwo = {1 / 25.4, 0.1, 10.0, 25.4, 0.001, 1000., 0.01, 100.0};
// ... with which the longest roll is between these, in perimeters: shorter ones say nothing, longer ones nobody rolls.
constexpr double kLeastRollOfTwo = 0.01;
constexpr double kMostRollOfTwo = 8;
// A disk that would be less than half as large, and so small that a contact's error turns its normal by more than this,
// tells nothing and fits everywhere; radians.
constexpr double kMostNormalNoise = 0.15;
constexpr double kMuchSmaller = 0.5;
// Beyond what Theta's own range allows, radians: noise.
constexpr double kTurnBeyond = 0.5;
constexpr double kTurnSigmas = 6;
// Scales that are looked at with all rows.
constexpr std::size_t kScalesToCompare = 5;
// Those only that fit so many times as badly as the best one, give or take as much as there are rows.
constexpr double kCloseCost = 3;
constexpr int kMostSteps = 6;
// A step of the scale that is this much of its standard deviation is the last one.
constexpr double kSmallStep = 0.2;

bool is_of(const Whose& whose, std::size_t finger) { return !whose || *whose == finger; }

/// Lengths this many times as long: of a disk with a radius that is.
Problem with_lengths(const Problem& problem, const Whose& whose, double scale) {
  Problem scaled = problem;
  if (whose && scaled.fingers.size() == 1) scaled.fingers.push_back(scaled.fingers.front());
  for (std::size_t k = 0; k < scaled.fingers.size(); ++k) {
    Finger& finger = scaled.fingers[k];
    if (is_of(whose, k) && finger.is_disk()) finger = disk(scale * finger.disk()->radius);
  }
  return scaled;
}

/// All lengths k times as long, of the rows and of those searched with.
Observation with_lengths(const Observation& observed, const Whose& whose, double scale) {
  Observation scaled = observed;
  for (std::vector<Reading>* readings : {&scaled.readings, &scaled.rolls}) {
    for (Reading& reading : *readings) {
      for (std::size_t k = 0; k < reading.length.size(); ++k) {
        if (is_of(whose, k)) reading.length[k] *= scale;
      }
    }
  }
  return scaled;
}

/// Of two fingers the geometric mean.
double common_scale(const PerFinger<double>& scale) {
  if (scale.size() == 1) return scale[0];
  return std::sqrt(scale[0] * scale[1]);
}

}  // namespace

/// Scales k at which chi^2(k) of some rows has a local minimum: the best few, and none that is far worse than the best.
std::vector<double> LengthScales::worth_a_look(const Whose& whose) const {
  std::vector<std::pair<double, double>> by_cost;
  for (const double scale : all(whose)) {
    std::optional<Belief> belief = belief_with(whose, scale, kRowsToCompare);
    // A scale with which the rows are no roll at all has no belief.
    if (belief && std::isfinite(belief->fit().chi_square)) by_cost.emplace_back(belief->fit().chi_square, scale);
  }
  std::sort(by_cost.begin(), by_cost.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<std::pair<double, double>> valleys;
  for (std::size_t k = 0; k < by_cost.size(); ++k) {
    // The neighbours in the order of scale; at either end there is one only.
    const bool is_valley = (k == 0 || by_cost[k - 1].first >= by_cost[k].first) &&
                           (k + 1 == by_cost.size() || by_cost[k + 1].first >= by_cost[k].first);
    if (is_valley) valleys.push_back(by_cost[k]);
  }
  std::sort(valleys.begin(), valleys.end());
  if (valleys.size() > kScalesToCompare) valleys.resize(kScalesToCompare);
  std::vector<double> found;
  for (const auto& [cost, scale] : valleys) {
    // The number of rows is added, so that among good fits chance does not decide.
    if (cost <= kCloseCost * (valleys.front().first + kRowsToCompare)) found.push_back(scale);
  }
  return found;
}

/// The scales to try. One finger: in equal ratios, all that the turn allows. Two fingers, whose search takes longer: a
/// fixed list about 1 and of mistaken units.
std::vector<double> LengthScales::all(const Whose& whose) const {
  std::vector<double> scales;
  if (rows_felt(problem_, observed_).front().fingers() == 2) {
    scales.assign(kScalesAboutOne.begin(), kScalesAboutOne.end());
    // One finger's unit is the other's as well.
    if (!whose) scales.insert(scales.end(), kUnitsOfTwo.begin(), kUnitsOfTwo.end());
    std::erase_if(scales, [&](double scale) { return !may_be_of_two(scale) || !tells_normals(whose, scale); });
    return scales;
  }
  for (double scale = kLeastScale; scale < kMostScale; scale *= kScaleStep) {
    if (may_be(scale) && tells_normals(whose, scale)) scales.push_back(scale);
  }
  return scales;
}

bool LengthScales::tells_normals(const Whose& whose, double scale) const {
  if (scale >= kMuchSmaller) return true;
  for (std::size_t k = 0; k < problem_.fingers.size(); ++k) {
    const Finger& finger = problem_.fingers[k];
    if (!is_of(whose, k) || !finger.is_disk() || !problem_.noise) continue;
    if (problem_.noise->contact > kMostNormalNoise * scale * finger.disk()->radius) return false;
  }
  return true;
}

/// The longest roll must be of a plausible number of laps.
bool LengthScales::may_be_of_two(double scale) const {
  double longest = 0;
  for (const Reading& row : rows_felt(problem_, observed_)) {
    for (const double length : row.length) longest = std::max(longest, std::abs(length));
  }
  const double laps = scale * longest / problem_.part.perimeter();
  return laps >= kLeastRollOfTwo && laps <= kMostRollOfTwo;
}

/// Whether lengths can be k times as long. On a closed outline Theta grows by a whole turn a lap and leaves that
/// straight line by a bounded amount, so that L and theta confine each other; on an open one no roll is longer than the
/// outline.
bool LengthScales::may_be(double scale) const {
  const std::vector<Reading>& rows = rows_felt(problem_, observed_);
  const TurningFunction& turning = problem_.part.turning();
  const double P = problem_.part.perimeter();
  if (turn_beyond_ < 0) {
    // Theta less its average growth, at the ends of all spirals: a rough range, with `kTurnBeyond` to spare.
    double lo = 0;
    double hi = 0;
    const double per_length = turning.period_turn() / P;
    for (const Spiral& spiral : turning.spirals()) {
      for (const double off :
           {spiral.start.angle - per_length * spiral.lo, spiral.end.angle - per_length * spiral.hi}) {
        lo = std::min(lo, off);
        hi = std::max(hi, off);
      }
    }
    // Both ends of a roll may be anywhere in that range.
    turn_beyond_ = 2 * (hi - lo) + kTurnBeyond + kTurnSigmas * problem_.noise->angle;
  }
  if (!problem_.part.closed()) {
    return std::all_of(rows.begin(), rows.end(),
                       [&](const Reading& row) { return std::abs(row.length[0]) * scale <= 1.1 * P; });
  }
  return std::all_of(rows.begin(), rows.end(), [&](const Reading& row) {
    return std::abs(row.turn - turning.period_turn() * row.length[0] * scale / P) <= turn_beyond_;
  });
}

/// Fixed-point iteration: each belief estimates the factor that is left, which multiplies the scale. It ends when the
/// factor is 1 to a share of its standard deviation, or after `kMostSteps`.
std::optional<SettledScale> LengthScales::settled(const Whose& whose, double scale) const {
  std::optional<Belief> belief;
  Fit fit;
  for (int step = 0; step < kMostSteps; ++step) {
    belief = belief_with(whose, scale, rows_felt(problem_, observed_).size());
    if (!belief) return std::nullopt;
    fit = belief->fit();
    const double by = whose ? fit.length_scale[*whose] : common_scale(fit.length_scale);
    const double sd = std::max(fit.length_scale_sd[whose.value_or(0)], 1e-12);
    scale *= by;
    // What is far off everywhere asks for any scale.
    if (!(scale >= kLeastScale / kScaleStep && scale <= kMostScale * kScaleStep)) return std::nullopt;
    if (!tells_normals(whose, scale)) return std::nullopt;
    if (std::abs(by - 1) < kSmallStep * sd) break;
  }
  return SettledScale{scale, scale * fit.length_scale_sd[whose.value_or(0)], *std::move(belief)};
}

/// `rows`: about so many. Nothing where no log can be so.
std::optional<Belief> LengthScales::belief_with(const Whose& whose, double scale, std::size_t rows) const {
  try {
    return believe(with_lengths(problem_, whose, scale), with_lengths(observed_, whose, scale),
                   {kOpenScale, rows, true, {}, true, {}, whose});
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace rollfix::answer
