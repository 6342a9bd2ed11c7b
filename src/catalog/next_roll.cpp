#include "rollfix/identify.hpp"

#include <cmath>

#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

// More places are not compared with each other: the likeliest, which hold nearly all of the probability, are.
constexpr std::size_t kMostPlaces = 200;

std::vector<NextRollOfParts::Place> places_of(const Identified& found) {
  std::vector<NextRollOfParts::Place> places;
  std::size_t labels = 0;
  const double all_alike = 1 / static_cast<double>(found.parts.size());
  double total = 0;
  for (std::size_t k = 0; k < found.parts.size() && labels < kMostPlaces; ++k) {
    const PartFound& one = found.parts[k];
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

std::string why_no_roll(const Identified& found) {
  const bool alike = !found.parts.empty() && found.parts.front().congruent.size() + 1 >= found.parts.size();
  return alike && found.parts.size() > 1 ? "the parts that remain are congruent"
                                         : "within the travel what remains looks alike";
}

}  // namespace

NextRollOfParts next_roll(const Identified& found, const std::optional<Interval>& travel) {
  NextRollOfParts next;
  if (found.parts.empty()) {
    next.why = "nothing fits: there is nothing to tell apart";
    return next;
  }
  for (const PartFound& one : found.parts) {
    for (const Placement& placement : one.answer.placements) {
      if (placement.clockwise) throw InputError("advise: expected one direction of the roll, found either");
    }
  }
  next.places = places_of(found);
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
    next.why = why_no_roll(found);
    return next;
  }
  for (NextRollOfParts::Place& place : next.places) {
    place.turn_ahead = turn_ahead(found.parts[place.part].answer.part, place.hypothesis, next.advice->lengths());
  }
  return next;
}

}  // namespace rollfix
