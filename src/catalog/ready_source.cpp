#include "ready_source.hpp"

#include <filesystem>
#include <optional>
#include <system_error>

#include "bounds/profile.hpp"
#include "database.hpp"
#include "rollfix/error.hpp"
#include "rollfix/inspect.hpp"

// A source's parts, measured and encoded.
//   stamp           shows whether a source has changed: the next build reads only what has another one
//   profile         bounds on Theta over 64 and 256 cells of a part, which are asked before the part itself
// Follows docs/identify.md, "The catalog".
namespace rollfix::catalog {

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

}  // namespace rollfix::catalog
