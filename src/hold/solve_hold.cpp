#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "answer_holds.hpp"
#include "arc_tree.hpp"
#include "box_search.hpp"
#include "held_rows.hpp"
#include "hold_facts.hpp"
#include "hold_fit.hpp"
#include "hold_modes.hpp"
#include "requirements.hpp"
#include "rollfix/error.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/part/reach.hpp"
#include "rollfix/pulse.hpp"
#include "weigh_holds.hpp"

// Notation:
//   box, set        arcs of first contacts, one for each finger; boxes that hang together
//   witness         first contacts and poses with every residual within its tolerance
// Follows docs/two_fingers.md, "Three and more fingers".
namespace rollfix {
namespace hold {
namespace {

constexpr int kHoldRefinements = 4;  // of sets without a witness, ...
constexpr double kHoldFiner = 0.25;  // ... each this much finer than the one before
constexpr double kSureShare = 0.95;  // so probable the first answer is the only one
constexpr double kFreeHold = 0.05;   // of the perimeter: without noise what is confined no better is a continuum

HeldRows chosen_rows(const HeldRows& rows, const std::vector<std::size_t>& chosen) {
  HeldRows result = rows;
  result.rows.clear();
  for (const std::size_t row : chosen) result.rows.push_back(rows.rows[row]);
  return result;
}

/// Where each finger can touch: of disks, and of jaws beside wheels; nullptr for others. Fingers of one radius share
/// it.
class ReachOfFingers {
 public:
  explicit ReachOfFingers(const HoldProblem& problem) {
    for (std::size_t k = 0; k < problem.logs.size(); ++k) {
      const Finger& finger = finger_of_log(problem, k);
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
  std::vector<const Reach*> each;

 private:
  std::map<double, std::unique_ptr<Reach>> reaches_;
};

class HoldSolver {
 public:
  HoldSolver(const HoldProblem& problem, const std::vector<Log>& logs, const WheelPaths& wheels, HoldAnswer& answer)
      : problem_(problem),
        answer_(answer),
        boundary_(problem.part.boundary()),
        rows_(held_rows(problem, logs)),
        instants_(rows_to_search(problem, logs.front())),
        searched_(chosen_rows(rows_, sorted(instants_))),
        part_(problem.part),
        reach_(problem),
        wheels_(wheels),
        search_(part_, rows_, instants_, reach_.each, wheels, problem.budget.value_or(kHoldBudget)) {}

  void run() {
    for (const std::size_t row : sorted(instants_)) answer_.instants.push_back(rows_.rows[row].time);
    for (std::size_t k = 0; k < rows_.fingers(); ++k) {
      answer_.rolls[k].length = searched_.rows.back().contacts[k].travelled;
    }
    if (!rows_.any_place) answer_.place = rows_.reference ? PlaceKnown::reference : PlaceKnown::unknown;
    Boxes boxes = search_.search();
    if (rows_.has_noise) {
      weigh(problem_, rows_, searched_, sets(boxes.fit), search_, wheels_, answer_);
      add_unresolved(boxes.undecided);
    } else {
      look_for_witnesses(std::move(boxes));
    }
    answer_.comparisons = search_.comparisons();
    conclude();
  }

 private:
  static std::vector<std::size_t> sorted(std::vector<std::size_t> rows) {
    std::sort(rows.begin(), rows.end());
    return rows;
  }

  std::vector<FoundSet> sets(const std::vector<Box>& boxes) {
    std::vector<FoundSet> found;
    for (std::vector<Box>& own : sets_of(search_, boxes, boundary_)) {
      FoundSet one{std::move(own), {}};
      for (std::size_t k = 0; k < search_.fingers(); ++k) {
        one.set.extent.push_back(extent_of(search_, one.boxes, k, boundary_));
      }
      for (std::size_t k = 0; k < wheels_.size(); ++k) {
        one.set.wheels.push_back(wheel_extent(search_, one.boxes, k, boundary_));
      }
      found.push_back(std::move(one));
    }
    return found;
  }

  /// In every set first contacts that fit at all instants; sets without are cut smaller, until they are gone or told.
  void look_for_witnesses(Boxes boxes) {
    double leaf = BoxSearch::kLeaf;
    HoldFit fit(problem_.part, searched_, wheels_);
    std::vector<Box> undecided = std::move(boxes.undecided);
    for (int round = 0; round <= kHoldRefinements && !boxes.fit.empty(); ++round) {
      std::vector<Box> left;
      for (const FoundSet& found : sets(boxes.fit)) {
        if (!add_witness(fit, found)) left.insert(left.end(), found.boxes.begin(), found.boxes.end());
      }
      boxes.fit = std::move(left);
      if (round == kHoldRefinements || boxes.fit.empty()) break;
      leaf *= kHoldFiner;
      boxes = search_.search(std::move(boxes.fit), leaf);
      undecided.insert(undecided.end(), boxes.undecided.begin(), boxes.undecided.end());
    }
    undecided.insert(undecided.end(), boxes.fit.begin(), boxes.fit.end());
    add_unresolved(undecided);
    std::sort(answer_.placements.begin(), answer_.placements.end(),
              [](const HoldPlacement& a, const HoldPlacement& b) { return a.contacts[0].start < b.contacts[0].start; });
  }

  bool add_witness(HoldFit& fit, const FoundSet& found) {
    const std::size_t looks = std::min(found.boxes.size(), kStarts);
    for (std::size_t look = 0; look < looks; ++look) {
      const HeldState state = fit.best_worst(fit.at(middle_of_box(search_, found, look, looks)));
      if (fit.worst(state) > 1) continue;
      // A fit may have ended in another set, which has its own.
      if (!is_within(found.set, state, boundary_, 0)) continue;
      HoldPlacement placement = described(fit, problem_.part, state, found.set);
      placement.continuum = is_free(fit, state, found.set);
      answer_.placements.push_back(std::move(placement));
      return true;
    }
    return false;
  }

  /// Whether the instants confine the first contacts no better than to a large share of the boundary.
  bool is_free(const HoldFit& fit, const HeldState& state, const HeldSet& set) const {
    double widest = 0;
    for (const Interval& arc : set.extent) widest = std::max(widest, arc.width());
    const UnknownsMatrix information = fit.reduced(state).matrix;
    const auto fingers = static_cast<Eigen::Index>(fit.fingers());  // an encoder's zero is no place
    const UnknownsMatrix places = information.topLeftCorner(fingers, fingers);
    const double weakest = Eigen::SelfAdjointEigenSolver<UnknownsMatrix>(places).eigenvalues()(0);
    const double confined = kFreeHold * boundary_.perimeter;
    return widest > 1e-3 * boundary_.perimeter && !(weakest > 1 / (confined * confined));
  }

  void add_unresolved(const std::vector<Box>& boxes) {
    if (boxes.empty()) return;
    for (const FoundSet& one : sets(boxes)) {
      answer_.unresolved.push_back(one.set.extent);
      answer_.unresolved.back().insert(answer_.unresolved.back().end(), one.set.wheels.begin(), one.set.wheels.end());
    }
  }

  void conclude() {
    Verdict& verdict = answer_.verdict;
    verdict.name = Verdict::inconsistent;
    verdict.fits_badly = answer_.fit && answer_.fit->is_bad();
    const std::vector<HoldPlacement>& placements = answer_.placements;
    if (!answer_.unresolved.empty()) {
      answer_.status = Status::incomplete;
      verdict.name = Verdict::undecided;
      return;
    }
    if (placements.empty()) return;
    const bool is_sure = placements.size() == 1 || placements.front().probability >= kSureShare;
    verdict.places = is_sure ? 1 : placements.size();
    verdict.stretches = 0;
    for (std::size_t k = 0; k < verdict.places; ++k) verdict.stretches += placements[k].continuum ? 1 : 0;
    const bool is_anywhere =
        is_sure && std::any_of(placements.front().contacts.begin(), placements.front().contacts.end(),
                               [&](const HoldContact& contact) { return boundary_.is_full(contact.extent); });
    if (is_anywhere && verdict.stretches > 0) {
      verdict = {Verdict::unobservable, 0, 0, verdict.fits_badly};
    } else if (is_sure && verdict.stretches == 0) {
      verdict = {Verdict::unique, 0, 0, verdict.fits_badly};
    } else {
      verdict.name = Verdict::ambiguous;
    }
  }

  const HoldProblem& problem_;
  HoldAnswer& answer_;
  Boundary boundary_;
  HeldRows rows_;
  std::vector<std::size_t> instants_;
  HeldRows searched_;
  HeldPart part_;
  ReachOfFingers reach_;
  const WheelPaths& wheels_;
  BoxSearch search_;
};

/// Throws InputError: a wheel that fits nowhere.
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

/// Those of the fingers, then those of the wheels, in the part's unit.
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

TouchTolerance largest_tolerance(const HeldRows& rows) {
  TouchTolerance most;
  for (const HeldErrors& errors : rows.errors) {
    most.length = std::max(most.length, errors.has_place ? errors.place : 0);
    most.angle = std::max(most.angle, errors.angle);
  }
  for (const HeldWheel& wheel : rows.wheels) most.length = std::max(most.length, wheel.place);
  return most;
}

}  // namespace
}  // namespace hold

HoldAnswer solve(const HoldProblem& problem) {
  hold::require_valid(problem);
  const Doing doing("looking for places that fit all fingers");
  const hold::WheelPaths wheels = hold::paths_of(problem);
  std::vector<Log> logs = hold::logs_of(problem);
  HoldAnswer answer{problem.part, {}};
  for (std::size_t k = 0; k < logs.size(); ++k) answer.rolls.push_back(hold::roll_of(problem, logs[k], k));
  answer.rows = logs.front().rows();
  answer.noise = problem.noise;
  answer.squeezed = problem.squeezed;
  answer.mirrored = problem.mirrored;
  const HoldProblem seen = problem.mirrored ? hold::in_mirror(problem, logs) : problem;
  if (!problem.noise) answer.tolerance = hold::largest_tolerance(hold::held_rows(seen, logs));
  hold::HoldSolver(seen, logs, wheels, answer).run();
  if (problem.mirrored) hold::out_of_mirror(answer);
  return answer;
}

std::string HoldAnswer::verdict_text() const {
  Verdict plain = verdict;
  plain.fits_badly = false;
  const bool is_said = verdict.fits_badly && verdict.name != Verdict::inconsistent;
  return plain.text() + (is_said ? ", but the measurements contradict the stated noise" : "");
}

}  // namespace rollfix
