#pragma once

#include <cstdint>
#include <string>

#include "database.hpp"

namespace rollfix {

inline constexpr const char* kCatalogSchema = "rollfix/catalog/4";

/// Makes the tables where the file is new. Throws InputError: a file with other tables, or of another version.
void make_tables(const Database& database);
/// Throws InputError: not a catalog, of another version, or something else in place of one of its tables.
void require_catalog(const Database& database);

/// A fact about the whole catalog by its name; empty: not there.
std::string fact(const Database& database, const std::string& name);
void set_fact(const Database& database, const std::string& name, const std::string& value);

/// What all its parts' checksums and its unit's add up to.
std::uint64_t whole_sum(const Database& database);
void set_whole_sum(const Database& database, std::uint64_t sum);

}  // namespace rollfix
