#include "survey.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "answer/crew.hpp"
#include "clues.hpp"
#include "glance.hpp"
#include "index.hpp"
#include "rollfix/answer/solve.hpp"
#include "rollfix/error.hpp"
#include "weights.hpp"

namespace rollfix {
namespace {

// Parts whose bounds a thread looks at in one go.
constexpr std::size_t kBlock = 1024;

/// The parts that bounds leave.
class Bounds {
 public:
  Bounds(const Catalog& catalog, const Problem& like, double excess)
      : catalog_(catalog), index_(catalog.index()), clues_(clues_of(catalog, like, excess)) {}

  /// From the catalog's index alone: the cells that are left, of each way; none: ruled out.
  bool may_be(std::size_t part, std::vector<std::uint64_t>& cells) const {
    cells.clear();
    bool any = false;
    for (const RollClues& way : of(part)) {
      std::uint64_t left = 0;
      if (cells_left(index_.coarse[part], index_.courses[part], way.few) != 0) {
        left = cells_left(index_.fine[part], index_.courses[part], way.few);
      }
      cells.push_back(left);
      any = any || left != 0;
    }
    return any || index_.measured[part] != 0;
  }

  /// With the part itself.
  bool may_be(std::size_t index, const Part& part, const std::vector<std::uint64_t>& cells) const {
    if (index_.measured[index] != 0) return true;
    const std::vector<RollClues>& ways = of(index);
    for (std::size_t k = 0; k < ways.size(); ++k) {
      if (cells[k] == 0) continue;
      if (ways[k].few.fingers != 1 || may_start(part, ways[k].many, cells[k])) return true;
    }
    return false;
  }

 private:
  const std::vector<RollClues>& of(std::size_t part) const { return clues_[catalog_.entry(part).reversed ? 1 : 0]; }

  const Catalog& catalog_;
  const Catalog::Index& index_;
  std::array<std::vector<RollClues>, 2> clues_;
};

/// A part that bounds leave, and the cells.
struct Candidate {
  std::size_t part = 0;
  std::vector<std::uint64_t> cells;
};

std::vector<Candidate> candidates(const Bounds& bounds, const std::vector<std::size_t>& parts,
                                  const IdentifyOptions& options) {
  std::vector<std::vector<Candidate>> blocks((parts.size() + kBlock - 1) / kBlock);
  Crew crew(parts.size(), kBlock);
  crew.run(options.threads, {}, [&](std::size_t lo, std::size_t hi) {
    std::vector<Candidate>& left = blocks[lo / kBlock];
    std::vector<std::uint64_t> cells;
    for (std::size_t k = lo; k < hi; ++k) {
      if (bounds.may_be(parts[k], cells)) left.push_back({parts[k], cells});
    }
  });
  crew.require_done();
  std::vector<Candidate> all;
  for (std::vector<Candidate>& block : blocks) std::move(block.begin(), block.end(), std::back_inserter(all));
  return all;
}

/// What one part says; nothing where nothing fits.
struct Outcome {
  std::optional<Answer> answer;
  std::string refused;
};

Outcome outcome_of(const Catalog& catalog, const Problem& like, std::size_t part) {
  Outcome outcome;
  Problem problem = like;
  problem.diagnose = false;
  problem.part = catalog.part(part);
  try {
    Answer answer = solve(problem);
    const auto contradicted = [](const Placement& placement) { return placement.is_contradicted; };
    answer.placements.erase(std::remove_if(answer.placements.begin(), answer.placements.end(), contradicted),
                            answer.placements.end());
    if (answer.placements.empty() && answer.status == Status::complete) return outcome;
    outcome.answer = std::move(answer);
  } catch (const InputError& error) {
    outcome.refused = error.what();
  }
  return outcome;
}

}  // namespace

std::vector<std::size_t> Survey::bounded(const std::vector<std::size_t>& parts, double excess) const {
  const Bounds bounds(catalog_, like_, excess);
  const std::vector<Candidate> by_index = candidates(bounds, parts, options_);
  std::vector<char> may_be(by_index.size());
  Crew crew(by_index.size(), 1);
  crew.run(options_.threads, options_.go_on, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) {
      const Candidate& one = by_index[k];
      may_be[k] = bounds.may_be(one.part, catalog_.part(one.part), one.cells) ? 1 : 0;
    }
  });
  crew.require_done();
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < by_index.size(); ++k) {
    if (may_be[k] != 0) left.push_back(by_index[k].part);
  }
  return left;
}

void Survey::look(const std::vector<std::size_t>& parts, double excess, Identified& found) {
  const bool widely = excess > 1;
  std::vector<std::size_t> left = options_.use_index ? bounded(parts, excess) : parts;
  const auto is_known = [&](std::size_t part) { return searched_.count(part) > 0; };
  left.erase(std::remove_if(left.begin(), left.end(), is_known), left.end());
  (widely ? found.searched_widely : found.searched) += left.size();
  searched_.insert(left.begin(), left.end());
  found.left.insert(found.left.end(), left.begin(), left.end());
  std::sort(found.left.begin(), found.left.end());
  if (left.size() > options_.most_searched) {
    found.counted = true;
    return;
  }
  if (options_.use_index && can_glance(like_)) left = worth_a_look(catalog_, like_, left, options_);
  std::vector<Outcome> outcomes(left.size());
  Crew crew(left.size(), 1);
  crew.run(options_.threads, options_.go_on, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) outcomes[k] = outcome_of(catalog_, like_, left[k]);
  });
  crew.require_done();
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (!outcomes[k].refused.empty()) found.refused.push_back({left[k], outcomes[k].refused, widely});
    if (!outcomes[k].answer) continue;
    found.weights.push_back(weight_of(left[k], *outcomes[k].answer));
    found.weights.back().widely = widely;
    answers_.emplace(left[k], std::move(*outcomes[k].answer));
  }
  std::sort(found.weights.begin(), found.weights.end(),
            [](const PartWeight& a, const PartWeight& b) { return a.part < b.part; });
  if (!fits_well(found.weights)) return;
  found.left.clear();
  for (const PartWeight& weight : found.weights) found.left.push_back(weight.part);
  for (const PartRefused& one : found.refused) found.left.push_back(one.part);
  std::sort(found.left.begin(), found.left.end());
}

}  // namespace rollfix
