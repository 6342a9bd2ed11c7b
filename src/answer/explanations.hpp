#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

// Which of the usual mistakes explains rows that fit badly, of a roll as of a hold: how trials are compared, and which
// are told. What is tried, and how, each room knows for itself.
// Notation:
//   chi^2, nu       squares of what the rows are off in standard deviations, and their degrees of freedom
//   k               sqrt(chi^2 / nu): rows as noisy as they are have the log evidence + chi^2 (1 - 1 / k^2) / 2 - nu
//                   log k
// Follows docs/belief.md, "What may be wrong".
namespace rollfix {

// An explanation with which the rows are off by this share of what they are without it is better, where none is right.
inline constexpr double kMuchBetter = 0.6;
// No more rows than this share, or this many, are outliers.
inline constexpr double kMostStrayShare = 0.05;
inline constexpr double kMostStray = 3;
// An explanation is the likelier one where its evidence is larger, in steps of this much of a logarithm: what is about
// as likely stays in the order of how common it is.
inline constexpr double kEvidenceStep = 6;
// ... and what is this much less likely than the likeliest is not worth a word.
inline constexpr double kFarLessLikely = 12;
// Rows that are this much less noisy than said are exact.
inline constexpr double kLeastNoise = 1e-3;
// Scales of lengths that are tried where each takes long: about 1, and a diameter for a radius; lengths are open about
// each by this standard deviation.
inline constexpr std::array<double, 9> kScalesAboutOne = {0.5, 0.79, 0.86, 0.93, 1.0, 1.08, 1.16, 1.26, 2.0};
inline constexpr double kOpenScale = 0.04;
// Slip of so much per length all along, and five times as much here and there, is rarely stated beforehand; the
// larger the rarer: the logarithm of the odds against it. The largest explains nearly anything, and takes long: it is
// tried where nothing else explains the rows.
struct RareSlip {
  double slip;
  double log_odds;
};
inline constexpr std::array<RareSlip, 2> kUnsaidSlips = {{{0.04, 6}, {0.2, 18}}};

/// Log evidence, with the noise scaled by k, as the rows themselves seem to have it: chi^2 becomes nu, and each of nu
/// degrees of freedom costs log k. So explanations with too much noise stated have no advantage.
inline double as_noisy_as_it_seems(double log_evidence, double chi_square, double freedom) {
  const double times = std::max(kLeastNoise, std::sqrt(chi_square / std::max(1.0, freedom)));
  const double less = 0.5 * chi_square * (1 - 1 / (times * times));
  return log_evidence + less - freedom * std::log(times);
}

/// A mistake without which the rows fit, or fit much better. `What`: Diagnosis or HoldDiagnosis.
template <class What>
struct Trial {
  What diagnosis;
  bool is_right = false;  // the rows fit
  double log_evidence = 0;
};

/// Whether the rows fit without one of these mistakes, by more than that they are noisier.
template <class What>
bool is_explained(const std::vector<Trial<What>>& trials) {
  return std::any_of(trials.begin(), trials.end(), [](const Trial<What>& trial) {
    return trial.is_right && trial.diagnosis.cause != decltype(What::cause)::noise;
  });
}

/// What is told of the trials, which stand in the order of how common mistakes are: those that explain the rows, else
/// those that fit better, the likeliest first.
template <class What>
std::vector<What> the_likeliest(std::vector<Trial<What>> trials,
                                std::size_t most = std::numeric_limits<std::size_t>::max()) {
  const auto steps_of = [](const Trial<What>& trial) { return std::round(trial.log_evidence / kEvidenceStep); };
  std::stable_sort(trials.begin(), trials.end(), [&](const Trial<What>& a, const Trial<What>& b) {
    return a.is_right != b.is_right ? a.is_right : steps_of(a) > steps_of(b);
  });
  std::vector<What> told;
  for (Trial<What>& trial : trials) {
    const Trial<What>& likeliest = trials.front();
    // Explanations that only fit better are not listed beside right ones.
    if (trial.is_right != likeliest.is_right || told.size() == most) break;
    if (trial.log_evidence > likeliest.log_evidence - kFarLessLikely) told.push_back(std::move(trial.diagnosis));
  }
  return told;
}

}  // namespace rollfix
