#include "steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "held_rows.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part.hpp"

// Notation:
//   box, set        arcs of first contacts, one for each finger; boxes that hang together
//   witness         first contacts and poses with every residual within its tolerance
// Follows docs/two_fingers.md, "Three and more fingers".
// Idea: a problem with its rows and the boxes of its search; without noise a set is a placement only with a witness in
// it. Sets without are cut smaller, until they are gone or as small as boxes get.
namespace rollfix::hold {
namespace {

/// These rows alone, in the order of time.
HeldRows chosen_rows(const HeldRows& rows, std::vector<std::size_t> chosen) {
  std::sort(chosen.begin(), chosen.end());
  HeldRows result = rows;
  result.rows.clear();
  for (const std::size_t row : chosen) result.rows.push_back(rows.rows[row]);
  return result;
}

constexpr int kHoldRefinements = 4;  // of sets without a witness, ...
constexpr double kHoldFiner = 0.25;  // ... each this much finer than the one before

/// Of each finger its arc of first contacts.
std::vector<Interval> arcs_of(HeldQuestion& question, const Box& box) {
  std::vector<Interval> arcs;
  for (std::size_t k = 0; k < question.search().fingers(); ++k) arcs.push_back(question.search().tree(k).arc(box[k]));
  return arcs;
}

/// First contacts as arcs of length 0.
std::vector<Interval> places_of(const HeldQuestion& question, const HeldState& state) {
  std::vector<Interval> places;
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(question.rows().fingers()); ++k) {
    places.push_back({state.unknowns(k), state.unknowns(k)});
  }
  return places;
}

/// The set with those boxes alone in which the fingers can be apart.
FoundSet apart_in(HeldQuestion& question, const FoundSet& found, const FingersApart* apart) {
  // No test is asked for: all boxes stay.
  if (apart == nullptr) return found;
  FoundSet left{{}, found.set};
  std::copy_if(found.boxes.begin(), found.boxes.end(), std::back_inserter(left.boxes),
               [&](const Box& box) { return !apart->must_overlap(arcs_of(question, box)); });
  return left;
}

/// First contacts in the set, with poses, that fit at all instants; none: not found from up to kStarts of its boxes,
/// which proves nothing.
std::optional<HeldState> witness_in(HeldQuestion& question, HoldFit& fit, const FoundSet& found,
                                    const FingersApart* apart) {
  const std::size_t looks = std::min(found.boxes.size(), kStarts);
  for (std::size_t look = 0; look < looks; ++look) {
    // A set fits if its largest residual, over its tolerance, is at most 1: that is made small, not the sum of
    // squares.
    HeldState state = fit.best_worst(fit.at(middle_of_box(question.search(), found, look, looks)));
    if (fit.worst(state) > 1) continue;
    // A fit may have ended in another set, which has its own.
    if (!is_within(found.set, state, question.part().boundary(), 0)) continue;
    if (apart == nullptr || !apart->must_overlap(places_of(question, state))) return state;
  }
  return std::nullopt;
}

}  // namespace

/// One path for each wheel, in their order.
WheelPaths paths_of(const HoldProblem& problem) {
  WheelPaths paths;
  for (const PassiveWheel& wheel : problem.wheels) {
    paths.push_back(std::make_unique<WheelPath>(problem.part, wheel.radius));
    if (!paths.back()->is_empty()) continue;
    throw InputError(fmt::format(
        "fingers on a free part: a wheel with radius {} can touch {} nowhere without entering it; check the radius and "
        "the part's unit",
        wheel.radius, problem.part.name()));
  }
  return paths;
}

/// Lengths of u and of x and y are brought into the part's unit; fingers' radii are in it already.
std::vector<Log> logs_of(const HoldProblem& problem) {
  std::vector<Log> logs;
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    logs.push_back(in_unit(problem.logs[k], problem.part.unit(), {finger_of_log(problem, k)}));
  }
  for (const PassiveWheel& wheel : problem.wheels) {
    logs.push_back(in_unit(wheel.log.rows, problem.part.unit(), {disk(wheel.radius)}));
  }
  return aligned(std::move(logs));
}

/// `reaches_` owns them, by radius; a map moves none of its elements, so that pointers to them stay.
ReachOfFingers::ReachOfFingers(const HoldProblem& problem) {
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    const Finger& finger = finger_of_log(problem, k);
    // Other fingers count as able to touch anywhere, which excludes nothing.
    const bool is_known = finger.is_disk() || (finger.is_jaw() && !problem.wheels.empty());
    if (!is_known) {
      each.push_back(nullptr);
      continue;
    }
    const double radius = finger.is_jaw() ? 0 : finger.disk()->radius;  // 0: a jaw
    const auto known = reaches_.find(radius);
    const auto& reach = known != reaches_.end()
                            ? known->second
                            : reaches_[radius] = std::make_unique<Reach>(
                                  radius > 0 ? reach_of_disk(problem.part, radius) : reach_of_jaw(problem.part));
    each.push_back(reach.get());
  }
}

/// Members are made in the order of their declaration: the search reads the rows and reaches made before it.
HeldQuestion::HeldQuestion(const HoldProblem& problem, HeldRows rows, const std::vector<std::size_t>& instants,
                           const WheelPaths& wheels)
    : wheels_(wheels.size()),
      rows_(std::move(rows)),
      searched_(chosen_rows(rows_, instants)),
      part_(problem.part),
      reach_(problem),
      search_(part_, rows_, instants, reach_.each, wheels, problem.budget.value_or(kHoldBudget)) {}

/// Each set with the extents of all first contacts in it.
std::vector<FoundSet> HeldQuestion::sets(const std::vector<Box>& boxes) {
  const Boundary boundary = part().boundary();
  std::vector<FoundSet> found;
  for (std::vector<Box>& own : sets_of(search_, boxes, boundary)) {
    FoundSet one{std::move(own), {}};
    for (std::size_t k = 0; k < search_.fingers(); ++k) {
      one.set.extent.push_back(extent_of(search_, one.boxes, k, boundary));
    }
    for (std::size_t k = 0; k < wheels_; ++k) {
      one.set.wheels.push_back(wheel_extent(search_, one.boxes, k, boundary));
    }
    found.push_back(std::move(one));
  }
  return found;
}

/// Each round asks every set that is left for a witness. At its start `boxes.fit`, the sets in `result`, and
/// `undecided` hold all first contacts that fit.
Witnessed witnessed(HeldQuestion& question, HoldFit& fit, Boxes boxes, const FingersApart* apart) {
  double leaf = HoldBoxSearch::kLeaf;
  Witnessed result{{}, {}, std::move(boxes.undecided)};
  std::vector<Box>& undecided = result.undecided;
  for (int round = 0; round <= kHoldRefinements && !boxes.fit.empty(); ++round) {
    std::vector<Box> left;
    for (const FoundSet& found : question.sets(boxes.fit)) {
      const FoundSet possible = apart_in(question, found, apart);
      // In every box some fingers enter each other, wherever in it they started.
      const bool overlaps = possible.boxes.empty();
      std::optional<HeldState> state =
          // A witness of a set that must overlap only says that the set is to be counted, as one that else fits.
          overlaps ? witness_in(question, fit, found, nullptr) : witness_in(question, fit, possible, apart);
      if (state) {
        result.sets.push_back({found.set, std::move(*state), overlaps});
      } else if (!overlaps) {
        // Smaller boxes may exclude it, or lead to a witness.
        left.insert(left.end(), found.boxes.begin(), found.boxes.end());
      }
    }
    boxes.fit = std::move(left);
    if (round == kHoldRefinements || boxes.fit.empty()) break;
    // Children of boxes that may fit are tested anew; those that fail are gone for sure.
    leaf *= kHoldFiner;
    boxes = question.search().search(std::move(boxes.fit), leaf);
    undecided.insert(undecided.end(), boxes.undecided.begin(), boxes.undecided.end());
  }
  result.doubtful = std::move(boxes.fit);
  return result;
}

}  // namespace rollfix::hold
