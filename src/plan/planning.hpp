#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "roll/motion.hpp"
#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"

namespace rollfix::planning {

// Notation:
//   x             how far a finger has turned against the part since its first contact: `turned`. With eq. (2)
//                 dx = (kappa + k) ds, k being the finger's curvature; at a corner s stays and dx = dTheta
//   s, Theta, p   the contact's place, the tangent's angle and the point there, in the part's frame
//   c             where the origin of the finger's frame is, in the part's frame
// Idea: x grows all along a way that the finger can go, over corners as well, so that it names each contact once.

/// One contact of a finger with the part, as the part sees it.
struct ContactPlace {
  double turned = 0;           // x
  double s = 0;                // unwrapped
  double angle = 0;            // Theta, unwrapped
  Contact contact;             // u, and psi against the part
  Vec2 point = Vec2::Zero();   // p
  Vec2 centre = Vec2::Zero();  // c

  double inward() const;  // direction of the normal into the part
};

/// How far the tangent can turn between two contacts of a way, at most: Theta = x - N, both monotone.
double turn_between(const ContactPlace& one, const ContactPlace& two);

/// All contacts that a finger can roll to from its first one.
class ContactWay {
 public:
  /// Throws InputError where the finger can't be at its start, or can't roll its length.
  ContactWay(const Part& part, const PlanFinger& finger, double heading);

  const Finger& finger() const { return track_->finger(); }
  const Part& part() const { return track_->part(); }

  /// x after this travel of the contact. Throws InputError where the finger can't go there.
  double turned_after(double length) const;

  /// As far as the finger can roll in this direction (+1 or -1), but not beyond `most`: a length, of the sign.
  double furthest(int direction, double most) const;

  /// The contacts at these turns x, in any order. Throws InputError where the finger can't be.
  std::vector<ContactPlace> places(const std::vector<double>& turned) const;

  /// 1 / r, 0 of a jaw: the finger's where it touches.
  double finger_curvature(const ContactPlace& place) const { return finger().curvature(place.contact.u); }

  /// x from lo to hi so close together that neither x nor s makes a step that matters; both ends included, and 0 where
  /// it lies between. `steps`: at least so many.
  std::vector<double> nodes(double lo, double hi, std::size_t steps) const;

 private:
  Motion motion(double length) const;

  /// s of the first contact
  double start_;
  /// against the part
  double psi_;
  /// of the first contact on the finger; a disk does not need it
  std::optional<double> u_;
  std::unique_ptr<Track> track_;
  Motion from_start_;  // at 1 rad/s: time is x
};

/// Where both contacts are; of one finger only a's.
struct PairPlace {
  double at = 0;  // lambda
  ContactPlace a;
  ContactPlace b;
};

/// Turned against the part: of each finger, or its rate by lambda.
struct Turned {
  double a = 0;
  double b = 0;
};

/// How both fingers roll: their turns x, y against the part as functions of lambda in [0, 1], monotone between nodes
/// and with a continuous derivative (Fritsch and Butland 1984). Beside a wheel y is what balances it, B = 0.
class RollPath {
 public:
  /// `b`: nullptr of one finger. `knots`: from 0 to 1, growing. `squeezed`: beside a wheel; then b at the knots is
  /// balanced, and between neighbours it is balanced once.
  RollPath(const ContactWay& a, const ContactWay* b, std::vector<double> knots, std::vector<Turned> turned,
           bool squeezed = false);

  const ContactWay& way_a() const { return *a_; }
  const ContactWay* way_b() const { return b_; }
  bool squeezed() const { return squeezed_; }
  const std::vector<double>& knots() const { return knots_; }

  /// `at`: values of lambda, in any order.
  std::vector<PairPlace> places(const std::vector<double>& at) const;
  std::vector<Turned> rates(const std::vector<double>& at) const;

 private:
  struct Cubic;
  struct Piece;
  Piece piece_at(double lambda) const;
  std::vector<Turned> turned(const std::vector<double>& at) const;

  const ContactWay* a_;
  const ContactWay* b_;
  std::vector<double> knots_;
  /// at the knots
  std::vector<Turned> turned_;
  /// of both turns by lambda, at the knots
  std::vector<Turned> slopes_;
  bool squeezed_;
};

/// A finger's turn y beside which a wheel is in balance, for each turn x of finger a: B(x, y) = 0 between lo and hi,
/// where B has different signs. By regula falsi with Illinois' correction, all at once.
std::vector<double> balanced(const ContactWay& a, const ContactWay& b, const std::vector<double>& x,
                             std::vector<double> lo, std::vector<double> hi);

// Notation:
//   p, q          the contacts of fingers a and b in the part's frame: places s and t
//   D             |q - p|
//   A             angle from the inward normal at p to the way to q; B from that at q to the way to p: `at_a`, `at_b`.
//                 Where the fingers press apart, to the opposite ways
// Two forces alone are in balance only on the line through both contacts, equal and opposite: finger a must be able to
// press under A, finger b under B, and |tan| of each be at most the friction there. A wheel's force goes through its
// pin: B = 0.

/// How two fingers press on the part at one instant.
struct Squeeze {
  double at_a = 0;      // A, radians, in (-pi, pi]
  double at_b = 0;      // B
  double distance = 0;  // D
};

/// `expanding`: they press apart.
Squeeze squeeze_of(const ContactPlace& a, const ContactPlace& b, bool expanding);

/// How far apart two fingers are, below 0 by how much they are in one another; nothing of two jaws, which without ends
/// would always meet somewhere. `enough`: a distance of no less than this needs not be exact.
std::optional<double> gap_between(const Finger& finger_a, const ContactPlace& a, const Finger& finger_b,
                                  const ContactPlace& b, double enough = std::numeric_limits<double>::infinity());

/// How much that can change, at most, from one contact of both to others, where each rolls from the one to the other.
double gap_change(const Finger& finger_a, const ContactPlace& a, const ContactPlace& next_a, const Finger& finger_b,
                  const ContactPlace& b, const ContactPlace& next_b);

/// What a finger is about as large as: a disk's radius, an outline's perimeter over a whole turn; of a jaw 0.
double size_of(const Finger& finger);

// Notation:
//   K             kappa(s) + the curvature of finger a: both bend away from each other
//   r, kappa      radius of the wheel, and the part's curvature where it touches
//   D, d          distance of the contacts, and Theta(t) - Theta(s)
//   w             1 / (1 + K (D + r)): `share`
// While finger a rests, part and wheel can roll together with one freedom, and the pin is lifted by half of
// K [ |cos d| + K (D + r) (1 - kappa D) / (1 + r kappa) ] (ds)^2: above 0 the balance is stable. What stands in the
// brackets, times w, is w |cos d| + (1 - w) b with b = (1 - kappa D) / (1 + r kappa), which has a limit at corners,
// where K or kappa are infinite: w = 0, b = -D / r.

/// That, of a part squeezed between finger a and a wheel. At joints and corners the worst of all sides.
double stability_of(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& place);

/// A lower bound of it all the way between two instants of a path, where each contact goes one way.
double stability_between(const ContactWay& way_a, const ContactWay& way_b, const PairPlace& one, const PairPlace& two);

/// Half the angle of a finger's friction cone, radians: a right angle where its friction is not known, 0 of a wheel.
double cone_of(const PlanFinger& finger);

/// One condition all along a path: what is left where it is worst.
struct Looked {
  PlanMargin margin;  // without its time and row
  double at = 0;      // lambda
};

/// What two fingers' contacts say of friction, of fingers that enter each other, and of the balance on a wheel. Between
/// instants it is proved.
struct SqueezeLook {
  std::vector<Looked> looked;
  PerFinger<double> tilt;  // the largest angle of the force to each normal, radians
  /// false: a margin is too near 0 to be proved
  bool decided = true;
};
SqueezeLook look_at_squeeze(const PlanProblem& problem, const RollPath& path, bool expanding);

/// Where a finger would enter the part; nothing: nowhere. `which`: 0 for finger a.
std::optional<Looked> look_at_reach(const Reach& reach, const RollPath& path, std::size_t which);

/// A path made a motion of the fingers and the part, in time from 0 to 1: how far along the path, rest at both ends.
double eased(double time);
/// Its derivative by time.
double eased_rate(double time);
/// Its inverse.
double time_of(double along);

/// One instant of the motion: where each body's frame is, and its rates by time.
struct BodyState {
  Pose pose;
  /// of the frame's origin, length per time
  double vx = 0;
  double vy = 0;
  /// radians per time
  double omega = 0;
};
struct MotionState {
  /// both contacts, in the part's frame
  PairPlace place;
  BodyState part;
  PerFinger<BodyState> finger;
  double force = 0;  // direction in which finger a presses
};

/// The motion at these times; rates are by a time in which the whole roll takes 1.
std::vector<MotionState> motion_at(const PlanProblem& problem, const RollPath& path, const std::vector<double>& times,
                                   bool expanding);

/// Which duration the limits, or what is usual, ask for; then what the limits leave.
double duration_of(const PlanProblem& problem, const std::vector<MotionState>& states);
std::vector<Looked> look_at_limits(const PlanProblem& problem, const std::vector<MotionState>& states,
                                   const std::vector<double>& times, double duration);

/// Rows of the plan at equal times.
void write_rows(const PlanProblem& problem, const RollPath& path, bool expanding, Plan& plan);

/// What a search for a path is asked.
struct PathQuestion {
  /// both ways have to outlive the search
  const ContactWay* a = nullptr;
  const ContactWay* b = nullptr;
  double goal_a = 0;                                                       // x at the end, not 0
  std::optional<double> goal_b;                                            // y at the end; nothing: any
  Interval range_b;                                                        // of y, 0 and the goal inside
  std::function<double(const ContactPlace&, const ContactPlace&)> margin;  // radians, of what is to be kept largest
};

/// A path from both first contacts: its knots in [0, 1] and both turns there.
struct FoundPath {
  /// lambda, from 0 to 1, growing
  std::vector<double> knots;
  /// x and y at the knots
  std::vector<Turned> turned;
};

/// The path whose worst margin is largest, up to the grid's step, and of those with that margin a short one that keeps
/// off the edges where it can. Finger a always rolls on, finger b may turn back.
FoundPath widest_path(const PathQuestion& question);

/// Both turn at a constant ratio.
FoundPath even_path(const ContactWay& a, double goal_a, const ContactWay* b, double goal_b);

/// The path beside a wheel that is balanced at y = start: as far as x = goal, or until it turns back.
struct BalancedPath {
  /// up to the goal, or to where the wheel turns back
  FoundPath path;
  bool turns_back = false;  // before the goal: at the last knot
};
BalancedPath balanced_path(const ContactWay& a, double goal_a, const ContactWay& b, double start,
                           const Interval& range_b);

/// All y in the range at which a wheel is in balance at finger a's first contact.
std::vector<double> balances(const ContactWay& a, const ContactWay& b, const Interval& range_b);

/// Throws InputError: a problem that contradicts itself, or numbers that are none.
void require_valid(const PlanProblem& problem);

/// "finger a", of one finger "the finger".
const char* name_of_finger(const PlanProblem& problem, std::size_t which);

/// The same problem as a mirror shows it, x with the other sign: there a part that lies face down lies as it was drawn.
PlanProblem in_mirror(const PlanProblem& problem);

/// Back again. `seen`: the problem in the mirror.
void out_of_mirror(const PlanProblem& seen, Plan& plan);

}  // namespace rollfix::planning
