#include "steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "belief/posterior.hpp"
#include "locate/remaining.hpp"

// Lengths that may count either way round: two answers made one.
// Notation:
//   way             0: counter-clockwise, 1: clockwise; with noise each has its evidence, and half the prior
// Follows docs/rolling.md, "Against the outline's direction".
namespace rollfix::answer {
namespace {

template <class Entries>
void append(Entries& all, const Entries& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// What is of the search, and what the fingers can't do.
void add_search(const Answer& other, Answer& answer) {
  // Placements know which way they are of.
  append(answer.placements, other.placements);
  append(answer.impossible, other.impossible);
  append(answer.unresolved, other.unresolved);
  answer.dropped.reach += other.dropped.reach;
  answer.dropped.overlap += other.dropped.overlap;
  answer.counts.intervals += other.counts.intervals;
  answer.counts.evaluations += other.counts.evaluations;
  answer.tolerance.value = std::max(answer.tolerance.value, other.tolerance.value);
  if (other.status == Status::incomplete) answer.status = Status::incomplete;
}

/// Whether some placement is not contradicted by the rows.
bool fits(const Answer& answer) {
  return std::any_of(answer.placements.begin(), answer.placements.end(),
                     [](const Placement& placement) { return !placement.is_contradicted; });
}

/// Both ways round were tried: that lengths are counted the other way is no explanation.
void drop_other_way(std::vector<Diagnosis>& diagnoses) {
  if (diagnoses.empty()) return;
  const auto is_other_way = [](const Diagnosis& one) { return one.cause == Cause::length_backwards; };
  diagnoses.erase(std::remove_if(diagnoses.begin(), diagnoses.end(), is_other_way), diagnoses.end());
  if (!diagnoses.empty()) return;
  // No other explanation is left: the part.
  diagnoses.emplace_back();
  diagnoses.back().cause = Cause::part;
}

/// Without noise: everything that fits, either way.
/// The verdict and diagnoses are those of the way that fits; where both fit, or the search gave up, of all placements.
Answer either_searched(Answer one, const Answer& other) {
  const bool one_fits = fits(one);
  const bool other_fits = fits(other);
  // The first way is contradicted: what is said of it does not matter.
  if (other_fits && !one_fits) {
    one.verdict = other.verdict;
    one.diagnoses = other.diagnoses;
  }
  add_search(other, one);
  drop_other_way(one.diagnoses);
  // Contradicted placements last, else by s.
  std::stable_sort(one.placements.begin(), one.placements.end(), [](const Placement& a, const Placement& b) {
    if (a.is_contradicted != b.is_contradicted) return b.is_contradicted;
    return a.start[0] < b.start[0];
  });
  if (one.status == Status::incomplete || (one_fits && other_fits)) {
    one.verdict = verdict_of(one.status, one.placements);
  }
  return one;
}

/// The probability that the roll went the second way, and not the first.
/// Bayes with equal priors: 1 / (1 + e^(E_1 - E_2)), E the log evidence of each way.
double probability_of_other(const Weighing& one, const Weighing& other) {
  // Of both as with the noise that the rows of the one that fits better seem to have.
  const bool is_better = one.fit.excess <= other.fit.excess;
  const double widened = (is_better ? one : other).fit.widened;
  const double with_one = one.evidence.with(widened);
  const double with_other = other.evidence.with(widened);
  // Neither way explains the rows at all.
  if (!std::isfinite(with_one) && !std::isfinite(with_other)) return is_better ? 0 : 1;
  return 1 / (1 + std::exp(with_one - with_other));
}

/// Multiplies all probabilities of one way by that way's own.
void scale(Answer& answer, double share) {
  for (Placement& placement : answer.placements) placement.probability *= share;
  Weighing& weighing = *answer.weighing;
  weighing.rest *= share;
  for (Density& of_finger : weighing.density) {
    for (DensityPiece& piece : of_finger) piece.probability *= share;
  }
}

/// The density's pieces of both ways by rising s; pieces of both ways may overlap.
void add_weighing(Weighing& other, Weighing& weighing) {
  weighing.rest += other.rest;
  append(weighing.improbable, other.improbable);
  for (std::size_t finger = 0; finger < weighing.density.size(); ++finger) {
    Density& density = weighing.density[finger];
    append(density, other.density[finger]);
    std::stable_sort(density.begin(), density.end(),
                     [](const DensityPiece& a, const DensityPiece& b) { return a.s.lo < b.s.lo; });
  }
}

/// Placements that are improbable because the roll went the other way are not listed.
void drop_improbable(Answer& answer) {
  Weighing& weighing = *answer.weighing;
  double likeliest = 0;
  for (const Placement& placement : answer.placements) likeliest = std::max(likeliest, placement.probability);
  const auto first =
      std::stable_partition(answer.placements.begin(), answer.placements.end(),
                            [&](const Placement& placement) { return is_listed(placement.probability, likeliest); });
  for (auto placement = first; placement != answer.placements.end(); ++placement) {
    weighing.rest += placement->probability;
    weighing.improbable.push_back(*placement);
  }
  answer.placements.erase(first, answer.placements.end());
  weighing.rest = std::min(1.0, weighing.rest);
  answer.dropped.improbable = weighing.improbable.size();
}

/// Of what remains of both; as Belief has it of one.
Verdict verdict_of(const Answer& both, const Verdict& likelier, const Verdict& other, bool likelier_is_clockwise) {
  if (both.placements.empty() || likelier.name == Verdict::inconsistent) return likelier;
  const auto verdict_on = [&](const Placement& placement) -> const Verdict& {
    return placement.clockwise == likelier_is_clockwise ? likelier : other;
  };
  // The places that remain: one that is sure, else all that count.
  const std::size_t count = how_many_remain(both.placements, &Placement::probability);
  if (count == 1) return verdict_on(both.placements.front());
  std::array<bool, 2> counts{};
  for (std::size_t k = 0; k < count; ++k) {
    // [0]: some of them are of the likelier way, [1]: of the other one.
    counts.at(both.placements[k].clockwise == likelier_is_clockwise ? 0 : 1) = true;
  }
  Verdict verdict = likelier;
  // All are of the likelier way: its own verdict holds.
  if (!counts[1]) return verdict;
  verdict.fits_badly |= other.fits_badly;
  // One way fits everywhere: together the place is no better known.
  if (likelier.name == Verdict::unobservable || other.name == Verdict::unobservable) {
    verdict.name = Verdict::unobservable;
    return verdict;
  }
  verdict.name = Verdict::ambiguous;
  verdict.places = count;
  verdict.stretches = (counts[0] ? likelier.stretches : 0) + other.stretches;
  return verdict;
}

/// With noise: the likelier way first.
/// Each way's answer, weighed by its probability. A way that is inconsistent has none if the other is not.
Answer either_weighed(Answer one, Answer other) {
  const bool one_fits = one.verdict.name != Verdict::inconsistent;
  const bool other_fits = other.verdict.name != Verdict::inconsistent;
  double of_other = probability_of_other(*one.weighing, *other.weighing);
  // The way that fits is certain where the other one does not.
  if (one_fits != other_fits) of_other = other_fits ? 1 : 0;
  scale(one, 1 - of_other);
  scale(other, of_other);
  // What is one for both ways (readings aside) is taken from the likelier one.
  const bool is_clockwise = of_other > 0.5;
  Answer& likelier = is_clockwise ? other : one;
  Answer& unlikelier = is_clockwise ? one : other;
  Answer both = likelier;
  both.readings = one.readings;
  add_search(unlikelier, both);
  add_weighing(*unlikelier.weighing, *both.weighing);
  drop_other_way(both.diagnoses);
  std::stable_sort(both.placements.begin(), both.placements.end(),
                   [](const Placement& a, const Placement& b) { return a.probability > b.probability; });
  drop_improbable(both);
  both.verdict = verdict_of(both, likelier.verdict, unlikelier.verdict, is_clockwise);
  return both;
}

}  // namespace

Answer only_way(Answer answer, const std::string& why_not_the_other) {
  drop_other_way(answer.diagnoses);
  answer.either_way = true;
  answer.other_way = why_not_the_other;
  return answer;
}

Answer either_of(Answer counter_clockwise, Answer clockwise) {
  Answer both = counter_clockwise.weighing ? either_weighed(std::move(counter_clockwise), std::move(clockwise))
                                           : either_searched(std::move(counter_clockwise), clockwise);
  both.either_way = true;
  return both;
}

}  // namespace rollfix::answer
