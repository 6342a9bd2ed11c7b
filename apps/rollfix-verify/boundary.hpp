#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convex.hpp"
#include "formulas.hpp"

namespace rollfix_verify {

/// A place on the boundary. On a closed one curves are counted on from lap to lap, and so are s and the angle.
struct Place {
  long curve = 0;
  Ball u;      // the curve's parameter
  Ball s;      // arc length from the first point
  Ball angle;  // of the tangent, from that at s = 0
};

/// Up to here a joint is smooth, radians: one crossing is one up to jumps of that size.
inline constexpr double kSmooth = 1e-12;
/// A concave joint turns by at least this, radians; at others the finger pivots: the angle takes every value in
/// between.
inline constexpr double kConcave = 1e-3;

/// An outline by its own formulas, with arc length and the tangent's angle as Taylor polynomials whose remainders are
/// bounded.
class Boundary {
 public:
  /// Throws std::runtime_error: what is no regular chain of curves.
  Boundary(std::vector<Formula> curves, bool closed);

  bool closed() const { return closed_; }
  long curves() const { return static_cast<long>(curves_.size()); }
  const Ball& perimeter() const { return starts_.back().s; }
  const Ball& total_turn() const { return starts_.back().angle; }
  double largest_gap() const { return largest_gap_; }  // between neighbouring curves

  /// The place of a curve's parameter, on the first lap.
  Place at(long curve, double u) const;
  /// The place that far along; none where that can't be told from a joint or an end.
  std::optional<Place> after(const Ball& s) const;
  /// The same; of an open outline the end where that is not clear before it.
  std::optional<Place> after_or_end(const Ball& s) const;
  Point position(const Place& place) const { return formula(place.curve).position(place.u); }
  Point velocity(const Place& place) const { return formula(place.curve).velocity(place.u); }

  /// The same place so many laps on.
  Place moved(Place place, long laps) const;
  /// Where a counted curve starts and ends.
  Place front(long curve) const;
  Place back(long curve) const;
  /// How far the tangent turns where a curve ends and the next begins, in (-pi, pi).
  Ball jump(long curve) const { return jumps_[index(curve)]; }

  /// Whether a curve has no speed where it ends, or the next one where it begins. There angles change as fast as at a
  /// corner.
  bool is_at_rest(long curve) const { return at_rest_[index(curve)]; }
  bool turns(long curve) const { return !abs(jump(curve)).is_below(kSmooth); }
  bool is_corner(long curve) const { return turns(curve) || is_at_rest(curve); }
  /// Whether it is a corner to the concave side for sure: then a finger has none of the angles in between.
  bool is_concave(long curve) const { return jump(curve).is_below(-kConcave); }
  /// Whether a finger may pivot there.
  bool pivots(long curve) const { return is_at_rest(curve) || (turns(curve) && !is_concave(curve)); }

  /// By how much an arc length may be told otherwise: a lap less, as it is, a lap more.
  const std::vector<double>& laps() const { return laps_; }

  /// The curvature and its derivative by arc length; where u is wide, those of all places in it.
  struct Bend {
    Ball curvature;
    Ball change;
  };
  Bend bend(long curve, const Ball& u) const;
  /// How fast the angle changes by the parameter, which is finite where a curve is at rest as well; where u is wide,
  /// at all places in it.
  Ball turning(long curve, const Ball& u) const;
  /// The curvature by the arc length ahead, to the power kOrder - 1; where u is wide, from all places in it.
  Series curvature_ahead(long curve, const Ball& u) const;

 private:
  /// A stretch of a curve: length and angle as polynomials in x = parameter - middle.
  struct Piece {
    double lo = 0;
    double hi = 0;
    double middle = 0;
    Series length;
    Series angle;
    double least_speed = 0;  // everywhere on it, for certain
    bool is_good = false;    // what the polynomials leave out does not matter
    Ball s;                  // at lo
    Ball s_base;             // what the polynomials are added to
    Ball angle_base;
  };

  std::size_t index(long curve) const;
  long lap(long curve) const { return (curve - static_cast<long>(index(curve))) / curves(); }
  const Formula& formula(long curve) const { return curves_[index(curve)]; }
  /// Appends pieces for the parameters from lo to hi of a curve.
  void add_pieces(std::size_t curve, double lo, double hi, int depth);
  /// A piece by itself, not yet behind others.
  static Piece piece_between(const Formula& formula, double lo, double hi);
  /// Puts a piece where those before it end.
  void append(std::size_t curve, Piece piece);
  /// The joint at a curve's end: jump, rest and gap.
  void join(std::size_t curve);
  /// The place of a parameter that is on the piece.
  Place on_piece(std::size_t curve, const Piece& piece, const Ball& u) const;

  std::vector<Formula> curves_;
  bool closed_;
  std::vector<std::vector<Piece>> pieces_;  // of each curve
  std::vector<Place> starts_;               // of each curve, and the end of all
  std::vector<Ball> jumps_;                 // at each curve's end, radians
  std::vector<bool> at_rest_;               // likewise: a curve has no speed there
  double largest_gap_ = 0;                  // of neighbouring curves, length
  std::vector<double> laps_ = {0};
};

/// Places this share of the perimeter apart are one place: what is that near to a corner is at it.
inline constexpr double kSamePlace = 4e-12;

/// Both ends of a stretch of a curve.
struct Segment {
  Place from;
  Place to;
};

/// The stretch between two places, curve by curve. REQUIRES `to` ahead of `from`.
std::vector<Segment> segments(const Boundary& boundary, const Place& from, const Place& to);

/// The curvatures on all segments.
Ball curvatures(const Boundary& boundary, const std::vector<Segment>& all);

/// What the jumps at the joints between the segments add up to, at most and at least.
Ball jumps(const Boundary& boundary, const std::vector<Segment>& all);

/// The tangent's angles: a set for each run of segments between concave corners.
std::vector<Ball> angles(const Boundary& boundary, const std::vector<Segment>& all);

/// Whether there is a corner between two places.
bool has_corner(const Boundary& boundary, const Place& from, const Place& to);

/// Whether a contact so far behind a place is within this of a corner.
bool is_at_corner(const Boundary& boundary, const Ball& s, const std::vector<Ball>& lengths, double reach);

}  // namespace rollfix_verify
