#include "hold_witness.hpp"

#include <algorithm>
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

std::optional<HeldState> witness_in(HeldQuestion& question, HoldFit& fit, const FoundSet& found) {
  const std::size_t looks = std::min(found.boxes.size(), kStarts);
  for (std::size_t look = 0; look < looks; ++look) {
    HeldState state = fit.best_worst(fit.at(middle_of_box(question.search(), found, look, looks)));
    if (fit.worst(state) > 1) continue;
    // A fit may have ended in another set, which has its own.
    if (is_within(found.set, state, question.part().boundary(), 0)) return state;
  }
  return std::nullopt;
}

}  // namespace

Witnessed witnessed(HeldQuestion& question, HoldFit& fit, Boxes boxes) {
  double leaf = BoxSearch::kLeaf;
  Witnessed result{{}, std::move(boxes.undecided)};
  std::vector<Box>& undecided = result.undecided;
  for (int round = 0; round <= kHoldRefinements && !boxes.fit.empty(); ++round) {
    std::vector<Box> left;
    for (const FoundSet& found : question.sets(boxes.fit)) {
      if (std::optional<HeldState> state = witness_in(question, fit, found)) {
        result.sets.push_back({found.set, std::move(*state)});
      } else {
        left.insert(left.end(), found.boxes.begin(), found.boxes.end());
      }
    }
    boxes.fit = std::move(left);
    if (round == kHoldRefinements || boxes.fit.empty()) break;
    leaf *= kHoldFiner;
    boxes = question.search().search(std::move(boxes.fit), leaf);
    undecided.insert(undecided.end(), boxes.undecided.begin(), boxes.undecided.end());
  }
  undecided.insert(undecided.end(), boxes.fit.begin(), boxes.fit.end());
  return result;
}

}  // namespace rollfix::hold
