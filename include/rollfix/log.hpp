#pragma once

// What sensors wrote, as a table or row by row, and the readings that it means: docs/rolling.md, "Logs".
//
//     const Log log = parse_log("time,u,psi\n0,0.1,0\n1,-0.9,0.7\n", "two rows");
//     const Reading reading = readings_as_given(log, {disk(0.2)}).back();
//     reading.length[0];  // 0.2
//
// Degenerate cases: a cell that is no number, a row that jumps, time that does not grow: an InputError with the file,
// the line and the value. Angles that wrap are unwrapped, which is refused where the rows are too far apart.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <array>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/units.hpp"

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
  /// As a mirror shows it: u, length, turn, distance, dturn and x with the other sign, pi - psi for psi (of a jaw -psi;
  /// of an open outlined finger u is counted from its other end). What is measured of a part that lies face down reads
  /// so like what is measured of the part as it was drawn.
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

/// What the rows of a log say.
enum class LogKind {
  contact,    // u and psi; the first row is the first contact
  travelled,  // length and turn, measured from a first contact that lies before the first row
  increments  // distance and dturn since the row before, as a wheel encoder with a gyroscope gives them
};

/// One finger's rows. Columns that a log does not have are empty.
struct FingerRows {
  std::string name;                        // of its own file where each finger has one, else empty
  std::vector<std::size_t> line;           // of the file that each row comes from; none of simulated rows
  std::vector<double> u;                   // contact on the finger, radians of a disk, else arc length, as written
  std::vector<double> psi;                 // the finger's orientation, radians, as written: wrapped or not, as is u
  std::vector<double> length;              // from the first contact, along the outline as the user gave it
  std::vector<double> turn;                // from the first contact, radians; increments are summed, as are lengths
  std::vector<double> x;                   // the finger's centre in the world
  std::vector<double> y;                   //
  double u_period = 2 * std::numbers::pi;  // of a simulated log: what once around the finger adds to u
  double place_rounding = 0;               // half a unit of the most precise u (radians) or length or distance
  double angle_rounding = 0;               // the same of psi or turn or dturn
  std::optional<Dimension> u_dimension{};  // where the log says whether u is an angle or a length
  std::vector<ColumnSource> columns{};     // of a log with a header: what it calls those that were read
  std::vector<double> distance{};          // of increments: as written, and `length` is their sum
  std::vector<double> dturn{};             // the same of `turn`
  std::optional<bool> u_wrapped{};         // whether u jumps back after a full turn, where that was said
  std::optional<bool> psi_wrapped{};       // the same of psi
};

/// What one finger, or two together, recorded of one roll, while all of them touched the part.
struct Log {
  std::string name;  // the file's, for messages; of two files the first one's
  LogKind kind = LogKind::contact;
  std::vector<double> time;                       // seconds, strictly growing; empty where there are none
  std::vector<FingerRows> fingers{FingerRows{}};  // one or two; row k of all is the same instant
  bool contact_was_off = false;                   // rows without contact, before these or after them, were left out
  std::string unit{};                             // of its lengths, as the options had it; empty: not known
  std::vector<std::string> notes{};               // what else stands in it that may have been meant
  std::vector<std::string> skipped{};             // why rows were left out that could not be read, as the options asked

  std::size_t rows() const { return kind == LogKind::contact ? fingers[0].u.size() : fingers[0].length.size(); }
};

/// Reads a log of one finger or, with u_a, psi_a, u_b, psi_b and so on in columns side by side, of two: columns by name
/// in any order, unknown ones ignored; two columns without a header are distance and dturn. Separated by commas,
/// semicolons, tabs or blanks. Angles may be written 73deg; a unit may stand behind a column's name, in brackets: psi
/// [deg], x (mm). Between semicolons a comma is a decimal one: 0,5;1,25. `options` says what columns are called where
/// they are not called that, and in what unit. `#` comments, blank lines, quotes, a byte order mark and both kinds of
/// line ends are allowed. Rows with contact 0, of either finger, before the first contact and after the last are
/// skipped, whatever they hold. "-" is standard input. Throws InputError with file, line and value: no such file, no
/// known header, a cell that is missing or not a finite number, a time that does not grow, contact lost and found
/// again, too few rows.
Log read_log(const std::string& path, const LogOptions& options = {});

/// The same from a text; `name` is what messages call it.
Log parse_log(std::string_view text, const std::string& name, const LogOptions& options = {});

/// The same of a log in which contact is lost and found again: every unbroken roll with at least a reading is a log of
/// its own, in order, each with its own first contact. Where there are several their names say the lines: "run.csv,
/// lines 12 to 90". A later roll of length and turn, or of distance and dturn, is measured from its own first row: what
/// was counted while the finger was off the part does not count.
std::vector<Log> read_rolls(const std::string& path, const LogOptions& options = {});
std::vector<Log> parse_rolls(std::string_view text, const std::string& name, const LogOptions& options = {});

/// The log with its lengths in another unit, u as well where `fingers` are not disks. As it is where it is in that
/// unit, or one of both is not known: empty. Throws InputError: a unit that can't be converted, such as "px".
Log in_unit(Log log, const std::string& unit, const std::vector<Finger>& fingers);

/// Two logs of one finger each as one of two fingers, by row. Where a contact column left out rows of one of them, both
/// are cut to the times that they share. Throws InputError: logs of different kinds, different times, different numbers
/// of rows (naming the lines), too few rows together, or one that is of two fingers already.
Log paired(Log a, Log b);

/// Reads two logs, one of each finger, with the same times. Columns of the options that end in _a or _b are of that
/// file alone. Throws InputError as read_log and `paired` do.
Log read_log(const std::string& path_a, const std::string& path_b, const LogOptions& options = {});

/// time,u,psi,x,y (or time,length,turn, or time,distance,dturn), of two fingers time,u_a,psi_a,x_a,y_a,u_b,..., 17
/// significant digits each: reading it back gives a log of the same kind and the same bits. Throws InputError when
/// columns differ in length, and when neighbouring rows are so far apart that a reader would take the angles as
/// wrapped.
std::string format_log(const Log& log);

/// Writes that to a file, "-" for standard output. Throws InputError when it can't be written.
void write_log(const std::string& path, const Log& log);

/// One of two fingers' rows as a log of their own.
Log one_finger(const Log& log, std::size_t finger);

/// Angles without jumps. A column may be wrapped when it stays within a full turn; then each sample is moved by the
/// multiple of 2 pi that brings it nearest to the one before. Where there are only two samples, and so nothing else to
/// tell by, both must lie in [-pi, pi] or in [0, 2 pi]. `rounding`: of each sample. `period`: in place of 2 pi, for
/// arc lengths along a finger's outline; infinite where nothing is wrapped.
std::vector<double> unwrapped(const std::vector<double>& angles, double rounding = 0,
                              double period = 2 * std::numbers::pi);

/// The rows that are meant by these instants: each must be within half the distance of a row from its neighbours in
/// time. No instants: of one finger the last row; of two the middle row and the last, because two fingers need two
/// readings, or only the last where the log is too short for both. Throws InputError: no such row, that of the first
/// contact, which is no reading, a row that is meant twice, or a log without times.
std::vector<std::size_t> rows_at(const Log& log, const std::vector<double>& times);

// In what follows `fingers` are those that rolled: none where they are not known, one that holds for both, or a and b.

/// Every row as a reading from the first contact, lengths along the outline as the user gave it; of two fingers eqs.
/// (7)-(9). Throws InputError: u and psi without a finger, two fingers for the log of one. `noise`: how far u may be
/// off for a contact on a corner of the finger, whose reading has a `pivot`; that of the first contact is in all of
/// them.
std::vector<Reading> readings_as_given(const Log& log, const std::vector<Finger>& fingers, const Noise& noise = {});

/// Which rows have a contact that may be on a corner of its finger, by the digits of u or by five standard deviations
/// of its noise: there theta is not known. Empty where no finger has corners.
std::vector<bool> rows_on_corners(const Log& log, const std::vector<Finger>& fingers, const Noise& noise = {});

/// The log without its rows before this one, which becomes the first contact.
Log from_row(Log log, std::size_t row);

/// The readings at these instants (see rows_at) in the direction in which the part is stored: what `locate` takes.
/// Throws InputError as those do, and, naming the line, where u is beyond the ends of an open finger, and where one row
/// is farther from the next than is physical: see docs/rolling.md. `noise` widens what is.
std::vector<Reading> readings(const Log& log, const Part& part, const std::vector<Finger>& fingers,
                              const std::vector<double>& times = {}, const Noise& noise = {});

/// The same log without its stray rows: up to three in a row that are farther from the roll than is physical, if the
/// roll goes on behind them where it was before (or ends). A jump from which no row comes back is no stray, and stays.
/// `lines`, where asked for: those that were left out, of simulated rows their numbers.
Log without_strays(const Log& log, const Part& part, const std::vector<Finger>& fingers, const Noise& noise = {},
                   std::vector<std::size_t>* lines = nullptr);

/// Where each row's contact is on the finger, and how that is turned, both unwrapped.
std::vector<Contact> contacts_of(const FingerRows& rows, const Finger& finger);

/// (N(u) + psi) of finger a less that of finger b, u + psi of disks, at the first contacts, which is Theta(s) -
/// Theta(t) up to whole turns, in (-pi, pi]. Nothing of one finger, and where the log does not have it: length and
/// turn, distance and dturn. Without fingers they are disks.
std::optional<double> facing(const Log& log, const std::vector<Finger>& fingers = {});

/// How far the digits that were written can have moved such a reading, at worst: both of its rows, every increment.
/// Of two fingers `length` is of both lengths together. The facing can't be further off than the turn.
Rounding rounding_of(const Log& log, const std::vector<Finger>& fingers);

/// One row of a log while the fingers touch, measured from the first contacts of its roll.
struct Sample {
  std::size_t line = 0;                       // of the log; of rows that are pushed as numbers, their count
  std::optional<double> time;                 // seconds
  Reading reading;                            // in the direction in which the part is stored
  PerFinger<double> finger_curvature;         // where each touches: 1/r; 0 of a jaw or not known; infinite on a corner
  std::optional<PerFinger<Contact>> contact;  // u and psi, unwrapped, where the log has them
  std::optional<PerFinger<Vec2>> centre;      // of each finger in the world, where the log has it
};

/// What a line of a growing log was.
enum class LineKind {
  nothing,    // a comment, a blank line, the header, a row before the first contact
  first,      // a first contact: a new roll starts (its sample has L = theta = 0 where the log has u and psi)
  sample,     // a further row of the roll
  lost,       // contact is lost: the roll is over
  malformed,  // can't be read: skipped and counted
  stray,      // farther away than is physical, of a stream that is robust: skipped, the roll goes on
  jump        // more than is physical since the row before: the roll is over, this row starts a new one
};

struct LogLine {
  LineKind kind = LineKind::nothing;
  Sample sample;           // of first, sample and jump
  std::string message;     // of malformed, stray and jump: "name:line: expected ..., found ..."
  bool goes_back = false;  // of malformed: because its time is not after that of the row before
};

/// What a finger that touches says of one instant, as numbers.
struct Touch {
  double u = 0;
  double psi = 0;
  std::optional<double> x{};  // the finger's centre in the world: both or neither
  std::optional<double> y{};
};

/// A log that grows, row by row, in constant memory, of one finger or of two. What read_log refuses a live stream
/// survives: a row that can't be read, a time that does not grow, is skipped and counted. Each sample is, bit by bit,
/// the last reading of a log that ends there. A later roll of length and turn, or of distance and dturn, is measured
/// from its own first row, as read_rolls does. docs/rolling.md says what a jump is.
class LogStream {
 public:
  /// `fingers`: for logs of u and psi. `noise`: widens what counts as a jump. `name`: for messages. `options`: as for
  /// read_log; rows of numbers are radians, seconds and the part's unit. `robust`: up to three rows in a row that jump
  /// away are stray ones, and skipped; where the next one is away as well it starts a new roll.
  LogStream(std::string name, const Part& part, std::vector<Finger> fingers, const Noise& noise = {},
            LogOptions options = {}, bool robust = false);
  ~LogStream();
  LogStream(LogStream&&) noexcept;
  LogStream& operator=(LogStream&&) noexcept;

  /// The next line, with or without its line end, in the format of read_log, the header included. Throws InputError: a
  /// header that names no known columns, u and psi without a finger, not a text.
  LogLine push(std::string_view line);

  /// The next row of one finger or of two, as numbers, with the same checks. Skipped and counted is as well what
  /// does not have what the first row has, a time or none, centres or none, as many fingers, and a line among numbers.
  /// Throws InputError: no finger is known.
  LogLine push(std::optional<double> time, double u, double psi, std::optional<double> x = {},
               std::optional<double> y = {});
  LogLine push(std::optional<double> time, const PerFinger<Touch>& fingers);
  /// The same of an instant in which not every finger touches.
  LogLine push_off(std::optional<double> time);

  /// After a dropped connection: the next row continues the roll, however far it is, and a header may come again (of
  /// the same kind of log; its columns may stand in another order, and the clock may have been set anew).
  void resume();

  LogKind kind() const;           // known after the header, or the first row
  std::size_t fingers() const;    // known then: 1 or 2
  std::size_t lines() const;      // seen
  std::size_t malformed() const;  // of them skipped

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What is known of a wheel without skin, which turns freely on a pin: where the pin was and, by an encoder, how the
/// wheel was turned. Where the part touches it is not known. docs/rig.md.
struct PinLog {
  /// time, x and y of the pin in the world, and psi in radians, counter-clockwise; no psi: without an encoder. Its u
  /// says nothing: there are as many as rows.
  Log rows;

  bool has_encoder() const { return !rows.fingers.front().psi.empty(); }
};

/// Reads such a log: columns x and y, at most psi, time and contact besides, all else as `read_log`. Throws InputError
/// as that does, where x or y is missing, and where the log has a skin's u: then the finger is a disk.
PinLog read_pin_log(const std::string& path, const LogOptions& options = {});

/// The same from a text; `name` is what messages call it.
PinLog parse_pin_log(std::string_view text, const std::string& name, const LogOptions& options = {});

/// The same from numbers. `psi` and `time` may be empty. Throws InputError: not at least two rows, columns of different
/// lengths, a number that is not finite, a time that does not grow.
PinLog pin_log(std::string name, std::vector<double> x, std::vector<double> y, std::vector<double> psi = {},
               std::vector<double> time = {});

/// Two logs that grow, one of each finger, as one log of two fingers, or the second one of a wheel without skin: a row
/// waits for its partner, which is the row of the other log with the same time; without a column `time` the row of the
/// same number. Rows that can't be read and rows that turn out to have no partner are skipped. What a sample says is
/// what LogStream says of the same rows side by side; its line is the first log's.
class PairedStream {
 public:
  /// Rows that wait: a reader who keeps to it gives no more lines of a log that is_ahead() until the other one's come.
  static constexpr std::size_t kMostWaiting = 4096;

  /// See LogStream; columns of the options that end in _a or _b are of that log alone. `b_is_pin`: the second log is a
  /// PinLog. Its samples are beside `fingers`: their `reading` is finger a's, `contact` of the pin has a psi, which
  /// without an encoder is not a number, and no step is a jump. Throws InputError: fingers that are not valid.
  PairedStream(const std::array<std::string, 2>& names, const Part& part, std::vector<Finger> fingers,
               const Noise& noise = {}, const LogOptions& options = {}, bool robust = false, bool b_is_pin = false);
  ~PairedStream();
  PairedStream(PairedStream&&) noexcept;
  PairedStream& operator=(PairedStream&&) noexcept;

  /// The next line of log 0 or 1, with what came of it: rows in order, mostly one or none. Throws InputError as
  /// LogStream does, and: logs of different kinds, of which only one has times, or one that is of two fingers already.
  std::vector<LogLine> push(std::size_t which, std::string_view line);

  /// After a dropped connection of that log: the next row continues the roll, however far it is. Throws InputError:
  /// without times nothing says which rows belong together then.
  void resume(std::size_t which);
  /// Another log begins in place of that one, and with it a roll. As long as the other log goes on, rows of both wait
  /// until two belong together. Returned is what was skipped.
  std::vector<LogLine> restart(std::size_t which);
  /// No more of both comes: what still waits is skipped.
  std::vector<LogLine> finish();

  /// So many rows wait that no more of it should be read before more comes of the other one.
  bool is_ahead(std::size_t which) const;
  bool has_waiting(std::size_t which) const;   // rows
  LogKind kind() const;                        // known after both headers
  std::size_t fingers() const;                 // 2 then, a pin included, else 0
  std::size_t lines(std::size_t which) const;  // seen
  const std::string& name(std::size_t which) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rollfix
