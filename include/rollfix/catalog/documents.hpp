#pragma once

#include <string>
#include <vector>

#include "rollfix/catalog/catalog.hpp"
#include "rollfix/catalog/identify.hpp"
#include "rollfix/catalog/next_roll.hpp"
#include "rollfix/files/documents.hpp"

// The JSON documents of catalogs, as text: docs/json.md lists their fields.
namespace rollfix {

/// "rollfix/identify/1".
std::string format_identified(const Catalog& catalog, const Identified& found, Layout layout = Layout::lines);

/// What one shard found, as JSON lines ("rollfix/identify-shard/1"): a line about all of it, then one for each part.
std::string format_shard(const Catalog& catalog, const Identified& found, const IdentifyOptions& options);

/// The document of all parts from the lines of all shards, in any order: the same as of one search. `names`: what the
/// texts are called. Throws InputError: of another catalog or roll, a shard that is missing or there twice, no such
/// lines; all were asked narrowly, and nothing fits well in any.
std::string merge_shards(const Catalog& catalog, const std::vector<std::string>& texts,
                         const std::vector<std::string>& names, Layout layout = Layout::lines);

/// {"schema": "rollfix/advise/1", ...}, as of one part, with each contender's part.
std::string format_next_roll(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                             Layout layout = Layout::lines);

}  // namespace rollfix
