#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "log/header/log_header.hpp"
#include "log/log_rows.hpp"
#include "log/roll_check.hpp"
#include "log/wrapping.hpp"
#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"

// From the rows of a log to readings.
// Notation:
//   u, psi          of a row of contacts, unwrapped; row 0 is the first contact
//   (L, theta)      a reading from the first contact on, by a finger's shape: `reading_between`; of two (La, Lb, theta)
//   instant         a time that is asked for; its row is the nearest one, no further than half the way to its
//                   neighbours
//   rounding        what half a unit of the last digits of places and angles leaves open of a reading: Rounding
// Follows docs/rolling.md, "The roll itself" and "Logs", and eqs. (1) to (3) of the paper (Jia, IROS 2001).
namespace rollfix {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

void require_clear(const Log& log, std::size_t which, const Finger& finger) {
  const FingerRows& rows = log.fingers[which];
  // Names the row and both values; the cure is to say whether the column is wrapped.
  const auto require = [&](Column column, const std::vector<double>& angles, const std::optional<std::size_t>& row) {
    if (!row) return;
    throw InputError(fmt::format(
        "{}: {}{} goes from {:.6g} to {:.6g} in one row, which is more than half way round: whether it is "
        "wrapped there can't be told, because the rows are far apart; say it with `wrapped` no, or `wrapped` yes",
        where(log, which, *row), name_of(column), log.fingers.size() == 1 ? "" : kFingerSuffixes[which],
        angles[*row - 1], angles[*row]));
  };
  require(Column::u, rows.u, unclear_step(rows.u, rows.place_rounding, finger.period(), rows.u_wrapped));
  require(Column::psi, rows.psi, unclear_step(rows.psi, rows.angle_rounding, kTurn, rows.psi_wrapped));
}

namespace {

/// One finger's rows as readings from its own first contact.
class FingerCourse {
 public:
  FingerCourse(const Log& log, const std::vector<Finger>& fingers, std::size_t which, const Noise& noise)
      : kind_(log.kind),
        rows_(log.fingers[which]),
        finger_(finger_of(fingers, which)),
        within_(reach_of_corners(rows_.place_rounding, noise)) {
    // Lengths and turns need no finger and are never wrapped.
    if (kind_ != LogKind::contact) return;
    // u of a disk has the period 2 pi, on a closed outline its length, on an open one none.
    u_ = unwrapped_as_said(rows_.u, rows_.place_rounding, finger_->period(), rows_.u_wrapped);
    psi_ = unwrapped_as_said(rows_.psi, rows_.angle_rounding, kTurn, rows_.psi_wrapped);
  }

  /// Lengths along the outline as the user gave it.
  Reading at(std::size_t row) const {
    if (kind_ != LogKind::contact) return {rows_.length[row], rows_.turn[row]};
    return reading_between(*finger_, {u_.front(), psi_.front()}, {u_[row], psi_[row]}, within_);
  }

 private:
  LogKind kind_;
  const FingerRows& rows_;
  const Finger* finger_;     // none where it is not known
  double within_;            // so near to a corner of the finger a contact may be on it, length
  std::vector<double> u_;    // unwrapped
  std::vector<double> psi_;  // unwrapped
};

/// Every finger's, which are readings together. Throws InputError: u and psi without a finger.
class Courses {
 public:
  Courses(const Log& log, const std::vector<Finger>& fingers, const Noise& noise) {
    require_fingers(fingers, log.fingers.size(), log.kind == LogKind::contact, log.name);
    // Before anything is measured: units and wraps have to be clear.
    for (std::size_t k = 0; k < log.fingers.size(); ++k) {
      require_unit_of_u(log.fingers[k].u_dimension, finger_of(fingers, k), log.name);
      if (log.kind == LogKind::contact) require_clear(log, k, *finger_of(fingers, k));
      courses_.emplace_back(log, fingers, k, noise);
    }
  }

  /// Each finger's own reading of a row: theta is what this finger saw the tangent turn.
  PerFinger<Reading> each(std::size_t row) const {
    if (courses_.size() == 1) return courses_[0].at(row);
    return {courses_[0].at(row), courses_[1].at(row)};
  }
  /// The row as one reading: of two fingers theta is the difference of both turns, eqs. (7) to (9).
  Reading at(std::size_t row) const { return together(each(row)); }

 private:
  std::vector<FingerCourse> courses_;
};

constexpr double kTurnInDegrees = 360;

/// Whether a column of angles in radians looks like one of degrees: no further from 0 than one turn in degrees, and it
/// wraps by such a turn, at this row.
bool looks_like_degrees(const std::vector<double>& angles, std::size_t row) {
  constexpr double kNearlyOne = 300;  // the last step before the wrap may be a long one
  const auto [least, most] = std::minmax_element(angles.begin(), angles.end());
  return *least >= -kTurnInDegrees && *most <= kTurnInDegrees && std::abs(angles[row] - angles[row - 1]) >= kNearlyOne;
}

/// Whether a column of angles in radians goes on by more than a radian and no more than a turn in degrees, at this row
/// and, most of all, from row to row.
bool goes_in_degrees(const std::vector<double>& angles, std::size_t row) {
  constexpr double kLeastStep = 1;
  // A step of degrees read as radians is 57 times too long.
  const auto is_long = [&](std::size_t k) {
    const double step = std::abs(angles[k] - angles[k - 1]);
    return step >= kLeastStep && step <= kTurnInDegrees;
  };
  std::size_t count = 0;
  for (std::size_t k = 1; k < angles.size(); ++k) count += is_long(k) ? 1 : 0;
  return is_long(row) && 2 * count > angles.size();
}

/// What `columns` has to say so that these are in degrees, with the names that the log's header has for them, and with
/// all other columns that have names of their own, so that it can be pasted as it is.
std::string columns_in_degrees(const FingerRows& rows, const std::vector<std::string>& in_degrees) {
  std::vector<ColumnSource> columns;
  for (const std::string& column : in_degrees) {
    const auto is_it = [&](const ColumnSource& source) { return source.column == column; };
    const auto named = std::find_if(rows.columns.begin(), rows.columns.end(), is_it);
    columns.push_back({column, named == rows.columns.end() ? column : named->name, "deg"});
  }
  for (const ColumnSource& source : rows.columns) {
    const bool is_there = std::find(in_degrees.begin(), in_degrees.end(), source.column) != in_degrees.end();
    const bool is_found_anyway = source.name == source.column && source.unit.empty();
    if (!is_there && !is_found_anyway) columns.push_back(source);
  }
  return written(columns);
}

/// What to do about a jump: a log in degrees that is read as radians has one wherever its degrees wrap.
std::string cure_of_jump(const Log& log, const Part& part, const std::vector<Finger>& fingers, const Noise& noise,
                         std::size_t finger, std::size_t row) {
  const FingerRows& rows = log.fingers[finger];
  const Finger* const shape = finger_of(fingers, finger);
  const std::string suffix = log.fingers.size() == 1 ? "" : kFingerSuffixes[finger];
  const bool has_angle_u = shape != nullptr && shape->is_disk();
  // If the roll goes on behind the jump, leaving the rows out is a cure as well.
  const bool comes_back = without_strays(log, part, fingers, noise).rows() < log.rows();
  std::string split =
      fmt::format("split the log there{}", comes_back ? ", or let stray rows pass with `robust` (and `noise`)" : "");
  if (log.kind != LogKind::contact) {
    // A jump between half a turn and 360: a turn in degrees, read as radians.
    const double step = std::abs(rows.turn[row] - rows.turn[row - 1]);
    if (step < std::numbers::pi || step > kTurnInDegrees) return split;
    const char* const column = log.kind == LogKind::increments ? "dturn" : "turn";
    return fmt::format("{}; if the turns are in degrees, that is written `columns` {}", split,
                       columns_in_degrees(rows, {column + suffix}));
  }
  // Degrees that wrap at 360 look like a jump of 360 radians.
  if (looks_like_degrees(rows.psi, row) || (has_angle_u && looks_like_degrees(rows.u, row))) {
    std::vector<std::string> angles{"psi" + suffix};
    if (has_angle_u) angles.insert(angles.begin(), "u" + suffix);
    return fmt::format("{}; if the angles are in degrees, that is written `columns` {}", split,
                       columns_in_degrees(rows, angles));
  }
  // One of them alone, that is not wrapped: its rows go in steps of whole degrees.
  const bool is_psi = goes_in_degrees(rows.psi, row);
  if (!is_psi && !(has_angle_u && goes_in_degrees(rows.u, row))) return split;
  const std::string column = is_psi ? "psi" : "u";
  return fmt::format("{}; if {} is in degrees, that is written `columns` {}", split, column,
                     columns_in_degrees(rows, {column + suffix}));
}

/// Throws InputError where a finger is beyond its ends or goes where none can: see RollCheck.
void require_physical(const Log& log, const Courses& courses, const Part& part, const std::vector<Finger>& fingers,
                      const Noise& noise) {
  RollCheck check(part, log.kind, fingers, log.fingers.size(), noise);
  const std::size_t count = log.fingers.size();
  // First every place on its finger, then every step.
  for (std::size_t k = 0; k < count && log.kind == LogKind::contact; ++k) {
    const FingerRows& rows = log.fingers[k];
    for (std::size_t row = 0; row < log.rows(); ++row) {
      const auto why = check.off_finger(k, rows.u[row], rows.place_rounding);
      if (why) throw InputError(fmt::format("{}: {}", where(log, k, row), *why));
    }
  }
  PerFinger<std::size_t> line = PerFinger<std::size_t>::of(count);
  PerFinger<Reading> before = PerFinger<Reading>::of(count);
  // Invariant: `before` has the readings of the row before this one; of row 0 the first contact, all 0.
  for (std::size_t row = 0; row < log.rows(); ++row) {
    PerFinger<Reading> now = courses.each(row);
    for (std::size_t k = 0; k < count; ++k) {
      const std::vector<std::size_t>& lines = log.fingers[k].line;
      line[k] = row < lines.size() ? lines[row] : row + 1;
      if (log.kind != LogKind::contact) now[k] = in_stored_direction(now[k], part);
    }
    const auto time = log.time.empty() ? std::nullopt : std::optional<double>(log.time[row]);
    // The first jump ends it: the message has its rows, what is wrong, and what to type.
    if (const auto jump = check.jump(line, before, now, time)) {
      throw InputError(fmt::format("{}: expected a roll that goes on, found a jump: {}; {}{}{}",
                                   where(log, jump->finger, row), jump->why,
                                   cure_of_jump(log, part, fingers, noise, jump->finger, row),
                                   log.notes.empty() ? "" : "; ", fmt::join(log.notes, "; ")));
    }
    // A file's angles are unwrapped as a whole: the row before stays as it was.
    before = now;
  }
}

/// How far from its own time a row may be taken: half the way to the nearer of its neighbours.
double reach_of(const std::vector<double>& time, std::size_t row) {
  double gap = std::numeric_limits<double>::infinity();
  if (row > 0) gap = std::min(gap, time[row] - time[row - 1]);
  if (row + 1 < time.size()) gap = std::min(gap, time[row + 1] - time[row]);
  return gap / 2;
}

/// The row whose time is nearest to an instant; of two as near the earlier one. O(log n), because times grow.
std::size_t nearest_row(const std::vector<double>& time, double instant) {
  // Between two rows the nearer one, before the first and behind the last those.
  const auto after = std::lower_bound(time.begin(), time.end(), instant);
  // Before the first row.
  if (after == time.begin()) return 0;
  const auto row = static_cast<std::size_t>(after - time.begin());
  if (row == time.size()) return row - 1;
  return instant - time[row - 1] <= time[row] - instant ? row - 1 : row;
}

/// Throws InputError that names the rows on both sides of the instant, or the log's first and last time.
[[noreturn]] void refuse_instant(const Log& log, double instant) {
  const auto after = std::upper_bound(log.time.begin(), log.time.end(), instant);
  // Within the log two rows are named, outside of it its ends.
  const bool is_inside = after != log.time.begin() && after != log.time.end();
  const std::string found = is_inside ? fmt::format("whose nearest rows are at {} and {}", *(after - 1), *after)
                                      : fmt::format("which goes from {} to {}", log.time.front(), log.time.back());
  throw InputError(fmt::format(
      "{}: there is no row at the instant {} of this log, {}: expected an instant within half a row's distance of one",
      log.name, instant, found));
}

/// Throws InputError: the first contact, from which a reading is measured, is none itself.
void require_reading(const Log& log, std::size_t row, double instant) {
  // Only a log of u and psi has the first contact as a row.
  if (row > 0 || log.kind != LogKind::contact) return;
  throw InputError(
      fmt::format("{}: the instant {} means the row of the first contact, at {}, from which readings are measured: "
                  "there L and theta are 0, which fits everywhere; expected a later one (`at`), up to {}",
                  log.name, instant, log.time.front(), log.time.back()));
}

/// Throws InputError: a row that another instant meant already would count twice.
void require_another(const Log& log, const std::vector<std::size_t>& rows, std::size_t row,
                     const std::vector<double>& times) {
  const auto before = std::find(rows.begin(), rows.end(), row);
  if (before == rows.end()) return;
  const double earlier = times[static_cast<std::size_t>(before - rows.begin())];
  throw InputError(fmt::format("{}: the instants {} and {} mean the same row, at {}: leave one out (`at`){}", log.name,
                               earlier, times[rows.size()], log.time[row],
                               earlier == times[rows.size()] ? "" : "; the rows are farther apart than these"));
}

/// The rows that are read where no instants are asked for: the last one; of two fingers the middle one as well, because
/// one reading of two leaves a curve of pairs.
std::vector<std::size_t> usual_rows(const Log& log) {
  const std::size_t last = log.rows() - 1;
  // The middle and the last row are far apart: their readings tell most.
  const std::size_t middle = last / 2;
  const std::size_t first_reading = log.kind == LogKind::contact ? 1 : 0;  // before it is the first contact
  // One finger, or a log too short for two different readings.
  if (log.fingers.size() == 1 || middle < first_reading || middle == last) return {last};
  return {middle, last};
}

/// How far half a unit of the last digits can have moved a reading of one finger, at worst: both of its rows; lengths
/// and turns themselves; of increments every row so far, because they add up.
Rounding rounding_of(const Log& log, const FingerRows& rows, const Finger* finger) {
  switch (log.kind) {
    case LogKind::contact:
      return {2 * finger->length_per_u() * rows.place_rounding,
              2 * (finger->turn_per_u() * rows.place_rounding + rows.angle_rounding)};
    case LogKind::travelled:
      return {rows.place_rounding, rows.angle_rounding};
    case LogKind::increments:
      break;
  }
  const auto count = static_cast<double>(log.rows());
  return {count * rows.place_rounding, count * rows.angle_rounding};
}

}  // namespace

/// Checked one after the other, so that the message names the first instant that is wrong.
std::vector<std::size_t> rows_at(const Log& log, const std::vector<double>& times) {
  if (times.empty()) return usual_rows(log);
  if (log.time.empty()) {
    throw InputError(fmt::format("{}: has no column 'time', so that instants of it can't be chosen", log.name));
  }
  std::vector<std::size_t> rows;
  // Each instant means one row, near enough, other than the first contact and not meant before.
  for (const double instant : times) {
    if (!std::isfinite(instant)) refuse_instant(log, instant);
    const std::size_t row = nearest_row(log.time, instant);
    if (!(std::abs(log.time[row] - instant) <= reach_of(log.time, row))) refuse_instant(log, instant);
    require_reading(log, row, instant);
    require_another(log, rows, row, times);
    rows.push_back(row);
  }
  return rows;
}

std::vector<Reading> readings_as_given(const Log& log, const std::vector<Finger>& fingers, const Noise& noise) {
  const Courses courses(log, fingers, noise);
  std::vector<Reading> result(log.rows());
  for (std::size_t row = 0; row < result.size(); ++row) result[row] = courses.at(row);
  return result;
}

/// All rows are checked, whichever are asked for.
std::vector<Reading> readings(const Log& log, const Part& part, const std::vector<Finger>& fingers,
                              const std::vector<double>& times, const Noise& noise) {
  const Courses courses(log, fingers, noise);
  require_physical(log, courses, part, fingers, noise);
  std::vector<Reading> result;
  for (const std::size_t row : rows_at(log, times)) {
    // A contact log needs no change of direction: the finger rolls on the part, however that was drawn.
    const Reading reading = courses.at(row);
    result.push_back(log.kind == LogKind::contact ? reading : in_stored_direction(reading, part));
  }
  return result;
}

double reach_of_corners(double place_rounding, const Noise& noise) {
  constexpr double kSurelyOff = 5;  // standard deviations: one row in two million is on the other side
  return std::max(2 * place_rounding, kSurelyOff * noise.contact);
}

/// u and psi of each row, unwrapped as the log says or as its rows show.
std::vector<Contact> contacts_of(const FingerRows& rows, const Finger& finger) {
  const std::vector<double> u = unwrapped_as_said(rows.u, rows.place_rounding, finger.period(), rows.u_wrapped);
  const std::vector<double> psi = unwrapped_as_said(rows.psi, rows.angle_rounding, kTurn, rows.psi_wrapped);
  std::vector<Contact> contacts;
  for (std::size_t row = 0; row < u.size(); ++row) contacts.push_back({u[row], psi[row]});
  return contacts;
}

std::vector<bool> rows_on_corners(const Log& log, const std::vector<Finger>& fingers, const Noise& noise) {
  std::vector<bool> on_corners;
  for (std::size_t which = 0; which < log.fingers.size() && log.kind == LogKind::contact; ++which) {
    const Finger* const finger = finger_of(fingers, which);
    // Without corners nothing is added: the result stays empty.
    if (finger == nullptr || !finger->has_corners()) continue;
    on_corners.resize(log.rows());
    const std::vector<double>& u = log.fingers[which].u;  // wrapped or not
    const double within = reach_of_corners(log.fingers[which].place_rounding, noise);
    for (std::size_t row = 0; row < u.size(); ++row) {
      on_corners[row] = on_corners[row] || finger->is_on_corner(u[row], within);
    }
  }
  return on_corners;
}

Log from_row(Log log, std::size_t row) {
  const auto cut = [&](auto& column) {
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(std::min(row, column.size())));
  };
  cut(log.time);
  for (FingerRows& rows : log.fingers) {
    for (const auto column : kRowColumns) cut(rows.*column);
    // Simulated rows have no lines.
    cut(rows.line);
  }
  return log;
}

std::optional<double> facing(const Log& log, const std::vector<Finger>& fingers) {
  if (log.fingers.size() != 2 || log.kind != LogKind::contact || log.rows() == 0) return std::nullopt;
  // Direction of the contact's outward normal in the world, u + psi of a disk. Whole turns do not matter.
  const auto direction = [&](std::size_t which) {
    const FingerRows& rows = log.fingers[which];
    const Contact first{rows.u.front(), rows.psi.front()};
    const Finger* const finger = finger_of(fingers, which);
    return finger != nullptr ? normal_direction(*finger, first) : first.normal_direction();
  };
  return nearest_angle(direction(0) - direction(1));
}

Rounding rounding_of(const Log& log, const std::vector<Finger>& fingers) {
  require_fingers(fingers, log.fingers.size(), log.kind == LogKind::contact, log.name);
  // Of two fingers theta is a difference: at worst both errors add up.
  Rounding sum;
  for (std::size_t k = 0; k < log.fingers.size(); ++k) {
    const Rounding one = rounding_of(log, log.fingers[k], finger_of(fingers, k));
    sum.length += one.length;
    sum.turn += one.turn;
  }
  return sum;
}

}  // namespace rollfix
