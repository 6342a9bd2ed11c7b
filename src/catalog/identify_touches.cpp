#include "rollfix/identify.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "belief/posterior.hpp"
#include "bounds/bounds.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"
#include "touch/measured.hpp"
#include "touch/problem.hpp"
#include "touch/roll_contacts.hpp"
#include "weights.hpp"
#include "work/crew.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/identify.md, "Touches":
//   left            parts that no touch and no roll by itself rules out: `bounds/`
//   weight          peak and volume of a part's evidence, the latter less the log of where poses can be: PartWeight
//   likeness        how far places and tangents of two parts may be apart that no touch tells from each other: Likeness
//   excess          so many times the noise of rolls is let pass, in turn
// Follows docs/identify.md, "Touches" and "How touches rule out a part".
namespace rollfix::catalog {
namespace {

/// What one part says; no answer where it refuses.
struct TouchOutcome {
  std::optional<TouchAnswer> answer;
  std::string refused;
};

/// Solves the problem on one part.
TouchOutcome touch_outcome_of(const Catalog& catalog, const TouchProblem& like, std::size_t part) {
  TouchOutcome outcome;
  TouchProblem problem = like;
  problem.part = catalog.part(part);
  try {
    outcome.answer = solve(problem);
  } catch (const InputError& error) {
    outcome.refused = error.what();
  }
  return outcome;
}

/// What is known of the one part that is left, by touches. Places are poses here; none: one touch fits any.
std::string words_for_poses(const PartWeight& weight) {
  if (weight.places == 0) return "any pose";
  if (weight.verdict.rfind("unobservable", 0) == 0) return "any heading";
  if (weight.verdict.rfind("ambiguous (1 stretch)", 0) == 0) return "a continuum of poses";
  return weight.places == 1 ? "unique pose" : counted(weight.places, "pose", "poses");
}
/// Of touches alone, and of rolls with or without touches.
const Wording kOfTouches{&words_for_poses, ", but the touches contradict the stated noise"};
const Wording kOfContacts{&words_for_poses, ", but the measurements contradict the stated noise"};

/// The weight of a part. Its starts are the first contact of each pose, from which two outlines are compared.
PartWeight weight_of(std::size_t part, const TouchAnswer& answer) {
  PartWeight weight;
  weight.part = part;
  weight.verdict = answer.verdict_text();
  weight.undecided = answer.status == Status::incomplete;
  weight.fits = !answer.poses.empty() || answer.verdict.name == Verdict::unobservable;
  weight.fits_badly = answer.verdict.fits_badly;
  weight.places = answer.verdict.name == Verdict::unique ? 1 : answer.poses.size();
  for (const TouchPose& pose : answer.poses) weight.starts.push_back(pose.contacts.front().s);
  if (weight.starts.empty()) weight.starts = {0};  // one touch: at least an outline under two names is seen
  if (!std::isnan(answer.log_evidence)) weight.peak = answer.log_evidence;
  return weight;
}

/// How far two parts may be apart that no touch tells from each other.
Likeness likeness_of(const TouchProblem& like, const std::vector<TouchTolerance>& tolerance) {
  Likeness likeness;
  likeness.noisy = like.noise.has_value();
  likeness.turn = kSameTurn;
  likeness.length = std::numeric_limits<double>::infinity();
  for (const TouchTolerance& one : tolerance) {
    // One standard deviation: what is searched with is kPossibleSigmas of them.
    likeness.length = std::min(likeness.length, like.noise ? one.length / kPossibleSigmas : one.length);
  }
  // All pairs of touches: the distance of two of them is what a touch measures of a part's size.
  for (const MeasuredTouch& one : like.touches) {
    // Over the largest distance of two touches a difference in scale shows most.
    for (const MeasuredTouch& other : like.touches) {
      likeness.roll = std::max(likeness.roll, (other.at - one.at).norm());
    }
  }
  for (const Log& roll : like.rolls) {
    const Likeness of_roll = catalog::likeness_of(touch::alone(like, roll));
    likeness.length = std::min(likeness.length, of_roll.length);
    likeness.roll = std::max(likeness.roll, of_roll.roll);
    // Without touches the rolls' angles say how far tangents may differ.
    if (like.touches.empty()) likeness.turn = of_roll.turn;
  }
  return likeness;
}

/// Throws InputError: what no part could take.
void require_valid(const Catalog& catalog, const TouchProblem& like) {
  if (like.rolls.size() == 1 && like.touches.empty()) {
    throw InputError("identify: expected several rolls, or touches, found one roll: give it as a Problem");
  }
  // The largest part stands for all: what is too much for it is too much for each.
  std::size_t largest = 0;
  for (std::size_t k = 1; k < catalog.size(); ++k) {
    if (catalog.entry(k).perimeter > catalog.entry(largest).perimeter) largest = k;
  }
  TouchProblem on_largest = like;
  on_largest.part = catalog.part(largest);
  touch::require_valid(on_largest);
}

/// An answer with what was asked, and nothing found yet.
IdentifiedByTouches touches_of(const TouchProblem& like) {
  IdentifiedByTouches found;
  for (const Log& roll : like.rolls) {
    const std::vector<std::size_t>& line = roll.fingers.front().line;
    // With the first and the last line of each, where it is of a file.
    found.rolls.push_back({roll.name, {}, roll.rows()});
    if (!line.empty()) found.rolls.back().lines = {line.front(), line.back()};
  }
  found.touches = like.touches;
  found.clear = like.clear;
  found.radius = touch::radius_of(like);
  found.noise = like.noise;
  found.mirrored = like.mirrored;
  return found;
}

/// Those of the parts that no touches and no roll by itself rule out, with so many times the noise of rolls. With
/// outliers among the rows no roll does.
std::vector<std::size_t> parts_left(const Catalog& catalog, const TouchProblem& like, double excess,
                                    const IdentifyOptions& options, std::vector<std::size_t> parts) {
  const bool may_have_outliers = like.robust && !like.touches.empty();  // then no touch rules a part out
  if (!options.use_index || may_have_outliers) return parts;
  std::vector<std::size_t> left = TouchBounds(catalog, like).left_of(parts, options);
  // Any row may be an outlier: rolls rule out nothing.
  if (like.robust) return left;
  // Rolls as the stored outline sees them: bounds know no mirror.
  const TouchProblem seen = like.mirrored ? touch::in_mirror(like) : like;
  // Each roll by itself, on the parts that the ones before have left.
  for (const Log& roll : seen.rolls) {
    const std::vector<PartLeft> of_roll = Bounds(catalog, touch::alone(seen, roll), excess).left_of(left, options);
    left.clear();
    for (const PartLeft& one : of_roll) left.push_back(one.part);
    std::sort(left.begin(), left.end());
  }
  return left;
}

/// Solves the parts that are left.
std::vector<TouchOutcome> touch_outcomes_of(const Catalog& catalog, const TouchProblem& like,
                                            const IdentifyOptions& options, const std::vector<std::size_t>& left) {
  std::vector<TouchOutcome> outcomes(left.size());
  each_of(left.size(), options, [&](std::size_t k) { outcomes[k] = touch_outcome_of(catalog, like, left[k]); });
  return outcomes;
}

/// Whether some part has a pose that the measurements don't contradict.
bool any_fits_well(const std::vector<TouchOutcome>& outcomes) {
  return std::any_of(outcomes.begin(), outcomes.end(), [](const TouchOutcome& one) {
    return one.answer && !one.answer->poses.empty() && !one.answer->verdict.fits_badly;
  });
}

/// The other parts that may be it where rows are noisier than stated, up to where nothing is said to fit.
void look_widely(const Catalog& catalog, const TouchProblem& like, const IdentifyOptions& options,
                 const std::vector<std::size_t>& parts, std::vector<TouchOutcome>& outcomes,
                 IdentifiedByTouches& found) {
  std::vector<std::size_t> others;
  const std::vector<std::size_t> wide = parts_left(catalog, like, belief::kMostExcess, options, parts);
  // Only those that were not solved before. Both lists are sorted.
  std::set_difference(wide.begin(), wide.end(), found.left.begin(), found.left.end(), std::back_inserter(others));
  for (TouchOutcome& one : touch_outcomes_of(catalog, like, options, others)) outcomes.push_back(std::move(one));
  // Outcomes and parts stay in the same order.
  found.left.insert(found.left.end(), others.begin(), others.end());
  found.searched = found.left.size();
}

/// The parts that something fits on, as one verdict.
void take(const Catalog& catalog, const TouchProblem& like, std::vector<TouchOutcome> outcomes,
          IdentifiedByTouches& found) {
  std::vector<PartWeight> weights;
  std::vector<std::size_t> from;  // the outcome of each weight
  std::vector<std::size_t> remaining;
  // Each part that was solved: it refuses, fits nowhere, is undecided, or is weighed.
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const std::size_t part = found.left[k];
    if (!outcomes[k].answer) {
      found.refused.push_back({part, outcomes[k].refused});
      remaining.push_back(part);
      continue;
    }
    // Weighed as rolls are: what fits nowhere is not listed.
    const PartWeight weight = weight_of(part, *outcomes[k].answer);
    if (!weight.fits && !weight.undecided) continue;
    // Its search ran out of budget: it remains, and the verdict is undecided.
    if (weight.undecided) found.undecided.push_back(part);
    weights.push_back(weight);
    from.push_back(k);
    remaining.push_back(part);
  }
  // What every part refuses is the problem's own fault.
  if (!found.refused.empty() && found.refused.size() == found.searched) throw InputError(found.refused.front().why);
  // Parts on which nothing fits are gone.
  found.left = std::move(remaining);
  // Rolls may be ruled out whose rows are far off, but not as far as to fit nowhere: whether they were or not, `rest`
  // has all parts.
  const bool has_rolls = !like.rolls.empty();
  const Conclusion conclusion = conclude(catalog, weights, has_rolls ? found.asked : weights.size(),
                                         likeness_of(like, found.tolerance), has_rolls ? kOfContacts : kOfTouches);
  found.verdict = conclusion.verdict;
  found.rest = conclusion.rest;
  for (const std::size_t k : conclusion.order) {
    found.parts.push_back(
        {weights[k].part, std::move(*outcomes[from[k]].answer), conclusion.probability[k], conclusion.congruent[k]});
  }
  // One part that is not decided leaves all of the verdict open.
  if (found.undecided.empty()) return;
  found.status = Status::incomplete;
  found.verdict = "undecided";
  found.rest = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

}  // namespace rollfix::catalog

namespace rollfix {

IdentifiedByTouches identify(const Catalog& catalog, const TouchProblem& asked, const IdentifyOptions& options) {
  TouchProblem like = asked;
  like.diagnose = false;
  // Touches may state their own noise.
  if (!like.noise && !like.tolerance && have_own_noise(like.touches)) like.noise.emplace();
  IdentifiedByTouches found = catalog::touches_of(like);
  if (catalog.size() == 0) {
    found.verdict = "none";
    return found;
  }
  catalog::require_valid(catalog, like);
  // What is searched with, of each touch, for whoever reads the answer.
  for (const touch::Measured& touch : touch::measured(like))
    found.tolerance.push_back({touch.place_most, touch.angle_most});
  const Doing doing("searching the catalog's parts");
  const std::vector<std::size_t> parts = catalog::parts_of(catalog, options);
  found.asked = parts.size();
  found.left = catalog::parts_left(catalog, like, 1, options, parts);
  found.searched = found.left.size();
  // Too many to be solved: they are only counted.
  if (found.left.size() > options.most_searched) {
    found.counted = true;
    found.verdict = counted(found.left.size(), "part", "parts");
    return found;
  }
  std::vector<catalog::TouchOutcome> outcomes = catalog::touch_outcomes_of(catalog, like, options, found.left);
  if (like.noise && !like.rolls.empty() && !catalog::any_fits_well(outcomes))
    catalog::look_widely(catalog, like, options, parts, outcomes, found);
  catalog::take(catalog, like, std::move(outcomes), found);
  return found;
}

}  // namespace rollfix
