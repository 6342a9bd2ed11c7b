#include <fmt/format.h>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bounds/bounds.hpp"
#include "database.hpp"
#include "files/part_record.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/inspect.hpp"
#include "work/crew.hpp"

// What a catalog writes of a source: a file, a gallery shape or a part that is there.
namespace rollfix::catalog {

/// A part, ready to be written.
struct ReadyPart {
  CatalogEntry entry;         // its id is not known yet: 0
  double period_turn = 0;     // turn of a lap, radians
  double most_curvature = 0;  // the largest |kappa|
  bool measured = false;      // the outline is not exact, as of a taught part
  std::string cells;          // of 64, ...
  std::string fine;           // ... and of 256
  PartRecord record;          // its outline, as bytes
};

/// All that a source holds.
struct ReadySource {
  std::string stamp;               // of the source just before it was read
  std::vector<ReadyPart> parts;    // of a drawing one for each closed loop
  std::vector<LeftOut> left_out;   // what could not be used of it
  std::vector<std::string> notes;  // of the reader, for people
  std::string unit;                // of its lengths; empty: not known
  bool again = false;              // left out for what the next build may say

  /// All of it is left out. It has no stamp then, so that the next build tries again.
  void leave_out(const CatalogSource& source, const std::string& why) {
    parts.clear();
    left_out.push_back({source.name, fmt::format("{}: {}", source.argument, why)});
    again = true;
  }
};

/// How a source is now, and how it would be taken: the size and time of the file, or a checksum of the part, and the
/// options.
std::string stamp_of(const CatalogSource& source, const BuildOptions& options);

/// Reads a source and measures its parts: of a drawing every closed loop. What can't be used is left out, with the
/// reason.
ReadySource read_source(const CatalogSource& source, const BuildOptions& options);

/// The same in the catalog's unit, where that is known and the options say none. What states no unit is left out.
ReadySource in_catalogs_unit(ReadySource ready, const CatalogSource& source, const BuildOptions& options,
                             const std::string& unit);

// A source's parts, measured and encoded.
//   stamp           shows whether a source has changed: the next build reads only what has another one
//   profile         bounds on Theta over 64 and 256 cells of a part, which are asked before the part itself
// Follows docs/identify.md, "The catalog".

std::string stamp_of(const CatalogSource& source, const BuildOptions& options) {
  std::error_code error;
  const auto size = std::filesystem::file_size(source.argument, error);
  const auto time = std::filesystem::last_write_time(source.argument, error);
  // A gallery shape has no file: its name says all.
  std::string file = error ? "" : fmt::format("{} {}", size, time.time_since_epoch().count());
  // A part that is given has no file: its shape is its state.
  if (source.part) {
    const PartRecord record = record_of(*source.part);
    file = fmt::format("{:016x}", checksum(record.outline + record.numbers));
  }
  const auto length = [](const std::optional<Length>& one) {
    return one ? fmt::format("{}{}", one->value, one->unit) : std::string();
  };
  const OutlineOptions& points = options.load.points;
  // The unit is the catalog's, which stays.
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}{}", file, source.name, source.count, points.open,
                     points.corner_angle.value_or(-1), length(points.smooth), length(options.load.gap),
                     options.load.layer, options.load.allow_crossing,
                     fmt::format("{}{}",
                                 !points.decimal_comma   ? ""
                                 : *points.decimal_comma ? "|,"
                                                         : "|.",
                                 options.load.outer ? "|outer" : ""));
}

namespace {

/// The same options with all lengths in this unit.
BuildOptions in_unit(BuildOptions options, const std::string& unit) {
  options.load.points.unit = unit;
  return options;
}

/// Measures a part and encodes it. The 64 cells that are stored are made of the 256, so that both agree.
ReadyPart ready_part(const Part& part, const std::string& name, double count) {
  ReadyPart ready;
  ready.entry = {0, name, part.perimeter(), symmetry(part), part.closed(), part.reversed(), count};
  ready.period_turn = part.turning().period_turn();
  ready.most_curvature = part.turning().most_curvature();
  ready.measured = !part.outline().accuracy.is_exact();
  // Bounds that are asked first are computed now, once; the part itself is stored as its outline.
  const Profile<kFineCells> fine = profile_of(part);
  ready.cells = bytes_of(coarser(fine));
  ready.fine = fine_bytes_of(fine, coarser(fine));
  ready.record = record_of(part);
  return ready;
}

/// Pixels are no length either.
bool states_a_length(const std::string& unit) { return !unit.empty() && unit != "px"; }

}  // namespace

/// Of a drawing every closed loop, else the one part.
ReadySource read_source(const CatalogSource& source, const BuildOptions& options) {
  ReadySource ready;
  // Before: what is replaced while it is read has another stamp, and the next build reads it again.
  ready.stamp = stamp_of(source, options);
  try {
    const LoadedPart loaded =
        source.part ? loaded_part(*source.part, options.load) : load_part(source.argument, options.load);
    // Notes and unit are the source's, whatever becomes of its parts.
    ready.notes = loaded.notes;
    ready.unit = loaded.unit;
    std::vector<const Loop*> closed;
    // Open lines of a drawing are no parts beside closed loops.
    for (const Loop& loop : loaded.loops) {
      if (loop.outline.closed) closed.push_back(&loop);
    }
    // One outline, or an open one: one part under the source's own name.
    if (closed.size() < 2 || options.load.points.open) {
      ready.parts.push_back(ready_part(loaded.part, source.name, source.count));
      return ready;
    }
    // Each loop by itself: one that can't be used does not keep the others out.
    for (std::size_t k = 0; k < closed.size(); ++k) {
      const std::string name = fmt::format("{}#{}", source.name, k + 1);
      try {
        // The loop that the reader has chosen is a part already.
        const bool is_loaded = k + 1 == loaded.loop;
        const Part part = is_loaded ? loaded.part : Part(closed[k]->outline, {options.load.allow_crossing});
        ready.parts.push_back(ready_part(part, name, source.count));
      } catch (const InputError& error) {
        ready.left_out.push_back({name, error.what()});
      }
    }
  } catch (const InputError& error) {
    ready.left_out.push_back({source.name, error.what()});
  }
  return ready;
}

ReadySource in_catalogs_unit(ReadySource ready, const CatalogSource& source, const BuildOptions& options,
                             const std::string& unit) {
  // Nothing to convert: no unit is known yet, the options decide, or it is the same.
  if (unit.empty() || !options.load.points.unit.empty() || ready.parts.empty() || ready.unit == unit) return ready;
  // The catalog counts in pixels: no length can be converted to these.
  if (states_a_length(ready.unit) && !states_a_length(unit)) {
    ready.leave_out(source, fmt::format("is in {0}, and the catalog is in {1}, as its first part: build another file, "
                                        "with `unit` {0}",
                                        ready.unit, unit));
    return ready;
  }
  if (states_a_length(ready.unit)) return read_source(source, in_unit(options, unit));
  // No unit, in a catalog that has one: a guess could be off by a factor.
  ready.leave_out(source, fmt::format("nobody says in what its lengths are, and the catalog is in {0}: give `unit` {0} "
                                      "where they are as well",
                                      unit));
  return ready;
}

// ---- a catalog of them
// Builds a catalog: threads read sources and measure their parts, the calling thread writes them in order.
//   source          a file, a gallery shape or a part that is there, with a stamp that shows whether it has changed
//   ready           all that a source holds, measured and encoded, in the catalog's unit
//   transaction     several sources at once: whole or not at all, with the catalog's checksum brought up to date
// Follows docs/identify.md, "The catalog". Several builds at once are allowed: each looks again, within its
// transaction, whether another one was faster.

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
            fmt::format("{}: there is no part '{}'; rollfix catalog list names them; "
                        "nothing was taken out",
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
