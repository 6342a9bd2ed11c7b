#include "log/roll_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "log/log_rows.hpp"
#include "log/log_table.hpp"
#include "log/wrapping.hpp"
#include "outline/turn.hpp"
#include "part/part_data.hpp"
#include "part/turning_range.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"

// Notation, rules 1 to 3 being those of roll_check.hpp:
//   step            L and theta of a finger from one row to the next, in their own units and radians: Step
//   error           what a step may be off: `length`, `turn`, and shares of both: StepError, `kSurely` standard
//                   deviations
//   variation       the sum of |dTheta| once around, corners included: TurnRange::variation
//   speed           2 pi |L| / P + |theta|, by the time that it took
//   away            the last rows, that a robust reader leaves out as stray: `kMostStrays` at the most
// Follows docs/rolling.md, "Logs" and "A log that grows".
// Idea: a step that no part of this shape allows is refused; a sudden one, `kSudden` times as large as most before it,
// only where no stretch of about its length turns by about as much. Of the places where a stretch may start `kCells`
// cells are looked at, each as a whole.
namespace rollfix {
namespace {

constexpr double kSurely = 10;          // standard deviations: no normal error reaches as many
constexpr double kSudden = 50;          // times the usual step
constexpr std::size_t kLeastSteps = 8;  // before that nothing is usual
constexpr double kSpareTurn = 1;        // radians, of rule 2
constexpr double kAboutTurn = 0.25;     // radians, of rule 3: logs of a part that was made a little differently ...
constexpr double kAboutLength = 0.25;   // ... and fingers whose radius is not quite what was said
constexpr double kSpareLength = 1e-6;   // of the perimeter, of rule 1
constexpr int kCells = 256;             // of the places where a stretch may start

}  // namespace

TurnRange::TurnRange(const Part& part) : part_(part) {
  const double step = part.perimeter() / kCells;
  for (int k = 0; k < kCells; ++k) {
    const Interval s{k * step, (k + 1) * step};
    cells_.push_back({s, angles_over(part.turning(), s)});
  }
  // Theta is monotone on a spiral: the sizes of all turns, corners included, add up to its variation.
  for (const Spiral& spiral : part.turning().spirals()) variation_ += std::abs(spiral.turn());
  for (const Corner& corner : part.corners()) variation_ += std::abs(corner.turn);
}

/// Each cell is a set of starts. Its ends lie in one arc: the cell, moved by the least and by the largest length.
/// Bounds on Theta on both give bounds on every difference.
Interval TurnRange::of(const Interval& lengths) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Interval result{kInfinity, -kInfinity};
  for (const Cell& cell : cells_) {
    const double from = cell.s.lo + lengths.lo;
    // Rolls from here on would end beyond the outline's end.
    if (!part_.closed() && from > part_.perimeter()) break;
    const Interval there = angles_over(part_.turning(), {from, cell.s.hi + lengths.hi});
    result = {std::min(result.lo, there.lo - cell.angle.hi), std::max(result.hi, there.hi - cell.angle.lo)};
  }
  return result;
}

RollCheck::RollCheck(const Part& part, LogKind kind, const std::vector<Finger>& fingers, std::size_t count,
                     const Noise& noise)
    : part_(part),
      turns_(part),
      fingers_(fingers),
      noise_in_place_(kSurely * noise.contact),
      error_(PerFinger<StepError>::of(count)),
      recent_(PerFinger<std::array<double, kRecent>>::of(count)) {
  for (const Finger& finger : fingers) {
    if (kind != LogKind::contact || !finger.is_disk()) continue;
    // A radius in another unit than the part's would make every step a jump: it is refused with its cure.
    require_not_lost(part, finger.length_per_u(), "a disk with a radius", ": give it in the outline's unit");
  }
  for (std::size_t k = 0; k < count; ++k) error_[k] = error_of(kind, finger_of(fingers, k), noise);
}

RollCheck::StepError RollCheck::error_of(LogKind kind, const Finger* finger, const Noise& noise) {
  // A difference of two rows has both rows' errors; an increment has one of its own.
  const double both_rows = kind == LogKind::increments ? 1 : std::numbers::sqrt2;
  StepError error{kSurely * both_rows * noise.contact, kSurely * both_rows * noise.angle, kSurely * noise.slip,
                  kSurely * noise.gyro};
  if (kind != LogKind::contact || finger == nullptr) return error;
  // An error of the contact's place is one of its normal's direction as well: d N / d u over d length / d u.
  error.turn += error.length * finger->turn_per_u() / finger->length_per_u();
  // A wrong radius scales all lengths, as slip does.
  if (finger->is_disk()) error.share += kSurely * noise.radius / finger->length_per_u();
  return error;
}

std::optional<std::string> RollCheck::off_finger(std::size_t finger, double u, double rounding) const {
  const Finger& shape = *finger_of(fingers_, finger);
  const Interval ends = shape.ends();
  // The ends of an outline are sums of its curves' lengths: rounding.
  const double seam = shape.outline() != nullptr ? kSpareLength * shape.outline()->perimeter() : 0;
  const double slack = 2 * rounding + noise_in_place_ + seam;
  if (u >= ends.lo - slack && u <= ends.hi + slack) return std::nullopt;
  return fmt::format("u{} is {:.9g}, but the finger {} goes from {:g} to {:.9g} along its length",
                     error_.size() == 1 ? "" : kFingerSuffixes[finger], u, shape.name(), ends.lo, ends.hi);
}

std::optional<RollCheck::Jump> RollCheck::jump(const PerFinger<std::size_t>& line, const PerFinger<Reading>& before,
                                               const PerFinger<Reading>& now, const std::optional<double>& time) {
  const std::size_t count = error_.size();
  PerFinger<Step> steps = PerFinger<Step>::of(count);
  for (std::size_t k = 0; k < count; ++k) {
    // On a finger's corner: the least turn that it leaves possible.
    const double turn = now[k].turn - before[k].turn;
    const double open = now[k].pivot + before[k].pivot;
    const double least = open > 0 ? std::copysign(std::max(0.0, std::abs(turn) - open), turn) : turn;
    steps[k] = {now[k].length[0] - before[k].length[0], least, line_[k]};
  }
  // Per second; per row where there are no times.
  const double duration = time && time_ ? *time - *time_ : 1;
  const bool is_first = !has_row_;
  const bool may_be_far = may_be_far_;
  // The next row comes after this one whatever is found here. What was before is kept for disregard().
  time_before_ = std::exchange(time_, time);
  line_before_ = std::exchange(line_, line);
  has_row_ = true;
  may_be_far_ = false;
  if (is_first) return std::nullopt;
  // Rules 1 and 2 need nothing but the two rows.
  if (auto why = impossible(steps)) return why;
  // Rows are missing in between: any speed is possible, only rules 1 and 2 hold.
  if (may_be_far) return std::nullopt;

  PerFinger<double> speed = PerFinger<double>::of(count);
  std::optional<std::size_t> sudden;
  for (std::size_t k = 0; k < count; ++k) {
    // In laps and turns, so that neither a pivot nor a straight side counts as rest.
    const double laps = steps[k].length / part_.perimeter();
    const double size = 2 * std::numbers::pi * std::abs(laps) + std::abs(steps[k].turn);
    const double noise = 2 * std::numbers::pi * error_[k].length / part_.perimeter() + error_[k].turn;
    speed[k] = size / duration;
    if (!sudden && size > noise && is_sudden(k, speed[k])) sudden = k;
  }
  if (sudden && !is_explained(steps)) {
    return Jump{
        *sudden,
        text(*sudden, steps[*sudden]) +
            fmt::format(", more than {:g} times what is usual here, and no stretch of the part is like that", kSudden)};
  }
  // Only steps that are no jumps say what is usual: one wrong row must not make the way back look usual.
  for (std::size_t k = 0; k < count; ++k) recent_[k][steps_ % kRecent] = speed[k];
  ++steps_;
  return std::nullopt;
}

/// A stray row is taken back, so that the next one is compared with the row before it.
void RollCheck::disregard() {
  time_ = time_before_;
  line_ = line_before_;
}

/// "the length changes by ... since line 3", "the length of finger b ...".
std::string RollCheck::text(std::size_t finger, const Step& step) const {
  const char* const whose = error_.size() == 1 ? "" : finger == 0 ? " of finger a" : " of finger b";
  return fmt::format("the length{0} changes by {1:.6g} and the turn{0} by {2:.6g} deg since line {3}", whose,
                     step.length, step.turn / kDegree, step.line_before);
}

/// Rules 1 and 2: what goes farther than an open outline is long, or turns more than the part does over such a length.
/// These hold for rows however far apart.
std::optional<RollCheck::Jump> RollCheck::impossible(const PerFinger<Step>& steps) const {
  const double perimeter = part_.perimeter();
  double most = 0;
  std::size_t largest = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    // The shortest way that the measured length may stand for.
    const double length = std::abs(steps[k].length) / (1 + error_[k].share);
    if (!part_.closed() && length > (1 + kSpareLength) * perimeter + error_[k].length) {
      return Jump{k, text(k, steps[k]) + fmt::format(", but the open outline is only {:.6g} long", perimeter)};
    }
    most += most_turn(k, length);
    if (std::abs(steps[k].turn) > std::abs(steps[largest].turn)) largest = k;
  }
  // Of two fingers the difference: the part may have turned by any angle, which both see alike.
  const double turn = steps.size() == 1 ? steps[0].turn : steps[0].turn - steps[1].turn;
  if (!(std::abs(turn) > most)) return std::nullopt;
  // One finger: the message has its own turn. Two: it names the one that turned most.
  if (steps.size() == 1) {
    return Jump{0, text(0, steps[0]) +
                       fmt::format(", but the part turns by at most {:.6g} deg over such a length", most / kDegree)};
  }
  return Jump{
      largest,
      text(largest, steps[largest]) +
          fmt::format(
              ", that of the other finger by {:.6g} deg, but the part turns by at most {:.6g} deg over both lengths",
              steps[1 - largest].turn / kDegree, most / kDegree)};
}

/// The most that the tangent can turn over such a length, radians, by rule 2: for each lap begun all turns of the part
/// added up without signs, at least a full one, and a radian to spare, widened by the errors.
double RollCheck::most_turn(std::size_t finger, double length) const {
  const double laps = 1 + std::floor(length / part_.perimeter());
  return (1 + error_[finger].turn_share) * laps * std::max(turns_.variation(), 2 * std::numbers::pi) + kSpareTurn +
         error_[finger].turn;
}

/// Whether a step of this speed is more than kSudden times as fast as most of the last kRecent ones. Before kLeastSteps
/// steps none is.
bool RollCheck::is_sudden(std::size_t finger, double size) const {
  // Too few steps to know what is usual.
  if (steps_ < kLeastSteps) return false;
  const std::size_t count = std::min(steps_, kRecent);
  const auto first = recent_[finger].begin();
  const auto smaller = std::count_if(first, first + static_cast<std::ptrdiff_t>(count),
                                     [&](double usual) { return kSudden * usual < size; });
  return 2 * static_cast<std::size_t>(smaller) > count;
}

/// Whether the part has stretches of about these lengths that turn by about as much, if it turned itself by some angle:
/// by none under one finger.
bool RollCheck::is_explained(const PerFinger<Step>& steps) const {
  const std::vector<Interval> of_a = part_turns(0, steps[0]);
  const std::vector<Interval> others = steps.size() == 1 ? std::vector<Interval>{{0, 0}} : part_turns(1, steps[1]);
  return std::any_of(of_a.begin(), of_a.end(), [&](const Interval& a) {
    return std::any_of(others.begin(), others.end(),
                       [&](const Interval& other) { return a.lo <= other.hi && other.lo <= a.hi; });
  });
}

/// By how much the part may have turned, radians, so that this finger's step is one along it. Theta of stretches of
/// about this length turns by some angle in `turns`; what the finger saw beyond that the part turned by itself. Empty:
/// more than a lap, which rule 3 does not take for a stretch. Two intervals where the length's sign is within its
/// error.
std::vector<Interval> RollCheck::part_turns(std::size_t finger, const Step& step) const {
  const StepError& error = error_[finger];
  const double length = std::abs(step.length);
  if (length > part_.perimeter() * (1 + error.share) + error.length) return {};
  const double share = kAboutLength + error.share;
  const Interval lengths{std::max(0.0, length / (1 + share) - error.length), length * (1 + share) + error.length};
  const double slack = kAboutTurn + error.turn;
  const Interval turns = turns_.of(lengths);
  // Along the outline the finger sees the stretch's turn, against it the same with the other sign.
  const Interval forwards{step.turn - (turns.hi + slack), step.turn - (turns.lo - slack)};
  const Interval backwards{step.turn + (turns.lo - slack), step.turn + (turns.hi + slack)};
  if (lengths.lo == 0) return {forwards, backwards};
  return {step.length < 0 ? backwards : forwards};
}

namespace {

/// One finger's rows as they are read one after the other, so that a stray one can be taken back: it would decide how
/// the angles behind it are unwrapped.
class RowByRow {
 public:
  RowByRow(const Log& log, const Part& part, const Finger* finger, std::size_t which, const Noise& noise)
      : log_(log),
        part_(part),
        rows_(log.fingers[which]),
        finger_(finger),
        within_(reach_of_corners(rows_.place_rounding, noise)),
        u_(finger != nullptr ? finger->period() : 2 * std::numbers::pi, rows_.u_wrapped),
        psi_(2 * std::numbers::pi, rows_.psi_wrapped) {}

  struct Step {
    Reading before;  // of the row before
    Reading now;     // of this row; both from the first contact
  };
  /// The reading of this row, and of the row before as the angles are unwrapped by now.
  Step add(std::size_t row) {
    if (log_.kind != LogKind::contact) {
      // Lengths are measured: the row before is as it was.
      return {std::exchange(last_, in_stored_direction({rows_.length[row], rows_.turn[row]}, part_)), last_};
    }
    const Contact now{u_.add(rows_.u[row], rows_.place_rounding), psi_.add(rows_.psi[row], rows_.angle_rounding)};
    if (!first_) first_ = now;
    return {reading_between(*finger_, *first_, {u_.before(), psi_.before()}, within_),
            reading_between(*finger_, *first_, now, within_)};
  }

 private:
  const Log& log_;
  const Part& part_;
  const FingerRows& rows_;
  const Finger* finger_;  // none where it is not known
  double within_;         // so near to a corner of the finger a contact may be on it, length
  GrowingAngle u_;
  GrowingAngle psi_;
  std::optional<Contact> first_;  // of u and psi
  Reading last_;                  // of lengths and turns: the row before
};

/// Finds the rows of a log that jump away and from which the roll comes back within kMostStrays rows.
class StraySearch {
 public:
  StraySearch(const Log& log, const Part& part, const std::vector<Finger>& fingers, const Noise& noise)
      : log_(log), check_(part, log.kind, fingers, log.fingers.size(), noise) {
    for (std::size_t k = 0; k < log.fingers.size(); ++k) {
      fingers_.emplace_back(log, part, finger_of(fingers, k), k, noise);
    }
  }

  /// Rows from which the roll comes back, in order.
  std::vector<std::size_t> run() {
    std::vector<std::size_t> strays;
    std::size_t away = 0;  // rows, the last ones, that are
    // Invariant: the last `away` of `strays` are the rows since the last one that follows.
    for (std::size_t row = 0; row < log_.rows(); ++row) {
      if (follows(row)) {
        away = 0;
        continue;
      }
      strays.push_back(row);
      if (++away <= kMostStrays) continue;
      strays.resize(strays.size() - away);  // a jump: for the checks to refuse
      break;
    }
    return strays;
  }

 private:
  /// Whether this row follows from the last one that did. If not, nothing is left of it: the fingers' angles are
  /// unwrapped in copies, which are thrown away.
  bool follows(std::size_t row) {
    const std::size_t count = fingers_.size();
    PerFinger<Reading> before = PerFinger<Reading>::of(count);
    PerFinger<Reading> now = PerFinger<Reading>::of(count);
    // Copies are small, and kept only where the row follows.
    std::vector<RowByRow> next = fingers_;
    for (std::size_t k = 0; k < count; ++k) {
      const RowByRow::Step step = next[k].add(row);
      before[k] = step.before;
      now[k] = step.now;
    }
    const auto time = log_.time.empty() ? std::nullopt : std::optional<double>(log_.time[row]);
    if (check_.jump(PerFinger<std::size_t>::of(count, row), before, now, time)) {
      check_.disregard();
      return false;
    }
    fingers_.swap(next);
    return true;
  }

  const Log& log_;
  RollCheck check_;
  std::vector<RowByRow> fingers_;
};

/// Takes these rows, which rise, out of a column; from the end, so that the others keep their places.
void erase_rows(std::vector<double>& column, const std::vector<std::size_t>& rows) {
  if (column.empty()) return;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) column.erase(column.begin() + static_cast<long>(*row));
}

}  // namespace

Log without_strays(const Log& log, const Part& part, const std::vector<Finger>& fingers, const Noise& noise,
                   std::vector<std::size_t>* lines) {
  require_fingers(fingers, log.fingers.size(), log.kind == LogKind::contact, log.name);
  const std::vector<std::size_t> strays = StraySearch(log, part, fingers, noise).run();
  Log result = log;
  erase_rows(result.time, strays);
  for (FingerRows& rows : result.fingers) {
    for (const auto column : kRowColumns) erase_rows(rows.*column, strays);
    for (auto row = strays.rbegin(); row != strays.rend(); ++row) {
      if (*row < rows.line.size()) rows.line.erase(rows.line.begin() + static_cast<long>(*row));
    }
  }
  if (lines == nullptr) return result;
  const std::vector<std::size_t>& written = log.fingers.front().line;
  for (const std::size_t row : strays) lines->push_back(row < written.size() ? written[row] : row + 1);
  return result;
}

}  // namespace rollfix
