#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "answer_poses.hpp"
#include "free_space.hpp"
#include "heading_sets.hpp"
#include "mirror_poses.hpp"
#include "mistakes.hpp"
#include "moved.hpp"
#include "outline/turn.hpp"
#include "pose_boxes.hpp"
#include "poses_beyond.hpp"
#include "requirements.hpp"
#include "roll_contacts.hpp"
#include "roll_poses.hpp"
#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/touch/touch.hpp"
#include "tilted_touch.hpp"

namespace rollfix {
namespace touch {
namespace {

// Sets of poses that are less probable are counted, not listed.
constexpr double kLeastProbability = 1e-4;
// Weighing poses with the first touch at one place takes as long as this many comparisons.
constexpr std::size_t kPlaceCost = 2000;
constexpr double kNegligible = 1e-8;
// Poses are one where they differ by less than this share of the least standard deviation, or tolerance, of a place.
constexpr double kSame = 0.2;
// One pose is the answer where it is at least so probable.
constexpr double kSure = 0.95;
// How often sets without a pose that is known to fit are looked at again, each time with a leaf so many times as fine.
constexpr int kRefinements = 2;
constexpr double kFiner = 0.25;
// Boxes of poses that are looked at for each such set.
constexpr std::size_t kBoxBudget = 200000;
// Cells of a set that are looked at for a pose that leaves the clear paths free.
constexpr std::size_t kFreeLooks = 64;

}  // namespace

std::vector<Measured> measured(const TouchProblem& problem) {
  std::vector<Measured> touches;
  for (const MeasuredTouch& touch : problem.touches) {
    Measured one;
    one.at = touch.at;
    if (touch.normal) one.tangent = *touch.normal + 0.5 * std::numbers::pi;
    const Noise none;
    const Noise& noise = problem.noise ? *problem.noise : none;
    one.place_unit = problem.noise ? touch.position_sd.value_or(noise.position) : problem.tolerance->length;
    one.angle_unit = problem.noise ? touch.normal_sd.value_or(noise.angle) : problem.tolerance->angle;
    const double most = problem.noise ? kTouchSigmas : 1;
    one.place_most = most * one.place_unit;
    one.angle_most = std::min(most * one.angle_unit, std::numbers::pi);
    touches.push_back(one);
  }
  return touches;
}

namespace {

/// The problem's rolls, then its touches.
std::vector<Measured> contacts_of(const TouchProblem& problem, const std::vector<RollContact>& rolls) {
  std::vector<Measured> contacts;
  for (const RollContact& roll : rolls) contacts.push_back(roll.measured);
  const std::vector<Measured> touches = measured(problem);
  contacts.insert(contacts.end(), touches.begin(), touches.end());
  return contacts;
}

std::vector<Cell> cells_of(const CellSets& sets, const std::vector<std::size_t>& groups) {
  std::vector<Cell> cells;
  for (const std::size_t g : groups) {
    for (const std::size_t k : sets.groups[g]) cells.push_back(sets.cells[k]);
  }
  return cells;
}

/// Arcs of the boundary that the first touch's nodes of cells cover.
std::vector<Interval> places_of(const PathTree& tree, const std::vector<Cell>& cells) {
  std::vector<Interval> arcs;
  for (const Cell& cell : cells) {
    std::vector<std::int32_t> waiting{cell.first};
    while (!waiting.empty()) {
      const PathTree::Node& node = tree.node(waiting.back());
      waiting.pop_back();
      if (!node.is_single()) {
        waiting.push_back(node.left);
        waiting.push_back(node.right);
        continue;
      }
      const CentreStretch& stretch = tree.path().stretches()[static_cast<std::size_t>(node.stretch)];
      arcs.push_back(stretch.corner ? Interval{stretch.s, stretch.s} : node.u);
    }
  }
  std::sort(arcs.begin(), arcs.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> merged;
  for (const Interval& arc : arcs) {
    if (!merged.empty() && arc.lo <= merged.back().hi) {
      merged.back().hi = std::max(merged.back().hi, arc.hi);
    } else {
      merged.push_back(arc);
    }
  }
  return merged;
}

/// The boundary's length as far as the finger gets to it, of a corner that of the finger's arc around it.
double length_in_reach(const CentrePath& path) {
  double length = 0;
  for (std::size_t k = 0; k < path.stretches().size(); ++k) {
    length += path.stretches()[k].u.width() * length_per_u(path, k);
  }
  return length;
}

/// log(exp(a) + exp(b) + ...) of the nodes' weights.
double log_total(const std::vector<PosteriorNode>& nodes) {
  double most = -std::numeric_limits<double>::infinity();
  for (const PosteriorNode& node : nodes) most = std::max(most, node.log_weight);
  if (!std::isfinite(most)) return most;
  double sum = 0;
  for (const PosteriorNode& node : nodes) sum += std::exp(node.log_weight - most);
  return most + std::log(sum);
}

/// Cells that hang together, with the pose that fits best.
struct PoseSet {
  FittedPose fitted;
  std::vector<Cell> cells;
  PoseMode mode;  // with noise
};

/// The steps of a search for all poses, and what they leave behind.
class Solver {
 public:
  /// `known`: poses whose extents need no more looking at; then all that is within the tolerances counts.
  Solver(const TouchProblem& problem, TouchAnswer& answer, const std::vector<TouchPose>* known = nullptr)
      : problem_(problem),
        answer_(answer),
        known_(known),
        rolls_(roll_contacts(problem)),
        touches_(contacts_of(problem, rolls_)),
        free_(problem) {
    if (known_ == nullptr) return;
    for (Measured& touch : touches_) {
      touch.place_unit = touch.place_most;
      touch.angle_unit = touch.angle_most;
    }
  }

  void run() {
    for (const Measured& touch : touches_) answer_.tolerance.push_back({touch.place_most, touch.angle_most});
    add_rolls();
    if (touches_.size() == 1 || are_at_one_place()) {
      if (rolls_.empty()) answer_.verdict.name = Verdict::unobservable;
      if (rolls_.empty() && problem_.noise) answer_.log_evidence = 0;  // the same on any part
      if (!rolls_.empty()) take_from(rolls_.front(), answer_);
      return;
    }
    answer_.verdict.name = Verdict::inconsistent;
    if (std::any_of(rolls_.begin(), rolls_.end(), [](const RollContact& roll) { return roll.fits_nowhere(); })) return;
    std::optional<CentrePath> path;
    if (!problem_.touches.empty()) path.emplace(problem_.part, answer_.radius);
    if (path && path->stretches().empty()) return;  // the disk can touch the part nowhere
    std::optional<PathTree> tree;
    if (path) tree.emplace(*path);
    for (std::size_t k = rolls_.size(); k < touches_.size(); ++k) touches_[k].tree = &*tree;
    if (!problem_.noise && answer_.place != PlaceKnown::measured) {
      search_headings();
    } else {
      search_poses();
    }
  }

 private:
  /// Places without normals, within their tolerances of each other: they say what one says, any place and any heading.
  bool are_at_one_place() const {
    const Measured& first = touches_.front();
    return rolls_.empty() && known_ == nullptr &&
           std::all_of(touches_.begin(), touches_.end(), [&](const Measured& one) {
             return !one.tangent && (one.at - first.at).norm() <= std::min(one.place_most, first.place_most);
           });
  }

  void add_rolls() {
    for (std::size_t k = 0; k < rolls_.size(); ++k) answer_.rolls.push_back(facts_of(rolls_[k], problem_.rolls[k]));
    if (rolls_.empty() || !problem_.touches.empty()) return;
    const bool is_measured = std::any_of(rolls_.begin(), rolls_.end(), [&](const RollContact& roll) {
      return roll.measured.has_place && !is_reference(roll.measured);
    });
    if (is_measured) return;
    answer_.place = answer_.rolls.front().has_centre ? PlaceKnown::reference : PlaceKnown::unknown;
  }

  /// Without noise, and with nothing that tells the place.
  void search_headings() {
    HeadingSets found = heading_sets(touches_, problem_.budget.value_or(kTouchBudget));
    answer_.poses = std::move(found.poses);
    answer_.comparisons = found.comparisons;
    if (!found.complete) {
      for (const CentreStretch& stretch : touches_.front().tree->path().stretches()) {
        answer_.unresolved.push_back(stretch.corner ? Interval{stretch.s, stretch.s} : stretch.u);
      }
    }
    add_roll_ends(rolls_, touches_, answer_);
    conclude();
    take_over_doubts(rolls_, answer_);
  }

  void search_poses() {
    const TouchPair pair = choose_pair(touches_);
    CellSearch search(touches_, pair, problem_.budget.value_or(kTouchBudget));
    double leaf = CellSearch::kLeaf;
    Cells cells = rolls_.empty() ? search.search() : search_by_levels(search, touches_, pair, leaf);
    PoseFit fit(touches_, problem_.pose);
    free_.drop_blocked(cells.fit, fit.tree(pair.first), touches_[pair.first]);
    if (known_ != nullptr) drop_known(cells.fit, fit, pair);
    if (problem_.noise && known_ == nullptr) {
      weigh(fit, pair, sets_of(fit.tree(pair.first), fit.tree(pair.second), std::move(cells.fit)), cells.undecided);
    } else {
      look_for_witnesses(fit, pair, search, leaf, std::move(cells.fit), cells.undecided);
    }
    answer_.unresolved_touch = pair.first;
    answer_.unresolved = places_of(fit.tree(pair.first), cells.undecided);
    answer_.comparisons = search.comparisons();
    if (!rolls_.empty()) add_roll_ends(rolls_, touches_, answer_);
    conclude();
    take_over_doubts(rolls_, answer_);
  }

  /// Cells all of whose poses are in a known extent go.
  void drop_known(std::vector<Cell>& cells, const PoseFit& fit, const TouchPair& pair) const {
    const double rounding = kSame * 1e-6 * touches_[pair.first].place_most;
    const auto known = [&](const Cell& cell) {
      const PoseExtent box = extent_of(fit, {cell}, pair, {});
      const Pose middle{box[0].middle(), box[1].middle(), box[2].middle()};
      const auto is_inside = [&](const TouchPose& pose) {
        PoseExtent inner = pose.extent;
        for (std::size_t k = 0; k < 3; ++k) {
          inner[k] = {inner[k].lo + 0.5 * box[k].width(), inner[k].hi - 0.5 * box[k].width()};
        }
        if (pose.any_heading) inner[2] = pose.extent[2];
        return holds(inner, middle, rounding);
      };
      return std::any_of(known_->begin(), known_->end(), is_inside);
    };
    cells.erase(std::remove_if(cells.begin(), cells.end(), known), cells.end());
  }

  /// With noise: what is less probable than kNegligible is not looked at, and modes that end in one pose are one.
  void weigh(PoseFit& fit, const TouchPair& pair, const CellSets& sets, std::vector<Cell>& undecided) {
    const std::size_t most = problem_.budget.value_or(kTouchBudget) / kPlaceCost;
    if (count_places(fit, sets, pair.first) > most) {
      undecided.insert(undecided.end(), sets.cells.begin(), sets.cells.end());
      return;
    }
    Posterior posterior = posterior_of(fit, sets, pair.first);
    free_.weigh(posterior.nodes);
    const std::vector<PosteriorNode>& nodes = posterior.nodes;
    if (rolls_.empty()) {
      const double length = length_in_reach(fit.path(pair.first));
      answer_.log_evidence = log_total(nodes) - static_cast<double>(touches_.size()) * std::log(length);
    }
    answer_.improbable += posterior.hopeless;
    std::vector<PoseSet> found;
    for (PoseMode& mode : modes_of(sets, posterior)) {
      const auto by_square = [&](std::size_t a, std::size_t b) { return nodes[a].square < nodes[b].square; };
      const std::size_t best = *std::min_element(mode.nodes.begin(), mode.nodes.end(), by_square);
      if (mode.probability >= kNegligible) {
        add_set(fit, {fit.fit(nodes[best].best), cells_of(sets, mode.groups), std::move(mode)}, found);
      } else {
        leave_out(mode);
      }
    }
    for (const PoseSet& set : found) {
      TouchPose pose = described(fit, set.fitted, set.cells, pair);
      if (set.mode.probability < kLeastProbability || pose.worst > 1) {
        leave_out(set.mode);
        continue;
      }
      add_posterior(pose, set.mode, nodes);
      if (pose.continuum) {
        const FittedPose middle = fit.fit(nodes[middle_of(pose, set.mode, nodes)].best);
        TouchPose moved = described(fit, middle, set.cells, pair);
        add_posterior(moved, set.mode, nodes);
        if (moved.worst <= 1) pose = std::move(moved);
      }
      const TouchFit one = fit_of(fit, set.fitted, pose.continuum);
      if (!answer_.fit || one.p > answer_.fit->p || (one.p == answer_.fit->p && one.freedom > answer_.fit->freedom)) {
        answer_.fit = one;
      }
      answer_.poses.push_back(std::move(pose));
    }
    std::stable_sort(answer_.poses.begin(), answer_.poses.end(),
                     [](const TouchPose& a, const TouchPose& b) { return a.probability > b.probability; });
  }

  static std::array<double, 3> numbers_of(const Pose& pose) { return {pose.x, pose.y, pose.heading}; }

  /// The node nearest to the middle of a continuum, in the sizes of its intervals: all along it poses fit about alike.
  static std::size_t middle_of(const TouchPose& pose, const PoseMode& mode, const std::vector<PosteriorNode>& nodes) {
    const auto off = [&](std::size_t k) {
      const std::array<double, 3> at = numbers_of(nodes[k].best);
      double square = 0;
      for (std::size_t i = 0; i < (pose.any_heading ? 2 : 3); ++i) {
        const Interval& interval = pose.interval[i];
        const double away = at[i] - interval.middle();
        square += std::pow((i == 2 ? nearest_angle(away) : away) / std::max(interval.width(), 1e-12), 2);
      }
      return square;
    };
    return *std::min_element(mode.nodes.begin(), mode.nodes.end(),
                             [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
  }

  void leave_out(const PoseMode& mode) {
    ++answer_.improbable;
    answer_.rest += mode.probability;
  }

  /// Adds a set to those with another pose. One pose can have several: of touches near a bump more than one place fits.
  void add_set(const PoseFit& fit, PoseSet set, std::vector<PoseSet>& to) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Measured& touch : touches_) {
      if (touch.has_place) least = std::min(least, touch.place_unit);
    }
    for (PoseSet& known : to) {
      // Where nothing tells the place, answers are of where the contacts are.
      if (answer_.place != PlaceKnown::measured) break;
      if (fit.distance(known.fitted.pose, set.fitted.pose) > kSame * least) continue;
      if (set.fitted.square < known.fitted.square) known.fitted = std::move(set.fitted);
      known.cells.insert(known.cells.end(), set.cells.begin(), set.cells.end());
      known.mode.nodes.insert(known.mode.nodes.end(), set.mode.nodes.begin(), set.mode.nodes.end());
      known.mode.probability += set.mode.probability;
      return;
    }
    to.push_back(std::move(set));
  }

  /// How well a pose fits. Each touch has a place on the boundary that is unknown, unless a corner pins it; where the
  /// part is free to slide the pose has one unknown less.
  TouchFit fit_of(const PoseFit& fit, const FittedPose& fitted, bool is_continuum) const {
    TouchFit result;
    result.chi_square = fitted.square;
    result.freedom = is_continuum ? -2 : -3;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      // How dense a roll's belief is counts as a measurement of its place.
      if (touches_[k].roll != nullptr) result.freedom += touches_[k].has_place ? 3 : 1;
      if (touches_[k].roll != nullptr) continue;
      result.freedom += touches_[k].tangent ? 2 : 1;
      result.freedom += fit.is_pinned(fitted.pose, k, fitted.places[k]) ? 1 : 0;
    }
    if (problem_.pose) result.freedom += std::isfinite(problem_.pose->place_sd) ? 3 : 1;
    result.freedom = std::max(result.freedom, 0);
    if (result.freedom > 0) result.p = boost::math::gamma_q(0.5 * result.freedom, 0.5 * result.chi_square);
    return result;
  }

  /// Without noise: in every set a pose that fits; sets without one are cut smaller, until they are gone or are told.
  void look_for_witnesses(PoseFit& fit, const TouchPair& pair, CellSearch& search, double leaf, std::vector<Cell> cells,
                          std::vector<Cell>& undecided) {
    std::vector<PoseSet> found;
    for (int round = 0; round <= kRefinements && !cells.empty(); ++round) {
      const CellSets sets = sets_of(fit.tree(pair.first), fit.tree(pair.second), std::move(cells));
      cells.clear();
      for (const std::vector<std::size_t>& component : sets.components) {
        std::vector<Cell> own = cells_of(sets, component);
        const PoseExtent extent = extent_of(fit, own, pair, {0, 0, own.front().heading.middle});
        // Least squares may lead to a pose of another set.
        const auto is_one = [&](const FittedPose& pose) {
          return worst_of(fit, pose) <= 1 && holds(extent, pose.pose);
        };
        FittedPose fitted = best_within(fit, own, pair);
        BoxesFound boxes;
        if (!is_one(fitted)) boxes = search_boxes(fit, own, pair, kBoxBudget);
        if (boxes.refuted) continue;  // proved: no pose of the set fits
        if (boxes.witness) fitted = std::move(*boxes.witness);
        if (free_.is_blocked(fitted.pose)) fitted = best_free(fit, own, pair, std::move(fitted));
        if (is_one(fitted) && !free_.is_blocked(fitted.pose)) {
          add_set(fit, {std::move(fitted), std::move(own), {}}, found);
        } else {
          cells.insert(cells.end(), own.begin(), own.end());
        }
      }
      if (round == kRefinements) break;
      leaf *= kFiner;
      Cells finer = search.search(cells, leaf);
      cells = std::move(finer.fit);
      free_.drop_blocked(cells, fit.tree(pair.first), touches_[pair.first]);
      undecided.insert(undecided.end(), finer.undecided.begin(), finer.undecided.end());
    }
    if (known_ != nullptr) add_bare(fit, pair, std::exchange(cells, {}));
    undecided.insert(undecided.end(), cells.begin(), cells.end());
    for (const PoseSet& set : found) answer_.poses.push_back(described(fit, set.fitted, set.cells, pair));
    std::sort(answer_.poses.begin(), answer_.poses.end(),
              [](const TouchPose& a, const TouchPose& b) { return a.pose.heading < b.pose.heading; });
  }

  /// Sets of which it is not known whether a pose of theirs fits: extents alone.
  void add_bare(const PoseFit& fit, const TouchPair& pair, std::vector<Cell> cells) {
    const CellSets sets = sets_of(fit.tree(pair.first), fit.tree(pair.second), std::move(cells));
    for (const std::vector<std::size_t>& component : sets.components) {
      const std::vector<Cell> own = cells_of(sets, component);
      TouchPose bare;
      bare.extent = extent_of(fit, own, pair, {0, 0, own.front().heading.middle});
      answer_.poses.push_back(std::move(bare));
    }
  }

  /// A pose from some cell that leaves the paths free and fits best, or else the one given.
  FittedPose best_free(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair, FittedPose given) {
    std::optional<FittedPose> best;
    const std::size_t looks = std::min(cells.size(), kFreeLooks);
    for (std::size_t look = 0; look < looks; ++look) {
      const Cell& cell = cells[(2 * look + 1) * cells.size() / (2 * looks)];
      const PathTree::Node& node = fit.tree(pair.first).node(cell.first);
      const Held held{pair.first, {static_cast<std::size_t>(node.stretch), node.u.middle()}};
      FittedPose fitted = fit.fit(fit.pose_at(held, cell.heading.middle), held);
      if (free_.is_blocked(fitted.pose) || (best && worst_of(fit, *best) <= worst_of(fit, fitted))) continue;
      best = std::move(fitted);
    }
    return best ? std::move(*best) : std::move(given);
  }

  void conclude() {
    Verdict& verdict = answer_.verdict;
    const std::vector<TouchPose>& poses = answer_.poses;
    verdict.fits_badly = answer_.fit && answer_.fit->is_bad();
    if (!answer_.unresolved.empty()) {
      answer_.status = Status::incomplete;
      verdict.name = Verdict::undecided;
      return;
    }
    if (poses.empty()) return;
    const bool is_sure = poses.size() == 1 || poses.front().probability >= kSure;
    const std::size_t places = is_sure ? 1 : poses.size();
    const auto stretches =
        static_cast<std::size_t>(std::count_if(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(places),
                                               [](const TouchPose& pose) { return pose.continuum; }));
    if (is_sure && poses.front().any_heading) {
      verdict.name = Verdict::unobservable;
    } else if (is_sure && stretches == 0) {
      verdict.name = Verdict::unique;
    } else {
      verdict.name = Verdict::ambiguous;
      verdict.places = places;
      verdict.stretches = stretches;
    }
  }

  const TouchProblem& problem_;
  TouchAnswer& answer_;
  const std::vector<TouchPose>* known_;
  std::vector<RollContact> rolls_;
  std::vector<Measured> touches_;
  FreeSpace free_;
};

}  // namespace

TouchAnswer solve_plain(const TouchProblem& problem) {
  TouchAnswer answer{problem.part, problem.touches};
  answer.radius = radius_of(problem);
  answer.robust = problem.robust;
  answer.noise = problem.noise;
  answer.pose = problem.pose;
  answer.clear = problem.clear;
  answer.mirrored = problem.mirrored;
  const TouchProblem seen = problem.mirrored ? in_mirror(problem) : problem;
  Solver(seen, answer).run();
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

bool is_own(const TouchPose& pose) { return holds(pose.extent, pose.pose); }

TouchAnswer poses_beyond(const TouchProblem& problem, const std::vector<TouchPose>& known) {
  TouchAnswer answer{problem.part, problem.touches};
  answer.radius = radius_of(problem);
  answer.noise = problem.noise;
  answer.mirrored = problem.mirrored;
  std::copy_if(known.begin(), known.end(), std::back_inserter(answer.poses), is_own);
  if (problem.mirrored) out_of_mirror(answer);  // into it: once more leads back
  const std::vector<TouchPose> seen_known = std::exchange(answer.poses, {});
  const TouchProblem seen = problem.mirrored ? in_mirror(problem) : problem;
  Solver(seen, answer, &seen_known).run();
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

}  // namespace touch

TouchAnswer solve(const TouchProblem& problem) {
  TouchProblem asked = problem;
  if (!asked.noise && !asked.tolerance && have_own_noise(asked.touches)) asked.noise.emplace();
  touch::require_valid(asked);
  const Doing doing(asked.rolls.empty() ? "looking for poses that fit the touches"
                                        : "looking for poses that fit all contacts");
  TouchAnswer answer = touch::solve_plain(asked);
  const bool is_odd = answer.verdict.fits_badly || answer.verdict.name == Verdict::inconsistent;
  if (asked.diagnose && is_odd && answer.status == Status::complete) {
    answer.diagnoses = asked.rolls.empty() ? touch::mistakes(asked) : touch::moved(asked, answer);
  }
  return answer;
}

std::string TouchAnswer::verdict_text() const {
  Verdict plain = verdict;
  plain.fits_badly = false;
  const bool is_said = verdict.fits_badly && verdict.name != Verdict::inconsistent;
  const std::string contradiction = rolls.empty() ? ", but the touches contradict the stated noise"
                                                  : ", but the measurements contradict the stated noise";
  return plain.text() + (is_said ? contradiction : "");
}

}  // namespace rollfix
