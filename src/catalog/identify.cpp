#include "rollfix/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "answer/observation.hpp"
#include "belief/posterior.hpp"
#include "bounds/bounds.hpp"
#include "rollfix/error.hpp"
#include "survey.hpp"
#include "text/text.hpp"
#include "weights.hpp"

namespace rollfix {
namespace {

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

std::vector<std::size_t> parts_of(const Catalog& catalog, const IdentifyOptions& options) {
  std::vector<std::size_t> parts = options.among;
  if (!parts.empty()) return parts;
  parts.resize(catalog.size());
  std::iota(parts.begin(), parts.end(), std::size_t{0});
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
  if (like.prior)
    throw InputError("`prior`: is about a place on one part; which part it is has `count` in the catalog");
  require_no_corners(like.fingers, "identify");
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
  Survey survey(catalog, like, options);
  survey.look(parts, 1, found);
  if (found.counted) {
    found.verdict = counted(found.left.size(), "part", "parts");
    return found;
  }
  if (like.noise && !fits_well(found.weights)) survey.look(parts, belief::kMostExcess, found);
  std::sort(found.refused.begin(), found.refused.end(),
            [](const PartRefused& a, const PartRefused& b) { return a.part < b.part; });
  if (!found.refused.empty() && found.refused.size() == found.searched + found.searched_widely)
    throw InputError(found.refused.front().why);
  const Conclusion conclusion =
      conclude(catalog, found.weights, found.searched + found.searched_widely, likeness_of(like));
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
