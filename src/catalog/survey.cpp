#include "survey.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "answer/crew.hpp"
#include "bounds/bounds.hpp"
#include "glance.hpp"
#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/solve.hpp"
#include "weights.hpp"

namespace rollfix {
namespace {

/// What one part says; nothing where nothing fits.
struct Looked {
  std::optional<Answer> answer;
  std::string refused;
};

Looked outcome_of(const Catalog& catalog, const Problem& like, std::size_t part) {
  Looked outcome;
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

void Survey::look(const std::vector<std::size_t>& parts, double excess, Identified& found) {
  const Doing doing("searching the catalog's parts");
  const bool widely = excess > 1;
  std::vector<PartLeft> bounded;
  if (options_.use_index) {
    bounded = Bounds(catalog_, like_, excess).left_of(parts, options_);
  } else {
    for (const std::size_t part : parts) bounded.push_back({part});
  }
  const auto is_known = [&](const PartLeft& one) { return searched_.count(one.part) > 0; };
  bounded.erase(std::remove_if(bounded.begin(), bounded.end(), is_known), bounded.end());
  std::vector<std::size_t> left;
  for (const PartLeft& one : bounded) left.push_back(one.part);
  (widely ? found.searched_widely : found.searched) += left.size();
  searched_.insert(left.begin(), left.end());
  found.left.insert(found.left.end(), left.begin(), left.end());
  std::sort(found.left.begin(), found.left.end());
  if (left.size() > options_.most_searched) {
    found.counted = true;
    return;
  }
  if (options_.use_index && can_glance(like_)) {
    left = worth_a_look(catalog_, like_, bounded, found.weights, options_);
  }
  std::vector<Looked> outcomes(left.size());
  Crew crew(left.size(), 1);
  crew.run(options_.threads, options_.go_on, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) outcomes[k] = outcome_of(catalog_, like_, left[k]);
  });
  crew.require_done();
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (!outcomes[k].refused.empty()) found.refused.push_back({left[k], outcomes[k].refused});
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
