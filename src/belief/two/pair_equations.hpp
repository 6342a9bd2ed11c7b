#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "belief/two/pair_filter.hpp"

namespace rollfix::belief {

/// The angle nearest to 0 that is the same: std::remainder, but for rounding, and faster.
inline double nearest_to_zero(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle - kTurn * std::floor(angle / kTurn + 0.5);
}

/// By how many nodes each finger's pivot is shared, see pivots_of.
using Alike = std::array<double, 2>;

/// A row as N equations f = 0, linear in the shared errors x and the start w about the point of linearisation: of the
/// turn, and with the centres of their distance and direction as well.
template <int N>
struct PairEquations {
  Eigen::Matrix<double, N, 1> f = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, 5> by_errors = Eigen::Matrix<double, N, 5>::Zero();
  Eigen::Matrix<double, N, 2> by_start = Eigen::Matrix<double, N, 2>::Zero();
  Eigen::Matrix<double, N, N> variance = Eigen::Matrix<double, N, N>::Zero();  // of the row on its own
  Eigen::Matrix<double, N, N> pivots = Eigen::Matrix<double, N, N>::Zero();    // of that, of fingers at corners
  double beyond = 0;  // squared distance beyond an open outline's ends, in standard deviations
};

/// Where the first contacts are.
struct StartPlaces {
  std::array<TiltedPlace, 2> place;
  std::array<double, 2> angle{};     // of the tangents
  std::array<double, 2> by_start{};  // of them by w
};

StartPlaces places_of(const PairModel& model, const PairStart& start);

/// What the first contacts say of how the fingers face. N = 3: with their centres.
template <int N>
PairEquations<N> facing_equations(const PairModel& model, const StartPlaces& at, const PairNode& node,
                                  const PairShared& x);

/// What a later row says. N = 3: with the fingers' centres.
template <int N>
PairEquations<N> row_equations(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                               const Alike& alike);

/// A finger that may be at one corner in several nodes in a row has pivoted there by one unknown angle, and they are
/// off alike, by their c_k times it. For each of them: what the others' c come to beside its own, S / c_k with S = sum
/// c_k. As (sum c_k e_k)^2 <= S sum c_k e_k^2, rows that are off on their own by c_k S are off by no less than that.
std::vector<Alike> pivots_of(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
                             const PairShared& x);

}  // namespace rollfix::belief
