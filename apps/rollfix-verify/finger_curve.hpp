#pragma once

#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "boundary.hpp"

namespace rollfix_verify {

/// w . v
inline Ball weighted(const std::vector<Ball>& weights, const std::vector<Ball>& values) {
  return std::inner_product(weights.begin(), weights.end(), values.begin(), Ball(0.0));
}

/// The tangent's angles at all contacts of one finger while its first contact moves, or while it pivots.
/// Notation: contact c is at s + L_c, L_0 = 0, its angle Theta_c(s) = Theta(s + L_c).
struct Stretch {
  double lo = 0;  // first contacts, s
  double hi = 0;
  bool pivot = false;       // at one place to kSamePlace: each contact's angle is anywhere in its range, on its own
  std::size_t pivots = 0;   // how many contacts are at a corner that is not concave
  std::vector<Ball> from;   // the angle of each contact at lo, the first contact's first; of a pivot its range
  std::vector<Ball> to;     // at hi; of a pivot unused
  std::vector<Ball> rate;   // its curvatures in between; of a pivot unused
  std::vector<Ball> jump;   // what it turns at smooth joints in between, at most and at least
  std::vector<Ball> range;  // the angle in between, where more is known than by the rates; of a pivot unused
  mutable std::shared_ptr<const std::pair<Stretch, Stretch>> halves;  // once somebody has asked for them

  double width() const { return hi - lo; }
  /// How much an angle changes at the most.
  double change() const;
  /// The contact that pivots: whose range is the widest.
  std::size_t widest() const;
  /// How far a contact turns from end to end; of a pivot the one that pivots.
  double turn(std::size_t contact) const;
  /// A contact's angle anywhere on the stretch.
  Ball angle(std::size_t contact) const;
  /// What a sum of the angles is, each with its weight, anywhere on the stretch.
  Ball sum(const std::vector<Ball>& weights) const;
  /// The same as the straight way from the one end to the other, which it leaves by no more than `off`.
  struct Chord {
    Ball from;
    Ball to;
    Ball off;
  };
  Chord chord(const std::vector<Ball>& weights) const;
};

/// What one finger's readings come to: the angles Theta(s + L_k) for all its first contacts s, L_0 = 0.
class FingerCurve {
 public:
  FingerCurve(const Boundary& boundary, std::vector<Ball> lengths)
      : boundary_(boundary), lengths_(std::move(lengths)), period_(boundary.perimeter().middle()) {}

  enum class Cuts { corners, bends };  // bends: and where the curvature jumps

  /// All first contacts from lo to hi: cut at each that brings a contact to a corner, with what happens there in
  /// between. Throws std::domain_error where that can't be told. What it returns is valid until the next call.
  const std::vector<Stretch>& over(double lo, double hi, Cuts cuts = Cuts::corners);

  /// All first contacts from lo to hi as one; nothing where a contact comes to a corner.
  std::optional<Stretch> plain(double lo, double hi) const;

  /// Both halves, kept for the next one who asks.
  const std::pair<Stretch, Stretch>& halved(const Stretch& stretch);

 private:
  /// Where all contacts are with the first one at s. Throws std::domain_error where that can't be told.
  std::vector<Place> places(double& s, int way) const;
  /// A first contact that brings a contact to a joint.
  struct Cut {
    double s = 0;
    bool is_corner = false;
  };
  /// The cuts of all contacts, by rising s.
  std::vector<Cut> cuts_between(double lo, double hi, Cuts cuts) const;
  /// The first contacts from lo to hi, among which there is no cut.
  Stretch smooth(double lo, double hi) const;
  /// Bounds on a contact's angle over some segments; unknown where the curvature changes its sign.
  Ball range_of(const std::vector<Segment>& all, const Ball& curvature) const;
  /// One place with contacts at corners: a stretch for each choice of their angles' sets.
  std::vector<Stretch> at_corner(double lo, double hi) const;

  const Boundary& boundary_;
  std::vector<Ball> lengths_;  // of each contact from the first one, 0 among them
  double period_;              // the perimeter
  std::map<std::tuple<double, double, Cuts>, std::vector<Stretch>> known_;
  std::size_t kept_ = 0;  // about how many stretches that makes
};

}  // namespace rollfix_verify
