#include "database.hpp"

#include <fmt/format.h>

#include <sqlite3.h>
#include <charconv>
#include <exception>
#include <filesystem>
#include <initializer_list>
#include <utility>

#include "files/part_record.hpp"
#include "rollfix/error.hpp"

// SQLite with errors as InputError, and what is in a catalog: its tables and checksums.
// Follows docs/identify.md, "The catalog", which lists the tables. A checksum is FNV-1a, by words of eight bytes, of
// numbers, lengths of texts, and texts. Those of all parts and of the unit add up, modulo 2^64, to that of the catalog:
// a part can be added or taken out without reading the others.
namespace rollfix::catalog {
namespace {

// Another program that writes is waited for so long.
constexpr int kPatienceMilliseconds = 60000;

/// Throws InputError for a code of SQLite, with the cure where there is one.
[[noreturn]] void fail(const std::string& path, sqlite3* database, int code) {
  // Without a database only the code says what it was.
  const std::string why = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  if (code == SQLITE_NOTADB) throw InputError(fmt::format("{}: is not a catalog: expected an SQLite file", path));
  // A reader that may not write can't roll back what a build that was killed has left.
  if (code == SQLITE_READONLY) {
    throw InputError(fmt::format(
        "{}: was left half written by a build that was stopped, and may not be written here: run that build "
        "again, or read it once where it may be written",
        path));
  }
  if (code == SQLITE_BUSY) throw InputError(fmt::format("{}: another program is writing to it", path));
  throw InputError(fmt::format("{}: {}", path, why));
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(sqlite3* database, sqlite3_stmt* statement, std::string path)
    : database_(database), statement_(statement), path_(std::move(path)) {}

/// Throws InputError unless the code is that of success.
void Statement::check(int code) const {
  if (code != SQLITE_OK) fail(path_, database_, code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  // SQLite counts parameters from 1.
  check(sqlite3_bind_int64(statement_.get(), parameter + 1, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(statement_.get(), parameter + 1, value));
  return *this;
}

Statement& Statement::bind_text(int parameter, std::string_view text) {
  check(sqlite3_bind_text64(statement_.get(), parameter + 1, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_bytes(int parameter, std::string_view bytes) {
  check(sqlite3_bind_blob64(statement_.get(), parameter + 1, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

/// SQLite may wait here for another program that writes, up to kPatienceMilliseconds.
bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  // Neither a row nor the end.
  if (code != SQLITE_DONE) fail(path_, database_, code);
  return false;
}

void Statement::run() {
  // Rows that it gives are passed over.
  while (step()) {
  }
  reset();
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t Statement::whole(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::number(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string_view Statement::bytes(int column) const {
  // The data before their length: SQLite asks for this order.
  const auto* const data = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

/// Opened without SQLite's own mutex: who shares it between threads has to lock it.
Database::Database(const std::string& path, Access access) : path_(path) {
  if (access == Access::read && !std::filesystem::exists(path)) {
    throw InputError(fmt::format("{}: there is no such file; rollfix catalog build makes one", path));
  }
  if (std::filesystem::is_directory(path)) {
    throw InputError(fmt::format(
        "{}: is a folder, expected a catalog's file; rollfix catalog build {} -o parts.db makes one of its outlines",
        path, path));
  }
  // For reading as well: what a build that was killed left half done has to be taken back first. Where the file may not
  // be written SQLite opens it for reading only.
  const int flags = SQLITE_OPEN_READWRITE | (access == Access::read ? 0 : SQLITE_OPEN_CREATE);
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &opened, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(opened);
  // A handle that failed to open has to be closed as well: it is owned by now.
  if (code != SQLITE_OK) fail(path, opened, code);
  sqlite3_extended_result_codes(opened, 0);
  sqlite3_busy_timeout(opened, kPatienceMilliseconds);
  if (access == Access::read) run("PRAGMA query_only = ON");
  run("PRAGMA cell_size_check = ON; PRAGMA trusted_schema = OFF");  // the file may be damaged, or a stranger's
}

/// Compiled once, to be run again and again.
Statement Database::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr);
  if (code != SQLITE_OK) fail(path_, database_.get(), code);
  return {database_.get(), statement, path_};
}

void Database::run(const std::string& sql) const {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(path_, database_.get(), code);
}

std::int64_t Database::last_id() const { return sqlite3_last_insert_rowid(database_.get()); }

/// Rolled back unless it was committed, as where an exception passes.
Transaction::~Transaction() {
  // Committed: nothing to undo.
  if (!is_open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const std::exception&) {  // SQLite rolls back by itself what it can't go on with
  }
}

void Transaction::commit() {
  // If this throws it is still open: the destructor rolls back.
  database_.run("COMMIT");
  is_open_ = false;
}

namespace {

/// Numbers, then texts with their lengths before them, so that no byte can move from one to the next. In one go: cells
/// end with a checksum of their own, and the sum of bytes with their sum is the same whatever they are.
std::uint64_t sum_of(ByteWriter numbers, std::initializer_list<std::string_view> columns) {
  // First all lengths, then all texts.
  for (const std::string_view column : columns) numbers.whole(column.size());
  std::string bytes = numbers.bytes();
  for (const std::string_view column : columns) bytes.append(column);
  return checksum(bytes);
}

}  // namespace

std::uint64_t sum_of(const PartRow& row) {
  ByteWriter numbers;
  // All columns but the checksum.
  for (const std::int64_t whole : {row.id, row.source, row.symmetry, std::int64_t{row.closed},
                                   std::int64_t{row.reversed}, std::int64_t{row.measured}}) {
    numbers.whole(static_cast<std::uint64_t>(whole));
  }
  for (const double number : {row.perimeter, row.period_turn, row.most_curvature, row.count}) numbers.number(number);
  return sum_of(numbers, {row.name, row.profile});
}

std::uint64_t sum_of(const ShapeRow& row, std::uint64_t part) {
  ByteWriter numbers;
  // The part's own sum first: the same bytes beside another part have another sum.
  numbers.whole(part);
  return sum_of(numbers, {row.outline, row.numbers});
}

std::uint64_t sum_of_fine(std::string_view fine, std::uint64_t part) {
  ByteWriter numbers;
  numbers.whole(part);
  return sum_of(numbers, {fine});
}

std::uint64_t sum_of_unit(const std::string& unit) { return checksum("unit " + unit); }

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
        fmt::format("{}: has a view or a trigger, '{}', which no catalog has: build it "
                    "again from its sources",
                    database.path(), strange.bytes(0)));
  }
  // The tables as this program makes them, to compare with: by their text.
  const Database made(":memory:", Database::Access::write);
  made.run(kTables);
  Statement expected = made.prepare("SELECT name, sql FROM sqlite_master WHERE type = 'table' AND sql IS NOT NULL");
  // Each table by name and text.
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

/// Whether anything was made in the file.
bool has_tables(const Database& database) { return database.prepare("SELECT 1 FROM sqlite_master LIMIT 1").step(); }

}  // namespace

void make_tables(const Database& database) {
  Transaction all(database);  // of two builds of one new file one makes them
  // Rolled back at the end: nothing was changed.
  if (has_tables(database)) return require_catalog(database);
  // A new file: tables, version and the sum of a catalog without parts.
  database.run(kTables);
  set_fact(database, "schema", kCatalogSchema);
  set_whole_sum(database, sum_of_unit(""));
  all.commit();
}

void require_catalog(const Database& database) {
  // Whether it is a catalog at all, of this version, and with nothing else in its place.
  Statement tables = database.prepare("SELECT 1 FROM sqlite_master WHERE name = 'facts'");
  if (!tables.step()) {
    throw InputError(fmt::format("{}: is not a catalog; rollfix catalog build makes one", database.path()));
  }
  // A version that is not this one is not read: its tables may be others.
  const std::string schema = fact(database, "schema");
  if (schema == kCatalogSchema) return require_own_tables(database);
  throw InputError(fmt::format("{}: is a catalog of version '{}', expected '{}': build it again from its sources",
                               database.path(), schema, kCatalogSchema));
}

/// Facts are texts; a name has one value.
std::string fact(const Database& database, const std::string& name) {
  Statement asked = database.prepare("SELECT value FROM facts WHERE name = ?");
  asked.bind_text(0, name);
  return asked.step() ? std::string(asked.bytes(0)) : std::string();
}

/// In place of what the name had before.
void set_fact(const Database& database, const std::string& name, const std::string& value) {
  Statement put = database.prepare("INSERT OR REPLACE INTO facts VALUES (?, ?)");
  put.bind_text(0, name).bind_text(1, value).run();
}

/// Stored as 16 hexadecimal digits. No number, as in a damaged file, is 0.
std::uint64_t whole_sum(const Database& database) {
  // Read anew each time: another build may have changed it.
  const std::string text = fact(database, "checksum");
  std::uint64_t sum = 0;
  std::from_chars(text.data(), text.data() + text.size(), sum, 16);
  return sum;
}

void set_whole_sum(const Database& database, std::uint64_t sum) {
  set_fact(database, "checksum", fmt::format("{:016x}", sum));
}

}  // namespace rollfix::catalog
