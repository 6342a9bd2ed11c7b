#pragma once

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "part/cursor.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix {

/// Where 1 + r kappa is not above this the disk is taken as too big: the contact would race along at more than 1e8
/// times its usual speed, and eqs. (1) and (2) lose all their digits.
inline constexpr double kLeastClearance = 1e-8;

/// A piece of a finger's way: it rolls along a spiral, or pivots in place at a convex corner, the part's or its own.
/// Arc lengths and angles are unwrapped: on the second lap s > P.
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
  const Spiral* finger_spiral = nullptr;  // of a finger's outline: that is rolled off meanwhile
  double finger_u_shift = 0;              // from the spiral's own arc length and angle to this lap's
  double finger_angle_shift = 0;
  bool is_finger_pivot = false;  // of a pivot: on a corner of the finger, whose upper spiral `finger_spiral` is; the
                                 // tangent stays, and `angle` is what it would be if the finger's normal stayed
};

/// A place of the way: which stretch, and where on it.
struct TrackPlace {
  std::int64_t index = 0;
  double s = 0;
};

/// The way of one finger along one part, piece by piece. It knows where the finger can't go, and says why.
class Track {
 public:
  Track(const Part& part, const Finger& finger) : part_(part), finger_(finger) {}
  virtual ~Track() = default;

  const Part& part() const { return part_; }
  const Finger& finger() const { return finger_; }

  /// The piece with this index. Indices grow with s; `next` tells which one follows.
  virtual Stretch stretch(std::int64_t index) const = 0;
  /// Theta and kappa of the part at s on this stretch, unwrapped.
  Turning turning(const Stretch& stretch, double s) const;

  /// The place s on the stretch that a finger is on when it leaves in this direction (+1 or -1): at a corner or a
  /// joint the one that lies ahead. Throws InputError where the finger can't be.
  virtual TrackPlace place(double s, int direction) const = 0;

  /// The stretch that follows in this direction; nothing where the finger can't go on, and `refuse` says why.
  virtual std::optional<std::int64_t> next(std::int64_t index, int direction) const = 0;
  [[noreturn]] virtual void refuse(std::int64_t index, int direction) const = 0;

  /// By how much the tangent falls where the way from one stretch to another passes the tiny concave joints of a
  /// drawing (kJointTurn), below 0 forwards and above it backwards. There the contact stays, and the finger turns back.
  /// Tiny joints of the finger's own outline count as well.
  virtual double fall_between(std::int64_t from, std::int64_t to) const = 0;

  /// Throws InputError unless the finger can roll from one place to the other; the tightest spot is named.
  virtual void require_way(double from, double to) const = 0;

  /// How far the finger has turned, up to a constant, when the contact is at s on this stretch and the tangent there
  /// points to angle: eq. (3), psi = Theta - N, of a disk Theta + s / r. It grows all along a way that the finger can
  /// go, but for falls.
  virtual double rotation(const Stretch& stretch, double s, double angle) const = 0;

  /// Of the finger where it touches at s on this stretch: 1 / r of a disk.
  virtual double finger_curvature(const Stretch& stretch, double s) const = 0;

  /// The first contact, at this place with this direction of the tangent.
  virtual Contact first_contact(const TrackPlace& place, double tangent, double psi) const = 0;

 private:
  const Part& part_;
  Finger finger_;
};

/// The way of a finger that first touches the part at s = start. `u`: where on the finger that is; a disk does not need
/// it. Throws InputError: no such finger, or no such place on it.
std::unique_ptr<Track> track_of(const Part& part, const Finger& finger, double start, std::optional<double> u);

/// The same of a disk or a jaw, which are alike all around: pivots (even index 2k) and spirals (odd index 2k + 1) in
/// turn, where spiral k starts at knot k. On a closed part k runs on over the laps.
class EvenTrack : public Track {
 public:
  EvenTrack(const Part& part, const Finger& finger, double u);

  Stretch stretch(std::int64_t index) const override;
  TrackPlace place(double s, int direction) const override;
  std::optional<std::int64_t> next(std::int64_t index, int direction) const override;
  [[noreturn]] void refuse(std::int64_t index, int direction) const override;
  double fall_between(std::int64_t from, std::int64_t to) const override;
  void require_way(double from, double to) const override;
  double rotation(const Stretch& /*stretch*/, double s, double angle) const override { return s / radius_ + angle; }
  double finger_curvature(const Stretch& /*stretch*/, double /*s*/) const override { return 1 / radius_; }
  Contact first_contact(const TrackPlace& place, double tangent, double psi) const override;

 private:
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

  /// The spiral that starts at knot k.
  Cursor after(std::int64_t k) const { return Cursor::at_spiral(turning_, k); }
  /// REQUIRES that s is on the part.
  Found find(double s, int direction) const;
  /// Throws InputError off the ends of an open part.
  void require_inside(double s) const;
  /// Above 0 where the finger fits; of a jaw, whose radius is infinite, the curvature in turns per lap.
  double clearance(double curvature) const;
  bool fits(double curvature) const { return clearance(curvature) > 0; }
  /// No stretch with this index: an open part's ends.
  bool ends_at(std::int64_t index) const;
  /// s, on the first lap, where the finger's reach on a spiral ends that fits at one end only.
  double limit_on(const Spiral& spiral) const;
  /// The knot within rounding of a place of the first lap.
  std::optional<std::int64_t> knot_at(double base) const;
  /// By how much Theta jumps at a knot, radians; 0 at a smooth one, and at the ends of an open part.
  double corner_turn(std::int64_t k) const { return ends_at(2 * k) ? 0 : corner_turns_[after(k).index()]; }
  /// Notes the tighter of both ends.
  void look_at(const Stretch& stretch, double lo, double hi, Tightest& tightest) const;
  [[noreturn]] void refuse_tight(const Tightest& tightest) const;
  [[noreturn]] void refuse_corner(double s, double turn) const;
  [[noreturn]] void refuse_end(double s) const;

  const TurningFunction& turning_;
  double radius_;  // infinite of a jaw
  double u_;       // of a jaw's first contact
  /// of all tiny concave joints, radians, 0 or below
  double fall_per_lap_ = 0;
  std::vector<double> corner_turns_;  // at the start of each spiral; 0: no corner
};

/// A plan made definite for one part: where it starts, and how the finger turns over time.
struct Motion {
  /// where the contact begins, and on which stretch
  TrackPlace start;
  double start_angle = 0;               // of the tangent
  Contact first;                        // what the sensors say there
  double duration = 0;                  // seconds
  double velocity = 0;                  // rad/s, where it is constant
  std::function<double(double)> omega;  // where it is not

  /// rad/s against the part
  double omega_at(double time) const { return omega ? omega(time) : velocity; }
};

/// Throws InputError: a plan that contradicts itself or that the finger can't follow.
Motion plan_motion(const Track& track, const RollPlan& plan);

/// Equal times from 0 to the end.
std::vector<double> times_of(const Motion& motion, std::size_t rows);

/// The integral of a rate from the first of these times to each.
std::vector<double> integrals(const std::function<double(double)>& rate, const std::vector<double>& times);

/// One instant of a roll.
struct RollState {
  /// u, and psi as seen in the part's frame
  Contact contact;
  double s = 0;
  double angle = 0;  // of the tangent
};

/// The roll at these times, in closed form.
std::vector<RollState> states_of(const Track& track, const Motion& motion, const std::vector<double>& times);

/// What the sensors say of a plan whose states are found so.
using Solve = decltype(&states_of);
Roll roll_with(Solve solve, const Part& part, const Finger& finger, const RollPlan& plan);
Roll roll_with(Solve solve, const Part& part, const FreePlan& plan);

inline constexpr std::array<const char*, 2> kFingerNames = {"finger a", "finger b"};

/// Says which finger an error is about.
template <class Action>
void naming(const char* finger, const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", finger, error.what()));
  }
}

/// Where a finger's contact is when the finger has turned so far.
struct Walked {
  double s = 0;
  double angle = 0;         // of the tangent, Theta
  double per_rotation = 0;  // ds per angle that the finger turns by; 0 while it pivots at a corner
};

/// Goes along a finger's track to where the finger has turned by a given amount: the inverse of Track::rotation.
class Walk {
 public:
  /// On the stretch with this index.
  Walk(const Track& track, std::int64_t index) : track_(track) { enter(index); }

  /// Throws InputError where the finger can't turn so far (Track::refuse); it can be asked for less then.
  Walked to(double rotation);

 private:
  void enter(std::int64_t index);
  void go(int direction);
  Walked solve(double rotation) const;

  const Track& track_;
  double fallen_ = 0;  // over the tiny concave joints of a drawing the finger turns back: by so much psi is behind
  /// the stretch that it is on, and its index
  std::int64_t index_ = 0;
  Stretch stretch_;
  /// psi at its ends
  Interval rotation_;
};

}  // namespace rollfix
