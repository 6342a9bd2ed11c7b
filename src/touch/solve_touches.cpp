#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "locate/remaining.hpp"
#include "problem.hpp"
#include "roll_contacts.hpp"
#include "rollfix/error.hpp"
#include "rollfix/touch.hpp"
#include "steps.hpp"
#include "work/pulse.hpp"

// Notation:
//   contact      a roll's first one or a touch, rolls first: `contacts.each`; two of them are the `pair`
//   cell         stretches of both contacts of the pair, and headings phi of the part: cell_search.hpp
//   set          cells that hang together, cut level by level: pose_sets.cpp
//   witness      without noise: a pose of the set with every residual within its tolerance
//   weight       with noise: of a node of the posterior; a set's share of all weights is its probability
//   log Z        `log_evidence`: likelihood of all contacts, averaged over poses and over where they can be
// Follows docs/touch.md, "How it works" and "What the answer promises".
// Idea: find every pose of the part in which all contacts fit. The search leaves cells that hold all such poses. Each
// connected set of them is told with a pose that fits, or with noise with its probability. What the search could not
// decide goes into `unresolved`; nothing is dropped but what is proved not to fit, or is improbable.
namespace rollfix {
namespace touch {
namespace {

/// Places without normals, within their tolerances of each other: they say what one says, any place and any heading.
bool are_at_one_place(const AllContacts& contacts) {
  const Measured& first = contacts.each.front();
  return contacts.rolls.empty() && std::all_of(contacts.each.begin(), contacts.each.end(), [&](const Measured& one) {
           return !one.tangent && (one.at - first.at).norm() <= std::min(one.place_most, first.place_most);
         });
}

/// The verdict of what was found, in this order: something undecided, the pose open by too many outliers, no pose, one,
/// or several. With noise `how_many_remain` counts only poses that are probable enough.
void conclude(TouchAnswer& answer) {
  Verdict& verdict = answer.verdict;
  verdict.fits_badly |= (answer.fit && answer.fit->is_bad()) || has_many_outliers(answer);
  if (!answer.unresolved.empty()) {
    answer.status = Status::incomplete;
    verdict.name = Verdict::undecided;
    return;
  }
  // Robust: the probability that too few touches count to hold the part.
  if (answer.anywhere > 1 - kSureProbability) {
    verdict.name = Verdict::unobservable;
    return;
  }
  // Of a round part, for example, the place is known and the heading is not.
  verdict = verdict_of(
      answer.poses, [](const TouchPose& pose) { return pose.any_heading; }, verdict.fits_badly);
}

/// Facts of each roll, and what tells the place: measured centres, only the reference, or nothing.
void add_rolls(const TouchProblem& problem, const std::vector<RollContact>& rolls, TouchAnswer& answer) {
  for (std::size_t k = 0; k < rolls.size(); ++k) answer.rolls.push_back(facts_of(rolls[k], problem.rolls[k]));
  if (rolls.empty() || !problem.touches.empty()) return;
  const bool is_measured = std::any_of(rolls.begin(), rolls.end(), [](const RollContact& roll) {
    return roll.measured.has_place && !is_reference(roll.measured);
  });
  if (!is_measured) answer.place = answer.rolls.front().has_centre ? PlaceKnown::reference : PlaceKnown::unknown;
}

/// With noise: the likelihood of all contacts, averaged over where each of them may be. `of_poses`: what the posterior
/// adds up to, in which a roll's density by its first contact and the pose is 1 all together.
double log_evidence_of(const TouchProblem& problem, const AllContacts& contacts, double of_poses) {
  const double radius = radius_of(problem);
  // Each contact is anywhere within reach with density 1 / length.
  const double length = contacts.path ? length_in_reach(*contacts.path) : length_in_reach({problem.part, radius});
  double sum = of_poses - static_cast<double>(contacts.each.size()) * std::log(length);
  for (const RollContact& roll : contacts.rolls) sum += roll.log_evidence;
  return sum;
}

/// The poses of a roll alone by how likely they leave the clear paths free; the logarithm of what is left of them.
double weigh_by_paths(const TouchProblem& problem, const AllContacts& contacts, TouchAnswer& answer) {
  FreeSpace free(problem, contacts.each);
  if (free.is_empty() || answer.poses.empty() || answer.place == PlaceKnown::unknown) return 0;
  std::vector<PosteriorNode> nodes;
  for (const TouchPose& pose : answer.poses) {
    PosteriorNode node;
    node.pose = pose.spread.mean;
    node.covariance = pose.spread.covariance;
    node.log_weight = std::log(pose.probability);
    nodes.push_back(node);
  }
  free.weigh(nodes);
  double left = 0;
  for (const PosteriorNode& node : nodes) left += std::exp(node.log_weight);
  // Probabilities of those left add up to 1 again; the sum before is what the paths leave.
  for (std::size_t k = 0; k < nodes.size(); ++k) answer.poses[k].probability = std::exp(nodes[k].log_weight) / left;
  std::erase_if(answer.poses, [](const TouchPose& pose) { return !(pose.probability >= kLeastListed); });
  put_in_order(answer.poses);
  if (answer.status == Status::complete) conclude(answer);
  return std::log(left);
}

/// Of one contact alone; of a touch there is nothing to say.
void take_alone(const TouchProblem& problem, const AllContacts& contacts, TouchAnswer& answer) {
  if (!contacts.rolls.empty()) {
    take_from(contacts.rolls.front(), answer);
    if (problem.noise)
      answer.log_evidence = log_evidence_of(problem, contacts, weigh_by_paths(problem, contacts, answer));
    return;
  }
  // One touch fits all along the boundary.
  answer.verdict.name = Verdict::unobservable;
  if (problem.noise) answer.log_evidence = 0;  // the same on any part
}

/// Without noise, and with nothing that tells the place.
void search_headings(const TouchProblem& problem, const AllContacts& contacts, TouchAnswer& answer) {
  HeadingSets found = heading_sets(contacts.each, problem.budget.value_or(kTouchBudget));
  answer.poses = std::move(found.poses);
  answer.comparisons = found.comparisons;
  // The budget ended: any place of the first contact is left open.
  if (found.complete) return;
  for (const CentreStretch& stretch : contacts.each.front().tree->path().stretches()) {
    answer.unresolved.push_back(stretch.corner ? Interval{stretch.s, stretch.s} : stretch.u);
  }
}

/// `log_evidence` stays NaN where nothing was weighed.
void take_over(WeighedPoses weighed, const TouchProblem& problem, const AllContacts& contacts, TouchAnswer& answer) {
  answer.poses = std::move(weighed.poses);
  answer.fit = weighed.fit;
  answer.improbable += weighed.improbable;
  answer.rest += weighed.rest;
  if (weighed.log_evidence) answer.log_evidence = log_evidence_of(problem, contacts, *weighed.log_evidence);
}

/// One place and a prior that knows where the part is: a grid, no search.
void weigh_by_prior(const TouchProblem& problem, const AllContacts& contacts, TouchAnswer& answer) {
  PoseFit fit(contacts.each, problem.pose);
  FreeSpace free(problem, contacts.each);
  take_over(weighed_by_prior({problem, fit, {}, free, answer.place}), problem, contacts, answer);
}

/// The search proper: cells, sets, then witnesses or probabilities. `undecided` gathers all that was left open on the
/// way.
void search_poses(const TouchProblem& problem, AllContacts& contacts, TouchAnswer& answer) {
  const TouchPair pair = choose_pair(contacts.each);
  const std::size_t budget = problem.budget.value_or(kTouchBudget);
  // Weighing a cell takes longer than looking for a witness in it.
  const std::size_t enough = problem.noise && contacts.rolls.empty() ? kEnoughToWeigh : kEnoughCells;
  std::optional<CellSearch> search;
  LevelCells level = search_levels(search, contacts, pair, budget, enough);
  PoseFit fit(contacts.each, problem.pose);
  FreeSpace free(problem, contacts.each);
  const Asked asked{problem, fit, pair, free, answer.place};
  const std::size_t abandoned = level.abandoned;
  std::vector<Cell> undecided = std::move(level.cells.undecided);
  std::vector<LevelSets> levels = cut_sets(asked, *search, std::move(level), enough);
  const auto leave = [&](const std::vector<Cell>& more) {
    undecided.insert(undecided.end(), more.begin(), more.end());
  };
  if (problem.noise) {
    const CellSets sets = together(std::move(levels));
    WeighedPoses weighed = weighed_poses(asked, sets, budget);
    // Nothing was weighed: all cells stay open.
    if (weighed.is_too_long) leave(sets.cells);
    take_over(std::move(weighed), problem, contacts, answer);
  } else {
    WitnessedPoses witnessed = witnessed_poses(asked, *search, levels);
    leave(witnessed.undecided);
    leave(witnessed.without);
    answer.poses = std::move(witnessed.poses);
  }
  // What is open is told as arcs of the pair's first contact.
  answer.unresolved_touch = pair.first;
  answer.unresolved = places_of(fit.tree(pair.first), undecided);
  answer.comparisons = abandoned + search->comparisons();
}

/// The answer in which every touch counts. Chooses how to solve: one contact alone, one place with a prior, headings
/// alone, or the search. REQUIRES a valid problem, as it is seen.
void solve_counted(const TouchProblem& problem, TouchAnswer& answer) {
  AllContacts contacts(problem, answer.radius);
  for (const Measured& one : contacts.each) answer.tolerance.push_back({one.place_most, one.angle_most});
  add_rolls(problem, contacts.rolls, answer);
  const bool is_alone = contacts.each.size() == 1 || are_at_one_place(contacts);
  const bool by_prior = is_alone && problem.rolls.empty() && contacts.each.front().has_place && knows_place(problem);
  if (is_alone && !by_prior) {
    take_alone(problem, contacts, answer);
    return;
  }
  answer.verdict.name = Verdict::inconsistent;
  // A roll that fits nowhere by itself, or a disk that fits nowhere: inconsistent.
  if (contacts.one_fits_nowhere()) return;
  if (by_prior) {
    weigh_by_prior(problem, contacts, answer);
  } else if (!problem.noise && answer.place != PlaceKnown::measured) {
    search_headings(problem, contacts, answer);
  } else {
    search_poses(problem, contacts, answer);
  }
  if (!contacts.rolls.empty()) add_roll_ends(contacts.rolls, contacts.each, answer);
  conclude(answer);
  take_over_doubts(contacts.rolls, answer);
}

/// `problem`: as it is seen, of a part that lies face down in the mirror.
/// One contact may be an outlier only where a prior says where the part is.
void solve_seen(const TouchProblem& problem, TouchAnswer& answer) {
  const bool is_one = problem.rolls.size() + problem.touches.size() == 1;
  const bool may_have_outliers = problem.robust && !problem.touches.empty() && (!is_one || knows_place(problem));
  if (!may_have_outliers) return solve_counted(problem, answer);
  solve_with_outliers(problem, solve_counted, answer);
  conclude(answer);
}

}  // namespace

/// What was asked, then the solve in the mirror where the part lies face down, then back.
TouchAnswer solve_plain(const TouchProblem& problem) {
  TouchAnswer answer{problem.part, problem.touches};
  answer.radius = radius_of(problem);
  answer.robust = problem.robust;
  answer.noise = problem.noise;
  answer.pose = problem.pose;
  answer.clear = problem.clear;
  answer.mirrored = problem.mirrored;
  const TouchProblem seen = problem.mirrored ? in_mirror(problem) : problem;
  solve_seen(seen, answer);
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

}  // namespace touch

TouchAnswer solve(const TouchProblem& problem) {
  TouchProblem asked = problem;
  // Each touch has its own standard deviations: the common ones are not needed.
  if (!asked.noise && !asked.tolerance && have_own_noise(asked.touches)) asked.noise.emplace();
  touch::require_valid(asked);
  const Doing doing(asked.rolls.empty() ? "looking for poses that fit the touches"
                                        : "looking for poses that fit all contacts");
  TouchAnswer answer = touch::solve_plain(asked);
  // Too many outliers are told as such: the usual mistakes would not explain them.
  const bool has_bad_fit = answer.verdict.fits_badly && !touch::has_many_outliers(answer);
  const bool is_odd = has_bad_fit || answer.verdict.name == Verdict::inconsistent;
  // Only complete answers: an incomplete one may have missed the pose that fits.
  if (asked.diagnose && is_odd && answer.status == Status::complete) {
    answer.diagnoses = asked.rolls.empty() ? touch::mistakes(asked) : touch::moved(asked, answer);
  }
  return answer;
}

std::string TouchAnswer::verdict_text() const {
  return text_of_verdict(verdict, rolls.empty() ? "touches" : "measurements");
}

}  // namespace rollfix
