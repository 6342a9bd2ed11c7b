#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// Where 1 + r kappa is not above this the disk is taken as too big: the contact would race along at more than 1e8
/// times its usual speed, and eqs. (1) and (2) lose all their digits.
inline constexpr double kLeastClearance = 1e-8;

/// A piece of a finger's way: it rolls along a spiral, or pivots in place at a convex corner. Arc lengths and angles
/// are unwrapped: on the second lap s > P.
struct Stretch {
  bool is_pivot = false;
  const Spiral* spiral = nullptr;  // that it rolls along, or that starts at the corner
  double s_shift = 0;              // from the spiral's own arc length and angle to this lap's
  double angle_shift = 0;
  Interval whole;       // s at its ends
  Interval s;           // where the finger fits: all of it, or what is left at one end of a spiral that is too concave
  Interval angle;       // of the tangent at the ends of `s`
  bool fits_lo = true;  // at the ends of `whole`
  bool fits_hi = true;
};

/// A place of the way: which stretch, and where on it.
struct TrackPlace {
  std::int64_t index = 0;
  double s = 0;
};

/// The way of one finger around one part: pivots (even index 2k) and spirals (odd index 2k + 1) in turn, where spiral
/// k starts at knot k. On a closed part k runs on over the laps. It knows where the finger can't go, and says why.
class Track {
 public:
  Track(const Part& part, const DiskFinger& finger);

  const Part& part() const { return part_; }
  double radius() const { return radius_; }

  Stretch stretch(std::int64_t index) const;
  Turning turning(const Stretch& stretch, double s) const;

  /// The place s on the stretch that a finger is on when it leaves in this direction (+1 or -1): at a corner or a
  /// joint the one that lies ahead. Throws InputError where the finger can't be.
  TrackPlace place(double s, int direction) const;

  /// The stretch that follows in this direction; nothing where the finger can't go on, and `refuse` says why.
  std::optional<std::int64_t> next(std::int64_t index, int direction) const;
  [[noreturn]] void refuse(std::int64_t index, int direction) const;

  /// By how much the tangent falls where the way from one stretch to another passes the tiny concave joints of a
  /// drawing (kJointTurn), below 0 forwards and above it backwards. There the contact stays, and the finger turns back.
  double fall_between(std::int64_t from, std::int64_t to) const;

  /// Throws InputError unless the finger can roll from one place to the other; the tightest spot is named.
  void require_way(double from, double to) const;

  /// How far the finger has turned, up to a constant, when the contact is at s and the tangent there points to angle:
  /// the sum of eq. (3), psi = Theta + s / r. It grows all along a way that the finger can go, but for falls.
  double rotation(double s, double angle) const { return s / radius_ + angle; }

 private:
  struct Knot {
    std::size_t index = 0;  // of the spiral that starts there
    double lap = 0;
  };
  /// The sharpest concavity that was met: one of the two ends of a spiral.
  struct Tightest {
    double s = 0;
    double curvature = 0;
  };

  /// A place without any check, and the knot that it is, if it is one.
  struct Found {
    TrackPlace place;
    std::optional<std::int64_t> knot;
  };

  Knot knot(std::int64_t k) const;
  Found find(double s, int direction) const;
  void require_inside(double s) const;
  bool fits(double curvature) const { return 1 + radius_ * curvature > kLeastClearance; }
  bool ends_at(std::int64_t index) const;
  double limit_on(const Spiral& spiral) const;
  std::optional<std::int64_t> knot_at(double base) const;
  double corner_turn(std::int64_t k) const { return ends_at(2 * k) ? 0 : corner_turns_[knot(k).index]; }
  double named(double s) const;
  void look_at(const Stretch& stretch, double lo, double hi, Tightest& tightest) const;
  [[noreturn]] void refuse_tight(const Tightest& tightest) const;
  [[noreturn]] void refuse_corner(double s, double turn) const;
  [[noreturn]] void refuse_end(double s) const;

  const Part& part_;
  const TurningFunction& turning_;
  double radius_;
  double fall_per_lap_ = 0;
  std::vector<double> corner_turns_;  // at the start of each spiral; 0: no corner
};

}  // namespace rollfix
