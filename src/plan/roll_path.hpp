#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "roll/motion.hpp"
#include "roll/track.hpp"
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

}  // namespace rollfix::planning
