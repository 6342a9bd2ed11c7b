#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>

#include "files/byte_stream.hpp"
#include "files/documents/documents.hpp"
#include "rollfix/catalog/documents.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

constexpr const char* kSchema = "rollfix/identify/1";
constexpr const char* kShardSchema = "rollfix/identify-shard/1";

/// What a search says of one part: what counts, and its placements as JSON; null where it is not listed.
struct Line {
  PartWeight weight;
  Json placements;
};

/// What a search says of all of it.
struct Gathered {
  Json asked;        // what the document says of it
  std::string roll;  // its fingerprint
  std::size_t parts = 0;
  std::size_t searched = 0;
  std::size_t searched_widely = 0;
  bool narrowly = false;  // some of it only, where nothing fitted well
  Likeness likeness;
  std::vector<PartRefused> refused;
  std::vector<Line> lines;
};

Json placements_json(const Answer& answer) {
  Json list = Json::array();
  for (const Placement& placement : answer.placements) list.push_back(placement_json(placement, answer));
  return list;
}

/// So that shards of other catalogs are not mixed up with these.
std::string identity_of(const Catalog& catalog) {
  std::string names;
  for (std::size_t k = 0; k < catalog.size(); ++k)
    names += fmt::format("{} {}\n", catalog.entry(k).id, catalog.entry(k).name);
  return fmt::format("{:016x}", checksum(names));
}

Gathered gathered(const Identified& found) {
  Gathered search;
  search.parts = found.asked;
  search.roll = found.roll;
  search.searched = found.searched;
  search.searched_widely = found.searched_widely;
  search.narrowly = found.narrowly;
  search.likeness = found.likeness;
  search.refused = found.refused;
  search.asked = {{"noise", found.noise ? noise_json(*found.noise) : Json(nullptr)},
                  {"mirrored", found.mirrored},
                  {"samples", found.samples}};
  for (const PartWeight& weight : found.weights) search.lines.push_back({weight, nullptr});
  for (const PartFound& part : found.parts) {
    const auto line = std::find_if(search.lines.begin(), search.lines.end(),
                                   [&](const Line& one) { return one.weight.part == part.weight.part; });
    line->placements = placements_json(part.answer);
  }
  return search;
}

/// What was looked at widely, only because a shard had nothing that fits well.
void drop_widely(Gathered& search, std::vector<PartWeight>& weights) {
  search.searched_widely = 0;
  const auto of_weight = [](const PartWeight& one) { return one.widely; };
  weights.erase(std::remove_if(weights.begin(), weights.end(), of_weight), weights.end());
  const auto of_line = [](const Line& one) { return one.weight.widely; };
  search.lines.erase(std::remove_if(search.lines.begin(), search.lines.end(), of_line), search.lines.end());
  const auto of_refused = [](const PartRefused& one) { return one.widely; };
  search.refused.erase(std::remove_if(search.refused.begin(), search.refused.end(), of_refused), search.refused.end());
}

std::vector<PartWeight> weights_of(const Gathered& search) {
  std::vector<PartWeight> weights;
  for (const Line& line : search.lines) weights.push_back(line.weight);
  return weights;
}

Json document_of(const Catalog& catalog, Gathered search) {
  std::sort(search.lines.begin(), search.lines.end(),
            [](const Line& a, const Line& b) { return a.weight.part < b.weight.part; });
  std::sort(search.refused.begin(), search.refused.end(),
            [](const PartRefused& a, const PartRefused& b) { return a.part < b.part; });
  std::vector<PartWeight> weights = weights_of(search);
  if (fits_well(weights)) drop_widely(search, weights);
  const Conclusion conclusion = conclude(catalog, weights, search.searched + search.searched_widely, search.likeness);
  Json document = {
      {"schema", kSchema},
      {"status", name_of(conclusion.status)},
      {"verdict", conclusion.verdict},
      {"catalog",
       {{"file", catalog.path()}, {"parts", search.parts}, {"searched", search.searched + search.searched_widely}}}};
  for (const auto& [field, value] : search.asked.items()) document[field] = value;
  document["parts"] = Json::array();
  for (const std::size_t k : conclusion.order) {
    const Line& line = search.lines[k];
    const CatalogEntry& entry = catalog.entry(line.weight.part);
    Json congruent = Json::array();
    for (const std::size_t other : conclusion.congruent[k]) congruent.push_back(catalog.entry(other).name);
    document["parts"].push_back({{"name", entry.name},
                                 {"id", entry.id},
                                 {"source", catalog.source_of(line.weight.part)},
                                 {"probability", json_number(conclusion.probability[k])},
                                 {"verdict", line.weight.verdict},
                                 {"congruent_with", congruent},
                                 {"placements", line.placements}});
  }
  document["rest"] = search.likeness.noisy ? json_number(conclusion.rest) : Json(nullptr);
  document["refused"] = Json::array();
  for (const PartRefused& one : search.refused) {
    document["refused"].push_back({{"name", catalog.entry(one.part).name}, {"why", one.why}});
  }
  return document;
}

std::string formatted(const Json& document, Layout layout) {
  return layout == Layout::line ? json_line(document) : json_text(document);
}

/// Infinite where JSON has null.
double number_from(const Json& json) {
  return json.is_null() ? -std::numeric_limits<double>::infinity() : json.get<double>();
}

Json weight_json(const PartWeight& weight) {
  return {{"verdict", weight.verdict},
          {"fits", weight.fits},
          {"fits_badly", weight.fits_badly},
          {"undecided", weight.undecided},
          {"places", weight.places},
          {"starts", json_numbers(weight.starts)},
          {"peak", json_number(weight.peak)},
          {"volume", json_number(weight.volume)},
          {"widened", json_number(weight.widened)},
          {"excess", json_number(weight.excess)},
          {"widely", weight.widely}};
}

PartWeight weight_from(const Json& json, std::size_t part) {
  PartWeight weight;
  weight.part = part;
  weight.verdict = json.at("verdict").get<std::string>();
  weight.fits = json.at("fits").get<bool>();
  weight.fits_badly = json.at("fits_badly").get<bool>();
  weight.undecided = json.at("undecided").get<bool>();
  weight.places = json.at("places").get<std::size_t>();
  weight.starts = json.at("starts").get<std::vector<double>>();
  weight.peak = number_from(json.at("peak"));
  weight.volume = number_from(json.at("volume"));
  weight.widened = json.at("widened").get<double>();
  weight.excess = json.at("excess").get<double>();
  weight.widely = json.at("widely").get<bool>();
  return weight;
}

/// The lines of one shard, and which it is of how many.
std::pair<std::size_t, std::size_t> add_shard(const Catalog& catalog, const std::string& text, Gathered& all) {
  std::pair<std::size_t, std::size_t> shard;
  bool is_first = true;
  std::size_t parts = 0;
  for (const std::string_view line : split(text, '\n')) {
    if (line.empty()) continue;
    const Json json = Json::parse(line);
    if (!is_first) {
      const auto part = json.at("part").get<std::size_t>();
      if (part >= catalog.size()) throw InputError("names a part that is not in the catalog");
      all.lines.push_back({weight_from(json.at("weight"), part), json.at("placements")});
      --parts;
      continue;
    }
    is_first = false;
    if (json.at("schema") != kShardSchema) throw InputError(fmt::format("expected lines of {}", kShardSchema));
    if (json.at("catalog") != identity_of(catalog)) throw InputError("is of another catalog, or it has changed since");
    if (!all.roll.empty() && all.roll != json.at("roll").get<std::string>())
      throw InputError("is of another roll, or was asked otherwise");
    all.asked = json.at("asked");
    all.roll = json.at("roll").get<std::string>();
    shard = {json.at("shard").get<std::size_t>(), json.at("shards").get<std::size_t>()};
    all.parts += json.at("parts").get<std::size_t>();
    all.searched += json.at("searched").get<std::size_t>();
    all.searched_widely += json.at("searched_widely").get<std::size_t>();
    all.narrowly = all.narrowly || json.at("narrowly").get<bool>();
    parts = json.at("lines").get<std::size_t>();
    const Json& likeness = json.at("likeness");
    all.likeness = {likeness.at("length").get<double>(), likeness.at("turn").get<double>(),
                    likeness.at("roll").get<double>(), likeness.at("noisy").get<bool>()};
    for (const Json& one : json.at("refused")) {
      all.refused.push_back(
          {one.at("part").get<std::size_t>(), one.at("why").get<std::string>(), one.at("widely").get<bool>()});
    }
  }
  if (is_first) throw InputError("is empty, expected the lines of a shard");
  if (parts != 0) throw InputError("is cut short: some of its lines are missing");
  return shard;
}

}  // namespace

std::string format_identified(const Catalog& catalog, const Identified& found, Layout layout) {
  return formatted(document_of(catalog, gathered(found)), layout);
}

std::string format_shard(const Catalog& catalog, const Identified& found, const IdentifyOptions& options) {
  const Gathered search = gathered(found);
  Json refused = Json::array();
  for (const PartRefused& one : search.refused)
    refused.push_back({{"part", one.part}, {"why", one.why}, {"widely", one.widely}});
  const Likeness& likeness = search.likeness;
  std::string text = json_line({{"schema", kShardSchema},
                                {"catalog", identity_of(catalog)},
                                {"shard", options.shard},
                                {"shards", options.shards},
                                {"parts", search.parts},
                                {"searched", search.searched},
                                {"searched_widely", search.searched_widely},
                                {"narrowly", search.narrowly},
                                {"lines", search.lines.size()},
                                {"roll", search.roll},
                                {"asked", search.asked},
                                {"likeness",
                                 {{"length", json_number(likeness.length)},
                                  {"turn", json_number(likeness.turn)},
                                  {"roll", json_number(likeness.roll)},
                                  {"noisy", likeness.noisy}}},
                                {"refused", refused}});
  for (const Line& line : search.lines) {
    text += json_line({{"part", line.weight.part},
                       {"name", catalog.entry(line.weight.part).name},
                       {"weight", weight_json(line.weight)},
                       {"placements", line.placements}});
  }
  return text;
}

std::string merge_shards(const Catalog& catalog, const std::vector<std::string>& texts,
                         const std::vector<std::string>& names, Layout layout) {
  Gathered all;
  std::set<std::size_t> there;
  std::size_t shards = 0;
  for (std::size_t k = 0; k < texts.size(); ++k) {
    try {
      const auto [shard, of] = add_shard(catalog, texts[k], all);
      if (shards != 0 && of != shards)
        throw InputError(fmt::format("is one of {} shards, the others of {}", of, shards));
      shards = of;
      if (!there.insert(shard).second) throw InputError(fmt::format("shard {} of {} is there twice", shard, of));
    } catch (const Json::exception&) {
      throw InputError(fmt::format("{}: expected the lines that identify --shard prints, found others", names[k]));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", names[k], error.what()));
    }
  }
  for (std::size_t shard = 1; shard <= shards; ++shard) {
    if (there.count(shard) == 0) throw InputError(fmt::format("shard {} of {} is missing", shard, shards));
  }
  if (all.narrowly && !fits_well(weights_of(all)))
    throw InputError(
        "nothing fits well in any of the shards, and they were asked narrowly: ask them without `narrowly`");
  return formatted(document_of(catalog, std::move(all)), layout);
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
  const Json of = {
      {"catalog",
       {{"file", catalog.path()}, {"parts", found.asked}, {"searched", found.searched + found.searched_widely}}}};
  return formatted(advice_json(found.verdict, of, next.advice, next.why, contenders), layout);
}

}  // namespace rollfix
