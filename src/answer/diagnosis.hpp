#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/log.hpp"
#include "rollfix/solve.hpp"
#include "steps.hpp"

namespace rollfix::answer {

/// How the log's columns are to be read where that is the mistake: those that change, and those that are not found by
/// their own names. None where no column changes, or no header is known.
std::vector<ColumnSource> columns_without(Cause cause, const Log& log);

/// Whether it was said of a finger's column, "u", "psi", "turn" or "dturn", that it is in degrees.
bool says_degrees(const std::vector<FingerRows>& fingers, std::string_view column);

/// A mistake in how the columns of a log are read: a unit, a sign, a name.
struct SlipOfThePen {
  Cause cause;
  std::function<void(FingerRows&)> mend;
  double log_stretch = 0;  // by how much the numbers of a row grow, and their density with them: the logarithm of it
  double left_of_roll = std::numeric_limits<double>::infinity();  // where it makes the roll shorter: how far the
                                                                  // columns still go, radians
};

/// The mistakes that are possible in these measurements.
std::vector<SlipOfThePen> slips_of_the_pen(const Measurement& measured);

/// The problem as it is without that mistake.
Problem without(const SlipOfThePen& slip, const Problem& problem);

// Rows that trials are compared by, before all are looked at.
inline constexpr std::size_t kRowsToCompare = 48;

/// The fingers whose lengths are scaled: all, or one of two.
using Whose = std::optional<std::size_t>;

/// How many times as long as they were measured the rows say that lengths are.
struct SettledScale {
  double scale = 1;
  double sd = 0;
  Belief belief;  // with it
};

/// By which factor lengths may be off, as by a wrong radius or another unit, of any size.
class LengthScales {
 public:
  /// Both have to outlive it.
  LengthScales(const Problem& problem, const Observation& observed) : problem_(problem), observed_(observed) {}

  /// Where a few rows fit best, the best first.
  std::vector<double> worth_a_look(const Whose& whose) const;

  /// From such a scale on by all rows; none: they ask for any scale, or can't be had with this one.
  std::optional<SettledScale> settled(const Whose& whose, double scale) const;

 private:
  std::vector<double> all(const Whose& whose) const;
  bool may_be_of_two(double scale) const;
  /// Does a row say anything of the normal with such fingers?
  bool tells_normals(const Whose& whose, double scale) const;
  bool may_be(double scale) const;
  std::optional<Belief> belief_with(const Whose& whose, double scale, std::size_t rows) const;

  const Problem& problem_;
  const Observation& observed_;
  mutable double turn_beyond_ = -1;  // what a turn may be off for its length, radians; below 0: not known yet
};

/// What may be wrong where the rows fit badly: the usual mistakes are tried, each estimated by the rows. Those with
/// which the rows fit, else those with which they fit far better, the likeliest first; Cause::part alone where nothing
/// does. Nothing where they fit.
std::vector<Diagnosis> diagnose(const Problem& problem, const Observation& observed, Belief& belief);

}  // namespace rollfix::answer
