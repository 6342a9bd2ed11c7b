#include "rollfix/catalog/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "answer/crew.hpp"
#include "belief/posterior.hpp"
#include "clues.hpp"
#include "congruent.hpp"
#include "files/byte_stream.hpp"
#include "index.hpp"
#include "rollfix/answer/solve.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

// Parts whose bounds a thread looks at in one go.
constexpr std::size_t kBlock = 1024;
// What is less probable is not listed.
constexpr double kLeastPartProbability = 1e-6;
// Without noise tangents of parts that are the same differ by no more, radians.
constexpr double kSameTurn = 1e-7;

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

PartWeight weight_of(std::size_t part, const Answer& answer) {
  PartWeight weight;
  weight.part = part;
  weight.verdict = answer.verdict.text();
  weight.undecided = answer.status == Status::incomplete;
  weight.fits_badly = answer.verdict.fits_badly;
  weight.places = answer.placements.size();
  weight.fits = !answer.placements.empty();
  if (!weight.fits) return weight;
  weight.clockwise = answer.placements.front().clockwise;
  for (const Placement& placement : answer.placements) {
    if (placement.clockwise == weight.clockwise) weight.starts.push_back(placement.start[0]);
  }
  if (!answer.weighing) return weight;
  weight.peak = answer.weighing->evidence.peak;
  // Anywhere on the boundary alike: of two fingers, each.
  weight.volume =
      answer.weighing->evidence.volume - static_cast<double>(answer.finger_count()) * std::log(answer.part.perimeter());
  weight.widened = answer.weighing->fit.widened;
  weight.excess = answer.weighing->fit.excess;
  return weight;
}

/// What one part says; nothing where bounds rule it out, or nothing fits.
struct Outcome {
  std::optional<Answer> answer;
  std::string refused;
  bool searched = false;
};

Outcome outcome_of(const Catalog& catalog, const Problem& like, const Bounds& bounds, const Candidate& candidate,
                   bool use_index) {
  Outcome outcome;
  Problem problem = like;
  problem.diagnose = false;
  problem.part = catalog.part(candidate.part);
  if (use_index && !bounds.may_be(candidate.part, problem.part, candidate.cells)) return outcome;
  outcome.searched = true;
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

/// log(exp(a) + exp(b) + ...).
double log_of_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  if (!std::isfinite(most)) return most;
  double sum = 0;
  for (const double each : logs) sum += std::exp(each - most);
  return most + std::log(sum);
}

/// With noise: the probability of each, as with the noise that the rows seem to have on the part that they fit best.
std::vector<double> probabilities(const Catalog& catalog, const std::vector<PartWeight>& weights) {
  const auto best = std::min_element(weights.begin(), weights.end(), [](const PartWeight& a, const PartWeight& b) {
    return a.excess != b.excess ? a.excess < b.excess : a.peak > b.peak;
  });
  std::vector<double> logs;
  for (const PartWeight& weight : weights) {
    const Evidence evidence{weight.peak, weight.volume};
    logs.push_back(evidence.with(best->widened) + std::log(catalog.entry(weight.part).count));
  }
  const double all = log_of_sum(logs);
  for (double& each : logs) each = std::isfinite(all) ? std::exp(each - all) : 0;
  return logs;
}

std::string words_for_one(const PartWeight& weight) {
  if (weight.verdict.rfind("unobservable", 0) == 0) return "any place";
  return weight.places == 1 ? "unique place" : counted(weight.places, "place", "places");
}

std::string verdict_of(const Conclusion& conclusion, const std::vector<PartWeight>& weights, bool noisy) {
  std::vector<std::size_t> that_count;
  for (const std::size_t k : conclusion.order) {
    if (!noisy || conclusion.probability[k] >= belief::kCounts) that_count.push_back(k);
  }
  if (that_count.empty()) return conclusion.status == Status::incomplete ? "undecided" : "none";
  const PartWeight& first = weights[that_count.front()];
  const std::string badly = first.fits_badly ? ", but the rows fit badly" : "";
  const bool is_one =
      that_count.size() == 1 || (noisy && conclusion.probability[that_count.front()] >= belief::kCertain);
  if (is_one) return fmt::format("unique part, {}{}", words_for_one(first), badly);
  const bool alike = conclusion.congruent[that_count.front()].size() + 1 >= that_count.size();
  return fmt::format("{} {}{}", that_count.size(), alike ? "congruent parts" : "parts", badly);
}

/// Of those that are listed, which can't be told apart.
void compare(const Catalog& catalog, const std::vector<PartWeight>& weights, const Likeness& likeness,
             Conclusion& conclusion) {
  conclusion.congruent.resize(weights.size());
  const double most_scale = likeness.roll > 0 ? likeness.length / likeness.roll : 0;
  std::vector<std::size_t> listed = conclusion.order;
  const auto perimeter = [&](std::size_t k) { return catalog.entry(weights[k].part).perimeter; };
  std::sort(listed.begin(), listed.end(), [&](std::size_t a, std::size_t b) { return perimeter(a) < perimeter(b); });
  for (std::size_t i = 0; i < listed.size(); ++i) {
    for (std::size_t j = i + 1; j < listed.size(); ++j) {
      const PartWeight& a = weights[listed[i]];
      const PartWeight& b = weights[listed[j]];
      if (perimeter(listed[j]) > perimeter(listed[i]) * (1 + most_scale + kSameScale)) break;
      if (a.clockwise != b.clockwise) continue;
      if (!are_congruent(catalog.part(a.part), a.starts, catalog.part(b.part), b.starts, likeness)) continue;
      conclusion.congruent[listed[i]].push_back(b.part);
      conclusion.congruent[listed[j]].push_back(a.part);
    }
  }
}

/// Of all that is asked of every part.
std::string fingerprint(const Problem& problem) {
  ByteWriter bytes;
  const auto add_all = [&](const std::vector<double>& numbers) {
    for (const double number : numbers) bytes.number(number);
    bytes.whole(numbers.size());
  };
  for (const Reading& reading : problem.felt.readings) {
    for (const double length : reading.length) bytes.number(length);
    bytes.number(reading.turn);
  }
  if (problem.felt.log) {
    add_all(problem.felt.log->time);
    for (const FingerRows& rows : problem.felt.log->fingers) {
      for (const auto* column : {&rows.u, &rows.psi, &rows.length, &rows.turn, &rows.x, &rows.y}) add_all(*column);
    }
  }
  for (const Finger& finger : problem.fingers) {
    for (const double place : {0.0, 0.3, 0.7}) bytes.number(finger.curvature(place));
    for (const char letter : finger.name()) bytes.whole(static_cast<unsigned char>(letter));
  }
  for (const Rounding& rounding : problem.felt.roundings) add_all({rounding.length, rounding.turn});
  if (problem.pose) {
    const PosePrior& pose = *problem.pose;
    add_all({pose.mean.x, pose.mean.y, pose.mean.heading, pose.heading_sd, pose.place_sd});
  }
  bytes.whole(problem.budget.value_or(0));
  for (const NoiseKind& kind : kNoiseKinds) bytes.number(problem.noise ? (*problem.noise).*kind.sd : -1);
  for (const auto& number : {problem.tolerance, problem.facing}) bytes.number(number.value_or(-1));
  add_all(problem.at);
  for (const bool is_so : {problem.mirrored, problem.either_way, problem.robust}) bytes.whole(is_so ? 1 : 0);
  return fmt::format("{:016x}", checksum(bytes.bytes()));
}

/// What has been found out about parts so far.
class Survey {
 public:
  Survey(const Catalog& catalog, const Problem& like, const IdentifyOptions& options)
      : catalog_(catalog), like_(like), options_(options) {}

  /// Looks at those that bounds leave with so many times the noise, and that were not looked at before.
  void look(const std::vector<std::size_t>& parts, double excess, Identified& found) {
    const Bounds bounds(catalog_, like_, excess);
    std::vector<Candidate> left;
    if (options_.use_index) {
      left = candidates(bounds, parts, options_);
    } else {
      for (const std::size_t part : parts) left.push_back({part, {}});
    }
    const auto is_known = [&](const Candidate& one) { return searched_.count(one.part) > 0; };
    left.erase(std::remove_if(left.begin(), left.end(), is_known), left.end());
    std::vector<Outcome> outcomes(left.size());
    Crew crew(left.size(), 1);
    crew.run(options_.threads, options_.go_on, [&](std::size_t lo, std::size_t hi) {
      for (std::size_t k = lo; k < hi; ++k) {
        outcomes[k] = outcome_of(catalog_, like_, bounds, left[k], options_.use_index);
      }
    });
    crew.require_done();
    for (std::size_t k = 0; k < left.size(); ++k) take(left[k].part, excess > 1, outcomes[k], found);
    std::sort(found.weights.begin(), found.weights.end(),
              [](const PartWeight& a, const PartWeight& b) { return a.part < b.part; });
  }

  /// Of a part that something fits on.
  const Answer& answer(std::size_t part) const { return answers_.at(part); }

 private:
  void take(std::size_t part, bool widely, Outcome& outcome, Identified& found) {
    if (!outcome.searched) return;
    searched_.insert(part);
    ++(widely ? found.searched_widely : found.searched);
    if (!outcome.refused.empty()) found.refused.push_back({part, outcome.refused, widely});
    if (!outcome.answer) return;
    found.weights.push_back(weight_of(part, *outcome.answer));
    found.weights.back().widely = widely;
    answers_.emplace(part, std::move(*outcome.answer));
  }

  const Catalog& catalog_;
  const Problem& like_;
  const IdentifyOptions& options_;
  std::unordered_set<std::size_t> searched_;
  std::unordered_map<std::size_t, Answer> answers_;
};

}  // namespace

Likeness likeness_of(const Problem& like) {
  Likeness likeness;
  const std::vector<Reading> rows =
      like.felt.is_log() ? readings_as_given(*like.felt.log, like.fingers) : like.felt.readings;
  for (const Reading& reading : rows) {
    for (const double length : reading.length) likeness.roll = std::max(likeness.roll, std::abs(length));
  }
  likeness.turn = kSameTurn;
  if (!like.noise) return likeness;
  likeness.noisy = true;
  likeness.length = like.noise->contact;
  likeness.turn = std::max(kSameTurn, like.noise->angle);
  return likeness;
}

bool fits_well(const std::vector<PartWeight>& weights) {
  return std::any_of(weights.begin(), weights.end(),
                     [](const PartWeight& one) { return !one.widely && one.fits && !one.fits_badly; });
}

Conclusion conclude(const Catalog& catalog, const std::vector<PartWeight>& weights, const Likeness& likeness) {
  Conclusion conclusion;
  const auto is_undecided = [](const PartWeight& weight) { return weight.undecided; };
  if (std::any_of(weights.begin(), weights.end(), is_undecided)) conclusion.status = Status::incomplete;
  conclusion.probability.assign(weights.size(), std::numeric_limits<double>::quiet_NaN());
  if (likeness.noisy && !weights.empty()) conclusion.probability = probabilities(catalog, weights);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const bool is_listed = weights[k].fits && (!likeness.noisy || conclusion.probability[k] >= kLeastPartProbability);
    if (is_listed) {
      conclusion.order.push_back(k);
    } else if (likeness.noisy) {
      conclusion.rest += conclusion.probability[k];
    }
  }
  std::sort(conclusion.order.begin(), conclusion.order.end(), [&](std::size_t a, std::size_t b) {
    if (likeness.noisy && conclusion.probability[a] != conclusion.probability[b]) {
      return conclusion.probability[a] > conclusion.probability[b];
    }
    return weights[a].part < weights[b].part;
  });
  compare(catalog, weights, likeness, conclusion);
  conclusion.verdict = verdict_of(conclusion, weights, likeness.noisy);
  return conclusion;
}

Identified identify(const Catalog& catalog, const Problem& like, const IdentifyOptions& options) {
  if (like.prior)
    throw InputError("`prior`: is about a place on one part; which part it is has `count` in the catalog");
  if (options.shards == 0 || options.shard == 0 || options.shard > options.shards) {
    throw InputError(
        fmt::format("`shard` {}/{}: expected the number of one of them, from 1 on", options.shard, options.shards));
  }
  Identified found;
  if (catalog.size() == 0) {
    found.verdict = "none";
    return found;
  }
  std::vector<std::size_t> parts;
  for (std::size_t k = options.shard - 1; k < catalog.size(); k += options.shards) parts.push_back(k);
  found.asked = parts.size();
  found.noise = like.noise;
  found.mirrored = like.mirrored;
  found.samples = like.felt.is_log() ? like.felt.log->rows() : like.felt.readings.size();
  found.roll = fingerprint(like);
  found.likeness = likeness_of(like);
  Survey survey(catalog, like, options);
  survey.look(parts, 1, found);
  if (like.noise && !fits_well(found.weights)) survey.look(parts, belief::kMostExcess, found);
  if (options.shards == 1 && !found.refused.empty() && found.refused.size() == found.searched + found.searched_widely)
    throw InputError(found.refused.front().why);
  const Conclusion conclusion = rollfix::conclude(catalog, found.weights, found.likeness);
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
