#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "files/part_record.hpp"
#include "rollfix/identify.hpp"

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

}  // namespace rollfix::catalog
