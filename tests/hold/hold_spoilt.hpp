#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "hold_cases.hpp"

// Logs of three and more fingers with one mistake in them, or in what is said of them.
namespace hold_cases {

using rollfix::FingerRows;

inline FingerRows& rows_of(HoldCase& one, std::size_t finger) { return one.problem.logs[finger].fingers.front(); }

/// The radius of one finger, or of all, is said to be so many times what it is.
inline void say_radius(HoldCase& one, double times, std::optional<std::size_t> finger = {}) {
  const double radius = one.problem.fingers.front().disk()->radius;
  one.problem.fingers.assign(one.problem.logs.size(), rollfix::disk(radius));
  for (std::size_t k = 0; k < one.problem.fingers.size(); ++k) {
    if (!finger || *finger == k) one.problem.fingers[k] = rollfix::disk(times * radius);
  }
}

inline void scale(std::vector<double>& values, double by) {
  for (double& value : values) value *= by;
}

/// One log's rows are of instants so many rows later than the others': its first contact is where it rolled to by then.
inline void delay(HoldCase& one, std::size_t finger, std::size_t rows) {
  const auto cut = static_cast<std::ptrdiff_t>(rows);
  const std::vector<double>& u = rows_of(one, finger).u;
  const double rolled = (u[rows] - u.front()) / (u.back() - u.front());
  one.starts[finger] += rolled * (one.ends[finger] - one.starts[finger]);
  for (std::size_t k = 0; k < one.problem.logs.size(); ++k) {
    FingerRows& of = rows_of(one, k);
    for (std::vector<double>* column : {&of.u, &of.psi, &of.x, &of.y}) {
      if (column->empty()) continue;
      if (k == finger) {
        column->erase(column->begin(), column->begin() + cut);
      } else {
        column->erase(column->end() - cut, column->end());
      }
    }
    one.problem.logs[k].time.resize(of.u.size());
  }
}

/// As if the part lay face down: x of everything has the other sign.
inline void turn_over(HoldCase& one) {
  for (std::size_t k = 0; k < one.problem.logs.size(); ++k) {
    FingerRows& rows = rows_of(one, k);
    scale(rows.u, -1);
    for (double& psi : rows.psi) psi = std::numbers::pi - psi;
    scale(rows.x, -1);
  }
}

/// A share of all measurements becomes anything: of a row of one finger u or psi by up to a radian, or its centre by up
/// to a third of the part.
inline std::size_t add_outliers(HoldCase& one, double share, std::mt19937_64& generator) {
  std::size_t count = 0;
  const double size = diagonal(one.problem.part);
  for (std::size_t k = 0; k < one.problem.logs.size(); ++k) {
    FingerRows& rows = rows_of(one, k);
    for (std::size_t row = 0; row < rows.u.size(); ++row) {
      if (uniform(generator, 0, 1) >= share) continue;
      ++count;
      const double kind = uniform(generator, 0, rows.x.empty() ? 2 : 3);
      if (kind < 1) {
        rows.u[row] += uniform(generator, -1, 1);
      } else if (kind < 2) {
        rows.psi[row] += uniform(generator, -1, 1);
      } else {
        rows.x[row] += uniform(generator, -0.3, 0.3) * size;
        rows.y[row] += uniform(generator, -0.3, 0.3) * size;
      }
    }
  }
  return count;
}

}  // namespace hold_cases
