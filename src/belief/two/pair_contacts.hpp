#pragma once

#include <Eigen/Core>
#include <array>

#include "belief/two/pair_filter.hpp"

namespace rollfix::belief {

/// What a row's numbers depend on, to first order, is one column each: the shared errors x (5), w of both first
/// contacts (2), and the row's own errors of both places and of the turn (3).
inline constexpr int kByErrors = 5;
inline constexpr int kByStart = 2;
inline constexpr int kByOwn = 3;
inline constexpr int kByAll = kByErrors + kByStart + kByOwn;
template <int Rows>
using ByAll = Eigen::Matrix<double, Rows, kByAll>;

/// What a row says of its contacts.
struct RowPlaces {
  std::array<double, 2> felt_at{};  // S: where they were felt, length, unwrapped
  ByAll<2> felt_by = ByAll<2>::Zero();
  std::array<double, 2> root{};  // w of each there, radians
  double apart = 0;              // D: w_b - w_a, radians
  ByAll<1> apart_by = ByAll<1>::Zero();
  double own = 0;   // variance of S by the row's own error, length^2, ...
  double turn = 0;  // ... and of D, radians^2
  // The same by what the roll shares, as far as it is known: D moves with S.
  std::array<double, 2> open{};
  double open_turn = 0;
};

/// `open`: of x; nullptr: exactly x.
RowPlaces places_in(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                    const PairSharedCovariance* open);

/// Both contacts of a row, where they fit best.
struct Contacts {
  std::array<double, 2> w{};
  std::array<double, 2> variance{};  // of each, by the errors of both; radians^2
};

/// The w_a that makes e_a^2 / V_a + e_b^2 / V_b least.
Contacts contacts_of(const PairModel& model, const StartPlaces& at, const RowPlaces& row);

// A contact that is this much of a radian off where it is looked at is looked at there as well as anywhere.
inline constexpr double kSameContact = 0.02;
// Where no contact tells w_a, both being at corners, it is known to this; radians.
inline constexpr double kPivot = 0.3;

}  // namespace rollfix::belief
