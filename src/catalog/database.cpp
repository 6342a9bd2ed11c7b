#include "database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <exception>
#include <filesystem>
#include <utility>

#include "rollfix/error.hpp"

namespace rollfix {
namespace {

// Another program that writes is waited for so long.
constexpr int kPatienceMilliseconds = 60000;

[[noreturn]] void fail(const std::string& path, sqlite3* database, int code) {
  const std::string why = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  if (code == SQLITE_NOTADB) throw InputError(fmt::format("{}: is not a catalog: expected an SQLite file", path));
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

void Statement::check(int code) const {
  if (code != SQLITE_OK) fail(path_, database_, code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
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

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) fail(path_, database_, code);
  return false;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t Statement::whole(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::number(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string_view Statement::bytes(int column) const {
  const auto* const data = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Database::Database(const std::string& path, Access access) : path_(path) {
  if (access == Access::read && !std::filesystem::exists(path)) {
    throw InputError(fmt::format("{}: there is no such file; rollfix catalog build makes one", path));
  }
  // For reading as well: what a build that was killed left half done has to be taken back first. Where the file may not
  // be written SQLite opens it for reading only.
  const int flags = SQLITE_OPEN_READWRITE | (access == Access::read ? 0 : SQLITE_OPEN_CREATE);
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &opened, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(opened);
  if (code != SQLITE_OK) fail(path, opened, code);
  sqlite3_extended_result_codes(opened, 0);
  sqlite3_busy_timeout(opened, kPatienceMilliseconds);
  if (access == Access::read) run("PRAGMA query_only = ON");
  run("PRAGMA cell_size_check = ON; PRAGMA trusted_schema = OFF");  // the file may be damaged, or a stranger's
}

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

Transaction::~Transaction() {
  if (!is_open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const std::exception&) {  // SQLite rolls back by itself what it can't go on with
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  is_open_ = false;
}

}  // namespace rollfix
