#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "log/log_rows.hpp"
#include "log/log_table.hpp"
#include "log/roll_rows.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "text/table.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

// From text to logs: lines to rows (RowReader), rows to rolls (LogMaker), and what is done with whole logs.
//   roll            rows between two losses of contact, each a Log of its own
//   splitting       contact that is lost and found again is refused (`read_log`), or begins another roll (`read_rolls`)
//   later roll      any but the first: lengths and increments are measured from its own first row
// Follows docs/rolling.md, "Logs".
namespace rollfix {
namespace {

/// Throws InputError: not as many values as x has, or one that is not finite.
void require_column(const std::vector<double>& column, const char* what, std::size_t rows, const std::string& name) {
  if (column.size() != rows) {
    throw InputError(fmt::format("{}: expected {} values of {}, as of x, found {}", name, rows, what, column.size()));
  }
  for (std::size_t k = 0; k < rows; ++k) {
    if (std::isfinite(column[k])) continue;
    throw InputError(fmt::format("{}: row {}: {} is {}, expected a finite number", name, k + 1, what, column[k]));
  }
}

}  // namespace

/// Checks columns of numbers as a reader checks a file's.
PinLog pin_log(std::string name, std::vector<double> x, std::vector<double> y, std::vector<double> psi,
               std::vector<double> time) {
  const std::size_t rows = x.size();
  if (rows < 2) throw InputError(fmt::format("{}: expected at least 2 rows of the pin, found {}", name, rows));
  require_column(x, "x", rows, name);
  require_column(y, "y", rows, name);
  if (!psi.empty()) require_column(psi, "psi", rows, name);
  if (!time.empty()) require_column(time, "time", rows, name);
  // Strictly growing, as of a file.
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (time[k] > time[k - 1]) continue;
    throw InputError(fmt::format("{}: row {}: time is {}, expected more than {} in the row before: time must grow",
                                 name, k + 1, time[k], time[k - 1]));
  }
  PinLog log;
  log.rows.name = std::move(name);
  log.rows.time = std::move(time);
  FingerRows& one = log.rows.fingers.front();
  // Where the part touches the wheel is not known: a Log counts its rows by u.
  one.u.assign(rows, 0);
  one.psi = std::move(psi);
  one.x = std::move(x);
  one.y = std::move(y);
  return log;
}

namespace {

/// What a reader makes of contact that is lost and found again.
enum class Splitting { refused, into_rolls };

/// Rows that a roll needs, so that there is a reading.
std::size_t least_rows(LogKind kind, bool is_later_roll) {
  return kind == LogKind::contact || is_later_roll ? 2 : 1;  // else the first contact lies before the rows
}

/// Makes logs of the rows that a reader gives.
class LogMaker {
 public:
  LogMaker(const RowReader& reader, Splitting splitting, bool single_rows, bool of_pin)
      : reader_(reader), splitting_(splitting), single_rows_(single_rows), of_pin_(of_pin) {}

  /// The next row. Invariant: `roll_` has the rows since contact was found last; `lost_line_` is not 0 from where it
  /// was lost until it is found again.
  void take(RowKind kind, const LogRow& row) {
    // A comment, a blank line, a header.
    if (kind == RowKind::none) return;
    any_row_ = true;
    if (kind == RowKind::off) {
      // Kept for `paired`: rows may be missing at either end of the other finger's log.
      any_without_contact_ = true;
      // The first row without contact behind a roll; before the first contact nothing is lost.
      if (roll_.rows() > 0 && lost_line_ == 0) lost_line_ = row.line;
      return;
    }
    // In contact again: another roll, or an error.
    if (lost_line_ != 0) find_again(row.line);
    if (roll_.rows() == 0) start_roll();
    add(row);
  }

  /// `skipped`: why rows were left out.
  std::vector<Log> finish(const std::vector<std::string>& skipped) {
    if (!reader_.knows_columns()) {
      throw InputError(fmt::format("{}: is empty, expected a log with a header such as '{}'", reader_.name(),
                                   of_pin_ ? "time,x,y" : "time,u,psi"));
    }
    // Counted before end_roll() empties it, for the message.
    const std::size_t last_rows = roll_.rows();
    end_roll();
    // No roll was long enough: the message says how many rows there were, and why others were left out.
    if (rolls_.empty()) {
      // There were rows, but in none of them did every finger touch.
      const bool none_in_contact = last_rows == 0 && any_row_;
      throw InputError(fmt::format(
          "{}: holds {} row{} of a roll{}, expected at least {}{}", reader_.name(), last_rows,
          last_rows == 1 ? "" : "s", none_in_contact ? " in contact" : "",
          least_rows(reader_.kind(), false) == 2 ? "2: the first contact and where it went from there" : "1",
          skipped.empty() ? ""
                          : fmt::format("; {} {} left out, the first: {}", skipped.size(),
                                        skipped.size() == 1 ? "row was" : "rows were", skipped.front())));
    }
    for (Log& roll : rolls_) {
      roll.skipped = skipped;
      roll.contact_was_off = any_without_contact_;
      // One roll alone keeps the log's name.
      if (rolls_.size() == 1) break;
      const std::vector<std::size_t>& line = roll.fingers[0].line;
      roll.name += fmt::format(", lines {} to {}", line.front(), line.back());
    }
    return std::move(rolls_);
  }

 private:
  /// An empty roll with what the header says of its columns.
  void start_roll() {
    roll_.name = reader_.name();
    roll_.kind = reader_.kind();
    roll_.unit = reader_.unit();
    roll_.fingers.assign(reader_.columns().size(), FingerRows{});
    for (std::size_t k = 0; k < roll_.fingers.size(); ++k) {
      roll_.fingers[k].u_dimension = reader_.columns()[k].u_dimension;
      for (const ColumnSource& source : reader_.columns()[k].source) {
        if (!source.name.empty()) roll_.fingers[k].columns.push_back(source);
      }
      roll_.fingers[k].u_wrapped = reader_.columns()[k].u_wrapped;
      roll_.fingers[k].psi_wrapped = reader_.columns()[k].psi_wrapped;
    }
    // Digits and sums begin anew with each roll.
    roundings_.assign(roll_.fingers.size(), FingerRounding{});
    odometers_.assign(roll_.fingers.size(), Odometer(reader_.kind(), is_later_roll_));
  }

  /// Appends a row in which all fingers touch: columns as they are written, lengths and turns as sums from the roll's
  /// start.
  void add(const LogRow& row) {
    if (row.time) roll_.time.push_back(*row.time);
    for (std::size_t k = 0; k < roll_.fingers.size(); ++k) {
      FingerRows& finger = roll_.fingers[k];
      const FingerCells& cells = row.fingers[k];
      roundings_[k].place.add(cells.place);
      roundings_[k].angle.add(cells.angle);
      // By all digits of the roll so far.
      finger.place_rounding = roundings_[k].place.value();
      finger.angle_rounding = roundings_[k].angle.value();
      if (roll_.kind == LogKind::contact) {
        finger.u.push_back(cells.place.value);
        // A wheel's log without an encoder has none.
        if (reader_.columns()[k].has(Column::psi)) finger.psi.push_back(cells.angle.value);
      } else {
        // Measured from the first contact, counters and increments alike.
        const Reading reading = odometers_[k].add(cells);
        finger.length.push_back(reading.length[0]);
        finger.turn.push_back(reading.turn);
      }
      if (roll_.kind == LogKind::increments) {  // that of a later roll's first contact does not count
        const bool counts = !is_later_roll_ || finger.length.size() > 1;
        finger.distance.push_back(counts ? cells.place.value : 0);
        finger.dturn.push_back(counts ? cells.angle.value : 0);
      }
      if (reader_.columns()[k].has(Column::x)) {
        finger.x.push_back(cells.x);
        finger.y.push_back(cells.y);
      }
      finger.line.push_back(row.line);
    }
  }

  /// Keeps the roll, unless it is too short to be one.
  void end_roll() {
    // A finger that touched for one row and went away: a touch, where these are asked for.
    const bool is_touch = single_rows_ && reader_.kind() == LogKind::contact && roll_.rows() == 1;
    if (is_touch || roll_.rows() >= least_rows(reader_.kind(), is_later_roll_)) rolls_.push_back(std::move(roll_));
    roll_ = Log{};
  }

  /// Contact is back, in this line: another roll, or an error. Throws InputError.
  void find_again(std::size_t line) {
    if (splitting_ == Splitting::refused) {
      throw InputError(
          fmt::format("{}: contact is lost here and found again in line {}, expected one unbroken roll; "
                      "split the log there, or choose one of its rolls with `roll`",
                      where(reader_.name(), lost_line_), line));
    }
    end_roll();
    is_later_roll_ = true;
    lost_line_ = 0;
  }

  const RowReader& reader_;
  Splitting splitting_;
  bool single_rows_;  // contact for a single row is a roll
  bool of_pin_;       // of a wheel
  Log roll_;          // that goes on
  std::vector<Odometer> odometers_;
  std::vector<FingerRounding> roundings_;  // of each finger's columns
  std::vector<Log> rolls_;
  std::size_t lost_line_ = 0;         // where contact was lost behind the roll that goes on; 0: it was not
  bool is_later_roll_ = false;        // that roll is not the first
  bool any_row_ = false;              // there was a row at all
  bool any_without_contact_ = false;  // and one in which not every finger touched
};

/// Whether a row holds the units of a header above it, and nothing else.
bool holds_units(const std::vector<std::string_view>& cells) {
  const auto is_unit = [](std::string_view cell) { return unit_named(cell).has_value(); };
  const auto is_none = [](std::string_view cell) { return cell.empty() || cell == "-" || cell == "1"; };
  return std::any_of(cells.begin(), cells.end(), is_unit) &&
         std::all_of(cells.begin(), cells.end(), [&](std::string_view cell) { return is_none(cell) || is_unit(cell); });
}

// So many rows after one that can't be read are looked at for one that can.
constexpr int kRowsAhead = 1000;

/// Whether a row can be read further on: else leaving rows out leaves nothing.
/// Reads on, which is no loss: an error follows either way.
bool any_row_can_be_read(RowReader& reader, TextLines& lines) {
  LogRow row;
  std::string_view line;
  for (int k = 0; k < kRowsAhead && lines.next(line); ++k) {
    try {
      if (reader.read(line, row) != RowKind::none) return true;
    } catch (const InputError&) {  // nor this one
    }
  }
  return false;
}

/// Reads rows one after the other, and leaves out what can't be read where that was asked for.
class RowsInLines {
 public:
  RowsInLines(TextLines& lines, const LogOptions& options, bool of_pin)
      : lines_(lines), skips_(options.skip_bad), reader_(lines.name(), options, of_pin) {}

  const RowReader& reader() const { return reader_; }
  const std::vector<std::string>& skipped() const { return skipped_; }

  /// False after the last row.
  bool next(RowKind& kind, LogRow& row) {
    std::string_view line;
    while (lines_.next(line)) {
      // A row that can't be read leaves the reader as it was: the next one is read as if it had not been there.
      try {
        kind = reader_.read(line, row);
      } catch (const InputError& error) {
        leave_out(error);
        continue;
      }
      if (kind == RowKind::none) continue;
      any_ = true;
      reader_.accept(row);
      return true;
    }
    return false;
  }

 private:
  /// What becomes of a row that can't be read: it is left out where that was asked for, else the error gets a cure.
  /// Called while the error is handled: `throw` passes it on.
  void leave_out(const InputError& error) {
    if (!reader_.knows_columns()) throw;  // of the header
    // A second header line with units under the names is a usual mistake: it gets its own cure.
    if (!any_ && skipped_.empty() && holds_units(reader_.row().cells)) {
      throw InputError(
          fmt::format("{}:{}: '{}' are units, expected them behind the names of the columns, as in 'u [deg]', "
                      "or said by `columns`, as in u=u:deg",
                      lines_.name(), reader_.lines(), shown(reader_.row().text)));
    }
    if (skips_) {
      skipped_.emplace_back(error.what());
      // Advised only where it leaves something.
    } else if (any_ || any_row_can_be_read(reader_, lines_)) {
      throw InputError(fmt::format("{}; `skip_bad` leaves such rows out", error.what()));
    } else {
      throw;
    }
  }

  TextLines& lines_;
  bool skips_;  // rows that can't be read are left out
  RowReader reader_;
  bool any_ = false;                  // a row was read
  std::vector<std::string> skipped_;  // why
};

/// All rolls of a log, read to its end. A note of the header goes with each of them.
std::vector<Log> rolls_in(TextLines& lines, Splitting splitting, const LogOptions& options, bool of_pin = false) {
  RowsInLines rows(lines, options, of_pin);
  LogMaker maker(rows.reader(), splitting, options.single_rows, of_pin);
  RowKind kind = RowKind::none;
  LogRow row;
  while (rows.next(kind, row)) maker.take(kind, row);
  std::vector<Log> rolls = maker.finish(rows.skipped());
  const std::string& note = rows.reader().columns().front().note;
  for (Log& roll : rolls) {
    if (!note.empty()) roll.notes = {fmt::format("{}: {}", lines.name(), note)};
  }
  return rolls;
}

/// The rolls in a text; `name` is for messages.
std::vector<Log> rolls_of_text(std::string_view text, const std::string& name, Splitting splitting,
                               const LogOptions& options) {
  TextLines lines(text, name);
  return rolls_in(lines, splitting, options);
}

/// Likewise of a file; "-" is standard input, of which the beginning may have been looked at before.
std::vector<Log> rolls_of_file(const std::string& path, Splitting splitting, const LogOptions& options) {
  const OpenFile file = open_text(path);
  const bool is_input = path == "-";
  TextLines lines(file.get(), is_input ? "standard input" : path, is_input ? take_looked_at() : "");
  return rolls_in(lines, splitting, options);
}

}  // namespace

PinLog parse_pin_log(std::string_view text, const std::string& name, const LogOptions& options) {
  TextLines lines(text, name);
  return {std::move(rolls_in(lines, Splitting::refused, options, true).front())};
}

PinLog read_pin_log(const std::string& path, const LogOptions& options) {
  const OpenFile file = open_text(path);
  const bool is_input = path == "-";
  TextLines lines(file.get(), is_input ? "standard input" : path, is_input ? take_looked_at() : "");
  return {std::move(rolls_in(lines, Splitting::refused, options, true).front())};
}

/// Columns whose names end in this finger's suffix lose it, those of the other finger go, all others hold for both.
LogOptions options_for_finger(const LogOptions& options, std::size_t finger) {
  LogOptions result = options;
  result.columns.clear();
  for (ColumnSource source : options.columns) {
    const std::string end = source.column.size() > 2 ? source.column.substr(source.column.size() - 2) : "";
    // Of the other file.
    if (end == kFingerSuffixes[1 - finger]) continue;
    if (end == kFingerSuffixes[finger]) source.column.resize(source.column.size() - 2);
    result.columns.push_back(source);
  }
  return result;
}

Log parse_log(std::string_view text, const std::string& name, const LogOptions& options) {
  return std::move(rolls_of_text(text, name, Splitting::refused, options).front());
}

Log read_log(const std::string& path, const LogOptions& options) {
  return std::move(rolls_of_file(path, Splitting::refused, options).front());
}

Log read_log(const std::string& path_a, const std::string& path_b, const LogOptions& options) {
  if (path_a == "-" && path_b == "-") {
    throw InputError("the logs of both fingers can't come from standard input: give one of them as a file");
  }
  // Each file is a log of one finger.
  Log a = read_log(path_a, options_for_finger(options, 0));  // first, so that its errors come first
  return paired(std::move(a), read_log(path_b, options_for_finger(options, 1)));
}

std::vector<Log> parse_rolls(std::string_view text, const std::string& name, const LogOptions& options) {
  return rolls_of_text(text, name, Splitting::into_rolls, options);
}

std::vector<Log> read_rolls(const std::string& path, const LogOptions& options) {
  return rolls_of_file(path, Splitting::into_rolls, options);
}

/// All columns of lengths are converted: u where it is one, and roundings in that unit.
Log in_unit(Log log, const std::string& unit, const std::vector<Finger>& fingers) {
  // Nothing to convert, or one unit is not known.
  if (log.unit.empty() || unit.empty() || log.unit == unit) return log;
  const Conversion convert = length_conversion(log.unit, unit, log.name);
  for (std::size_t k = 0; k < log.fingers.size(); ++k) {
    FingerRows& rows = log.fingers[k];
    const Finger* const finger = finger_of(fingers, k);
    // u of a disk is an angle, of any other finger a length. Without a finger the header may say it.
    const bool is_length = finger != nullptr ? !finger->is_disk() : rows.u_dimension == Dimension::length;
    std::vector<std::vector<double>*> lengths{&rows.length, &rows.distance, &rows.x, &rows.y};
    if (is_length) lengths.push_back(&rows.u);
    for (std::vector<double>* const column : lengths) {
      for (double& value : *column) value = convert(value);
    }
    if (is_length) rows.u_period = convert(rows.u_period);
    // The rounding is in the unit of the column that it is of.
    if (is_length || log.kind != LogKind::contact) rows.place_rounding = convert(rows.place_rounding);
  }
  log.unit = unit;
  return log;
}

Log one_finger(const Log& log, std::size_t finger) {
  const FingerRows& rows = log.fingers[finger];
  return {rows.name.empty() ? log.name : rows.name, log.kind, log.time, {rows}, log.contact_was_off, log.unit};
}

// ---- row by row
// A log that grows: a RowReader makes rows of lines or of numbers, RollRows judges and measures them. What a file
// refuses is an answer of kind `malformed` here, so that a stream goes on. Follows docs/rolling.md, "A log that grows".
// Only what leaves every row unreadable ends a stream: no text, a header that can't be taken, fingers that don't go
// with it.

struct LogStream::State {
  State(std::string name, const Part& part, std::vector<Finger> fingers, const Noise& noise, LogOptions options,
        bool robust)
      : rolls(part, std::move(fingers), noise, robust, options.any_part, name),
        reader(std::move(name), in_unit_of(part, std::move(options))) {}

  /// What the reader makes of a row, judged and measured.
  template <class Read>
  LogLine push(const Read& read);

  RollRows rolls;             // judges rows and measures them
  RowReader reader;           // makes rows of what is pushed
  std::size_t malformed = 0;  // rows that were left out

 private:
  /// Tells the rolls what the columns are, whenever a header may have come.
  void start();
  /// Counts a row that is left out, and says why.
  LogLine skip(const InputError& error);

  LogRow row_;  // the one that is pushed
};

void LogStream::State::start() {
  rolls.start(reader.columns(), std::vector<std::string>(reader.columns().size(), reader.name()));
}

template <class Read>
LogLine LogStream::State::push(const Read& read) {
  RowKind found = RowKind::none;
  try {
    found = read(reader, row_);
  } catch (const InputError& error) {
    // The header, or the first row that says what the columns are: without it no row can be read.
    if (!reader.knows_columns()) throw;
    return skip(error);
  }
  // A header gives no row. It can also have come again, with columns in another order.
  const bool may_be_header = found == RowKind::none || !rolls.has_started();
  if (may_be_header && reader.knows_columns()) start();
  if (found == RowKind::none) return {};
  // Contact is lost, or was not there yet: the row's time counts, its cells do not.
  if (found == RowKind::off) {
    reader.accept(row_);
    return rolls.off();
  }
  // Both fingers' cells stand in one line.
  const auto lines = PerFinger<std::size_t>::of(reader.columns().size(), row_.line);
  // A row off the finger's end is left out before accept(): it must not count as the row before the next one.
  try {
    rolls.require_on_finger(row_, lines);
  } catch (const InputError& error) {
    return skip(error);
  }
  reader.accept(row_);
  return rolls.take(row_, lines);
}

LogLine LogStream::State::skip(const InputError& error) {
  ++malformed;
  LogLine result;
  result.kind = LineKind::malformed;
  result.message = error.what();
  result.goes_back = dynamic_cast<const NotLater*>(&error) != nullptr;
  return result;
}

LogStream::LogStream(std::string name, const Part& part, std::vector<Finger> fingers, const Noise& noise,
                     LogOptions options, bool robust)
    : state_(std::make_unique<State>(std::move(name), part, std::move(fingers), noise, std::move(options), robust)) {}
LogStream::~LogStream() = default;
LogStream::LogStream(LogStream&&) noexcept = default;
LogStream& LogStream::operator=(LogStream&&) noexcept = default;

LogLine LogStream::push(std::string_view line) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(line, row); });
}

LogLine LogStream::push(std::optional<double> time, double u, double psi, std::optional<double> x,
                        std::optional<double> y) {
  // One finger is the same as a list of one.
  return push(time, Touch{u, psi, x, y});
}

LogLine LogStream::push(std::optional<double> time, const PerFinger<Touch>& fingers) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(time, fingers, row); });
}

LogLine LogStream::push_off(std::optional<double> time) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(time, std::nullopt, row); });
}

void LogStream::resume() {
  state_->reader.resume();
  // The next row may be far from the last one, and a header may come again.
  state_->rolls.skip();
}

LogKind LogStream::kind() const { return state_->reader.knows_columns() ? state_->reader.kind() : LogKind::contact; }

std::size_t LogStream::fingers() const { return state_->reader.columns().size(); }

std::size_t LogStream::lines() const { return state_->reader.lines(); }

std::size_t LogStream::malformed() const { return state_->malformed; }

}  // namespace rollfix
