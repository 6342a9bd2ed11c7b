#pragma once

#include <Eigen/Core>
#include <array>
#include <memory_resource>
#include <numbers>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::belief {

/// How far a finger has travelled, told by lengths that are noisy. The steps from each length to the next add up to
/// what the finger travelled and to all the noise besides: of n rows at rest to 2 n sd / sqrt(pi). So a length is
/// compared with the last one that is farther off than noise can make it; what lies between is spread evenly over the
/// rows between, and is not given out twice.
class Travel {
 public:
  /// A length that was measured, of as many rows as were joined for it.
  struct Mark {
    double row = 0;       // their number, the middle one's
    double length = 0;    // from the first contact
    double variance = 0;  // of that, the mark's own
  };

  /// `first`: the first contact. `per_row`: what the variance of a difference of lengths grows by with every row
  /// between them, as where lengths are sums of increments.
  Travel(const Mark& first, double per_row, std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : marks_({first}, memory), so_far_({0.0}, memory), per_row_(per_row) {}

  /// From the last mark to this one: length, at least 0.
  double since_last(const Mark& mark) const;
  /// The same, and this one is the last mark from now on.
  double add(const Mark& mark);
  /// From the first contact to the last mark.
  double so_far() const { return so_far_.back(); }
  /// Takes all marks away but the first contact.
  void restart();

 private:
  std::pmr::vector<Mark> marks_;
  std::pmr::vector<double> so_far_;  // from the first contact to each of them
  double per_row_;
};

/// Errors of one row on its own: variances of length and turn.
struct RowCovariance {
  double length = 0;
  double both = 0;
  double turn = 0;
};

/// Of (length, turn).
inline Eigen::Matrix2d matrix_of(const RowCovariance& covariance) {
  return (Eigen::Matrix2d() << covariance.length, covariance.both, covariance.both, covariance.turn).finished();
}
inline RowCovariance operator*(double factor, const RowCovariance& covariance) {
  return {factor * covariance.length, factor * covariance.both, factor * covariance.turn};
}
inline RowCovariance operator+(const RowCovariance& a, const RowCovariance& b) {
  return {a.length + b.length, a.both + b.both, a.turn + b.turn};
}

/// How far the sensors of a finger are off, which of their errors a row has on its own and which a roll gathers: the
/// same for one finger and for each of two. docs/belief.md derives it.
struct SensorErrors {
  SensorErrors(const BeliefOptions& options, LogKind kind, double perimeter);

  /// Of the scale of lengths: slip all along, and a radius that is off by a share has every length off by it.
  double scale_variance(double finger_curvature, bool is_open = true) const;  // is_open: see BeliefOptions::scale_sd
  /// The noise is to be taken this many times as large: filters take slip to be small, and its errors to be normal.
  double for_large_slip() const;
  /// What slips among rows that are joined over this length leaves of their mean open, besides what gathers.
  RowCovariance bent(double travelled) const;
  /// Of the length, and of the turn, that is gathered on the way over a length, in these seconds from the start.
  double slipped(double length) const;
  double drifted(double length, const Interval& seconds) const;
  /// The same without what a bias makes, which is one and the same all along.
  double wandered(double length, const Interval& seconds) const;
  /// As many rows' worth as so many are that a finger travels over this length for: fewer where rows close together are
  /// off alike.
  double worth(double travelled, double rows) const;
  /// Of a log's lengths.
  Travel travel(std::pmr::memory_resource* memory) const;
  /// Of a tangent's direction, as the part's outline has it.
  double part_variance() const { return noise.part.turn * noise.part.turn; }
  /// Among so many rows, spread over so much of the boundary, the number that the part's outline is off for alike: each
  /// tells of it only its share, and counts as if its own error were so many times larger.
  double rows_alike(double rows, double range) const;

  bool gathers_rows() const { return kind == LogKind::increments; }  // every row adds its own to all that follow
  /// Anything but slip gathers.
  bool gathers() const { return gathers_rows() || drifts() || noise.part.walk > 0; }
  bool drifts() const { return !bare && (noise.drift > 0 || noise.walk > 0 || is_gyroscope()); }
  /// Slip is one and the same over this length.
  double patch() const;
  bool is_gyroscope() const { return kind == LogKind::travelled && !bare; }

  LogKind kind;  // which sensors measured lengths and turns
  bool bare;     // exact first contacts, no drift
  Noise noise;
  double scale_sd;             // see BeliefOptions
  double contact_variance;     // of a contact's place
  double angle_variance;       // of a finger's orientation
  double row_share;            // of both, what a row has on its own: of increments the part that is under way
  double perimeter;            // P, length
  double slip_here_and_there;  // over short stretches, per length
};

/// Errors that a whole roll of one finger shares: of a length and of a turn as measured, of the scale of lengths, of a
/// gyroscope's scale, of its rate (its bias), of the centre as it is known at the first contact, x and y, and of the
/// turn as it was offset at the first contact: what gathers on the way is in the second alone.
inline constexpr int kShared = 8;
using Shared = Eigen::Matrix<double, kShared, 1>;
using SharedCovariance = Eigen::Matrix<double, kShared, kShared>;
/// The first of them, which lengths and turns tell of, ...
inline constexpr int kRolling = 5;
/// ... and of those the ones that a log has whose gyroscope is not biased, and one to which no gyroscope belongs.
inline constexpr int kWithoutBias = 4;
inline constexpr int kWithoutGyroscope = 3;

/// Variances of length and turn that gather on the way.
struct Gathered {
  double length = 0;
  double turn = 0;
};

// Of an angle, radians: from about here on what rows share is seen to be out of line where the boundary bends.
inline constexpr double kWideAngle = 0.004;

/// How the noise enters the measured length and turn of one finger's roll. Measured are
///   L (1 + scale) + offset of length + the row's own,   theta + gyroscope's scale * what it turned + bias * seconds +
///   offset of turn + the row's own.
class ErrorModel {
 public:
  /// `finger_curvature`: of the finger where it first touched.
  ErrorModel(const BeliefOptions& options, LogKind kind, double finger_curvature, double perimeter);

  /// Of the shared errors before the first row.
  const SharedCovariance& start() const { return start_; }
  /// Of a centre's coordinate, each row on its own; 0: centres are not looked at.
  double centre_variance() const { return sensor_.noise.position * sensor_.noise.position; }
  bool gathers_rows() const { return sensor_.gathers_rows(); }
  /// As far as the scale's variance is that of a wrong radius.
  double radius_share(double finger_curvature) const;
  double worth(double travelled, double rows) const { return sensor_.worth(travelled, rows); }
  RowCovariance bent(double travelled) const { return sensor_.bent(travelled); }
  double for_large_slip() const { return sensor_.for_large_slip(); }
  Travel travel(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) const {
    return sensor_.travel(memory);
  }
  /// Over less than this length what gathers is one and the same.
  double patch() const { return sensor_.patch(); }
  /// Of the boundary as a whole.
  double turn_per_length() const { return 2 * std::numbers::pi / sensor_.perimeter; }
  /// Angles are too noisy for one look at every row to do.
  bool is_wide() const { return start_(1, 1) > kWideAngle * kWideAngle || has_gyroscope_scale() || has_bias(); }
  bool has_gyroscope_scale() const { return start_(3, 3) > 0; }
  bool has_bias() const { return start_(4, 4) > 0; }
  /// Of a row on its own, with the finger's curvature where it touches, and so many rows that the part is off for
  /// alike.
  RowCovariance row(double finger_curvature, double alike = 1) const;
  double rows_alike(double rows, double range) const { return sensor_.rows_alike(rows, range); }
  /// What the offsets gather over so many rows that travel over this length, in these seconds from the roll's start.
  Gathered gathered(double travelled, double rows, const Interval& seconds) const;

 private:
  SensorErrors sensor_;                                // of this finger's log
  SharedCovariance start_ = SharedCovariance::Zero();  // P0
};

/// Errors that two fingers' whole roll shares: of a's and b's lengths as measured, of the scales of both, and of the
/// turn as measured.
using PairShared = Eigen::Matrix<double, 5, 1>;
using PairSharedCovariance = Eigen::Matrix<double, 5, 5>;

/// How the noise enters two fingers' lengths and turn; docs/two_fingers.md derives it.
class PairErrors {
 public:
  /// `finger_curvature`: of both disks; 0 where it is not known or a jaw. `facing`: the first contacts' facing is
  /// known.
  PairErrors(const BeliefOptions& options, LogKind kind, const std::array<double, 2>& finger_curvature, bool facing,
             double perimeter);

  /// Of the shared errors before the first row.
  const PairSharedCovariance& start() const { return start_; }
  /// What they gather, on their diagonal, over so many rows that travel over these lengths.
  PairShared gathered(double rows, const std::array<double, 2>& travelled) const;
  /// They gather anything: then no one value of them serves all rows.
  bool drifts() const;
  bool gathers_rows() const { return sensor_.gathers_rows(); }

  /// Rows say where the tangents point against each other, not only how that has changed since the first.
  bool absolute() const { return absolute_; }
  double turn_variance() const { return turn_variance_; }        // of a row's turn, on its own
  double contact_variance() const { return contact_variance_; }  // of a row's length, on its own
  double contact_sd() const;
  double facing_variance() const { return 2 * sensor_.angle_variance + part_variance(); }
  /// Of the difference of two tangents' directions, as the part's outline has it.
  double part_variance() const { return 2 * sensor_.part_variance(); }
  double rows_alike(double rows, double range) const { return sensor_.rows_alike(rows, range); }
  /// With the place u, its error turns the normal that it tells: 1/r for logs of u, else 0.
  double normal_turn(std::size_t finger) const { return normal_turn_[finger]; }
  double worth(double travelled, double rows) const { return sensor_.worth(travelled, rows); }
  double for_large_slip() const { return sensor_.for_large_slip(); }
  Travel travel(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) const {
    return sensor_.travel(memory);
  }
  /// Of a centre's coordinate, each row on its own; 0: centres are not looked at.
  double centre_variance() const { return sensor_.noise.position * sensor_.noise.position; }
  double angle_variance() const { return sensor_.angle_variance; }  // of one finger's orientation, each row on its own
  double perimeter() const { return sensor_.perimeter; }

 private:
  SensorErrors sensor_;                                        // of either finger
  bool absolute_;                                              // see absolute()
  double contact_variance_;                                    // length^2
  double turn_variance_;                                       // of both fingers' orientations, radians^2
  std::array<double, 2> normal_turn_{};                        // see normal_turn()
  PairSharedCovariance start_ = PairSharedCovariance::Zero();  // P0
};

}  // namespace rollfix::belief
