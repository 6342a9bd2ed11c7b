#pragma once

#include <optional>
#include <string>
#include <vector>

#include "log/log_rows.hpp"
#include "log/roll_check.hpp"
#include "log/wrapping.hpp"
#include "rollfix/log.hpp"

namespace rollfix {

/// How the rows of a log without u and psi are measured from the first contact of their roll. That lies before the
/// log's first row. A later roll's first row is its own first contact: what was counted while the finger was off the
/// part does not count.
class Odometer {
 public:
  Odometer(LogKind kind, bool is_later_roll) : kind_(kind), starts_here_(is_later_roll) {}

  /// Length and turn up to this row, lengths along the outline as the user gave it.
  Reading add(const FingerCells& row);

 private:
  /// A sum that keeps what rounding drops (Neumaier 1974): a million increments add up to one rounding.
  class ExactSum {
   public:
    double add(double term);

   private:
    double sum_ = 0;   // rounded
    double rest_ = 0;  // what rounding took from it, added up
  };

  LogKind kind_;
  bool starts_here_;   // the next row is its roll's first contact
  FingerCells start_;  // of lengths and turns: what the counters showed at the first contact
  ExactSum length_;    // of increments
  ExactSum turn_;
};

/// What a log of increments says from row to row.
struct Increments {
  std::vector<double> distance;
  std::vector<double> dturn;
};

/// Those that were written, where `length` and `turn` are still their sums; else what leads from sum to sum.
Increments increments_of(const FingerRows& rows);

/// What the rows of growing rolls come to, one after the other, of one finger or of two, or of one beside the pin of a
/// wheel: each is judged, and measured from the first contacts of its roll. Knows no lines of text.
class RollRows {
 public:
  /// `any_part`: see LogOptions. `name`: for messages. Throws InputError: fingers that are not valid, more than two.
  RollRows(const Part& part, std::vector<Finger> fingers, const Noise& noise, bool robust, bool any_part,
           const std::string& name);

  /// What the rows have, of each finger, and what their logs are called. Throws InputError: u and psi without a finger,
  /// fingers of another number.
  void start(const std::vector<Columns>& columns, const std::vector<std::string>& names);
  bool has_started() const { return check_.has_value(); }
  std::size_t fingers() const { return columns_.size(); }  // a wheel without skin included
  LogKind kind() const { return columns_.front().kind; }

  /// Throws InputError: u is beyond an open finger's end. REQUIRES has_started().
  void require_on_finger(const LogRow& row, const PerFinger<std::size_t>& lines) const;
  /// A row in which not every finger touches.
  LogLine off();
  /// A row in which all do. REQUIRES has_started().
  LogLine take(const LogRow& row, const PerFinger<std::size_t>& lines);
  /// Rows may be missing before the next one.
  void skip();
  /// The next row begins a roll, of another log: as if there had been none.
  void restart();

 private:
  /// What a finger's roll is measured by while it lasts.
  struct OngoingRoll {
    OngoingRoll(const Columns& columns, const Finger* finger, bool is_later_roll);

    bool has_first = false;  // `first` is known
    Contact first;           // of u and psi
    GrowingAngle u;
    GrowingAngle psi;
    FingerRounding rounding;  // of the columns so far
    Odometer odometer;        // of everything else
    Reading last;             // of the last row
  };

  /// The reading of each finger with skin of a row, and what the row before it says by now.
  struct Steps {
    PerFinger<Reading> before;
    PerFinger<Reading> now;
  };

  void begin_roll();
  std::optional<std::string> unclear_angle(const PerFinger<std::size_t>& lines) const;
  Sample sample_of(const LogRow& row, const PerFinger<std::size_t>& lines) const;
  Steps measure(const LogRow& row, Sample& sample);
  Reading measure_contact(const FingerCells& cells, std::size_t which, Sample& sample, Reading& before);
  void add_pin(const FingerCells& cells, std::size_t which, Sample& sample);
  std::size_t with_skin() const { return columns_.size() - (columns_.back().of_pin ? 1 : 0); }
  std::string place_of(std::size_t finger, const PerFinger<std::size_t>& lines) const;

  Part part_;
  std::vector<Finger> fingers_;
  Noise noise_;
  bool robust_;                   // up to kMostStrays rows that jump away are left out
  bool any_part_;                 // the part is not known: no step is a jump
  std::vector<Columns> columns_;  // of each finger
  std::vector<std::string> names_;
  std::optional<RollCheck> check_;  // none before the columns are known
  std::vector<OngoingRoll> rolls_;  // of each finger; none while there is no contact
  bool is_later_roll_ = false;      // the next one is not the log's first
  std::size_t strays_ = 0;          // since the last row of the roll
};

/// Lengths of a stream come out in the part's unit, unless another is asked for.
LogOptions in_unit_of(const Part& part, LogOptions options);

}  // namespace rollfix
