#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "log/log_rows.hpp"
#include "log/roll_check.hpp"
#include "log/wrapping.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"

namespace rollfix {

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
    Reading before;
    Reading now;
  };
  Step add(std::size_t row) {
    if (log_.kind != LogKind::contact) {
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
  const Finger* finger_;
  double within_;
  GrowingAngle u_;
  GrowingAngle psi_;
  std::optional<Contact> first_;
  Reading last_;
};

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
  bool follows(std::size_t row) {
    const std::size_t count = fingers_.size();
    PerFinger<Reading> before = PerFinger<Reading>::of(count);
    PerFinger<Reading> now = PerFinger<Reading>::of(count);
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
    for (auto* column : {&rows.u, &rows.psi, &rows.length, &rows.turn, &rows.x, &rows.y}) erase_rows(*column, strays);
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
