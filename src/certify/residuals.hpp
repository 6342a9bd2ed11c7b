#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "residual.hpp"

namespace rollfix {

/// Readings of which one at least is outside the tolerance all the way, and a row where they come nearest to it.
struct Exclusion {
  std::vector<std::size_t> by;
  std::optional<double> row;
};

/// f of all readings along the boundary, s unwrapped.
class Residuals {
 public:
  Residuals(const Part& part, const std::vector<Reading>& readings, double tolerance);

  std::size_t count() const { return f_.size(); }
  const Residual& operator[](std::size_t reading) const { return f_[reading]; }
  const std::vector<double>& lengths() const { return lengths_; }

  /// The largest |f|: outside the tolerance where some reading's is.
  double size(double s) const;
  /// Whether the f of some reading has a jump between these.
  bool jumps(double lo, double hi) const;

  /// What a row beside a placement has to be off by.
  double edge() const;

  /// Moved ahead (or back, `way` -1) until the start and all ends of the rolls are clear of where curves meet.
  double clear(double s, int way) const { return clear_of_joints(part_, lengths_, s, way); }

  /// Nothing where no reading, nor two of them, exclude all between these.
  std::optional<Exclusion> exclusion(double lo, double hi) const;

  /// Where to halve what none excludes: beside a corner that a roll may start at.
  double split(double lo, double hi) const;

  /// The stretches between these on which every f is 0 to rounding.
  std::vector<Interval> flat(double lo, double hi) const;

 private:
  /// What is off by more is excluded: with some to spare where another reading may do it as well.
  double excluded() const;
  std::optional<Exclusion> exclusion(const Residual& f, double bound, double lo, double hi) const;
  std::optional<Exclusion> exclusion_by_one(double lo, double hi) const;
  std::optional<Exclusion> exclusion_by_two(double lo, double hi) const;

  const Part& part_;
  const std::vector<Reading>& readings_;
  double tolerance_;
  double step_;  // the least between places
  std::vector<Residual> f_;
  std::vector<double> lengths_;
};

}  // namespace rollfix
