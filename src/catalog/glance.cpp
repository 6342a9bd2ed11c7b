#include "glance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "answer/crew.hpp"
#include "answer/either_way.hpp"
#include "answer/observation.hpp"
#include "answer/weighing.hpp"
#include "rollfix/error.hpp"
#include "weights.hpp"

namespace rollfix {
namespace {

// Rows are joined to so many at most, so that a part takes a tenth of the time.
constexpr std::size_t kNodes = 32;
// A part is left out that has less than exp(-this) of the likeliest one's weight: joined rows tell a little less.
constexpr double kHopeless = 25;

/// What a part makes of the joined rows; nothing where it is hopeless next to the likeliest so far.
struct Glance {
  std::optional<PartWeight> weight;
  bool refused = false;
};

/// The likeliest part so far, as others are held against it.
std::optional<Rival> rival_of(const Catalog& catalog, const std::vector<PartWeight>& weights, std::size_t part) {
  if (weights.empty()) return std::nullopt;
  const PartWeight& best = best_of(weights);
  const double log_evidence = log_weight(catalog, best, best.widened) - std::log(catalog.entry(part).count) +
                              std::log(catalog.entry(part).perimeter);
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
    if (k == 0 || !cells[k - 1]) stretches.push_back({lo, lo});
    stretches.back().hi = step * static_cast<double>(k + 1);
  }
  return stretches;
}

Glance glance_at(const Catalog& catalog, const std::vector<Problem>& ways, const PartLeft& left,
                 const std::vector<PartWeight>& weights) {
  const std::optional<Rival> rival = rival_of(catalog, weights, left.part);
  Glance glance;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    Problem way = ways[k];
    way.part = catalog.part(left.part);
    Supposed supposed;
    supposed.nodes = kNodes;
    if (!left.cells.empty()) {
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
    weight.volume = belief->evidence().volume - std::log(way.part.perimeter());
    weight.widened = belief->fit().widened;
    weight.excess = belief->fit().excess;
    if (!glance.weight || glance.weight->peak < weight.peak) glance.weight = weight;
  }
  return glance;
}

/// Of each part; adds what they weigh to the weights.
std::vector<Glance> glances_at(const Catalog& catalog, const Problem& like, const std::vector<PartLeft>& parts,
                               std::vector<PartWeight>& weights, const IdentifyOptions& options) {
  std::vector<Problem> ways{like.mirrored ? in_mirror(like) : like};
  if (like.either_way) ways.push_back(counted_clockwise(ways.front()));
  std::vector<Glance> glances(parts.size());
  // Those before tell what the others are held against: the same ones with however many threads.
  for (std::size_t begin = 0, end = 1; begin < parts.size(); begin = end, end = 2 * end) {
    end = std::min(end, parts.size());
    Crew crew(end - begin, 1);
    crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
      for (std::size_t k = begin + lo; k < begin + hi; ++k) glances[k] = glance_at(catalog, ways, parts[k], weights);
    });
    crew.require_done();
    for (std::size_t k = begin; k < end; ++k) {
      if (glances[k].weight) weights.push_back(*glances[k].weight);
    }
  }
  return glances;
}

}  // namespace

bool can_glance(const Problem& like) {
  const std::size_t fingers = like.felt.is_log()           ? like.felt.log->fingers.size()
                              : like.felt.readings.empty() ? 1
                                                           : like.felt.readings.front().fingers();
  return like.noise && !like.robust && fingers == 1;
}

std::vector<std::size_t> worth_a_look(const Catalog& catalog, const Problem& like, const std::vector<PartLeft>& parts,
                                      std::vector<PartWeight> known, const IdentifyOptions& options) {
  std::vector<PartWeight> weights = std::move(known);
  const std::vector<Glance> glances = glances_at(catalog, like, parts, weights, options);
  const double widened = weights.empty() ? 1 : best_of(weights).widened;
  const double most = weights.empty() ? 0 : log_weight(catalog, best_of(weights), widened);
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Glance& one = glances[k];
    const bool matters = one.weight && log_weight(catalog, *one.weight, widened) > most - kHopeless;
    if (matters || one.refused) left.push_back(parts[k].part);
  }
  return left;
}

}  // namespace rollfix
