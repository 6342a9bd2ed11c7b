#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "problem.hpp"
#include "roll_contacts.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/touch.hpp"

// Notation:
//   E_j             extents of the poses that an answer lists, intervals of x, y and the heading: `known`, PoseExtent
//   (a, b)          a cell of the search: stretches of two contacts, and around its poses an extent: `extent_of`
//   delta, eps      tolerances of contacts; of a roll those of its first contact, which its readings confine to arcs
// Follows docs/certificates.md: what is within all tolerances and in no E_j is a claim that the answer lacks something.
// Idea: the search of a problem without noise, less the cells whose extent is all in one E_j. What is left is witnessed
// or refuted as ever; of what the budget leaves open the extents are told.
namespace rollfix::touch {
namespace {

/// All that fits the readings.
/// The complete search of one roll, without noise, log and reach.
Answer placed(const Part& part, const RollSearched& roll) {
  Answer alone{part, {}};
  alone.readings.assign(roll.readings.begin(), roll.readings.end());
  alone.tolerance.value = roll.tolerance;
  LocateOptions options;
  options.tolerance = roll.tolerance;
  Search found = locate(part, roll.readings, options);
  alone.status = found.status;
  alone.verdict = found.verdict();
  alone.placements = std::move(found.placements);
  alone.unresolved = std::move(found.unresolved);
  return alone;
}

/// Rolls as contacts by the readings that were searched with alone, without noise: also where other rows of the log
/// contradict them, or where the finger could not have rolled. `tolerance`: of each, first those of rolls.
/// Throws InputError as `locate` does.
std::vector<RollContact> plain_rolls(const Part& part, double radius, const std::vector<RollSearched>& rolls,
                                     const std::vector<TouchTolerance>& tolerance) {
  std::vector<RollContact> contacts;
  for (std::size_t k = 0; k < rolls.size(); ++k) {
    RollContact contact{placed(part, rolls[k]), {}, {}, {}, {}, {}};
    confine_by_readings(contact, part, radius);
    Measured& measured = contact.measured;
    // As `contact_of` of roll_contacts.cpp, by what was stored of the roll.
    measured.is_roll = true;
    measured.tangent = rolls[k].normal + 0.5 * std::numbers::pi;
    measured.angle_unit = measured.angle_most = tolerance[k].angle;
    measured.has_place = rolls[k].at.has_value();
    measured.at = rolls[k].at.value_or(Vec2::Zero());
    measured.place_unit = measured.place_most = measured.has_place ? tolerance[k].length : part.perimeter();
    measured.tree = contact.tree.get();
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

// Of the least difference of two poses: rounding.
constexpr double kRounding = 1e-6;

/// Whether all of this box is in a pose's extent.
/// The box's middle, with the extent smaller by half the box on each side. A pose of any heading leaves x and y to be
/// compared. `rounding`: length.
bool covers(const TouchPose& pose, const PoseExtent& box, double rounding) {
  PoseExtent inner = pose.extent;
  for (std::size_t k = 0; k < 3; ++k) {
    inner[k] = {inner[k].lo + 0.5 * box[k].width(), inner[k].hi - 0.5 * box[k].width()};
  }
  if (pose.any_heading) inner[2] = pose.extent[2];
  return holds(inner, {box[0].middle(), box[1].middle(), box[2].middle()}, rounding);
}

/// Cells all of whose poses are in a known extent go.
/// A cell's poses lie in its extent, so none that is not known goes with it.
void drop_known(std::vector<Cell>& cells, const Asked& asked, const std::vector<TouchPose>& known) {
  const double rounding = kRounding * least_difference({asked.fit.touches()[asked.pair.first]});
  const auto is_known = [&](const Cell& cell) {
    const PoseExtent box = extent_of(asked.fit, {cell}, asked.pair, {});
    return std::any_of(known.begin(), known.end(), [&](const TouchPose& pose) { return covers(pose, box, rounding); });
  };
  cells.erase(std::remove_if(cells.begin(), cells.end(), is_known), cells.end());
}

/// Whether headings are all among others, which may be whole turns off.
/// Modulo turns: middles are compared, and half widths.
bool is_in(const Interval& headings, const Interval& others) {
  const double off = std::abs(nearest_angle(headings.middle() - others.middle()));
  return off + 0.5 * headings.width() <= 0.5 * others.width() + kRounding * others.width();
}

/// Sets of which it is not known whether a pose of theirs fits: extents alone.
/// One for each component of the cells.
std::vector<TouchPose> bare_poses(const Asked& asked, std::vector<Cell> cells) {
  std::vector<TouchPose> bare;
  const CellSets sets = sets_of(asked.fit.tree(asked.pair.first), asked.fit.tree(asked.pair.second), std::move(cells));
  for (const std::vector<std::size_t>& component : sets.components) {
    const std::vector<Cell> own = cells_of(sets, component);
    bare.emplace_back();
    bare.back().extent = extent_of(asked.fit, own, asked.pair, {0, 0, own.front().heading.middle});
  }
  return bare;
}

/// Sets of headings that are in none of those that are known; nothing tells where the part is.
/// As `search_headings` of solve_touches.cpp; a known pose of any heading leaves nothing.
void headings_beyond(const AllContacts& contacts, const std::vector<TouchPose>& known, std::size_t budget,
                     TouchAnswer& answer) {
  HeadingSets found = heading_sets(contacts.each, budget);
  for (TouchPose& pose : found.poses) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const TouchPose& one) {
      return one.extent[2].width() >= kFullTurn || is_in(pose.extent[2], one.extent[2]);
    });
    if (!is_known) answer.poses.push_back(std::move(pose));
  }
  // The budget ended: all of the first contact's places stay open.
  if (found.complete) return;
  for (const CentreStretch& stretch : contacts.each.front().tree->path().stretches()) {
    answer.unresolved.push_back(stretch.corner ? Interval{stretch.s, stretch.s} : stretch.u);
  }
}

/// What the search of a roll's readings could not decide stays undecided.
/// `unresolved` is of one contact. If two contacts have open places, all of the boundary is told instead.
void leave_rolls_open(const AllContacts& contacts, TouchAnswer& answer) {
  for (std::size_t k = 0; k < contacts.rolls.size(); ++k) {
    const Answer& alone = contacts.rolls[k].alone;
    if (alone.status == Status::complete) continue;
    const bool is_other = !answer.unresolved.empty() && answer.unresolved_touch != k;
    if (is_other) answer.unresolved = {{0, answer.part.perimeter()}};
    if (is_other) return;
    answer.unresolved_touch = k;
    for (const PerFinger<Interval>& arc : alone.unresolved) answer.unresolved.push_back(arc[0]);
  }
}

/// `known`: as the problem is seen, in the mirror of a part face down. What they cover is not witnessed.
void search_beyond(const TouchProblem& problem, AllContacts& contacts, const std::vector<TouchPose>& known,
                   TouchAnswer& answer) {
  for (Measured& touch : contacts.each) {  // all that is within the tolerances counts
    touch.place_unit = touch.place_most;
    touch.angle_unit = touch.angle_most;
  }
  const std::size_t budget = problem.budget.value_or(kTouchBudget);
  if (answer.place == PlaceKnown::unknown) return headings_beyond(contacts, known, budget, answer);
  const TouchPair pair = choose_pair(contacts.each);
  std::optional<CellSearch> search;
  LevelCells level = search_levels(search, contacts, pair, budget, kEnoughCells);
  PoseFit fit(contacts.each, problem.pose);
  FreeSpace free(problem, contacts.each);
  const Asked asked{problem, fit, pair, free, answer.place};
  // Before cells are cut finer: coarse cells within a known extent go at once.
  drop_known(level.cells.fit, asked, known);
  std::vector<Cell> undecided = std::move(level.cells.undecided);
  // Nothing is weighed: also with noise a pose within the tolerances is a claim.
  WitnessedPoses found = witnessed_poses(asked, *search, cut_sets(asked, *search, std::move(level), kEnoughCells));
  answer.poses = std::move(found.poses);
  for (TouchPose& bare : bare_poses(asked, std::move(found.without))) answer.poses.push_back(std::move(bare));
  // What is open is open in the pair's first contact.
  undecided.insert(undecided.end(), found.undecided.begin(), found.undecided.end());
  answer.unresolved_touch = pair.first;
  answer.unresolved = places_of(fit.tree(pair.first), undecided);
}

}  // namespace

bool is_own(const TouchPose& pose) { return holds(pose.extent, pose.pose); }

TouchAnswer poses_beyond(const TouchProblem& problem, const std::vector<RollSearched>& rolls,
                         const std::vector<TouchTolerance>& tolerance, const std::vector<TouchPose>& known) {
  TouchAnswer answer{problem.part, problem.touches};
  answer.radius = radius_of(problem);
  answer.noise = problem.noise;
  answer.mirrored = problem.mirrored;
  // A problem with touches has a place: `require_valid` refuses normals alone.
  const bool any_place = !problem.touches.empty() ||
                         std::any_of(rolls.begin(), rolls.end(), [](const RollSearched& roll) { return roll.at; });
  if (!any_place) answer.place = PlaceKnown::unknown;
  std::copy_if(known.begin(), known.end(), std::back_inserter(answer.poses),
               [&](const TouchPose& pose) { return !any_place || is_own(pose); });
  if (problem.mirrored) out_of_mirror(answer);  // into it: once more leads back
  // The known poses as they are seen; from here on `answer.poses` are those that are found.
  const std::vector<TouchPose> seen_known = std::exchange(answer.poses, {});
  const TouchProblem seen = problem.mirrored ? in_mirror(problem) : problem;

  std::vector<RollSearched> seen_rolls = rolls;
  for (RollSearched& roll : seen_rolls) {
    if (problem.mirrored) roll = in_mirror(std::move(roll));
  }
  // A contact that fits nowhere leaves no pose at all.
  AllContacts contacts(seen, answer.radius, plain_rolls(problem.part, answer.radius, seen_rolls, tolerance));
  if (!contacts.one_fits_nowhere()) search_beyond(seen, contacts, seen_known, answer);
  leave_rolls_open(contacts, answer);
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

}  // namespace rollfix::touch
