#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/files/load_part.hpp"
#include "rollfix/part/part.hpp"

// Many parts in one SQLite file: docs/identify.md has its tables.
namespace rollfix {

/// A part of a catalog, as its lists show it.
struct CatalogEntry {
  std::int64_t id = 0;   // stays the same for as long as the part is there
  std::string name;      // no two have the same
  double perimeter = 0;  // in the catalog's unit
  int symmetry = 1;      // see symmetry(const Part&)
  bool closed = true;
  bool reversed = false;  // given clockwise
  double count = 1;       // so many of it are among what may be touched: what makes it likelier than another
};

/// What is not in a catalog, and why.
struct LeftOut {
  std::string source;  // the file, or gallery:...
  std::string why;
};

/// A catalog that is read. Parts are loaded when they are asked for. Any number of threads may share one.
class Catalog {
 public:
  /// Throws InputError: no such file, not a catalog, or of a version that this program does not know.
  explicit Catalog(const std::string& path);
  ~Catalog();
  Catalog(Catalog&&) noexcept;
  Catalog& operator=(Catalog&&) noexcept;

  const std::string& path() const;
  /// Of all lengths; empty: not known.
  const std::string& unit() const;
  std::size_t size() const;
  /// In the order of their ids, which is that in which they were added.
  const CatalogEntry& entry(std::size_t index) const;
  /// Where the name was read from.
  std::string source_of(std::size_t index) const;
  std::vector<LeftOut> left_out() const;

  /// The part, as if it had been loaded from its source; its name is the entry's. It is kept, so that the next one who
  /// asks has it at once. Throws InputError: the file was damaged.
  Part part(std::size_t index) const;

  struct Index;  // what identify() looks at first
  const Index& index() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What a log is read with while it is not known which part it is of: one of them, in the catalog's unit. Throws
/// InputError: there is none.
Part any_part_of(const Catalog& catalog);

/// What a catalog is built of: a file, "gallery:..." or a part that is there, and how many parts of it there are.
struct CatalogSource {
  std::string argument;  // as load_part takes it
  std::string name;      // of its part; of a drawing with several loops "name#1", "name#2", ... by falling area
  double count = 1;
  std::optional<Part> part{};  // what `argument` is called after; none: it is to be loaded
};

/// All that load_part takes in a folder and the folders in it, by name; or what a list names: a text file with a file
/// or gallery:... in each line, relative to the list, and behind a tabulator the count. Empty lines and lines that
/// begin with # are passed over. Any other file, and gallery:..., is a source itself. Throws InputError: nothing of the
/// name, a folder without any, a count that is not above 0.
std::vector<CatalogSource> catalog_sources(const std::string& argument);

/// How far a build is. Only what is safe in the file counts.
struct BuildProgress {
  std::size_t sources = 0;  // of them
  std::size_t done = 0;
  std::size_t parts = 0;  // in the catalog
};

struct BuildOptions {
  LoadOptions load{};  // how files are taken; `loop` is not asked: every closed loop of a drawing is a part
  unsigned jobs = 0;   // threads; 0: as many as the machine has processors
  /// Called now and then by the thread that waits: false stops the build; what was done stays.
  std::function<bool(const BuildProgress&)> go_on{};
};

struct BuildReport {
  std::size_t added = 0;      // parts
  std::size_t unchanged = 0;  // sources that were there already, as they are now
  std::size_t replaced = 0;   // sources that have changed since
  std::vector<LeftOut> left_out;
  std::vector<std::string> notes;
  bool stopped = false;  // by go_on
};

/// Adds parts to a catalog, which it makes where there is none. What was there is not read again unless its file has
/// changed, so that a build that was interrupted goes on where it was. Several parts are written in one transaction;
/// whatever happens, those that progress has told of are in the file. A source that can't be taken is left out, which
/// the catalog remembers. All parts are in one unit: that of `load.points.unit`, else of the first part that has one;
/// other units are converted.
/// Throws InputError: a file that is not a catalog or can't be written, one of another unit.
BuildReport build_catalog(const std::string& path, const std::vector<CatalogSource>& sources,
                          const BuildOptions& options = {});

/// Takes parts out, by name; so many were there. Throws InputError: a name that is not in the catalog, by which nothing
/// is taken out; and as build_catalog does.
std::size_t remove_from_catalog(const std::string& path, const std::vector<std::string>& names);

}  // namespace rollfix
