#pragma once

#include <string>

#include "database.hpp"

namespace rollfix {

inline constexpr const char* kCatalogSchema = "rollfix/catalog/2";

/// Makes the tables where the file is new. Throws InputError: a file with other tables, or of another version.
void make_tables(const Database& database);
/// Throws InputError: not a catalog, or of another version.
void require_catalog(const Database& database);

/// A fact about the whole catalog by its name; empty: not there.
std::string fact(const Database& database, const std::string& name);
void set_fact(const Database& database, const std::string& name, const std::string& value);

}  // namespace rollfix
