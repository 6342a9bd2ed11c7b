#include "identify_json.hpp"

#include <utility>

#include "documents/documents.hpp"
#include "rollfix/identify.hpp"

// JSON documents of catalogs. docs/json.md lists the fields, under "identify" and "advise".
namespace rollfix {
namespace {

constexpr const char* kSchema = "rollfix/identify/1";

/// The catalog's file, how many parts were asked, and how many of them bounds left to be searched.
Json catalog_json(const Catalog& catalog, std::size_t asked, std::size_t searched) {
  return {{"file", catalog.path()}, {"parts", asked}, {"searched", searched}};
}
/// Both passes count, the one with more noise as well.
Json catalog_json(const Catalog& catalog, const Identified& found) {
  return catalog_json(catalog, found.asked, found.searched + found.searched_widely);
}

/// Names of parts, given by their places in the catalog.
Json names_json(const Catalog& catalog, const std::vector<std::size_t>& parts) {
  return json_list(parts, [&](std::size_t part) { return catalog.entry(part).name; });
}

/// Parts that can't have been rolled on so, each with its reason.
Json refused_json(const Catalog& catalog, const std::vector<PartRefused>& refused) {
  Json list = Json::array();
  for (const PartRefused& one : refused) list.push_back({{"name", catalog.entry(one.part).name}, {"why", one.why}});
  return list;
}

/// One part that remains; `placements`: places of a roll, or poses of touches. A probability that is not a number is
/// null.
Json part_json(const Catalog& catalog, std::size_t part, double probability, const std::string& verdict,
               const std::vector<std::size_t>& congruent, Json placements) {
  const CatalogEntry& entry = catalog.entry(part);
  return {{"name", entry.name},
          {"id", entry.id},
          {"source", catalog.source_of(part)},
          {"probability", json_number(probability)},
          {"verdict", verdict},
          {"congruent_with", names_json(catalog, congruent)},
          {"placements", std::move(placements)}};
}

/// Of a roll: its placements, as the documents of `locate` have them.
Json part_json(const Catalog& catalog, const PartFound& part) {
  return part_json(catalog, part.weight.part, part.probability, part.weight.verdict, part.congruent,
                   json_list(part.answer.placements,
                             [&](const Placement& placement) { return placement_json(placement, part.answer); }));
}

}  // namespace

Json identified_document(const Catalog& catalog, const Identified& found) {
  return {{"schema", kSchema},
          {"status", name_of(found.status)},
          {"verdict", found.verdict},
          {"catalog", catalog_json(catalog, found)},
          {"noise", found.noise ? noise_json(*found.noise) : Json(nullptr)},
          {"mirrored", found.mirrored},
          {"samples", found.samples},
          {"parts", json_list(found.parts, [&](const PartFound& part) { return part_json(catalog, part); })},
          {"rest", found.noise ? json_number(found.rest) : Json(nullptr)},
          {"refused", refused_json(catalog, found.refused)}};
}

std::string format_identified(const Catalog& catalog, const Identified& found, Layout layout) {
  return formatted(identified_document(catalog, found), layout);
}

std::string format_identified(const Catalog& catalog, const IdentifiedByTouches& found, Layout layout) {
  Json parts = Json::array();
  for (const PartTouched& one : found.parts) {
    parts.push_back(part_json(catalog, one.part, one.probability, one.answer.verdict_text(), one.congruent,
                              pose_sets_json(one.answer)));
  }
  // Rolls with the lines of their files; simulated rows have none. Each touch is one sample, and so is each row.
  Json rolls = Json::array();
  std::size_t samples = found.touches.size();
  for (const RollGiven& roll : found.rolls) {
    samples += roll.rows;
    rolls.push_back(
        {{"name", roll.name}, {"rows", roll.rows}, {"lines", roll.lines.empty() ? Json(nullptr) : Json(roll.lines)}});
  }
  const Json document = {{"schema", kSchema},
                         {"status", name_of(found.status)},
                         {"verdict", found.verdict},
                         {"catalog", catalog_json(catalog, found.asked, found.searched)},
                         {"rolls", rolls},
                         {"radius", json_number(found.radius)},
                         {"touches", touches_json(found.touches, found.tolerance)},
                         {"clear", clear_json(found.clear)},
                         {"noise", found.noise ? noise_json(*found.noise) : Json(nullptr)},
                         {"mirrored", found.mirrored},
                         {"samples", samples},
                         {"parts", parts},
                         {"rest", found.noise ? json_number(found.rest) : Json(nullptr)},
                         {"undecided", names_json(catalog, found.undecided)},
                         {"refused", refused_json(catalog, found.refused)}};
  return formatted(document, layout);
}

std::string format_next_roll(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                             Layout layout) {
  Json hypotheses = Json::array();
  for (const NextRollOfParts::Place& place : next.places) {
    // `turn` is what the place would measure on the advised roll; without one it is null.
    hypotheses.push_back({{"part", catalog.entry(found.parts[place.part].weight.part).name},
                          {"placement", place.hypothesis.label},
                          {"contact", per_finger_json(place.hypothesis.place)},
                          {"sd", per_finger_json(place.hypothesis.sd)},
                          {"probability", json_number(place.hypothesis.probability)},
                          {"turn", next.helps() ? json_number(place.turn_ahead) : Json(nullptr)}});
  }
  const Json of = {{"catalog", catalog_json(catalog, found)}};
  return formatted(advice_json(found.verdict, of, next.advice, next.why, hypotheses), layout);
}

}  // namespace rollfix
