#include "hold_witness.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

// Notation:
//   box, set        arcs of first contacts, one for each finger; boxes that hang together
//   witness         first contacts and poses with every residual within its tolerance
// Follows docs/two_fingers.md, "Three and more fingers".
namespace rollfix::hold {
namespace {

constexpr int kHoldRefinements = 4;  // of sets without a witness, ...
constexpr double kHoldFiner = 0.25;  // ... each this much finer than the one before

std::vector<Interval> arcs_of(HeldQuestion& question, const Box& box) {
  std::vector<Interval> arcs;
  for (std::size_t k = 0; k < question.search().fingers(); ++k) arcs.push_back(question.search().tree(k).arc(box[k]));
  return arcs;
}

std::vector<Interval> places_of(const HeldQuestion& question, const HeldState& state) {
  std::vector<Interval> places;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(question.rows().fingers()); ++k) {
    places.push_back({state.unknowns(k), state.unknowns(k)});
  }
  return places;
}

/// The set with those boxes alone in which the fingers can be apart.
FoundSet apart_in(HeldQuestion& question, const FoundSet& found, const FingersApart* apart) {
  if (apart == nullptr) return found;
  FoundSet left{{}, found.set};
  std::copy_if(found.boxes.begin(), found.boxes.end(), std::back_inserter(left.boxes),
               [&](const Box& box) { return !apart->must_overlap(arcs_of(question, box)); });
  return left;
}

std::optional<HeldState> witness_in(HeldQuestion& question, HoldFit& fit, const FoundSet& found,
                                    const FingersApart* apart) {
  const std::size_t looks = std::min(found.boxes.size(), kStarts);
  for (std::size_t look = 0; look < looks; ++look) {
    HeldState state = fit.best_worst(fit.at(middle_of_box(question.search(), found, look, looks)));
    if (fit.worst(state) > 1) continue;
    // A fit may have ended in another set, which has its own.
    if (!is_within(found.set, state, question.part().boundary(), 0)) continue;
    if (apart == nullptr || !apart->must_overlap(places_of(question, state))) return state;
  }
  return std::nullopt;
}

}  // namespace

Witnessed witnessed(HeldQuestion& question, HoldFit& fit, Boxes boxes, const FingersApart* apart) {
  double leaf = BoxSearch::kLeaf;
  Witnessed result{{}, {}, std::move(boxes.undecided)};
  std::vector<Box>& undecided = result.undecided;
  for (int round = 0; round <= kHoldRefinements && !boxes.fit.empty(); ++round) {
    std::vector<Box> left;
    for (const FoundSet& found : question.sets(boxes.fit)) {
      const FoundSet possible = apart_in(question, found, apart);
      const bool overlaps = possible.boxes.empty();
      std::optional<HeldState> state =
          overlaps ? witness_in(question, fit, found, nullptr) : witness_in(question, fit, possible, apart);
      if (state) {
        result.sets.push_back({found.set, std::move(*state), overlaps});
      } else if (!overlaps) {
        left.insert(left.end(), found.boxes.begin(), found.boxes.end());
      }
    }
    boxes.fit = std::move(left);
    if (round == kHoldRefinements || boxes.fit.empty()) break;
    leaf *= kHoldFiner;
    boxes = question.search().search(std::move(boxes.fit), leaf);
    undecided.insert(undecided.end(), boxes.undecided.begin(), boxes.undecided.end());
  }
  result.doubtful = std::move(boxes.fit);
  return result;
}

}  // namespace rollfix::hold
