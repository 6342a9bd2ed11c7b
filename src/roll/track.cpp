#include "roll/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"

// Notation, as in docs/rolling.md, "The roll itself":
//   s, Theta, kappa   the contact, the tangent's angle and the curvature there, unwrapped: on the second lap s > P
//   r               radius of the disk, of a jaw infinite: `radius_`
//   knot k          where spiral k begins; stretch 2k is the pivot there, stretch 2k + 1 the spiral
//   turn            by which Theta jumps at a knot: above 0 a pivot, below 0 a joint that is passed (`fall_of`) or a
//                   corner that no finger gets over (`blocks`)
//   1 + r kappa     above kLeastClearance where the finger fits: `clearance`; of a jaw kappa, in turns per lap
// Idea: kappa is monotone on a spiral. Its ends say whether the finger fits all along, and if not, one root of the
// clearance (by TOMS 748) is where it fits no longer.
namespace rollfix {

namespace {

/// Even stretches are pivots at knots, odd ones spirals.
bool is_pivot(std::int64_t index) { return index % 2 == 0; }
/// The knot of a pivot, or that at which a spiral starts; also right for indices below 0.
std::int64_t knot_before(std::int64_t index) { return (index - (index % 2 != 0 ? 1 : 0)) / 2; }
/// A concave corner that can't be rolled over.
bool blocks(double turn) { return Corner{0, turn}.is_concave(); }
/// The turn of a tiny concave joint, below 0; 0 of a pivot, of a smooth knot, and of a corner that blocks.
double fall_of(double turn) { return turn < 0 && !blocks(turn) ? turn : 0; }
/// Index of the pivot at a knot, and of the spirals on both sides of it.
std::int64_t pivot_at(std::int64_t knot) { return 2 * knot; }
std::int64_t spiral_after(std::int64_t knot) { return 2 * knot + 1; }
std::int64_t spiral_before(std::int64_t knot) { return 2 * knot - 1; }

}  // namespace

/// `u` matters to a jaw only.
EvenTrack::EvenTrack(const Part& part, const Finger& finger, double u)
    : Track(part, finger),
      turning_(part.turning()),
      radius_(finger.is_disk() ? finger.length_per_u() : std::numeric_limits<double>::infinity()),
      u_(u),
      corner_turns_(part.turning().spirals().size()) {
  // `corners` has all jumps of Theta, the tiny joints as well; each lies at a knot.
  for (const Corner& corner : part.corners()) {
    if (const auto k = knot_at(corner.s)) corner_turns_[after(*k).index()] = corner.turn;
  }
  for (const double turn : corner_turns_) fall_per_lap_ += fall_of(turn);
}

/// The knot at this base in [0, P], if there is one.
std::optional<std::int64_t> EvenTrack::knot_at(double base) const {
  // A place within rounding of a spiral's end is the knot there. The last spiral ends at knot n, which is knot 0 one
  // lap further on.
  const std::vector<Spiral>& spirals = turning_.spirals();
  const auto k = static_cast<std::int64_t>(turning_.spiral_at(std::min(base, turning_.perimeter())));
  const double near = kLengthAccuracy * turning_.perimeter();
  const Spiral& spiral = spirals[static_cast<std::size_t>(k)];
  if (base - spiral.lo <= near) return k;
  if (spiral.hi - base <= near) return k + 1;
  return std::nullopt;
}

/// An open part has no stretch at this index.
bool EvenTrack::ends_at(std::int64_t index) const {
  return !turning_.closed() && (index <= 0 || index >= pivot_at(static_cast<std::int64_t>(turning_.spirals().size())));
}

/// 1 + r kappa less kLeastClearance. Of a jaw r is infinite, and kappa itself has to be above 0: it is made free of the
/// unit by P / (2 pi), so that the same bound serves.
double EvenTrack::clearance(double curvature) const {
  const double room = std::isinf(radius_) ? curvature * turning_.perimeter() / kFullTurn : 1 + radius_ * curvature;
  return room - kLeastClearance;
}

/// Of a disk u follows from psi; of a jaw psi follows from u.
Contact EvenTrack::first_contact(const TrackPlace& /*place*/, double tangent, double psi) const {
  return finger().is_disk() ? contact_on(tangent, psi) : contact_at(finger(), tangent, u_);
}

/// Where on a spiral that is partly too concave the finger's reach ends: the curvature is monotone.
double EvenTrack::limit_on(const Spiral& spiral) const {
  const auto clearance_at = [&](double s) { return clearance(turning_.on_spiral(spiral, s).curvature); };
  // kappa is monotone on the spiral, and so is the clearance: one root.
  const double at_lo = clearance_at(spiral.lo);
  const double at_hi = clearance_at(spiral.hi);
  // Rounding can take the sign change away: then the limit is the end that is nearer to fitting.
  if (!(at_lo * at_hi < 0)) return at_lo > at_hi ? spiral.lo : spiral.hi;
  std::uintmax_t iterations = 100;
  const boost::math::tools::eps_tolerance<double> full(std::numeric_limits<double>::digits);
  const auto bracket =
      boost::math::tools::toms748_solve(clearance_at, spiral.lo, spiral.hi, at_lo, at_hi, full, iterations);
  return at_lo > 0 ? bracket.first : bracket.second;  // the side on which it fits
}

/// A stretch of a later lap is that of the first lap, shifted by each lap's P in s and by its turn in Theta.
Stretch EvenTrack::stretch(std::int64_t index) const {
  const Cursor at = after(knot_before(index));
  const Spiral& spiral = at.spiral();
  Stretch result;
  result.is_pivot = is_pivot(index);
  result.spiral = &spiral;
  result.s_shift = at.shift();
  result.angle_shift = at.lift();
  // A pivot has no length: s stays, and Theta goes from its value before the knot to the one after it.
  if (result.is_pivot) {
    result.s = result.whole = {at.lo(), at.lo()};
    result.angle = {at.angle_before(), at.angle_after()};
    return result;
  }
  result.fits_lo = fits(spiral.start.curvature);
  result.fits_hi = fits(spiral.end.curvature);
  result.s = result.whole = {at.lo(), at.hi()};
  result.angle = {at.angle_after(), spiral.end.angle + at.lift()};
  // It fits at both ends, so all along, as kappa is monotone; or at neither, and `next` never enters here.
  if (result.fits_lo == result.fits_hi) return result;
  const double limit = limit_on(spiral);
  const double angle = turning_.on_spiral(spiral, limit).angle;
  // Only the part next to the end that fits is left.
  (result.fits_lo ? result.s.hi : result.s.lo) = limit + result.s_shift;
  (result.fits_lo ? result.angle.hi : result.angle.lo) = angle + result.angle_shift;
  return result;
}

/// Theta and kappa at s on this stretch's own spiral: at a knot they are one-sided, those of the stretch.
Turning Track::turning(const Stretch& stretch, double s) const {
  const Spiral& spiral = *stretch.spiral;
  Turning turning = part_.turning().on_spiral(spiral, std::clamp(s - stretch.s_shift, spiral.lo, spiral.hi));
  turning.angle += stretch.angle_shift;
  return turning;
}

/// Throws InputError off the ends of an open part.
void EvenTrack::require_inside(double s) const {
  const double near = kLengthAccuracy * turning_.perimeter();
  if (!turning_.closed() && !(s >= -near && s <= turning_.perimeter() + near)) refuse_end(s);
}

/// A place at a knot belongs to the spiral that lies ahead: forwards to the one after it, backwards to the one before.
/// Throws InputError at the end of an open part, where no spiral is ahead.
EvenTrack::Found EvenTrack::find(double s, int direction) const {
  const Wrapped wrapped = turning_.boundary().reduced(s);
  const auto laps = static_cast<std::int64_t>(wrapped.winding) * static_cast<std::int64_t>(turning_.spirals().size());
  const std::optional<std::int64_t> knot = knot_at(wrapped.base);
  if (!knot) return {{spiral_after(static_cast<std::int64_t>(turning_.spiral_at(wrapped.base)) + laps), s}, {}};
  const std::int64_t k = *knot + laps;
  const std::int64_t index = direction > 0 ? spiral_after(k) : spiral_before(k);
  if (ends_at(index)) refuse_end(s);
  const Stretch ahead = stretch(index);
  return {{index, direction > 0 ? ahead.whole.lo : ahead.whole.hi}, k};
}

/// Throws InputError for a place off an open part, in a corner that blocks, or too tight for the finger.
TrackPlace EvenTrack::place(double s, int direction) const {
  require_inside(s);
  const auto [place, knot] = find(s, direction);
  if (knot && blocks(corner_turn(*knot))) refuse_corner(s, corner_turn(*knot));
  // of the side that the finger leaves to
  const double curvature = turning(stretch(place.index), place.s).curvature;
  if (!fits(curvature)) refuse_tight({place.s, curvature});
  return place;
}

std::optional<std::int64_t> EvenTrack::next(std::int64_t index, int direction) const {
  // The finger gets stuck on this stretch before its end.
  if (!is_pivot(index)) {
    const Stretch here = stretch(index);
    if (!(direction > 0 ? here.fits_hi : here.fits_lo)) return std::nullopt;
  }
  std::int64_t found = index + direction;
  if (ends_at(found)) return std::nullopt;
  if (is_pivot(found)) {
    const double turn = corner_turn(knot_before(found));
    if (blocks(turn)) return std::nullopt;
    // A convex corner is a stretch of its own. At a smooth knot, or a tiny concave joint, the spiral beyond follows.
    if (turn > 0) return found;
    found += direction;
  }
  // kappa can jump down at a knot: the finger may not fit right behind it.
  const Stretch ahead = stretch(found);
  if (!(direction > 0 ? ahead.fits_lo : ahead.fits_hi)) return std::nullopt;
  return found;
}

/// Sum of the falls at the knots from one stretch to a later one. Whole laps are counted at once, so that it takes one
/// lap's time at most however far apart the stretches are.
double EvenTrack::fall_between(std::int64_t from, std::int64_t to) const {
  if (fall_per_lap_ == 0) return 0;
  // Backwards each fall counts with the other sign.
  if (to < from) return -fall_between(to, from);
  const auto count = static_cast<std::int64_t>(corner_turns_.size());
  const std::int64_t last = knot_before(to);
  std::int64_t k = knot_before(from) + (is_pivot(from) ? 0 : 1);
  const std::int64_t laps = std::max<std::int64_t>(0, last - k) / count;
  double sum = static_cast<double>(laps) * fall_per_lap_;
  for (k += laps * count; k <= last; ++k) sum += fall_of(corner_turn(k));
  return sum;
}

/// Finds what stops the finger: the end of an open part, a corner, or a concavity, of which the tightest place is named
/// (not the place where it got stuck), since that says how small the finger must be.
void EvenTrack::refuse(std::int64_t index, int direction) const {
  const Stretch here = stretch(index);
  const double edge = direction > 0 ? here.s.hi : here.s.lo;
  Tightest tightest{edge, std::numeric_limits<double>::infinity()};
  std::int64_t at = index;
  if (!here.is_pivot) {
    // Where it does not fit at this spiral's own end, the concavity lies there.
    const double end = direction > 0 ? here.whole.hi : here.whole.lo;
    look_at(here, end, end, tightest);
    if (fits(tightest.curvature)) {  // then it is what comes next
      at += direction;
      if (ends_at(at)) refuse_end(edge);
      const double turn = corner_turn(knot_before(at));
      if (blocks(turn)) refuse_corner(edge, turn);
    }
  }
  // From here on `at` is a spiral: the first to look at.
  if (is_pivot(at)) at += direction;
  // On to the bottom of the concavity.
  for (std::size_t seen = 0; seen <= turning_.spirals().size() && !ends_at(at); ++seen, at += 2 * direction) {
    const Stretch spiral = stretch(at);
    if (at != index) look_at(spiral, spiral.whole.lo, spiral.whole.hi, tightest);
    // The finger fits again, or a corner or joint ends the concavity.
    const bool is_out = direction > 0 ? spiral.fits_hi : spiral.fits_lo;
    if (is_out || corner_turn(knot_before(at + direction)) != 0) break;
  }
  refuse_tight(tightest);
}

/// Keeps the smaller curvature of both ends: kappa is monotone between them.
void EvenTrack::look_at(const Stretch& stretch, double lo, double hi, Tightest& tightest) const {
  for (const double s : {lo, hi}) {  // monotone between
    const double curvature = turning(stretch, s).curvature;
    if (curvature < tightest.curvature) tightest = {s, curvature};
  }
}

/// From the lower end to the upper one, whatever the direction: what the finger passes is the same.
void EvenTrack::require_way(double from, double to) const {
  const double lo = std::min(from, to);
  const double hi = std::max(from, to);
  require_inside(lo);
  require_inside(hi);
  const double near = kLengthAccuracy * turning_.perimeter();
  // The tightest place of the whole way is named, not the first one that is too tight.
  const double last = std::min(hi, lo + turning_.perimeter());  // a second lap meets nothing new
  const auto [start, start_knot] = find(lo, 1);
  if (start_knot && blocks(corner_turn(*start_knot))) refuse_corner(lo, corner_turn(*start_knot));
  Tightest tightest{lo, std::numeric_limits<double>::infinity()};
  for (std::int64_t index = start.index; !ends_at(index); ++index) {
    const Stretch at = stretch(index);
    if (is_pivot(index)) {
      const double turn = corner_turn(knot_before(index));
      // A corner at the very end of the way counts: the finger can't be in it.
      if (blocks(turn) && at.whole.lo <= last + near) refuse_corner(at.whole.lo, turn);
      continue;
    }
    if (at.whole.lo >= last) break;
    look_at(at, std::max(at.whole.lo, lo), std::min(at.whole.hi, last), tightest);
  }
  if (!fits(tightest.curvature)) refuse_tight(tightest);
}

/// Throws InputError with the place, its curvature, and for a disk -1 / kappa: the radius has to be below that.
void EvenTrack::refuse_tight(const Tightest& tightest) const {
  const Vec2 point = part().point(tightest.s);
  if (std::isinf(radius_)) {
    throw InputError(fmt::format(
        "{}: a flat jaw can't roll where the part is not curved outwards, as at s = {:.9g}, ({:.6g}, {:.6g}), "
        "where the curvature is {:.9g}: expected it above 0; choose a disk or another roll",
        part().name(), part().boundary().base(tightest.s), point.x(), point.y(), tightest.curvature));
  }
  throw InputError(
      fmt::format("{}: a disk of radius {:.9g} is too big for the concavity at s = {:.9g}, ({:.6g}, {:.6g}), where the "
                  "curvature is {:.9g}: expected a radius below {:.9g}; choose a smaller finger or another roll",
                  part().name(), radius_, part().boundary().base(tightest.s), point.x(), point.y(), tightest.curvature,
                  -1 / tightest.curvature));
}

/// Throws InputError: `turn` is the corner's, below 0, radians.
void EvenTrack::refuse_corner(double s, double turn) const {
  const Vec2 point = part().point(s);
  throw InputError(
      fmt::format("{}: a finger can't get into the concave corner at s = {:.9g}, ({:.6g}, {:.6g}), where the tangent "
                  "turns by {:.6g} degrees: the largest radius that would do is 0 (the curvature is -inf); end the "
                  "roll before it",
                  part().name(), part().boundary().base(s), point.x(), point.y(), turn / kDegree));
}

/// Throws InputError: at s an open part ends.
void EvenTrack::refuse_end(double s) const {
  const Vec2 point = part().point(s);
  throw InputError(
      fmt::format("{}: the roll runs off the end of the open outline at s = {:.9g}, ({:.6g}, {:.6g}): expected a "
                  "contact that stays in 0 <= s <= {:.9g}; start elsewhere or roll less far",
                  part().name(), part().boundary().base(s), point.x(), point.y(), turning_.perimeter()));
}

}  // namespace rollfix
