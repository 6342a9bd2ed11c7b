#include <fmt/format.h>

#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "database.hpp"
#include "ready_source.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "work/crew.hpp"

// Builds a catalog: threads read sources and measure their parts, the calling thread writes them in order.
//   source          a file, a gallery shape or a part that is there, with a stamp that shows whether it has changed
//   ready           all that a source holds, measured and encoded, in the catalog's unit: ready_source.cpp
//   transaction     several sources at once: whole or not at all, with the catalog's checksum brought up to date
// Follows docs/identify.md, "The catalog". Several builds at once are allowed: each looks again, within its
// transaction, whether another one was faster.
namespace rollfix::catalog {
namespace {

// At most so many sources may be ready while an earlier one is not: this bounds the memory.
constexpr std::size_t kMostWaiting = 512;

/// What is ready, in the order of the sources.
class Waiting {
 public:
  /// Waits where too much is ready before number k. False: nobody takes it any more.
  bool put(std::size_t k, ReadySource source) {
    std::unique_lock lock(mutex_);
    // The next one in order never waits, so that this can't block for ever.
    room_.wait(lock, [&] { return is_closed_ || k < next_ + kMostWaiting; });
    if (is_closed_) return false;
    ready_.emplace(k, std::move(source));
    return true;
  }

  /// All that nothing before it is missing of.
  std::vector<std::pair<std::size_t, ReadySource>> take() {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<std::size_t, ReadySource>> taken;
    // Invariant: all below `next_` were taken, in order.
    for (auto first = ready_.begin(); first != ready_.end() && first->first == next_; first = ready_.begin()) {
      taken.emplace_back(first->first, std::move(first->second));
      ready_.erase(first);
      ++next_;
    }
    room_.notify_all();
    return taken;
  }

  /// Nothing is taken any more: threads that wait in put() go on, and end.
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    room_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable room_;              // notified when `next_` has grown, or nothing is taken any more
  std::map<std::size_t, ReadySource> ready_;  // by number, what was not taken yet
  std::size_t next_ = 0;                      // number of the next one to be taken
  bool is_closed_ = false;
};

/// Where nothing could be written to a new file, none is left behind.
class NoEmptyFile {
 public:
  explicit NoEmptyFile(std::string path) : path_(std::move(path)) {}
  ~NoEmptyFile() {
    std::error_code error;
    if (std::filesystem::is_regular_file(path_, error) && std::filesystem::file_size(path_, error) == 0 && !error) {
      std::filesystem::remove(path_, error);
    }
  }
  NoEmptyFile(const NoEmptyFile&) = delete;
  NoEmptyFile& operator=(const NoEmptyFile&) = delete;

 private:
  std::string path_;
};

/// Writes to a catalog, and keeps its checksum. `write` has to be called within a transaction that commit() ends.
class CatalogWriter {
 public:
  /// Makes the tables of a new file. `unit`: of all lengths; empty: not said. Throws InputError: a catalog in another
  /// unit.
  CatalogWriter(const std::string& path, const std::string& unit) : database_(path, Database::Access::write) {
    make_tables(database_);
    // What is reported as done survives a crash of the machine.
    database_.run("PRAGMA synchronous = FULL");
    Transaction all(database_);
    unit_ = fact(database_, "unit");
    if (unit.empty() || unit == unit_) return;
    if (!unit_.empty() || parts() > 0) {
      throw InputError(fmt::format("`unit` {}: the lengths of {} are in {}: expected that unit, or another file", unit,
                                   path, unit_.empty() ? "no known unit" : unit_));
    }
    set_unit(unit);
    commit(all);
  }

  const std::string& unit() const { return unit_; }

  /// The stamp of each source that is there, by its argument.
  std::unordered_map<std::string, std::string> stamps() const {
    std::unordered_map<std::string, std::string> stamps;
    Statement rows = database_.prepare("SELECT argument, stamp FROM sources");
    while (rows.step()) stamps.emplace(rows.bytes(0), rows.bytes(1));
    return stamps;
  }

  /// How many parts are there.
  std::size_t parts() const {
    Statement asked = database_.prepare("SELECT count(*) FROM parts");
    asked.step();
    return static_cast<std::size_t>(asked.whole(0));
  }

  /// In place of what was there of this source, in the catalog's unit.
  void write(const CatalogSource& source, const BuildOptions& options, ReadySource& ready, BuildReport& report) {
    const std::string& stamp = ready.stamp;
    if (is_there(source.argument, stamp)) {  // looked up within the transaction: another build was faster
      ++report.unchanged;
      return;
    }
    unit_ = fact(database_, "unit");  // which that may have set
    // The first part that states a unit sets the catalog's. Parts that are there without one could be in any: the new
    // one is left out.
    if (unit_.empty() && !ready.unit.empty() && !ready.parts.empty()) {
      if (parts() == 0) {
        set_unit(ready.unit);
      } else {
        ready.leave_out(source,
                        fmt::format("is in {0}, and nobody says in what the parts are that are there: build them "
                                    "anew, with `unit` {0}",
                                    ready.unit));
      }
    }
    // The unit may have been set since the source was read: then it is read again.
    ready = in_catalogs_unit(std::move(ready), source, options, unit_);
    // All that was there of this source goes, also where less of it can be used now.
    if (forget(source.argument)) ++report.replaced;
    Statement put = database_.prepare("INSERT INTO sources (argument, stamp) VALUES (?, ?)");
    put.bind_text(0, source.argument).bind_text(1, ready.again ? "" : stamp).run();
    const std::int64_t id = database_.last_id();
    for (const ReadyPart& part : ready.parts) {
      // Names have to differ: the first one stays.
      if (const std::string other = source_that_has(part.entry.name); !other.empty()) {
        ready.left_out.push_back({part.entry.name, fmt::format("{}: a part of this name is there from {}: names have "
                                                               "to differ; give the file another one",
                                                               source.argument, other)});
        continue;
      }
      write_part(part, id);
      ++report.added;
    }
    for (const LeftOut& one : ready.left_out) {
      Statement left_out = database_.prepare("INSERT INTO left_out VALUES (?, ?, ?)");
      left_out.bind(0, id).bind_text(1, one.source).bind_text(2, one.why).run();
      report.left_out.push_back(one);
    }
    for (std::string& note : ready.notes) report.notes.push_back(std::move(note));
  }

  /// Takes parts out by name, all of them or none. Throws InputError: a name that is not there.
  std::size_t remove(const std::vector<std::string>& names) {
    Transaction all(database_);
    for (const std::string& name : names) {
      Statement asked = database_.prepare("SELECT id, source, checksum FROM parts WHERE name = ?");
      asked.bind_text(0, name);
      if (!asked.step()) {
        throw InputError(
            fmt::format("{}: there is no part '{}'; rollfix catalog list names them; nothing was taken "
                        "out",
                        database_.path(), name));
      }
      const std::int64_t id = asked.whole(0);
      const std::int64_t source = asked.whole(1);
      // Sums are modulo 2^64: what was added is taken off.
      sum_change_ -= static_cast<std::uint64_t>(asked.whole(2));
      // What refers to the part goes first.
      database_.prepare("DELETE FROM shapes WHERE part = ?").bind(0, id).run();
      database_.prepare("DELETE FROM parts WHERE id = ?").bind(0, id).run();
      // So that a build takes it in again.
      database_.prepare("UPDATE sources SET stamp = '' WHERE id = ?").bind(0, source).run();
    }
    commit(all);
    return names.size();
  }

  /// What was written, with the whole catalog's sum.
  void commit(Transaction& all) {
    if (sum_change_ != 0) set_whole_sum(database_, whole_sum(database_) + std::exchange(sum_change_, 0));
    all.commit();
  }

  const Database& database() const { return database_; }

 private:
  /// The unit is part of the catalog's checksum: its share is exchanged.
  void set_unit(const std::string& unit) {
    sum_change_ += sum_of_unit(unit) - sum_of_unit(unit_);
    set_fact(database_, "unit", unit);
    unit_ = unit;
  }

  /// Whether this source is in the catalog as it is now.
  bool is_there(const std::string& argument, const std::string& stamp) const {
    Statement asked = database_.prepare("SELECT 1 FROM sources WHERE argument = ? AND stamp = ?");
    return asked.bind_text(0, argument).bind_text(1, stamp).step();
  }

  /// Takes out all that is there of a source; its parts leave the catalog's checksum. Whether there was anything.
  bool forget(const std::string& argument) {
    Statement asked = database_.prepare("SELECT id FROM sources WHERE argument = ?");
    asked.bind_text(0, argument);
    if (!asked.step()) return false;
    const std::int64_t id = asked.whole(0);
    Statement parts = database_.prepare("SELECT checksum FROM parts WHERE source = ?");
    parts.bind(0, id);
    while (parts.step()) sum_change_ -= static_cast<std::uint64_t>(parts.whole(0));
    // In this order: what refers to a row goes before it.
    for (const char* const sql : {"DELETE FROM shapes WHERE part IN (SELECT id FROM parts WHERE source = ?)",
                                  "DELETE FROM parts WHERE source = ?", "DELETE FROM left_out WHERE source = ?",
                                  "DELETE FROM sources WHERE id = ?"}) {
      database_.prepare(sql).bind(0, id).run();
    }
    return true;
  }

  /// The source of a part of this name; empty: there is none.
  std::string source_that_has(const std::string& name) const {
    Statement asked =
        database_.prepare("SELECT argument FROM sources JOIN parts ON parts.source = sources.id WHERE parts.name = ?");
    asked.bind_text(0, name);
    return asked.step() ? std::string(asked.bytes(0)) : std::string();
  }

  /// Writes a row of `parts`, and returns its checksum, which is written in a second step: the id belongs to it.
  std::uint64_t write_row(const ReadyPart& part, std::int64_t source) {
    Statement row = database_.prepare(
        "INSERT INTO parts (name, source, perimeter, period_turn, most_curvature, closed, reversed, measured, "
        "symmetry, count, profile, checksum) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 0)");
    const CatalogEntry& entry = part.entry;
    row.bind_text(0, entry.name).bind(1, source).bind(2, entry.perimeter).bind(3, part.period_turn);
    row.bind(4, part.most_curvature).bind(5, std::int64_t{entry.closed}).bind(6, std::int64_t{entry.reversed});
    row.bind(7, std::int64_t{part.measured}).bind(8, std::int64_t{entry.symmetry}).bind(9, entry.count);
    row.bind_bytes(10, part.cells).run();
    const std::int64_t id = database_.last_id();  // known only now, and part of the sum
    const std::uint64_t sum =
        sum_of({id, entry.name, source, entry.perimeter, part.period_turn, part.most_curvature, entry.closed,
                entry.reversed, part.measured, entry.symmetry, entry.count, part.cells});
    Statement put = database_.prepare("UPDATE parts SET checksum = ? WHERE id = ?");
    put.bind(0, static_cast<std::int64_t>(sum)).bind(1, id).run();
    return sum;
  }

  /// Writes a part: what is looked through as a whole in `parts`, the rest in `shapes`. Both sums of `shapes` begin
  /// with that of `parts`.
  void write_part(const ReadyPart& part, std::int64_t source) {
    const std::uint64_t sum = write_row(part, source);
    const std::int64_t id = database_.last_id();
    sum_change_ += sum;
    const PartRecord& record = part.record;
    Statement shape = database_.prepare(
        "INSERT INTO shapes (part, fine, fine_checksum, outline, numbers, checksum) VALUES (?, ?, ?, ?, ?, ?)");
    shape.bind(0, id).bind_bytes(1, part.fine).bind(2, static_cast<std::int64_t>(sum_of_fine(part.fine, sum)));
    shape.bind_text(3, record.outline).bind_bytes(4, record.numbers);
    shape.bind(5, static_cast<std::int64_t>(sum_of({record.outline, record.numbers}, sum))).run();
  }

  Database database_;
  std::string unit_;              // the catalog's; empty: not known
  std::uint64_t sum_change_ = 0;  // of the whole catalog's, since the last commit
};

}  // namespace

}  // namespace rollfix::catalog

namespace rollfix {

BuildReport build_catalog(const std::string& path, const std::vector<CatalogSource>& sources,
                          const BuildOptions& options) {
  // First, so that it ends last: after the file is closed.
  const catalog::NoEmptyFile none(path);
  catalog::CatalogWriter writer(path, options.load.points.unit);
  const std::string unit = writer.unit();  // which may be set while parts are read
  BuildReport report;
  const std::unordered_map<std::string, std::string> there = writer.stamps();
  std::vector<std::size_t> wanted;
  // What has the stamp of before is not read again.
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto found = there.find(sources[k].argument);
    if (found != there.end() && found->second == catalog::stamp_of(sources[k], options)) {
      ++report.unchanged;
    } else {
      wanted.push_back(k);
    }
  }

  catalog::Waiting waiting;
  BuildProgress progress{sources.size(), report.unchanged, writer.parts()};
  // All that is ready in order, in one transaction. Progress counts it only after the commit.
  const auto write_ready = [&] {
    std::vector<std::pair<std::size_t, catalog::ReadySource>> ready = waiting.take();
    if (!ready.empty()) {
      catalog::Transaction all(writer.database());
      for (auto& [k, source] : ready) {
        writer.write(sources[wanted[k]], options, source, report);
      }
      writer.commit(all);
      // Committed: from here on it is safe in the file.
      progress.done += ready.size();
      progress.parts = writer.parts();
    }
    return !options.go_on || options.go_on(progress);
  };
  const auto go_on = [&](std::size_t /*done*/) {
    try {
      report.stopped = !write_ready();
    } catch (...) {
      // An error ends the build. Threads may wait for room: without this they would never end.
      waiting.close();
      throw;
    }
    if (report.stopped) waiting.close();
    return !report.stopped;
  };
  Crew crew(wanted.size(), 1);
  crew.run(options.jobs, go_on, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) {
      const CatalogSource& source = sources[wanted[k]];
      if (!waiting.put(k, catalog::in_catalogs_unit(catalog::read_source(source, options), source, options, unit)))
        return;
    }
  });
  // What became ready after the last call of go_on.
  if (!report.stopped) {
    crew.require_done();
    write_ready();
  }
  return report;
}

std::size_t remove_from_catalog(const std::string& path, const std::vector<std::string>& names) {
  // A writer would make an empty catalog of it.
  if (!std::filesystem::exists(path)) throw InputError(fmt::format("{}: there is no such catalog", path));
  return catalog::CatalogWriter(path, "").remove(names);
}

}  // namespace rollfix
