#pragma once

#include <vector>

#include "log/log_rows.hpp"

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
    double sum_ = 0;
    double rest_ = 0;
  };

  LogKind kind_;
  bool starts_here_;
  FingerCells start_;
  ExactSum length_;
  ExactSum turn_;
};

/// What a log of increments says from row to row.
struct Increments {
  std::vector<double> distance;
  std::vector<double> dturn;
};

/// Those that were written, where `length` and `turn` are still their sums; else what leads from sum to sum.
Increments increments_of(const FingerRows& rows);

}  // namespace rollfix
