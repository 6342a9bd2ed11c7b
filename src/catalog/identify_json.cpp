#include <utility>

#include "files/documents/documents.hpp"
#include "rollfix/catalog/documents.hpp"

namespace rollfix {
namespace {

constexpr const char* kSchema = "rollfix/identify/1";

std::string formatted(const Json& document, Layout layout) {
  return layout == Layout::line ? json_line(document) : json_text(document);
}

Json catalog_json(const Catalog& catalog, const Identified& found) {
  return {{"file", catalog.path()}, {"parts", found.asked}, {"searched", found.searched + found.searched_widely}};
}

Json part_json(const Catalog& catalog, const PartFound& part) {
  const CatalogEntry& entry = catalog.entry(part.weight.part);
  Json congruent = Json::array();
  for (const std::size_t other : part.congruent) congruent.push_back(catalog.entry(other).name);
  Json placements = Json::array();
  for (const Placement& placement : part.answer.placements)
    placements.push_back(placement_json(placement, part.answer));
  return {{"name", entry.name},
          {"id", entry.id},
          {"source", catalog.source_of(part.weight.part)},
          {"probability", json_number(part.probability)},
          {"verdict", part.weight.verdict},
          {"congruent_with", congruent},
          {"placements", placements}};
}

}  // namespace

std::string format_identified(const Catalog& catalog, const Identified& found, Layout layout) {
  Json parts = Json::array();
  for (const PartFound& part : found.parts) parts.push_back(part_json(catalog, part));
  Json refused = Json::array();
  for (const PartRefused& one : found.refused) {
    refused.push_back({{"name", catalog.entry(one.part).name}, {"why", one.why}});
  }
  const Json document = {{"schema", kSchema},
                         {"status", name_of(found.status)},
                         {"verdict", found.verdict},
                         {"catalog", catalog_json(catalog, found)},
                         {"noise", found.noise ? noise_json(*found.noise) : Json(nullptr)},
                         {"mirrored", found.mirrored},
                         {"samples", found.samples},
                         {"parts", parts},
                         {"rest", found.noise ? json_number(found.rest) : Json(nullptr)},
                         {"refused", refused}};
  return formatted(document, layout);
}

std::string format_next_roll(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                             Layout layout) {
  Json contenders = Json::array();
  for (const NextRollOfParts::Place& place : next.places) {
    contenders.push_back({{"part", catalog.entry(found.parts[place.part].weight.part).name},
                          {"placement", place.contender.label},
                          {"contact", json_number(place.contender.place)},
                          {"sd", json_number(place.contender.sd)},
                          {"probability", json_number(place.contender.probability)},
                          {"turn", next.helps() ? json_number(place.turn_ahead) : Json(nullptr)}});
  }
  const Json of = {{"catalog", catalog_json(catalog, found)}};
  return formatted(advice_json(found.verdict, of, next.advice, next.why, contenders), layout);
}

}  // namespace rollfix
