#include "log/odometer.hpp"

#include <cmath>

namespace rollfix {

double Odometer::ExactSum::add(double term) {
  const double next = sum_ + term;
  rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
  return sum_ + rest_;
}

Reading Odometer::add(const FingerCells& row) {
  const bool is_first_contact = starts_here_;
  starts_here_ = false;
  if (kind_ == LogKind::increments) {
    return is_first_contact ? Reading{} : Reading{length_.add(row.place.value), turn_.add(row.angle.value)};
  }
  if (is_first_contact) start_ = row;
  return {row.place.value - start_.place.value, row.angle.value - start_.angle.value};
}

namespace {

/// Whether a reader of these increments would add them up to the rows' length and turn, to the bit.
bool add_up(const std::vector<double>& distance, const std::vector<double>& dturn, const FingerRows& rows) {
  if (distance.size() != rows.length.size() || dturn.size() != rows.turn.size()) return false;
  Odometer odometer(LogKind::increments, false);
  for (std::size_t row = 0; row < distance.size(); ++row) {
    const Reading sum = odometer.add({{distance[row], 0}, {dturn[row], 0}});
    if (sum.length[0] != rows.length[row] || sum.turn != rows.turn[row]) return false;
  }
  return true;
}

/// Steps that a reader adds up to these sums, to the rounding of a step.
std::vector<double> steps_to(const std::vector<double>& sums) {
  std::vector<double> steps;
  Odometer odometer(LogKind::increments, false);
  double before = 0;
  for (const double sum : sums) {
    steps.push_back(sum - before);
    before = odometer.add({{steps.back(), 0}, {}}).length[0];  // what rounding took comes back with the next step
  }
  return steps;
}

}  // namespace

Increments increments_of(const FingerRows& rows) {
  if (add_up(rows.distance, rows.dturn, rows)) return {rows.distance, rows.dturn};
  return {steps_to(rows.length), steps_to(rows.turn)};  // rows made or changed without them
}

}  // namespace rollfix
