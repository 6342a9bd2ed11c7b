#pragma once

#include <memory>

#include "rollfix/identify.hpp"
#include "watch/meaning.hpp"

namespace rollfix::catalog {

/// Which parts remain, as a roll grows.
std::unique_ptr<Meaning> meaning_on_catalog(const std::shared_ptr<const Catalog>& catalog, const Followed& followed,
                                            LogKind kind);

/// Fewer parts, or another one is the likeliest, or as likely no more.
bool is_news_of_parts(const Identified& said, const Identified& now);

}  // namespace rollfix::catalog
