#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/noise.hpp"
#include "rollfix/contact/reading.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What the rows of a log say.
enum class LogKind {
  contact,    // u and psi; the first row is the first contact
  travelled,  // length and turn, measured from a first contact that lies before the first row
  increments  // distance and dturn since the row before, as a wheel encoder with a gyroscope gives them
};

/// One finger's rows while it touched the part. Columns that a log does not have are empty.
struct Log {
  std::string name;  // the file's, for messages
  LogKind kind = LogKind::contact;
  std::vector<double> time;    // seconds, strictly growing
  std::vector<double> u;       // contact on the finger, radians of a disk, else arc length, as written: wrapped or not
  std::vector<double> psi;     // the finger's orientation, radians, as written: wrapped or not
  std::vector<double> length;  // from the first contact, along the outline as the user gave it; increments are summed
  std::vector<double> turn;    // from the first contact, radians; increments are summed
  std::vector<double> x;       // the finger's centre in the world
  std::vector<double> y;
  std::vector<std::size_t> line;           // of the file that each row comes from
  bool contact_was_off = false;            // rows without contact, before these or after them, were left out
  double u_period = 2 * std::numbers::pi;  // of a simulated log: what once around the finger adds to u
  double place_rounding = 0;               // half a unit of the most precise u (radians) or length or distance
  double angle_rounding = 0;               // the same of psi or turn or dturn

  std::size_t rows() const { return kind == LogKind::contact ? u.size() : length.size(); }
};

/// Reads a log: columns by name in any order, unknown ones ignored; two columns without a header are distance and
/// dturn. Separated by commas, semicolons, tabs or blanks. Angles may be written 73deg. `#` comments, blank lines,
/// quotes, a byte order mark and both kinds of line ends are allowed. Rows with contact 0 before the first contact and
/// after the last are skipped, whatever they hold. "-" is standard input. Throws InputError with file, line and value:
/// no such file, no known header, a cell that is missing or not a finite number, a time that does not grow, contact
/// lost and found again, too few rows, two fingers.
Log read_log(const std::string& path);

/// The same from a text; `name` is what messages call it.
Log parse_log(std::string_view text, const std::string& name);

/// The same of a file that may be of one finger or of two: u_a, psi_a, u_b, psi_b and so on in columns side by side
/// (pair_log.hpp makes one of the two). Of two fingers the rows in which both touch the part are taken.
std::vector<Log> read_logs(const std::string& path);
std::vector<Log> parse_logs(std::string_view text, const std::string& name);

/// The same of a log in which contact is lost and found again: every unbroken roll with at least a reading is a log of
/// its own, in order, each with its own first contact. Where there are several their names say the lines: "run.csv,
/// lines 12 to 90". A later roll of length and turn, or of distance and dturn, is measured from its own first row: what
/// was counted while the finger was off the part does not count.
std::vector<Log> read_rolls(const std::string& path);
std::vector<Log> parse_rolls(std::string_view text, const std::string& name);

/// The same of a file that may be of one finger or of two: each roll has a log for each finger. Two fingers roll while
/// both touch.
std::vector<std::vector<Log>> read_rolls_of_fingers(const std::string& path);
std::vector<std::vector<Log>> parse_rolls_of_fingers(std::string_view text, const std::string& name);

/// time,u,psi,x,y (or time,length,turn), 17 significant digits each: reading it back gives the same bits.
/// Throws InputError when neighbouring rows are so far apart that a reader would take the angles as wrapped.
std::string format_log(const Log& log);

/// Writes that to a file, "-" for standard output. Throws InputError when it can't be written.
void write_log(const std::string& path, const Log& log);

/// Angles without jumps. A column may be wrapped when it stays within a full turn; then each sample is moved by the
/// multiple of 2 pi that brings it nearest to the one before. Where there are only two samples, and so nothing else to
/// tell by, both must lie in [-pi, pi] or in [0, 2 pi]. `rounding`: of each sample. `period`: in place of 2 pi, for
/// arc lengths along a finger's outline; infinite where nothing is wrapped.
std::vector<double> unwrapped(const std::vector<double>& angles, double rounding = 0,
                              double period = 2 * std::numbers::pi);

/// The rows that are meant by these instants: each must be within half the distance of a row from its neighbours in
/// time. No instants: the last row. Throws InputError: no such row, or a log without times.
std::vector<std::size_t> rows_at(const Log& log, const std::vector<double>& times);

/// Every row as a reading from the first contact, lengths along the outline as the user gave it.
/// Throws InputError: u and psi without a finger.
std::vector<Reading> readings_as_given(const Log& log, const std::optional<Finger>& finger);

/// The readings at these instants (see rows_at) in the direction in which the part is stored: what `locate` takes.
/// Throws InputError as those do, and where one row is farther from the next than is physical, naming the line: see
/// docs/rolling.md. `noise` widens what is.
std::vector<Reading> readings(const Log& log, const Part& part, const std::optional<Finger>& finger,
                              const std::vector<double>& times = {}, const Noise& noise = {});

/// How far the digits that were written can have moved such a reading, at worst: both of its rows, every increment.
Rounding rounding_of(const Log& log, const std::optional<Finger>& finger);

}  // namespace rollfix
