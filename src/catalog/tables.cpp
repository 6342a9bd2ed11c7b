#include "tables.hpp"

#include <fmt/format.h>

#include <charconv>

#include "rollfix/error.hpp"
#include "sums.hpp"

namespace rollfix {
namespace {

// What is looked through as a whole stands apart from what is asked for part by part.
constexpr const char* kTables = R"(
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE sources (
  id INTEGER PRIMARY KEY,
  argument TEXT NOT NULL UNIQUE,
  stamp TEXT NOT NULL);
CREATE TABLE parts (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL UNIQUE,
  source INTEGER NOT NULL REFERENCES sources (id),
  perimeter REAL NOT NULL,
  period_turn REAL NOT NULL,
  most_curvature REAL NOT NULL,
  closed INTEGER NOT NULL,
  reversed INTEGER NOT NULL,
  measured INTEGER NOT NULL,
  symmetry INTEGER NOT NULL,
  count REAL NOT NULL,
  profile BLOB NOT NULL,
  checksum INTEGER NOT NULL);
CREATE INDEX parts_by_source ON parts (source);
CREATE TABLE shapes (
  part INTEGER PRIMARY KEY REFERENCES parts (id),
  fine BLOB NOT NULL,
  fine_checksum INTEGER NOT NULL,
  outline TEXT NOT NULL,
  numbers BLOB NOT NULL,
  checksum INTEGER NOT NULL);
CREATE TABLE left_out (
  source INTEGER NOT NULL REFERENCES sources (id),
  what TEXT NOT NULL,
  why TEXT NOT NULL);
CREATE INDEX left_out_by_source ON left_out (source);
)";

/// The tables as they were made: views, triggers and other columns would answer in their place.
void require_own_tables(const Database& database) {
  Statement strange = database.prepare("SELECT name FROM sqlite_master WHERE type NOT IN ('table', 'index') LIMIT 1");
  if (strange.step()) {
    throw InputError(
        fmt::format("{}: has a view or a trigger, '{}', which no catalog has: build it again from its "
                    "sources",
                    database.path(), strange.bytes(0)));
  }
  const Database made(":memory:", Database::Access::write);
  made.run(kTables);
  Statement expected = made.prepare("SELECT name, sql FROM sqlite_master WHERE type = 'table' AND sql IS NOT NULL");
  while (expected.step()) {
    const std::string name(expected.bytes(0));
    Statement found = database.prepare("SELECT 1 FROM sqlite_master WHERE name = ? AND type = 'table' AND sql = ?");
    found.bind_text(0, name).bind_text(1, expected.bytes(1));
    if (!found.step()) {
      throw InputError(fmt::format("{}: the table '{}' is not as rollfix made it: build it again from its sources",
                                   database.path(), name));
    }
  }
}

bool has_tables(const Database& database) { return database.prepare("SELECT 1 FROM sqlite_master LIMIT 1").step(); }

}  // namespace

void make_tables(const Database& database) {
  Transaction all(database);  // of two builds of one new file one makes them
  if (has_tables(database)) return require_catalog(database);
  database.run(kTables);
  set_fact(database, "schema", kCatalogSchema);
  set_whole_sum(database, sum_of_unit(""));
  all.commit();
}

void require_catalog(const Database& database) {
  Statement tables = database.prepare("SELECT 1 FROM sqlite_master WHERE name = 'facts'");
  if (!tables.step()) {
    throw InputError(fmt::format("{}: is not a catalog; rollfix catalog build makes one", database.path()));
  }
  const std::string schema = fact(database, "schema");
  if (schema == kCatalogSchema) return require_own_tables(database);
  throw InputError(fmt::format("{}: is a catalog of version '{}', expected '{}': build it again from its sources",
                               database.path(), schema, kCatalogSchema));
}

std::string fact(const Database& database, const std::string& name) {
  Statement asked = database.prepare("SELECT value FROM facts WHERE name = ?");
  asked.bind_text(0, name);
  return asked.step() ? std::string(asked.bytes(0)) : std::string();
}

void set_fact(const Database& database, const std::string& name, const std::string& value) {
  Statement put = database.prepare("INSERT OR REPLACE INTO facts VALUES (?, ?)");
  put.bind_text(0, name).bind_text(1, value).run();
}

std::uint64_t whole_sum(const Database& database) {
  const std::string text = fact(database, "checksum");
  std::uint64_t sum = 0;
  std::from_chars(text.data(), text.data() + text.size(), sum, 16);
  return sum;
}

void set_whole_sum(const Database& database, std::uint64_t sum) {
  set_fact(database, "checksum", fmt::format("{:016x}", sum));
}

}  // namespace rollfix
