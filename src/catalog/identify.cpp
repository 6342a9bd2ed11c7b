#include "rollfix/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "answer/steps.hpp"
#include "belief/posterior.hpp"
#include "catalog/bounds/bounds.hpp"
#include "rollfix/error.hpp"
#include "rollfix/solve.hpp"
#include "text/text.hpp"
#include "weights.hpp"
#include "work/crew.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/identify.md:
//   weight          what a part is worth: peak and volume of its evidence, `widened` and `excess` of its noise:
//                   PartWeight
//   glance          the same by no more than `kNodes` joined rows
//   rival           the likeliest part so far: below exp(-`kHopeless`) of its weight a part is not looked at further
//   excess          so many times the noise that was said is let pass, in turn: `look`
//   left            parts, with the cells of 256 in which bounds let the roll start: PartLeft
// Follows docs/identify.md, "How parts are ruled out".
// Idea: bounds rule out most parts, with noise a glance most others, and those that are left are solved.
namespace rollfix::catalog {
namespace {

// Rows are joined to so many at most, so that a part takes a tenth of the time. Fewer tell less, so that more parts
// have to be solved.
constexpr std::size_t kNodes = 32;
// A part is left out that has less than exp(-this) of the likeliest one's weight: joined rows tell a little less.
constexpr double kHopeless = 25;

/// What a part makes of the joined rows; nothing where it is hopeless next to the likeliest so far.
struct Glance {
  std::optional<PartWeight> weight;  // of the way that fits best
  bool refused = false;              // the part can't have been rolled on so: the solver has to say why
};

/// The likeliest part so far, as part `part` is held against it: with that part's count and perimeter, which its belief
/// does not know. Nothing: there is none yet.
std::optional<Rival> rival_of(const Catalog& catalog, const std::vector<PartWeight>& weights, std::size_t part) {
  if (weights.empty()) return std::nullopt;
  const PartWeight& best = best_of(weights);
  const double log_evidence = log_weight(catalog, best, best.widened) - std::log(catalog.entry(part).count) +
                              std::log(catalog.entry(part).perimeter);
  // The likeliest so far fits nowhere: nothing to be held against.
  if (!std::isfinite(log_evidence)) return std::nullopt;
  return Rival{log_evidence, best.widened};
}

/// The stretches of the boundary that these cells are.
std::vector<Interval> stretches_of(const Cells<kFineCells>& cells, double perimeter) {
  std::vector<Interval> stretches;
  const double step = perimeter / kFineCells;
  for (std::size_t k = 0; k < kFineCells; ++k) {
    if (!cells[k]) continue;
    const double lo = step * static_cast<double>(k);
    // Neighbouring cells are one stretch.
    if (k == 0 || !cells[k - 1]) stretches.push_back({lo, lo});
    stretches.back().hi = step * static_cast<double>(k + 1);
  }
  return stretches;
}

/// What one part makes of the joined rows, in each way that the roll may have gone, and only where bounds let it start.
/// `weights`: of parts so far, of which the likeliest is the rival.
Glance glance_at(const Catalog& catalog, const std::vector<Problem>& ways, const PartLeft& left,
                 const std::vector<PartWeight>& weights) {
  // The part, each way in which the roll may have gone, is held against the likeliest one before.
  const std::optional<Rival> rival = rival_of(catalog, weights, left.part);
  Glance glance;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    Problem way = ways[k];
    way.part = catalog.part(left.part);
    Supposed supposed;
    supposed.nodes = kNodes;
    if (!left.cells.empty()) {
      // Bounds exclude this way.
      if (left.cells[k].none()) continue;
      supposed.within = stretches_of(left.cells[k], way.part.perimeter());
    }
    std::optional<Belief> belief;
    try {
      belief = believe(way, observe(way), supposed);
    } catch (const InputError&) {  // the solver says why
      glance.refused = true;
      continue;
    }
    if (rival && belief->is_hopeless(*rival)) continue;
    PartWeight weight;
    weight.part = left.part;
    weight.peak = belief->evidence().peak;
    // The evidence is averaged over first contacts anywhere on the boundary: density 1 / P.
    weight.volume = belief->evidence().volume - std::log(way.part.perimeter());
    weight.widened = belief->fit().widened;
    weight.excess = belief->fit().excess;
    // The likelier way counts.
    if (!glance.weight || glance.weight->peak < weight.peak) glance.weight = weight;
  }
  return glance;
}

/// Of each part; adds what they weigh to the weights.
std::vector<Glance> glances_at(const Catalog& catalog, const Problem& like, const std::vector<PartLeft>& parts,
                               std::vector<PartWeight>& weights, const IdentifyOptions& options) {
  std::vector<Problem> ways;
  // In the order of RollClues, whose cells go with them.
  for (const View& view : views_of(like)) ways.push_back(view.of(like));
  std::vector<Glance> glances(parts.size());
  // Those before tell what the others are held against: the same ones with however many threads.
  // Blocks of 1, 1, 2, 4, ... parts. Parts of one block don't see each other, so that what each is held against does
  // not depend on the order in which threads end.
  for (std::size_t begin = 0, end = 1; begin < parts.size(); begin = end, end = 2 * end) {
    end = std::min(end, parts.size());
    each_of(end - begin, options,
            [&](std::size_t k) { glances[begin + k] = glance_at(catalog, ways, parts[begin + k], weights); });
    for (std::size_t k = begin; k < end; ++k) {
      if (glances[k].weight) weights.push_back(*glances[k].weight);
    }
  }
  return glances;
}

/// Whether a glance tells anything: not without noise, of two fingers, or with stray rows among them.
bool can_glance(const Problem& like) {
  const std::size_t fingers = like.measured.is_log()           ? like.measured.log->fingers.size()
                              : like.measured.readings.empty() ? 1
                                                               : like.measured.readings.front().fingers();
  return like.noise && !like.robust && fingers == 1;
}

/// Of these parts those that may be something next to the likeliest of them, or of those whose weights are known
/// already, by a roll of one finger with noise: all rows are looked at, but joined to a few, and only where bounds let
/// a roll start. No part is left out that has more than exp(-20) of its weight.
std::vector<std::size_t> worth_a_look(const Catalog& catalog, const Problem& like, const std::vector<PartLeft>& parts,
                                      std::vector<PartWeight> known, const IdentifyOptions& options) {
  std::vector<PartWeight> weights = std::move(known);
  const std::vector<Glance> glances = glances_at(catalog, like, parts, weights, options);
  // All with the noise of the likeliest part, as the conclusion does.
  const double widened = weights.empty() ? 1 : best_of(weights).widened;
  const double most = weights.empty() ? 0 : log_weight(catalog, best_of(weights), widened);
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Glance& one = glances[k];
    // By the final likeliest one: what was held against a weaker rival may be nothing now.
    const bool matters = one.weight && log_weight(catalog, *one.weight, widened) > most - kHopeless;
    if (matters || one.refused) left.push_back(parts[k].part);
  }
  return left;
}

/// What has been found out about parts so far: bounds rule out most, with noise a glance most others, and those that
/// are left are solved.
class Survey {
 public:
  Survey(const Catalog& catalog, const Problem& like, const IdentifyOptions& options)
      : catalog_(catalog), like_(like), options_(options) {}

  /// Looks at those that may be it with so many times the noise, and that were not looked at before.
  void look(const std::vector<std::size_t>& parts, double excess, Identified& found);

  /// Of a part that something fits on.
  const Answer& answer(std::size_t part) const { return answers_.at(part); }

 private:
  const Catalog& catalog_;
  const Problem& like_;
  const IdentifyOptions& options_;
  std::unordered_set<std::size_t> searched_;         // parts that were not ruled out so far, glanced at or solved
  std::unordered_map<std::size_t, Answer> answers_;  // of parts that something fits on
};

/// What one part says; nothing where nothing fits.
struct Looked {
  std::optional<Answer> answer;
  std::string refused;  // why; empty: it was not
};

/// Solves the problem on one part. Placements that other rows contradict are left out.
Looked outcome_of(const Catalog& catalog, const Problem& like, std::size_t part) {
  Looked outcome;
  Problem problem = like;
  // Why rows fit badly is not asked of each part: it takes long.
  problem.diagnose = false;
  problem.part = catalog.part(part);
  try {
    Answer answer = solve(problem);
    const auto contradicted = [](const Placement& placement) { return placement.is_contradicted; };
    answer.placements.erase(std::remove_if(answer.placements.begin(), answer.placements.end(), contradicted),
                            answer.placements.end());
    // Nothing fits, and the search is complete. An incomplete one counts: the part may be it.
    if (answer.placements.empty() && answer.status == Status::complete) return outcome;
    outcome.answer = std::move(answer);
  } catch (const InputError& error) {
    outcome.refused = error.what();
  }
  return outcome;
}

/// Steps: bounds, those that were looked at before left out, a glance at what is left, then each part by itself.
/// `excess` 1 first, then 2.5 where nothing fits well.
void Survey::look(const std::vector<std::size_t>& parts, double excess, Identified& found) {
  const Doing doing("searching the catalog's parts");
  // The second time, with more noise.
  const bool widely = excess > 1;
  std::vector<PartLeft> bounded;
  if (options_.use_index) {
    bounded = Bounds(catalog_, like_, excess).left_of(parts, options_);
  } else {
    for (const std::size_t part : parts) bounded.push_back({part});
  }
  const auto is_known = [&](const PartLeft& one) { return searched_.count(one.part) > 0; };
  // Only parts that were not looked at with less noise.
  bounded.erase(std::remove_if(bounded.begin(), bounded.end(), is_known), bounded.end());
  std::vector<std::size_t> left;
  for (const PartLeft& one : bounded) left.push_back(one.part);
  (widely ? found.searched_widely : found.searched) += left.size();
  searched_.insert(left.begin(), left.end());
  found.left.insert(found.left.end(), left.begin(), left.end());
  std::sort(found.left.begin(), found.left.end());
  // Too many to be searched: they are only counted.
  if (left.size() > options_.most_searched) {
    found.counted = true;
    return;
  }
  if (options_.use_index && can_glance(like_)) {
    left = worth_a_look(catalog_, like_, bounded, found.weights, options_);
  }
  std::vector<Looked> outcomes(left.size());
  each_of(left.size(), options_, [&](std::size_t k) { outcomes[k] = outcome_of(catalog_, like_, left[k]); });
  // In the order of the parts, whichever thread was first.
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (!outcomes[k].refused.empty()) found.refused.push_back({left[k], outcomes[k].refused});
    if (!outcomes[k].answer) continue;
    // Something fits, or its search is incomplete: it is weighed.
    found.weights.push_back(weight_of(left[k], *outcomes[k].answer));
    found.weights.back().widely = widely;
    answers_.emplace(left[k], std::move(*outcomes[k].answer));
  }
  std::sort(found.weights.begin(), found.weights.end(),
            [](const PartWeight& a, const PartWeight& b) { return a.part < b.part; });
  // Something fits well: what remains are the parts that something fits on, and those that refuse. Else all that bounds
  // left do.
  if (!fits_well(found.weights)) return;
  found.left.clear();
  for (const PartWeight& weight : found.weights) found.left.push_back(weight.part);
  for (const PartRefused& one : found.refused) found.left.push_back(one.part);
  std::sort(found.left.begin(), found.left.end());
}

/// Throws InputError: noise that no part's answer could take.
void require_weighable(const Catalog& catalog, const Noise& noise) {
  belief::require_weighable(noise);
  double most = 0;
  for (std::size_t k = 0; k < catalog.size(); ++k) most = std::max(most, catalog.entry(k).perimeter);
  if (noise.contact <= kMostLengthNoise * most) return;
  throw InputError(fmt::format(
      "noise: a contact's standard deviation of {:.6g} is more than the perimeter of the largest part, {:.6g}: a row "
      "says nothing then; check the unit",
      noise.contact, most));
}

}  // namespace

std::vector<std::size_t> parts_of(const Catalog& catalog, const IdentifyOptions& options) {
  std::vector<std::size_t> parts = options.among;
  if (!parts.empty()) return parts;
  parts.resize(catalog.size());
  std::iota(parts.begin(), parts.end(), std::size_t{0});
  return parts;
}

Likeness likeness_of(const Problem& like) {
  Likeness likeness;
  const std::vector<Reading> rows =
      like.measured.is_log() ? readings_as_given(*like.measured.log, like.fingers) : like.measured.readings;
  // The longest way of any finger: over it a difference in scale shows most.
  for (const Reading& reading : rows) {
    for (const double length : reading.length) likeness.roll = std::max(likeness.roll, std::abs(length));
  }
  // Without noise only rounding may differ.
  likeness.turn = kSameTurn;
  if (!like.noise) return likeness;
  likeness.noisy = true;
  // What one row may be off is not seen as a difference.
  likeness.length = like.noise->contact;
  likeness.turn = std::max(kSameTurn, like.noise->angle);
  return likeness;
}

}  // namespace rollfix::catalog

namespace rollfix {

Identified identify(const Catalog& catalog, const Problem& like, const IdentifyOptions& options) {
  if (like.prior)
    throw InputError("`prior`: is about a place on one part; which part it is has `count` in the catalog");
  require_no_corners(like.fingers, "identify");
  Identified found;
  if (catalog.size() == 0) {
    found.verdict = "none";
    return found;
  }
  if (like.noise) catalog::require_weighable(catalog, *like.noise);
  const std::vector<std::size_t> parts = catalog::parts_of(catalog, options);
  found.asked = parts.size();
  found.noise = like.noise;
  found.mirrored = like.mirrored;
  found.samples = like.measured.is_log() ? like.measured.log->rows() : like.measured.readings.size();
  catalog::Survey survey(catalog, like, options);
  survey.look(parts, 1, found);
  // Bounds left too many: no part was searched.
  if (found.counted) {
    found.verdict = counted(found.left.size(), "part", "parts");
    return found;
  }
  // Nothing fits well: rows may be noisier than stated, up to where `locate` says that nothing fits.
  if (like.noise && !catalog::fits_well(found.weights)) survey.look(parts, belief::kMostExcess, found);
  std::sort(found.refused.begin(), found.refused.end(),
            [](const PartRefused& a, const PartRefused& b) { return a.part < b.part; });
  // What every part refuses is the problem's own fault.
  if (!found.refused.empty() && found.refused.size() == found.searched + found.searched_widely)
    throw InputError(found.refused.front().why);
  const catalog::Conclusion conclusion =
      catalog::conclude(catalog, found.weights, found.searched + found.searched_widely, catalog::likeness_of(like));
  found.verdict = conclusion.verdict;
  found.status = conclusion.status;
  found.rest = conclusion.rest;
  for (const std::size_t k : conclusion.order) {
    found.parts.push_back(
        {found.weights[k], survey.answer(found.weights[k].part), conclusion.probability[k], conclusion.congruent[k]});
  }
  return found;
}

}  // namespace rollfix
