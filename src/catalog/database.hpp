#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "work/crew.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace rollfix::catalog {

/// One SQL statement, to be run once or again and again. Columns and parameters are counted from 0.
class Statement {
 public:
  /// The value of a parameter; texts and bytes are copied. All of these throw InputError: what SQLite says.
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind_text(int parameter, std::string_view text);
  Statement& bind_bytes(int parameter, std::string_view bytes);

  /// The next row; false: there is none.
  bool step();
  /// Runs it to its end, and makes it ready to be run again.
  void run();
  void reset();  // to be run again; what is bound stays

  // Of the row that step() found:
  std::int64_t whole(int column) const;
  double number(int column) const;
  std::string_view bytes(int column) const;  // of a text as well; until the next step

 private:
  friend class Database;
  Statement(sqlite3* database, sqlite3_stmt* statement, std::string path);
  void check(int code) const;

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  sqlite3* database_;  // of which it is; has to outlive it
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  std::string path_;  // of the file, for messages
};

/// An SQLite file. Throws InputError: what SQLite says, with the file's name.
class Database {
 public:
  enum class Access { read, write };
  /// For writing the file is made where there is none.
  Database(const std::string& path, Access access);

  Statement prepare(const std::string& sql) const;  // one statement
  void run(const std::string& sql) const;           // any number of them, without results
  std::int64_t last_id() const;                     // of the row that was inserted last
  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
  std::string path_;
};

/// All or nothing: what was done since it was made is undone unless it is committed, and a signal waits for that, so
/// that none leaves the file half written. Of one that only reads: all of it is of one state, whatever others write
/// meanwhile.
class Transaction {
 public:
  explicit Transaction(const Database& database, Database::Access access = Database::Access::write)
      : database_(database) {
    database_.run(access == Database::Access::write ? "BEGIN IMMEDIATE" : "BEGIN");
    if (access == Database::Access::write) signals_wait_.emplace();  // now: before it may have to wait for others
  }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  /// Throws InputError: then nothing is done.
  void commit();

 private:
  const Database& database_;
  bool is_open_ = true;  // neither committed nor rolled back
  std::optional<SignalsWait> signals_wait_;
};

/// A row of `parts`.
struct PartRow {
  std::int64_t id = 0;        // never used again for another part
  std::string_view name;      // no two have the same
  std::int64_t source = 0;    // id in `sources`
  double perimeter = 0;       // in the catalog's unit
  double period_turn = 0;     // turn of a lap, radians
  double most_curvature = 0;  // the largest |kappa|
  bool closed = false;
  bool reversed = false;      // given clockwise
  bool measured = false;      // the outline is not exact, as of a taught part
  std::int64_t symmetry = 0;  // 0: a circle
  double count = 0;           // so many of it
  std::string_view profile;   // Theta on 64 cells: bytes_of(Profile)
};

/// A row of `shapes` without its fine cells.
struct ShapeRow {
  std::string_view outline;  // JSON: what the outline is, with its curves by kind or its gallery shape
  std::string_view numbers;  // of the curves, and the gap; little-endian doubles
};

/// The checksum of all columns.
std::uint64_t sum_of(const PartRow& row);
/// The checksums of what belongs to a part hold only beside that part's own.
std::uint64_t sum_of(const ShapeRow& row, std::uint64_t part);
std::uint64_t sum_of_fine(std::string_view fine, std::uint64_t part);

/// Of the whole catalog: its parts' checksums are added to this one, so that none goes missing.
std::uint64_t sum_of_unit(const std::string& unit);

/// A catalog of another version is refused: it is built again from its sources.
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

}  // namespace rollfix::catalog
