#include <cmath>

#include "outline/shapes/shapes.hpp"

// Notation:
//   x               along the chord of length 1; w = sqrt(x); v = -w above and w below
//   t(w)            half the thickness: `half_thickness`
//   y_c(x), p       camber line, and where it is highest: Camber
// Follows docs/gallery.md, "naca": the sections of four digits of E. N. Jacobs, K. E. Ward and R. M. Pinkerton, "The
// characteristics of 78 related airfoil sections from tests in the variable-density wind tunnel" (NACA report 460,
// 1933).
// Idea: by v instead of x the outline is regular at the nose.
namespace rollfix::shapes {

namespace {

/// A function of w with three derivatives.
struct Scalar {
  double value;
  double first;
  double second;
  double third;
};

/// Half the thickness of the 4-digit sections, thickness 1, over w = sqrt(x): the sum of kThickness[k] w^k.
/// The last coefficient is the one that closes the trailing edge.
constexpr double kThickness[] = {0, 5 * 0.2969, -5 * 0.126, 0, -5 * 0.3516, 0, 5 * 0.2843, 0, -5 * 0.1036};

/// t and its derivatives by w; 0 at the nose and, exactly, at the trailing edge.
Scalar half_thickness(double w) {
  constexpr const double* k = kThickness;
  // The same sum divided by 1 - w, so that it vanishes at the trailing edge exactly: partial sums of the coefficients.
  const double closed =
      5 * (0.2969 + w * (0.1709 + w * (0.1709 + w * (-0.1807 + w * (-0.1807 + w * (0.1036 + w * 0.1036))))));
  const double x = w * w;
  return {w * (1 - w) * closed, k[1] + w * (2 * k[2] + x * (4 * k[4] + x * (6 * k[6] + x * (8 * k[8])))),
          2 * k[2] + x * (12 * k[4] + x * (30 * k[6] + x * (56 * k[8]))),
          w * (24 * k[4] + x * (120 * k[6] + x * (336 * k[8])))};
}

/// The camber line, a parabola on either side of its highest point: its slope there is rate (x - p).
struct Camber {
  double height = 0;  // m
  double place = 1;   // p; 1 where there is no camber
  bool fore = true;   // x <= p

  /// The camber line's second derivative by x, constant on either side of its highest point.
  double rate() const {
    const double reach = fore ? place : 1 - place;
    return -2 * height / (reach * reach);
  }
  double slope(double x) const { return rate() * (x - place); }
  /// y_c. `one_minus_x` apart, because near the trailing edge 1 - x as a difference would lose digits.
  double value(double x, double one_minus_x) const {
    const double part = fore ? x / place : one_minus_x / (1 - place);
    return height * part * (2 - part);
  }
};

/// One side of the section between two breaks of its formula, drawn by v = -sqrt(x) above and v = sqrt(x) below,
/// so that v grows along the outline and the nose is regular:
///   (x, camber(x)) + side * half thickness * (unit normal of the camber line), with x = v^2.
struct NacaPiece {
  double chord;      // length of the chord: everything is drawn with 1 and multiplied
  double thickness;  // the largest, as a share of the chord
  Camber camber;
  bool upper;
  Interval range;  // of v

  Interval domain() const { return range; }

  /// d(x, y)/dv: the derivative by w, times dw/dv, which is -1 above and 1 below.
  Vec2 velocity(double v) const {
    const Offset offset = offset_at(v);
    const Vec2 first = 2 * offset.w * Vec2(1, offset.slope) + offset.half.first * offset.normal -
                       (offset.half.value * offset.turn1) * offset.tangent;
    return (upper ? -chord : chord) * first;
  }

  Jet jet(double v) const {
    const Offset o = offset_at(v);
    const double w = o.w;
    const double rate = camber.rate();
    // The tangent's angle is atan(slope); with share = 1/(1 + slope^2) its derivatives by w are
    const double share1 = -4 * rate * o.slope * w * o.share * o.share;
    const double share2 =
        -4 * rate * ((2 * rate * w * w + o.slope) * o.share * o.share + 2 * o.slope * w * o.share * share1);
    const double turn2 = 2 * rate * (o.share + w * share1);
    const double turn3 = 2 * rate * (2 * share1 + w * share2);
    const double turn1 = o.turn1;
    // of the normal ...
    const Vec2 normal1 = -turn1 * o.tangent;
    const Vec2 normal2 = -turn2 * o.tangent - turn1 * turn1 * o.normal;
    const Vec2 normal3 = (turn1 * turn1 * turn1 - turn3) * o.tangent - 3 * turn1 * turn2 * o.normal;
    // of the camber line ...
    const Vec2 line(w * w, camber.value(w * w, (1 - w) * (1 + w)));
    const Vec2 line1 = 2 * w * Vec2(1, o.slope);
    const Vec2 line2(2, 2 * o.slope + 4 * w * w * rate);
    const Vec2 line3(0, 12 * w * rate);
    // and of their sum.
    const Scalar& h = o.half;
    const double sign = upper ? -1 : 1;  // dw/dv
    Jet jet;
    jet.position = chord * (line + h.value * o.normal);
    jet.first = sign * chord * (line1 + h.first * o.normal + h.value * normal1);
    jet.second = chord * (line2 + h.second * o.normal + 2 * h.first * normal1 + h.value * normal2);
    jet.third = sign * chord *
                (line3 + h.third * o.normal + 3 * h.second * normal1 + 3 * h.first * normal2 + h.value * normal3);
    return jet;
  }

 private:
  /// What position and derivatives have in common at one v.
  struct Offset {
    double w;      // |v|
    Scalar half;   // signed half thickness
    double slope;  // of the camber line, dy/dx
    double share;  // 1 / (1 + slope^2)
    double turn1;  // of the camber line's tangent, d(angle)/dw
    Vec2 tangent;
    Vec2 normal;
  };

  /// The half thickness is negative below, so that both sides add it along the same normal.
  Offset offset_at(double v) const {
    Offset o;
    o.w = std::abs(v);
    const double signed_thickness = upper ? thickness : -thickness;
    const Scalar unit = half_thickness(o.w);
    o.half = {signed_thickness * unit.value, signed_thickness * unit.first, signed_thickness * unit.second,
              signed_thickness * unit.third};
    o.slope = camber.slope(o.w * o.w);
    o.share = 1 / (1 + o.slope * o.slope);
    o.turn1 = 2 * camber.rate() * o.w * o.share;
    const double cosine = std::sqrt(o.share);
    o.tangent = {cosine, cosine * o.slope};
    o.normal = {-cosine * o.slope, cosine};
    return o;
  }
};

/// Exactly four of 0 to 9.
bool is_digits(const std::string& text) {
  return text.size() == 4 && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

/// From the trailing edge over the top and back; without camber two pieces, which meet at the nose, else four.
Curves naca(const Parameters& parameters) {
  const std::string& digits = parameters.text("digits");
  if (!is_digits(digits)) parameters.refuse("digits must be the four digits of a section such as 0012 or 2412");
  const double height = (digits[0] - '0') / 100.0;
  const double place = (digits[1] - '0') / 10.0;
  const double thickness = ((digits[2] - '0') * 10 + (digits[3] - '0')) / 100.0;
  if (thickness == 0) parameters.refuse("the last two digits are the thickness in percent and must not be 00");
  if ((height == 0) != (place == 0)) {
    parameters.refuse("the first two digits are camber and its place: both 0 (symmetric) or neither");
  }
  const double chord = parameters.number("chord");
  const Camber fore{height, height > 0 ? place : 1, true};
  if (height == 0) {
    return {NacaPiece{chord, thickness, fore, true, {-1, 0}}, NacaPiece{chord, thickness, fore, false, {0, 1}}};
  }
  const Camber aft{height, place, false};
  // There the camber line's second derivative jumps, and with it the rate at which its normal turns: the thickness
  // that is laid off along the normal makes a slight corner of it.
  const double top = std::sqrt(place);
  return {NacaPiece{chord, thickness, aft, true, {-1, -top}}, NacaPiece{chord, thickness, fore, true, {-top, 0}},
          NacaPiece{chord, thickness, fore, false, {0, top}}, NacaPiece{chord, thickness, aft, false, {top, 1}}};
}

}  // namespace rollfix::shapes
