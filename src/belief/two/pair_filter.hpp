#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/nodes.hpp"
#include "belief/posterior.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/turning_function.hpp"

namespace rollfix::belief {

struct PairModel;

// What is wider than so many standard deviations of a contact has a flat middle between passings.
inline constexpr double kWide = 6;

/// A place of a first contact from where a node is at a corner, or at an open outline's end, with its standard
/// deviation.
struct Passing {
  double s = 0;
  double sd = 0;
};

/// All of one finger. Between two neighbours the likelihood is smooth: nearly constant, on flat sides; at each it
/// changes within the passing's standard deviation.
class Passings {
 public:
  Passings(const PairModel& model, std::size_t finger, const std::vector<PairNode>& nodes);

  bool empty() const { return passings_.empty(); }
  /// In order. REQUIRES on a closed outline: both on the first lap.
  std::span<const Passing> between(double lo, double hi) const;
  /// The least standard deviation of those within `reach` of s; infinite where there are none.
  double sharpest(double s, double reach) const;
  /// From the last one before s to the next after it, unwrapped as s is; infinite where there is none.
  Interval gap(double s) const;

 private:
  Boundary boundary_;
  std::vector<Passing> passings_;  // in order
};

/// Does it turn by more than the noise of the facing?
bool is_felt(const PairModel& model, const Corner& corner);

/// Two first contacts on trial, each by its tilted turning: at a convex corner that tells how far it has pivoted.
struct PairStart {
  std::array<const TiltedArc*, 2> arc{};
  std::array<double, 2> w{};
};

/// What it is worth: minus twice the logarithm of the likelihood is cost + log_volume, up to what is the same
/// everywhere.
struct PairScore {
  double cost = 0;
  double direct_cost = 0;  // with the errors about which it was linearised: more than the cost, unless that served
                           // badly
  double log_volume = 0;
  double log_gathered = 0;  // see RollFilter
  std::array<Whiteness, 3> whiteness;
  double right_rows = 0;                                  // robust: that are no outliers, ...
  double right_cost = 0;                                  // ... and their part of the cost
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();        // of the log-likelihood by (w_a, w_b), the volume's left out
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // expected, by them
  PairShared errors = PairShared::Zero();
  PairSharedCovariance covariance = PairSharedCovariance::Zero();
  Eigen::Matrix<double, 5, 2> errors_by_start = Eigen::Matrix<double, 5, 2>::Zero();

  double log_likelihood() const { return -0.5 * (cost + log_volume); }
};

/// How much time an answer is worth.
enum class Effort {
  whole,
  trial,    // of one of many explanations, or where rows fit badly: what they say may be widened without end
  hopeless  // nothing fits, and no place is listed
};

/// What all hypotheses have in common.
struct PairModel {
  const PairErrors* errors = nullptr;
  std::array<const TiltedBoundary*, 2> boundary{};
  std::array<const Passings*, 2> passings{};  // of the nodes, where the part has corners or ends
  const BoundaryPath* path = nullptr;         // where centres are looked at
  PairShared gathered = PairShared::Zero();   // variances of what gathers over the whole roll
  double outlier_share = 0;                   // of rows whose turn is anything
  std::optional<Prior> prior;                 // of finger a's first contact
  std::optional<PosePrior> pose;              // of the part at the first contacts, ...
  std::array<MeasuredContact, 2> first{};     // ... as they were felt
  const Part* part = nullptr;
  Boundary places;
  Effort effort = Effort::whole;
  Innovations* kept = nullptr;  // where the last pass's go, if they are asked for

  double perimeter() const { return places.perimeter; }
};

/// The likelihood of two first contacts: a Kalman filter of the errors that the whole roll shares, linearised about
/// what they come out as (an iterated one: Gauss-Newton), or where they drift about its own estimate as it goes.
/// `guess`: of the shared errors; passes go on until it agrees with what comes out, at most `most_passes`.
PairScore score_of(const PairModel& model, const PairStart& start, const std::vector<PairNode>& nodes,
                   const PairShared& guess, int most_passes);

/// The angle nearest to 0 that is the same: std::remainder, but for rounding, and faster.
inline double nearest_to_zero(double angle) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle - kTurn * std::floor(angle / kTurn + 0.5);
}

/// A row as N equations f = 0, linear in the shared errors x and the start w about the point of linearisation: of the
/// turn, and with the centres of their distance and direction as well.
template <int N>
struct PairEquations {
  Eigen::Matrix<double, N, 1> f = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, 5> by_errors = Eigen::Matrix<double, N, 5>::Zero();
  Eigen::Matrix<double, N, 2> by_start = Eigen::Matrix<double, N, 2>::Zero();
  Eigen::Matrix<double, N, N> variance = Eigen::Matrix<double, N, N>::Zero();  // of the row on its own
  std::array<double, 2> w{};                                                   // of both contacts, where they fit best
  // How far each contact is past an arc's end, SpreadPlace::beyond; and that by w.
  Eigen::Vector2d past = Eigen::Vector2d::Zero();
  Eigen::Vector2d past_by_start = Eigen::Vector2d::Zero();
};

/// Where the first contacts are.
struct StartPlaces {
  std::array<const TiltedArc*, 2> arc{};
  std::array<double, 2> w{};
  std::array<TiltedPlace, 2> place;
  std::array<double, 2> angle{};     // of the tangents
  std::array<double, 2> by_start{};  // of them by w
};

StartPlaces places_of(const PairModel& model, const PairStart& start);

/// What the first contacts say of how the fingers face. N = 3: with their centres.
template <int N>
PairEquations<N> facing_equations(const PairModel& model, const StartPlaces& at, const PairNode& node,
                                  const PairShared& x);

/// What a later row says. N = 3: with the fingers' centres. `open`: of x, as far as it is known, where slip leaves the
/// places open; nullptr: linearised at x itself. `before`: w of the contacts in the row before.
template <int N>
PairEquations<N> row_equations(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                               const PairSharedCovariance* open, const std::array<double, 2>& before);

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

// Where no contact tells w_a, both being at corners, it is known to this; radians.
inline constexpr double kPivot = 0.3;

}  // namespace rollfix::belief
