#include "rollfix/log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "rollfix/error.hpp"

namespace rollfix {
namespace {

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

PinLog pin_log(std::string name, std::vector<double> x, std::vector<double> y, std::vector<double> psi,
               std::vector<double> time) {
  const std::size_t rows = x.size();
  if (rows < 2) throw InputError(fmt::format("{}: expected at least 2 rows of the pin, found {}", name, rows));
  require_column(x, "x", rows, name);
  require_column(y, "y", rows, name);
  if (!psi.empty()) require_column(psi, "psi", rows, name);
  if (!time.empty()) require_column(time, "time", rows, name);
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (time[k] > time[k - 1]) continue;
    throw InputError(fmt::format("{}: row {}: time is {}, expected more than {} in the row before: time must grow",
                                 name, k + 1, time[k], time[k - 1]));
  }
  PinLog log;
  log.rows.name = std::move(name);
  log.rows.time = std::move(time);
  FingerRows& one = log.rows.fingers.front();
  one.u.assign(rows, 0);
  one.psi = std::move(psi);
  one.x = std::move(x);
  one.y = std::move(y);
  return log;
}

}  // namespace rollfix
