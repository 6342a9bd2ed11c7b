#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "log/log_rows.hpp"
#include "log/roll_rows.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "text/text.hpp"

// Two logs, of a finger each, as one of both: whole ones, and row by row.
// Which rows belong together, of two logs a and b whose next rows have the times t_a and t_b:
//   t_a = t_b        both, but for kSameInstant of the time since the logs began: clocks round
//   t_a < t_b        a's row has no partner, as times of a log grow: it is skipped
// Without times rows are counted, those that can't be read among them. Of whole logs rows without a partner are skipped
// at both ends only, elsewhere they are refused. Follows docs/rolling.md, "Logs of two fingers".
namespace rollfix {
namespace {

/// The columns of this kind of log, for messages.
std::string columns_in(const Log& log) {
  switch (log.kind) {
    case LogKind::contact:
      return "u and psi";
    case LogKind::travelled:
      return "length and turn";
    case LogKind::increments:
      break;
  }
  return "distance and dturn";
}

/// Seconds from the first row to the last. REQUIRES times.
double duration_of(const Log& log) { return log.time.back() - log.time.front(); }

/// Throws InputError: a log of two fingers is paired already.
void require_one_finger(const Log& log) {
  if (log.fingers.size() == 1) return;
  throw InputError(fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", log.name));
}

/// Throws InputError: other columns, or only one log has times.
void require_same_kind(const Log& a, const Log& b) {
  if (a.kind != b.kind) {
    throw InputError(fmt::format("{} has {}, {} has {}: expected the same columns of both fingers", a.name,
                                 columns_in(a), b.name, columns_in(b)));
  }
  if (a.time.empty() != b.time.empty()) {
    throw InputError(fmt::format("{} has a column 'time' and {} has none: expected the same instants in both",
                                 a.time.empty() ? b.name : a.name, a.time.empty() ? a.name : b.name));
  }
}

/// Keeps the rows [from, to) of a column; an empty column stays empty.
template <class Column>
void keep(Column& column, std::size_t from, std::size_t to) {
  if (column.empty()) return;
  // The end first, so that `from` and `to` stay what they are.
  column.erase(column.begin() + static_cast<std::ptrdiff_t>(to), column.end());
  column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(from));
}

/// The rows of a log of u and psi that lie between these times.
void keep_between(Log& log, double first, double last) {
  const auto from =
      static_cast<std::size_t>(std::lower_bound(log.time.begin(), log.time.end(), first) - log.time.begin());
  const auto to = static_cast<std::size_t>(std::upper_bound(log.time.begin(), log.time.end(), last) - log.time.begin());
  // A first contact and one reading, at least.
  if (to < from + 2) {
    throw InputError(
        fmt::format("{}: holds {} of a roll in which the other finger touches the part as well, expected "
                    "at least 2: the first contacts and where they went from there",
                    log.name, to <= from ? "no row" : "1 row"));
  }
  FingerRows& rows = log.fingers[0];
  keep(log.time, from, to);
  for (const auto column : kRowColumns) keep(rows.*column, from, to);
  keep(rows.line, from, to);
}

/// Cuts both logs to the times in which both fingers touch: one may have found the part earlier or lost it later. Only
/// logs of u and psi are cut. Throws InputError: without times nothing says which rows belong together.
void keep_common_contact(Log& a, Log& b) {
  const bool is_about_contact = a.contact_was_off || b.contact_was_off;
  // Nothing was left out, or nothing can be cut, or both have the same lines.
  if (!is_about_contact || a.kind != LogKind::contact || a.fingers[0].line == b.fingers[0].line) return;
  if (a.time.empty()) {
    throw InputError(
        fmt::format("{} and {}: rows without contact were left out and there is no column 'time', so that it is not "
                    "known which rows belong together; add the times",
                    a.name, b.name));
  }
  // Clocks round: rows at the ends may differ by that.
  const double slack = kSameInstant * std::max(duration_of(a), duration_of(b));
  const double first = std::max(a.time.front(), b.time.front()) - slack;
  const double last = std::min(a.time.back(), b.time.back()) + slack;
  keep_between(a, first, last);
  keep_between(b, first, last);
}

/// Throws InputError: row k of both logs is not the same instant, but for rounding.
void require_same_times(const Log& a, const Log& b) {
  const double slack = a.time.empty() ? 0 : kSameInstant * std::max(duration_of(a), duration_of(b));
  // As far as both go; other numbers of rows are refused next.
  const std::size_t both = std::min(a.time.size(), b.time.size());
  for (std::size_t k = 0; k < both; ++k) {
    if (std::abs(a.time[k] - b.time[k]) <= slack) continue;
    throw InputError(
        fmt::format("{} is at the time {} and {} at {}: expected the same times in both logs, row by row; "
                    "resample one of them",
                    where(a, 0, k), a.time[k], where(b, 0, k), b.time[k]));
  }
}

/// Throws InputError: one log has more rows; the message names the first without a partner.
void require_same_rows(const Log& a, const Log& b) {
  if (a.rows() == b.rows()) return;
  const Log& longer = a.rows() > b.rows() ? a : b;
  const Log& shorter = a.rows() > b.rows() ? b : a;
  throw InputError(
      fmt::format("{} has {} rows and {} has {}: expected the same instants in both, but {} has no partner", a.name,
                  a.rows(), b.name, b.rows(), where(longer, 0, shorter.rows())));
}

}  // namespace

Log paired(Log a, Log b) {
  // In this order: what both are, their common rows, then row by row.
  require_one_finger(a);
  require_one_finger(b);
  require_same_kind(a, b);
  keep_common_contact(a, b);
  require_same_times(a, b);
  require_same_rows(a, b);
  // Each finger keeps its own file's name, for messages with lines.
  a.fingers[0].name = a.name;
  b.fingers[0].name = b.name;
  a.fingers.push_back(std::move(b.fingers[0]));
  a.contact_was_off = a.contact_was_off || b.contact_was_off;
  a.skipped.insert(a.skipped.end(), b.skipped.begin(), b.skipped.end());
  a.notes.clear();  // each was of one finger
  return a;
}

namespace {

/// A row that waits for its partner; RowKind::none: it could not be read.
struct WaitingRow {
  RowKind kind = RowKind::none;
  LogRow row;
};

/// One of the logs.
struct OneLog {
  OneLog(const std::string& name, LogOptions of_log, bool is_pin)
      : options(std::move(of_log)), of_pin(is_pin), reader(name, options, of_pin) {}

  bool knows_columns() const { return reader.knows_columns(); }
  /// REQUIRES known columns.
  bool has_time() const { return reader.columns().front().has(Column::time); }
  /// Another log comes in its place: its header is read anew, and no row waits.
  void begin_anew() {
    reader = RowReader(reader.name(), options, of_pin);
    rows.clear();
    began.reset();
  }

  LogOptions options;
  bool of_pin;  // of a wheel without skin
  RowReader reader;
  std::deque<WaitingRow> rows;
  std::optional<double> began{};  // time of its first row
};

/// A row that is left out, and why.
LogLine malformed(const std::string& why) {
  LogLine line;
  line.kind = LineKind::malformed;
  line.message = why;
  return line;
}

}  // namespace

/// Two logs, rows of each that wait, and the rolls of both together. Invariant after match(): at most one of the logs
/// has rows that could still find a partner, unless `holds` or a header is missing.
struct PairedStream::State {
  State(const std::array<std::string, 2>& names, const Part& part, std::vector<Finger> fingers, const Noise& noise,
        const LogOptions& options, bool robust, bool b_is_pin)
      : sides{OneLog{names[0], in_unit_of(part, options_for_finger(options, 0)), false},
              OneLog{names[1], in_unit_of(part, options_for_finger(options, 1)), b_is_pin}},
        rolls(part, std::move(fingers), noise, robust, options.any_part, names[0]) {}

  /// The next line of one log; what comes of it is added to what take() gives.
  void push(std::size_t which, std::string_view line);
  /// The first row that waits has no partner: it is left out, with a message, unless it could not be read and was told
  /// of before.
  void drop_front(std::size_t which);
  /// Pairs and skips rows until one of the logs has none left, or both wait.
  void match();
  std::vector<LogLine> take() { return std::exchange(found_, {}); }

  std::array<OneLog, 2> sides;
  RollRows rolls;
  bool holds = false;  // one log began anew: the other one's rows may be of the time before

 private:
  void start();
  /// match_fronts: without times. match_by_time: with times. take_fronts: both first rows become one row of two
  /// fingers. slack: how far times of one instant may differ, seconds.
  void match_fronts();
  void match_by_time();
  void take_fronts();
  double slack() const;

  std::vector<LogLine> found_;  // since the last take(), in order
};

/// Both logs' columns are known.
void PairedStream::State::start() {
  const Columns& a = sides[0].reader.columns().front();
  const Columns& b = sides[1].reader.columns().front();
  for (const OneLog& side : sides) {
    // Each log has to be of one finger.
    if (side.reader.columns().size() == 1) continue;
    throw InputError(
        fmt::format("{}: this log is of two fingers, expected one with columns 'u' and 'psi'", side.reader.name()));
  }
  // A wheel only measures where its pin was: seen from a finger whose own place in the world is not known that says
  // nothing.
  if (b.of_pin && (a.kind != LogKind::contact || !a.has(Column::x))) {
    throw InputError(fmt::format(
        "{}: expected columns 'u', 'psi', 'x' and 'y' beside a wheel: it says something by where its pin was as seen "
        "from the finger; without them any place on the part fits",
        sides[0].reader.name()));
  }
  if (a.kind != b.kind) {
    throw InputError(fmt::format("{} and {}: expected the same columns of both fingers, found logs of different kinds",
                                 sides[0].reader.name(), sides[1].reader.name()));
  }
  if (sides[0].has_time() != sides[1].has_time()) {
    const std::size_t with = sides[0].has_time() ? 0 : 1;
    throw InputError(fmt::format("{} has a column 'time' and {} has none: expected the same instants in both",
                                 sides[with].reader.name(), sides[1 - with].reader.name()));
  }
  rolls.start({a, b}, {sides[0].reader.name(), sides[1].reader.name()});
}

void PairedStream::State::push(std::size_t which, std::string_view line) {
  OneLog& side = sides[which];
  WaitingRow next;
  try {
    next.kind = side.reader.read(line, next.row);
  } catch (const InputError& error) {
    if (!side.knows_columns()) throw;
    // A row that can't be read ends nothing: it is told of.
    LogLine& skipped = found_.emplace_back(malformed(error.what()));
    // Whoever reads may take it for a log that begins anew.
    skipped.goes_back = dynamic_cast<const NotLater*>(&error) != nullptr;
    // Without times rows are counted: one that can't be read keeps its number, and takes its partner with it.
    if (!side.has_time()) side.rows.push_back({});
    return match();
  }
  // A header, or the first row: as soon as both logs' columns are known they are compared.
  const bool may_be_header = next.kind == RowKind::none || !rolls.has_started();
  if (may_be_header && sides[0].knows_columns() && sides[1].knows_columns()) start();
  // A comment or a header; rows that waited for it may go on.
  if (next.kind == RowKind::none) return match();
  side.reader.accept(next.row);
  // Rounding of times grows with the time since the first row.
  if (!side.began) side.began = next.row.time;
  side.rows.push_back(next);
  match();
}

void PairedStream::State::drop_front(std::size_t which) {
  OneLog& side = sides[which];
  const WaitingRow gone = side.rows.front();
  side.rows.pop_front();
  if (gone.kind == RowKind::none) return;  // it was told
  const std::string at = gone.row.time ? fmt::format(" at the time {}", *gone.row.time) : "";
  found_.push_back(
      malformed(fmt::format("{}: {} has no row{} to go with it: it is left out",
                            where(side.reader.name(), gone.row.line), sides[1 - which].reader.name(), at)));
}

void PairedStream::State::match() {
  // Rows wait until both headers are there.
  if (!rolls.has_started()) return;
  const auto is_full = [](const OneLog& side) { return side.rows.size() >= kMostWaiting; };
  // Whoever waits for the other log to begin anew can't wait for ever.
  if (is_full(sides[0]) && is_full(sides[1])) holds = false;
  // Each turn takes at least one row away, or both logs wait.
  while (!sides[0].rows.empty() && !sides[1].rows.empty()) {
    const std::size_t before = sides[0].rows.size() + sides[1].rows.size();
    sides[0].has_time() ? match_by_time() : match_fronts();
    if (sides[0].rows.size() + sides[1].rows.size() == before) return;  // they wait
  }
}

/// Without times: the first rows of both belong together. If one of them could not be read neither counts.
void PairedStream::State::match_fronts() {
  // RowKind::none: could not be read, and keeps its number.
  const bool both = sides[0].rows.front().kind != RowKind::none && sides[1].rows.front().kind != RowKind::none;
  if (both) return take_fronts();
  for (const std::size_t which : {0U, 1U}) drop_front(which);
}

/// How far times of one instant may differ, seconds: kSameInstant of the longer time since a log began.
double PairedStream::State::slack() const {
  double elapsed = 0;
  for (const OneLog& side : sides) elapsed = std::max(elapsed, *side.rows.front().row.time - *side.began);
  return kSameInstant * elapsed;
}

/// Times grow: the earlier one of both first rows can't find a partner any more. While a log begins anew both wait
/// instead, because the other one's rows may be of the time before.
void PairedStream::State::match_by_time() {
  const double apart = *sides[0].rows.front().row.time - *sides[1].rows.front().row.time;
  if (std::abs(apart) <= slack()) return take_fronts();
  if (!holds) drop_front(apart < 0 ? 0 : 1);
}

/// Both first rows as one of two fingers: contact is lost if either has none. Line and time are the first log's.
void PairedStream::State::take_fronts() {
  holds = false;
  const WaitingRow a = sides[0].rows.front();
  const WaitingRow b = sides[1].rows.front();
  for (OneLog& side : sides) side.rows.pop_front();
  // One finger without contact ends the roll of both.
  if (a.kind == RowKind::off || b.kind == RowKind::off) {
    found_.push_back(rolls.off());
    return;
  }
  LogRow both = a.row;
  both.fingers = PerFinger<FingerCells>(a.row.fingers[0], b.row.fingers[0]);
  const PerFinger<std::size_t> lines(a.row.line, b.row.line);
  try {
    rolls.require_on_finger(both, lines);
  } catch (const InputError& error) {
    found_.push_back(malformed(error.what()));
    return;
  }
  found_.push_back(rolls.take(both, lines));
}

PairedStream::PairedStream(const std::array<std::string, 2>& names, const Part& part, std::vector<Finger> fingers,
                           const Noise& noise, const LogOptions& options, bool robust, bool b_is_pin)
    : state_(std::make_unique<State>(names, part, std::move(fingers), noise, options, robust, b_is_pin)) {}
PairedStream::~PairedStream() = default;
PairedStream::PairedStream(PairedStream&&) noexcept = default;
PairedStream& PairedStream::operator=(PairedStream&&) noexcept = default;

std::vector<LogLine> PairedStream::push(std::size_t which, std::string_view line) {
  state_->push(which, line);
  return state_->take();
}

void PairedStream::resume(std::size_t which) {
  OneLog& side = state_->sides[which];
  // Rows may be missing: their numbers don't tell any more which belong together.
  if (side.knows_columns() && !side.has_time()) {
    throw InputError(
        fmt::format("{}: the connection dropped, and there is no column 'time', so that it is not known which rows of "
                    "{} belong to those that come now; add the times",
                    name(which), name(1 - which)));
  }
  side.reader.resume();
  // Rows that were lost meanwhile make the next one look far.
  state_->rolls.skip();
}

std::vector<LogLine> PairedStream::restart(std::size_t which) {
  OneLog& side = state_->sides[which];
  // Rows of the old log find no partner any more; those of the other log wait for the new one.
  while (!side.rows.empty()) state_->drop_front(which);
  side.begin_anew();
  state_->rolls.restart();
  // Until the first pair of the new log, or until both have too many rows waiting.
  state_->holds = true;
  return state_->take();
}

std::vector<LogLine> PairedStream::finish() {
  for (const std::size_t which : {0U, 1U}) {
    // No partner comes any more.
    while (!state_->sides[which].rows.empty()) state_->drop_front(which);
  }
  return state_->take();
}

bool PairedStream::is_ahead(std::size_t which) const { return state_->sides[which].rows.size() >= kMostWaiting; }

bool PairedStream::has_waiting(std::size_t which) const { return !state_->sides[which].rows.empty(); }

LogKind PairedStream::kind() const { return state_->rolls.has_started() ? state_->rolls.kind() : LogKind::contact; }

std::size_t PairedStream::fingers() const { return state_->rolls.fingers(); }

std::size_t PairedStream::lines(std::size_t which) const { return state_->sides[which].reader.lines(); }

const std::string& PairedStream::name(std::size_t which) const { return state_->sides[which].reader.name(); }

}  // namespace rollfix
