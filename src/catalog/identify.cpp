#include "rollfix/catalog/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "answer/observation.hpp"
#include "belief/posterior.hpp"
#include "bounds/bounds.hpp"
#include "files/byte_stream.hpp"
#include "glance.hpp"
#include "rollfix/error.hpp"
#include "survey.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

// Without noise tangents of parts that are the same differ by no more, radians.
constexpr double kSameTurn = 1e-7;

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
  for (const bool is_so : {problem.mirrored, problem.either_way, problem.robust, problem.may_overlap})
    bytes.whole(is_so ? 1 : 0);
  return fmt::format("{:016x}", checksum(bytes.bytes()));
}

void require_meant(const Problem& like, const IdentifyOptions& options) {
  if (like.prior)
    throw InputError("`prior`: is about a place on one part; which part it is has `count` in the catalog");
  if (options.shards == 0 || options.shard == 0 || options.shard > options.shards) {
    throw InputError(
        fmt::format("`shard` {}/{}: expected the number of one of them, from 1 on", options.shard, options.shards));
  }
}

std::vector<std::size_t> parts_of(const Catalog& catalog, const IdentifyOptions& options) {
  std::vector<std::size_t> parts = options.among;
  if (!parts.empty()) return parts;
  for (std::size_t k = options.shard - 1; k < catalog.size(); k += options.shards) parts.push_back(k);
  return parts;
}

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

Identified identify(const Catalog& catalog, const Problem& like, const IdentifyOptions& options) {
  require_meant(like, options);
  Identified found;
  if (catalog.size() == 0) {
    found.verdict = "none";
    return found;
  }
  if (like.noise) require_weighable(catalog, *like.noise);
  const std::vector<std::size_t> parts = parts_of(catalog, options);
  found.asked = parts.size();
  found.noise = like.noise;
  found.mirrored = like.mirrored;
  found.samples = like.felt.is_log() ? like.felt.log->rows() : like.felt.readings.size();
  found.roll = fingerprint(like);
  found.likeness = likeness_of(like);
  Survey survey(catalog, like, options);
  survey.look(parts, 1, found);
  if (found.counted) {
    found.verdict = counted(found.left.size(), "part", "parts");
    return found;
  }
  if (like.noise && !fits_well(found.weights)) {
    found.narrowly = options.narrowly;
    if (!options.narrowly) survey.look(parts, belief::kMostExcess, found);
  }
  if (options.shards == 1 && !found.refused.empty() && found.refused.size() == found.searched + found.searched_widely)
    throw InputError(found.refused.front().why);
  const Conclusion conclusion =
      conclude(catalog, found.weights, found.searched + found.searched_widely, found.likeness);
  found.verdict = conclusion.verdict;
  found.status = conclusion.status;
  found.rest = conclusion.rest;
  for (const std::size_t k : conclusion.order) {
    found.parts.push_back(
        {found.weights[k], survey.answer(found.weights[k].part), conclusion.probability[k], conclusion.congruent[k]});
  }
  return found;
}

std::optional<PartWeight> likeliest(const Catalog& catalog, const Problem& like, const IdentifyOptions& options) {
  require_meant(like, options);
  if (catalog.size() == 0 || !can_glance(like)) return std::nullopt;
  const std::vector<PartLeft> left = Bounds(catalog, like, 1).left_of(parts_of(catalog, options), options);
  return likeliest_of(catalog, like, left, options);
}

}  // namespace rollfix
