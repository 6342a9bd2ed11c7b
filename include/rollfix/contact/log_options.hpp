#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix {

/// Where a log's header has one of the columns, when it does not have it under its known name.
struct ColumnSource {
  std::string column;  // the known name: "u", "psi", "time", "x"; of one of two fingers "u_a"
  std::string name;    // what the header calls it
  std::string unit{};  // deg, rad, mm, cm, m, in, s, ms, us, ns, ...; empty: what the header says, else radians,
                       // seconds, or the part's unit. Of u and psi it may be, or end in, "wrapped" or "unwrapped", as
                       // in "deg:unwrapped": whether the column jumps back after a full turn
};

/// How to read a log: see docs/rolling.md.
struct LogOptions {
  /// A column that is named here is found by that name only. A pair that is named here (u and psi, ...) is the one that
  /// is read, whatever else the log has. Without _a or _b: of the log's one finger; of two files of both.
  std::vector<ColumnSource> columns{};
  /// The part's: columns with a unit of length are converted to it. Empty: not known.
  std::string unit{};
  /// What columns of angles are in where neither `columns` nor the header says it: "deg". Empty: radians.
  std::string angles{};
  /// Whether u and psi jump back after a full turn, where `columns` does not say it. None: the rows show it.
  std::optional<bool> wrapped{};
  /// Whether numbers have a comma for the decimal point, as in 0,5 1,25. None: they may between semicolons.
  std::optional<bool> decimal_comma{};
  /// Rows that can't be read, a time that does not grow among them, are left out, and Log::skipped tells of them.
  bool skip_bad = false;
  /// As a mirror shows it: u, length, turn, distance, dturn and x with the other sign, pi - psi for psi. What is felt
  /// of a part that lies face down reads so like what is felt of the part as it was drawn.
  bool mirrored = false;
  /// Lengths and distances count against the outline: they get the other sign. Of u and psi that is not meant.
  bool clockwise = false;
  /// The part is one of many, which of them is not known: no step of a stream is a jump. Of files each part has its
  /// say.
  bool any_part = false;
  /// Of several rolls with u and psi: contact for a single row is a roll of length 0, and kept. Else it is left out.
  bool single_rows = false;
};

/// "u=contact_deg:deg,psi=yaw_deg:deg,time=stamp:ms": COLUMN=NAME or COLUMN=NAME:UNIT, any number of them. Throws
/// InputError: not of this form, a column that is not known or there twice, a unit that is not known or not the
/// column's.
std::vector<ColumnSource> parse_columns(std::string_view text);

}  // namespace rollfix
