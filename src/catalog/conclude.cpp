#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "belief/posterior.hpp"
#include "congruent.hpp"
#include "text/text.hpp"
#include "weights.hpp"

namespace rollfix {
namespace {

// What is less probable is not listed.
constexpr double kLeastPartProbability = 1e-6;

/// log(exp(a) + exp(b) + ...).
double log_of_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  if (!std::isfinite(most)) return most;
  double sum = 0;
  for (const double each : logs) sum += std::exp(each - most);
  return most + std::log(sum);
}

/// With noise: the probability of each, as with the noise that the rows seem to have on the part that they fit best.
/// Next to nothing is 0, so that it makes no difference whether it was looked at closely.
std::vector<double> probabilities(const Catalog& catalog, const std::vector<PartWeight>& weights) {
  const double widened = best_of(weights).widened;
  std::vector<double> logs;
  for (const PartWeight& weight : weights) logs.push_back(log_weight(catalog, weight, widened));
  const double most = *std::max_element(logs.begin(), logs.end());
  for (double& each : logs) {
    if (each < most - kNothing) each = -std::numeric_limits<double>::infinity();
  }
  const double all = log_of_sum(logs);
  for (double& each : logs) each = std::isfinite(all) ? std::exp(each - all) : 0;
  return logs;
}

std::string words_for_one(const PartWeight& weight) {
  if (weight.verdict.rfind("unobservable", 0) == 0) return "any place";
  return weight.places == 1 ? "unique place" : counted(weight.places, "place", "places");
}

std::string verdict_of(const Conclusion& conclusion, const std::vector<PartWeight>& weights, bool noisy,
                       const Wording& wording) {
  std::vector<std::size_t> that_count;
  for (const std::size_t k : conclusion.order) {
    if (!noisy || conclusion.probability[k] >= belief::kCounts) that_count.push_back(k);
  }
  if (that_count.empty()) return conclusion.status == Status::incomplete ? "undecided" : "none";
  const PartWeight& first = weights[that_count.front()];
  const std::string badly = first.fits_badly ? wording.badly : "";
  const bool is_one =
      that_count.size() == 1 || (noisy && conclusion.probability[that_count.front()] >= belief::kCertain);
  if (is_one) return fmt::format("unique part, {}{}", wording.of_one(first), badly);
  const bool alike = conclusion.congruent[that_count.front()].size() + 1 >= that_count.size();
  return fmt::format("{} {}{}", that_count.size(), alike ? "congruent parts" : "parts", badly);
}

/// Of those that are listed, which can't be told apart.
void compare(const Catalog& catalog, const std::vector<PartWeight>& weights, const Likeness& likeness,
             Conclusion& conclusion) {
  conclusion.congruent.resize(weights.size());
  const double most_scale = likeness.roll > 0 ? likeness.length / likeness.roll : 0;
  std::vector<std::size_t> listed = conclusion.order;
  const auto perimeter = [&](std::size_t k) { return catalog.entry(weights[k].part).perimeter; };
  std::sort(listed.begin(), listed.end(), [&](std::size_t a, std::size_t b) { return perimeter(a) < perimeter(b); });
  for (std::size_t i = 0; i < listed.size(); ++i) {
    for (std::size_t j = i + 1; j < listed.size(); ++j) {
      const PartWeight& a = weights[listed[i]];
      const PartWeight& b = weights[listed[j]];
      if (perimeter(listed[j]) > perimeter(listed[i]) * (1 + most_scale + kSameScale)) break;
      if (!are_congruent(catalog.part(a.part), a.starts, catalog.part(b.part), b.starts, likeness)) continue;
      conclusion.congruent[listed[i]].push_back(b.part);
      conclusion.congruent[listed[j]].push_back(a.part);
    }
  }
}

}  // namespace

const Wording kOfRolls{&words_for_one, ", but the rows fit badly"};

PartWeight weight_of(std::size_t part, const Answer& answer) {
  PartWeight weight;
  weight.part = part;
  weight.verdict = answer.verdict.text();
  weight.undecided = answer.status == Status::incomplete;
  weight.fits_badly = answer.verdict.fits_badly;
  weight.places = answer.placements.size();
  weight.fits = !answer.placements.empty();
  if (!weight.fits) return weight;
  for (const Placement& placement : answer.placements) weight.starts.push_back(placement.start[0]);
  if (!answer.weighing) return weight;
  weight.peak = answer.weighing->evidence.peak;
  // Anywhere on the boundary alike: of two fingers, each.
  weight.volume =
      answer.weighing->evidence.volume - static_cast<double>(answer.finger_count()) * std::log(answer.part.perimeter());
  weight.widened = answer.weighing->fit.widened;
  weight.excess = answer.weighing->fit.excess;
  return weight;
}

const PartWeight& best_of(const std::vector<PartWeight>& weights) {
  return *std::min_element(weights.begin(), weights.end(), [](const PartWeight& a, const PartWeight& b) {
    return a.excess != b.excess ? a.excess < b.excess : a.peak > b.peak;
  });
}

double log_weight(const Catalog& catalog, const PartWeight& weight, double widened) {
  return Evidence{weight.peak, weight.volume}.with(widened) + std::log(catalog.entry(weight.part).count);
}

bool fits_well(const std::vector<PartWeight>& weights) {
  return std::any_of(weights.begin(), weights.end(),
                     [](const PartWeight& one) { return !one.widely && one.fits && !one.fits_badly; });
}

Conclusion conclude(const Catalog& catalog, const std::vector<PartWeight>& weights, std::size_t searched,
                    const Likeness& likeness, const Wording& wording) {
  Conclusion conclusion;
  conclusion.probability.assign(weights.size(), std::numeric_limits<double>::quiet_NaN());
  if (likeness.noisy && !weights.empty()) conclusion.probability = probabilities(catalog, weights);
  const auto counts = [&](std::size_t k) { return !likeness.noisy || conclusion.probability[k] > 0; };
  std::size_t counted = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!counts(k)) continue;
    ++counted;
    if (weights[k].undecided) conclusion.status = Status::incomplete;
    const bool is_listed = weights[k].fits && (!likeness.noisy || conclusion.probability[k] >= kLeastPartProbability);
    if (is_listed) {
      conclusion.order.push_back(k);
    } else if (likeness.noisy) {
      conclusion.rest += conclusion.probability[k];
    }
  }
  if (likeness.noisy && counted > 0) {
    conclusion.rest += static_cast<double>(searched - counted) * std::exp(-kNothing);
  }
  std::sort(conclusion.order.begin(), conclusion.order.end(), [&](std::size_t a, std::size_t b) {
    if (likeness.noisy && conclusion.probability[a] != conclusion.probability[b]) {
      return conclusion.probability[a] > conclusion.probability[b];
    }
    return weights[a].part < weights[b].part;
  });
  compare(catalog, weights, likeness, conclusion);
  conclusion.verdict = verdict_of(conclusion, weights, likeness.noisy, wording);
  return conclusion;
}

}  // namespace rollfix
