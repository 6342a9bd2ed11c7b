#pragma once

#include <string>

#include "rollfix/catalog/catalog.hpp"
#include "rollfix/catalog/identify.hpp"
#include "rollfix/catalog/identify_touches.hpp"
#include "rollfix/catalog/next_roll.hpp"
#include "rollfix/files/documents.hpp"

// The JSON documents of catalogs, as text: docs/json.md lists their fields.
namespace rollfix {

/// "rollfix/identify/1".
std::string format_identified(const Catalog& catalog, const Identified& found, Layout layout = Layout::lines);

/// "rollfix/identify/1" of touches.
std::string format_identified(const Catalog& catalog, const IdentifiedByTouches& found, Layout layout = Layout::lines);

/// {"schema": "rollfix/advise/1", ...}, as of one part, with each contender's part.
std::string format_next_roll(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                             Layout layout = Layout::lines);

}  // namespace rollfix
