#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "belief/posterior.hpp"
#include "locate/remaining.hpp"
#include "part/turning_range.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "text/text.hpp"
#include "weights.hpp"

// Notation, as in docs/identify.md:
//   evidence        of a part, from its belief: `peak` and `volume`, the latter less log P of each finger (any place
//                   alike)
//   widened         by how much the rows are further off than was said, on the part that they fit best: `best_of`
//   log weight      log evidence, with that noise, + log of how many of the part there are: `log_weight`
//   probability     weight over the sum of all weights; below exp(-`kNothing`) of the likeliest it is 0
//   congruent       Theta of both parts agrees at `kPlaces` places, but for the lengths and turns that Likeness allows
// Follows docs/identify.md; the evidence is docs/belief.md, "What the verdict says".
// Idea: of all that fit the verdict counts those that can't be neglected; parts that no roll can tell apart are one
// answer. The next roll is advised over all their places together, each weighed by its part's probability.
namespace rollfix::catalog {
namespace {

// Places that are compared: a difference between two of them is not seen.
constexpr int kPlaces = 512;

/// Whether two outlines turn alike from these places on. At kPlaces places of one, the other's Theta, within `near` of
/// the same share of the perimeter, holds this angle, but for the allowed turn. Perimeters may differ: places are
/// scaled.
bool agree(const Part& one, double from, const Part& other, double other_from, const Likeness& likeness) {
  const TurningFunction& a = one.turning();
  const TurningFunction& b = other.turning();
  const double P = one.perimeter();
  // Congruent parts may differ in size by what the roll can't show.
  const double scale = other.perimeter() / P;
  const double near = likeness.length + kSameScale * P;
  // Both start in one direction: a part may lie turned.
  const double lift = b.angle(other_from) - a.angle(from);
  for (int k = 0; k < kPlaces; ++k) {
    const double x = (k + 0.5) / kPlaces * P;
    const double at = other_from + x * scale;
    const Interval arc{at - near, at + near};
    // Bounds on an arc, because near a corner the angle itself says nothing.
    const Interval angles = angles_over(b, one.closed() ? arc : other.boundary().arc(arc.lo, arc.hi));
    const double angle = a.angle(from + x) + lift;
    if (angle < angles.lo - likeness.turn || angle > angles.hi + likeness.turn) return false;
  }
  return true;
}

}  // namespace

bool are_congruent(const Part& one, const std::vector<double>& from, const Part& other,
                   const std::vector<double>& other_from, const Likeness& likeness) {
  if (one.closed() != other.closed() || one.corners().size() != other.corners().size()) return false;
  // A roll of length L shows a scale difference as off L. Below the noise of a contact it can't be seen.
  const double off = std::abs(other.perimeter() / one.perimeter() - 1);  // the scale
  if (off > kSameScale && off * likeness.roll > likeness.length) return false;
  // Open outlines have their own beginning.
  if (!one.closed()) return agree(one, 0, other, 0, likeness);
  // Where a closed outline begins is arbitrary: the places that were found on both are where they have to agree.
  return std::any_of(from.begin(), from.end(), [&](double place) {
    return std::any_of(other_from.begin(), other_from.end(),
                       [&](double other_place) { return agree(one, place, other, other_place, likeness); });
  });
}

namespace {

// A part with less probability is not listed, and counts in `rest`. Beside a likeliest part that is itself improbable
// the bound is smaller: see conclude.
constexpr double kLeastPartProbability = 1e-6;

/// log(exp(a) + exp(b) + ...).
double log_of_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  // All of them are impossible.
  if (!std::isfinite(most)) return most;
  double sum = 0;
  for (const double each : logs) sum += std::exp(each - most);
  return most + std::log(sum);
}

/// With noise: the probability of each, as with the noise that the rows seem to have on the part that they fit best.
/// Below exp(-kNothing) of the likeliest it is 0, so that it makes no difference whether the part was looked at
/// closely.
std::vector<double> probabilities(const Catalog& catalog, const std::vector<PartWeight>& weights) {
  const double widened = best_of(weights).widened;
  std::vector<double> logs;
  for (const PartWeight& weight : weights) logs.push_back(log_weight(catalog, weight, widened));
  const double most = *std::max_element(logs.begin(), logs.end());
  for (double& each : logs) {
    if (each < most - kNothing) each = -std::numeric_limits<double>::infinity();
  }
  const double all = log_of_sum(logs);
  // Of impossible parts alone none is probable.
  for (double& each : logs) each = std::isfinite(all) ? std::exp(each - all) : 0;
  return logs;
}

/// What is known of the one part that is left, by a roll.
std::string words_for_one(const PartWeight& weight) {
  if (weight.verdict.rfind("unobservable", 0) == 0) return "any place";
  return weight.places == 1 ? "unique place" : counted(weight.places, "place", "places");
}

/// The verdict in words: how many parts remain, and whether these are congruent. "undecided": nothing fits, and a
/// search is incomplete.
std::string verdict_of(const Conclusion& conclusion, const std::vector<PartWeight>& weights, const Wording& wording) {
  const std::size_t count = how_many_remain(conclusion.order, [&](std::size_t k) { return conclusion.probability[k]; });
  // No part remains.
  if (count == 0) return conclusion.status == Status::incomplete ? "undecided" : "none";
  const PartWeight& first = weights[conclusion.order.front()];
  const std::string badly = first.fits_badly ? wording.badly : "";
  if (count == 1) return fmt::format("unique part, {}{}", wording.of_one(first), badly);
  // All others that remain are congruent to the likeliest one.
  const bool alike = conclusion.congruent[conclusion.order.front()].size() + 1 >= count;
  return fmt::format("{} {}{}", count, alike ? "congruent parts" : "parts", badly);
}

/// Of those that are listed, which can't be told apart.
void compare(const Catalog& catalog, const std::vector<PartWeight>& weights, const Likeness& likeness,
             Conclusion& conclusion) {
  conclusion.congruent.resize(weights.size());
  // Sorted by perimeter: beyond this scale no pair can be congruent, so that the inner loop ends soon. O(n^2) only of
  // parts of one size.
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

/// Without noise peak and volume stay as they are: nothing is weighed.
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
    // Fit first: a part whose rows are less noisy than another's goes before it, whatever its likelihood; the peak
    // decides between parts that fit alike.
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

/// Lists, counts and compares. Without noise every part that fits is listed, in the catalog's order.
Conclusion conclude(const Catalog& catalog, const std::vector<PartWeight>& weights, std::size_t searched,
                    const Likeness& likeness, const Wording& wording) {
  Conclusion conclusion;
  conclusion.probability.assign(weights.size(), std::numeric_limits<double>::quiet_NaN());
  if (likeness.noisy && !weights.empty()) conclusion.probability = probabilities(catalog, weights);
  // NaN without noise: fmax passes it over.
  double likeliest = 0;
  for (const double each : conclusion.probability) likeliest = std::fmax(likeliest, each);
  const double least = std::min(kLeastPartProbability, kLeastProbability * likeliest);
  // With noise: its probability is not 0, so it is at least exp(-kNothing) of the likeliest one's.
  const auto counts = [&](std::size_t k) { return !likeness.noisy || conclusion.probability[k] > 0; };
  std::size_t counted = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!counts(k)) continue;
    ++counted;
    if (weights[k].undecided) conclusion.status = Status::incomplete;
    // An undecided part counts for the status, and is listed only if something fits.
    const bool is_listed = weights[k].fits && (!likeness.noisy || conclusion.probability[k] >= least);
    if (is_listed) {
      conclusion.order.push_back(k);
    } else if (likeness.noisy) {
      conclusion.rest += conclusion.probability[k];
    }
  }
  if (likeness.noisy && counted > 0) {
    // Each part that was searched and has no probability here may still have up to exp(-kNothing).
    conclusion.rest += static_cast<double>(searched - counted) * std::exp(-kNothing);
  }
  // By falling probability; of equal ones, and without noise, by the catalog's order.
  std::sort(conclusion.order.begin(), conclusion.order.end(), [&](std::size_t a, std::size_t b) {
    if (likeness.noisy && conclusion.probability[a] != conclusion.probability[b]) {
      return conclusion.probability[a] > conclusion.probability[b];
    }
    return weights[a].part < weights[b].part;
  });
  compare(catalog, weights, likeness, conclusion);
  conclusion.verdict = verdict_of(conclusion, weights, wording);
  return conclusion;
}

namespace {

// More places are not compared with each other: the likeliest, which hold nearly all of the probability, are.
constexpr std::size_t kMostPlaces = 200;

/// Places of all parts as hypotheses of one question: each probability is that of the part times that of the place on
/// it, and they add up to 1. Labels are counted through, so that no two placements share one.
std::vector<NextRollOfParts::Place> weighed_places(const Identified& found) {
  std::vector<NextRollOfParts::Place> places;
  std::size_t labels = 0;
  const double all_alike = 1 / static_cast<double>(found.parts.size());
  double total = 0;
  // The likeliest parts first; a part's places are taken all or none.
  for (std::size_t k = 0; k < found.parts.size() && labels < kMostPlaces; ++k) {
    const PartFound& one = found.parts[k];
    // Without noise all parts are as probable.
    const double part_probability = std::isnan(one.probability) ? all_alike : one.probability;
    for (Hypothesis hypothesis : hypotheses_of(one.answer.part, one.answer.placements)) {
      hypothesis.probability *= part_probability;
      hypothesis.label += labels;
      total += hypothesis.probability;
      places.push_back({k, hypothesis});
    }
    labels += one.answer.placements.size();
  }
  for (NextRollOfParts::Place& place : places) place.hypothesis.probability /= total;
  return places;
}

/// Why no roll tells them apart.
std::string why_no_roll(const Identified& found) {
  const bool alike = !found.parts.empty() && found.parts.front().congruent.size() + 1 >= found.parts.size();
  return alike && found.parts.size() > 1 ? "the parts that remain are congruent"
                                         : "within the travel what remains looks alike";
}

}  // namespace

}  // namespace rollfix::catalog

namespace rollfix {

NextRollOfParts next_roll(const Identified& found, const std::optional<Interval>& travel) {
  NextRollOfParts next;
  if (found.parts.empty()) {
    next.why = "nothing fits: there is nothing to tell apart";
    return next;
  }
  for (const PartFound& one : found.parts) {
    for (const Placement& placement : one.answer.placements) {
      // A roll along a direction that is not known can't be advised.
      if (placement.clockwise) throw InputError("advise: expected one direction of the roll, found either");
    }
  }
  next.places = catalog::weighed_places(found);
  // Nothing to tell apart.
  if (found.verdict.rfind("unique part, unique place", 0) == 0) {
    next.why = "there is only one part and one place left";
    return next;
  }
  std::vector<ReachForAdvice> reaches;
  for (const PartFound& one : found.parts) reaches.emplace_back(one.answer);
  std::vector<PartHypothesis> hypotheses;
  for (const NextRollOfParts::Place& place : next.places) {
    hypotheses.push_back({&found.parts[place.part].answer.part, reaches[place.part].pointers(), place.hypothesis});
  }
  AdviceOptions options = advice_options(found.parts.front().answer, travel);
  options.disks = disks_for_advice(found.parts.front().answer, false);
  next.advice = advise(hypotheses, options);
  if (!next.advice->helps) {
    next.why = catalog::why_no_roll(found);
    return next;
  }
  // What each place would measure on the advised roll.
  for (NextRollOfParts::Place& place : next.places) {
    place.turn_ahead = turn_ahead(found.parts[place.part].answer.part, place.hypothesis, next.advice->lengths());
  }
  return next;
}

}  // namespace rollfix
