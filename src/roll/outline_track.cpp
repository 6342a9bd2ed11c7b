#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "part/part_data.hpp"
#include "roll/motion.hpp"
#include "rollfix/error.hpp"

// Notation, as in docs/rolling.md, "Fingers of any convex shape":
//   s, u            the contact on the part and on the finger, arc lengths; s + u stays: `sum_`
//   Theta, N        direction of the part's tangent, and of the finger's outward normal in its own frame
//   kappa, kappa_f  their derivatives; the finger fits where kappa_f(u) + kappa(s) > 0: `has_room`
//   base            a stretch of a point's way along the part: EvenTrack
//   cell            a spiral of the finger, counted on over its laps: while s grows, u and the cell fall
//   piece           of both at once: what rolls along one spiral of the part and off one of the finger
//   jump            by which tiny joints of the finger have turned it
// Idea: on a piece both curvatures are monotone: their ends bound the sum, and halving finds the first place where the
// finger may not fit. Pieces are made one after another, as far as the roll goes.
namespace rollfix {

namespace {

constexpr double kNoSize = 1e-300;   // radius of a finger that gets into every concavity
constexpr double kTightStep = 1e-9;  // of the perimeter: how closely the place is found where a finger sticks

/// Theta by arc length of the finger's outline; its normal N = Theta - pi / 2.
const TurningFunction& turning_of(const Finger& finger) { return finger.outline()->turning(); }

/// How many spirals one lap has.
std::int64_t count_of(const TurningFunction& turning) { return static_cast<std::int64_t>(turning.spirals().size()); }

/// The way of a finger with an outline: that of a point, cut where a spiral of the finger ends and another begins. The
/// pieces are found as they are needed; index 0 is where the roll starts.
class OutlineTrack : public Track {
 public:
  /// The first contact is at s = start, in [0, P), and at u on the finger. Throws InputError where the finger can't be.
  OutlineTrack(const Part& part, const Finger& finger, double start, double u);

  Stretch stretch(std::int64_t index) const override { return piece(index).stretch; }
  TrackPlace place(double s, int direction) const override;
  std::optional<std::int64_t> next(std::int64_t index, int direction) const override;
  [[noreturn]] void refuse(std::int64_t index, int direction) const override;
  double fall_between(std::int64_t from, std::int64_t to) const override;
  void require_way(double from, double to) const override;
  double rotation(const Stretch& stretch, double s, double angle) const override;
  double finger_curvature(const Stretch& stretch, double s) const override;
  Contact first_contact(const TrackPlace& place, double tangent, double psi) const override;

 private:
  struct Piece {
    std::int64_t base = 0;     // the point's stretch
    std::int64_t cell = 0;     // which of the finger's spirals, on over its laps
    Stretch stretch;           // cut
    bool is_tight_lo = false;  // the finger does not fit beyond this end
    bool is_tight_hi = false;
    double jump = 0;  // by which the finger's tiny joints have turned it since piece 0
  };

  /// REQUIRES that it was made: 0, or an index that `next` has given
  const Piece& piece(std::int64_t index) const;
  /// the finger's spiral that the piece rolls off
  void set_cell(Piece& piece, std::int64_t cell) const;
  /// s over which that spiral lasts
  Interval cell_range(const Piece& piece) const;
  /// Theta and kappa_f of the finger at u = sum_ - s
  Turning on_finger(const Stretch& stretch, double s) const;
  bool has_room(const Stretch& stretch, const Interval& s) const;
  std::optional<double> first_tight(const Stretch& stretch, double from, double to) const;
  /// ends the piece where the finger sticks
  void cut(Piece& piece, double from, int direction) const;
  /// the next piece
  std::optional<Piece> follow(const Piece& piece, int direction) const;
  /// a piece without length, at a corner of the finger
  Piece finger_pivot(Piece piece, std::int64_t cell, double s) const;
  bool finger_ends(std::int64_t cell) const;
  double corner_turn(std::int64_t cell) const;

  EvenTrack point_;  // the way of a finger without any size
  double sum_;       // s + u, which stays
  double u_;
  double near_;                        // lengths closer together than this are one place
  std::vector<double> corner_turns_;   // of the finger, at the start of each of its spirals; 0: it does not pivot there
  mutable std::vector<Piece> ahead_;   // 0, 1, 2 ...
  mutable std::vector<Piece> behind_;  // -1, -2 ...
};

}  // namespace

OutlineTrack::OutlineTrack(const Part& part, const Finger& finger, double start, double u)
    : Track(part, finger),
      point_(part, disk(kNoSize), 0),
      sum_(start + u),
      u_(u),
      near_(kLengthAccuracy * std::max(part.perimeter(), finger.outline()->perimeter())) {
  const TurningFunction& on_finger = turning_of(finger);
  // Tiny joints of the finger are no pivots: their turn is kept in Piece::jump.
  for (const Spiral& spiral : on_finger.spirals()) {
    corner_turns_.push_back(0);
    for (const Corner& corner : finger.outline()->corners()) {
      if (corner.turn > kJointTurn && std::abs(corner.s - spiral.lo) <= near_) corner_turns_.back() = corner.turn;
    }
  }
  // A roll that starts where an open part ends can only go back.
  const int direction = !part.closed() && start >= part.perimeter() - near_ ? -1 : 1;
  const TrackPlace first = point_.place(start, direction);
  // Of the finger's spirals the one at u, counted on over its laps: u may be any number.
  const Cursor on_cell(on_finger, u);
  const std::int64_t cell =
      static_cast<std::int64_t>(on_cell.index()) + static_cast<std::int64_t>(on_cell.winding()) * count_of(on_finger);

  Piece piece;
  piece.base = first.index;
  piece.stretch = point_.stretch(first.index);
  set_cell(piece, cell);
  // s grows as u falls: forwards the next cell is cell - 1.
  // Where one of the finger's spirals ends the roll starts on the one that lies ahead.
  if (direction > 0 && cell_range(piece).hi <= first.s + near_ && !finger_ends(cell - 1)) set_cell(piece, cell - 1);
  if (direction < 0 && cell_range(piece).lo >= first.s - near_ && !finger_ends(cell + 1)) set_cell(piece, cell + 1);
  // The piece ends where either spiral does, the part's or the finger's.
  const Interval range = cell_range(piece);
  piece.stretch.s = {std::max(piece.stretch.s.lo, range.lo), std::min(piece.stretch.s.hi, range.hi)};
  piece.stretch.whole = piece.stretch.s;
  // From the start outwards, to one side and then to the other: each cut moves its own end only.
  cut(piece, first.s, -1);
  cut(piece, first.s, 1);
  ahead_.push_back(piece);
  if (piece.is_tight_hi && piece.stretch.s.hi <= first.s) refuse(0, 1);
}

/// `cell` is counted on over the laps of a closed finger; the shifts bring its spiral to that lap.
void OutlineTrack::set_cell(Piece& piece, std::int64_t cell) const {
  const TurningFunction& on_finger = turning_of(finger());
  const Cursor at = Cursor::at_spiral(on_finger, cell);
  piece.cell = cell;
  piece.stretch.finger_spiral = &at.spiral();
  piece.stretch.finger_u_shift = at.shift();
  piece.stretch.finger_angle_shift = at.lift();
}

/// An open finger has no spiral there.
bool OutlineTrack::finger_ends(std::int64_t cell) const {
  const TurningFunction& on_finger = turning_of(finger());
  return !on_finger.closed() && (cell < 0 || cell >= count_of(on_finger));
}

/// By how much the finger pivots where one of its spirals starts.
double OutlineTrack::corner_turn(std::int64_t cell) const {
  const std::int64_t count = count_of(turning_of(finger()));
  return corner_turns_[static_cast<std::size_t>((cell % count + count) % count)];
}

/// The places of the part that the finger's spiral can roll over.
Interval OutlineTrack::cell_range(const Piece& piece) const {
  const Spiral& spiral = *piece.stretch.finger_spiral;
  // s = sum - u, and u goes from spiral.lo to spiral.hi plus the lap's shift: the larger u is the smaller s.
  const double offset = sum_ - piece.stretch.finger_u_shift;
  return {offset - spiral.hi, offset - spiral.lo};
}

/// The finger's tangent and curvature at the place that touches when the contact is at s: u = sum - s, clamped to the
/// piece's own spiral, so that at a corner of the finger it is the side that the piece rolls on.
Turning OutlineTrack::on_finger(const Stretch& stretch, double s) const {
  const Spiral& spiral = *stretch.finger_spiral;
  const double u = std::clamp(sum_ - s - stretch.finger_u_shift, spiral.lo, spiral.hi);
  Turning result = turning_of(finger()).on_spiral(spiral, u);
  result.angle += stretch.finger_angle_shift;
  return result;
}

/// psi up to a constant, eq. (3): Theta(s) - N(u), with the finger's own tangent angle, N + pi / 2, in place of N.
double OutlineTrack::rotation(const Stretch& stretch, double s, double angle) const {
  return angle - on_finger(stretch, s).angle;
}

/// kappa_f = dN / du
double OutlineTrack::finger_curvature(const Stretch& stretch, double s) const {
  return on_finger(stretch, s).curvature;
}

/// On a corner of the finger: of its two sides the one that the roll starts on.
Contact OutlineTrack::first_contact(const TrackPlace& place, double tangent, double /*psi*/) const {
  if (!finger().has_corners()) return contact_at(finger(), tangent, u_);
  return {u_, tangent + std::numbers::pi - on_finger(stretch(place.index), place.s).angle};  // N = angle - pi / 2
}

/// Whether the finger surely fits all along: both curvatures are monotone.
bool OutlineTrack::has_room(const Stretch& stretch, const Interval& s) const {
  // The least values of both may lie at different ends: their sum is a lower bound of kappa + kappa_f, and false only
  // means that halving has to go on.
  const double part_least = std::min(turning(stretch, s.lo).curvature, turning(stretch, s.hi).curvature);
  const double finger_least = std::min(finger_curvature(stretch, s.lo), finger_curvature(stretch, s.hi));
  return (part_least + finger_least) * part().perimeter() / (2 * std::numbers::pi) > kLeastClearance;
}

/// Where, on the way from one place to another, the finger does not surely fit any more.
std::optional<double> OutlineTrack::first_tight(const Stretch& stretch, double from, double to) const {
  if (has_room(stretch, {std::min(from, to), std::max(from, to)})) return std::nullopt;
  // Not proved for a stretch this short: the finger sticks here, within kTightStep.
  if (std::abs(to - from) <= kTightStep * part().perimeter()) return from;
  const double middle = from + 0.5 * (to - from);
  // The half next to `from` first: it is the first tight place on the way that counts.
  if (const auto near = first_tight(stretch, from, middle)) return near;
  return first_tight(stretch, middle, to);
}

/// Cuts a piece that is entered at `from` where the finger does not fit any more.
void OutlineTrack::cut(Piece& piece, double from, int direction) const {
  Stretch& stretch = piece.stretch;
  if (!stretch.is_pivot) {
    double& end = direction > 0 ? stretch.s.hi : stretch.s.lo;
    if (const auto tight = first_tight(stretch, from, end)) {
      end = *tight;
      (direction > 0 ? piece.is_tight_hi : piece.is_tight_lo) = true;
    }
    // Theta at the ends that are left
    stretch.angle = {turning(stretch, stretch.s.lo).angle, turning(stretch, stretch.s.hi).angle};
  }
}

/// What follows a piece where the finger's spirals below and above a corner of it meet; `cell`: the one above.
OutlineTrack::Piece OutlineTrack::finger_pivot(Piece piece, std::int64_t cell, double s) const {
  set_cell(piece, cell);
  Stretch& stretch = piece.stretch;
  const double angle = turning(stretch, s).angle;
  stretch.is_pivot = stretch.is_finger_pivot = true;
  stretch.s = stretch.whole = {s, s};
  stretch.angle = {angle, angle + corner_turn(cell)};
  return piece;
}

/// The piece behind this one's end; nothing where there is none.
/// Where the part's spiral is over the next base follows, where the finger's is over the next cell; it may be both.
std::optional<OutlineTrack::Piece> OutlineTrack::follow(const Piece& piece, int direction) const {
  if (direction > 0 ? piece.is_tight_hi : piece.is_tight_lo) return std::nullopt;
  const double edge = direction > 0 ? piece.stretch.s.hi : piece.stretch.s.lo;
  const Stretch below = point_.stretch(piece.base);
  const Interval range = cell_range(piece);
  const bool base_is_over = std::abs(edge - (direction > 0 ? below.s.hi : below.s.lo)) <= near_;
  const bool cell_is_over = std::abs(edge - (direction > 0 ? range.hi : range.lo)) <= near_;

  Piece found;
  found.jump = piece.jump;
  found.base = piece.base;
  if (base_is_over) {
    const auto next_base = point_.next(piece.base, direction);
    if (!next_base) return std::nullopt;
    found.base = *next_base;
  }
  found.stretch = point_.stretch(found.base);
  // Of a pivot on the finger's own corner the cell is the upper one, which a roll forwards leaves.
  const bool is_pivoted = piece.stretch.is_finger_pivot;
  const bool takes_new_cell = is_pivoted ? direction > 0 : cell_is_over && !found.stretch.is_pivot;
  const std::int64_t cell = takes_new_cell ? piece.cell - direction : piece.cell;
  // An open finger ends here: the roll is over.
  if (finger_ends(cell)) return std::nullopt;
  // Two cells meet at the lower end of the upper one, in u.
  const std::int64_t upper = std::max(cell, piece.cell);
  const bool is_at_corner = is_pivoted || (takes_new_cell && corner_turn(upper) > 0);
  // A corner of the finger comes first: a pivot between the two spirals. After it the spiral beyond follows.
  if (is_at_corner && !is_pivoted) return finger_pivot(found, upper, edge);
  set_cell(found, cell);
  // A pivot of the part: no length, and nothing to cut.
  if (found.stretch.is_pivot) return found;
  // Across a tiny joint of the finger N jumps without a pivot. `jump` adds this up, and fall_between counts it.
  if (takes_new_cell && !is_at_corner)
    found.jump += on_finger(piece.stretch, edge).angle - on_finger(found.stretch, edge).angle;
  const Interval on = cell_range(found);
  if (direction > 0) {
    found.stretch.s = {std::max(edge, found.stretch.s.lo), std::min(found.stretch.s.hi, on.hi)};
  } else {
    found.stretch.s = {std::max(found.stretch.s.lo, on.lo), std::min(edge, found.stretch.s.hi)};
  }
  found.stretch.whole = found.stretch.s;
  cut(found, direction > 0 ? found.stretch.s.lo : found.stretch.s.hi, direction);
  // The finger sticks where the next piece would begin: there is none.
  const bool is_shut = direction > 0 ? found.is_tight_hi : found.is_tight_lo;
  if (is_shut && found.stretch.s.width() <= 0) return std::nullopt;
  return found;
}

/// Index 0, 1, 2 ... in `ahead_`, -1, -2 ... in `behind_`.
const OutlineTrack::Piece& OutlineTrack::piece(std::int64_t index) const {
  return index >= 0 ? ahead_[static_cast<std::size_t>(index)] : behind_[static_cast<std::size_t>(-1 - index)];
}

std::optional<std::int64_t> OutlineTrack::next(std::int64_t index, int direction) const {
  const std::int64_t found = index + direction;
  std::vector<Piece>& side = direction > 0 ? ahead_ : behind_;
  const auto last =
      direction > 0 ? static_cast<std::int64_t>(ahead_.size()) - 1 : -static_cast<std::int64_t>(behind_.size());
  // The outermost piece on this side: one more is made, if the finger can go on.
  if (index != last) return found;
  const std::optional<Piece> fresh = follow(piece(index), direction);
  if (!fresh) return std::nullopt;
  side.push_back(*fresh);
  return found;
}

TrackPlace OutlineTrack::place(double s, int direction) const {
  const double there = point_.place(s, direction).s;
  // A place between two pieces belongs to the one that lies ahead.
  const auto is_behind = [&](const Stretch& at) {
    return direction > 0 ? there >= at.s.hi - near_ : there > at.s.hi + near_;
  };
  const auto is_ahead = [&](const Stretch& at) {
    return direction < 0 ? there <= at.s.lo + near_ : there < at.s.lo - near_;
  };
  // From piece 0 outwards, making pieces as needed. At most one of both directions does anything.
  std::int64_t index = 0;
  for (const int way : {1, -1}) {
    while (way > 0 ? is_behind(piece(index).stretch) : is_ahead(piece(index).stretch)) {
      const auto following = next(index, way);
      if (!following) refuse(index, way);
      index = *following;
    }
  }
  const Interval on = piece(index).stretch.s;
  return {index, std::clamp(there, on.lo, on.hi)};
}

/// The part's falls on the way, and how far the finger's own tiny joints have turned it.
double OutlineTrack::fall_between(std::int64_t from, std::int64_t to) const {
  return point_.fall_between(piece(from).base, piece(to).base) + piece(to).jump - piece(from).jump;
}

/// First as for a point: ends and concave corners of the part. Then piece by piece, up to where the finger sticks.
void OutlineTrack::require_way(double from, double to) const {
  point_.require_way(from, to);
  const int direction = to < from ? -1 : 1;
  std::int64_t index = place(from, direction).index;
  while (direction > 0 ? piece(index).stretch.s.hi < to - near_ : piece(index).stretch.s.lo > to + near_) {
    const auto following = next(index, direction);
    if (!following) refuse(index, direction);
    index = *following;
  }
}

/// Of the three reasons the first that holds: the part's own (an end, a concave corner), the finger's end, or no room.
void OutlineTrack::refuse(std::int64_t index, int direction) const {
  const Piece& here = piece(index);
  const double edge = direction > 0 ? here.stretch.s.hi : here.stretch.s.lo;
  const Interval range = cell_range(here);
  const bool cell_is_over = std::abs(edge - (direction > 0 ? range.hi : range.lo)) <= near_;
  const bool base_ends = !point_.next(here.base, direction).has_value();
  const bool at_base_end =
      std::abs(edge - (direction > 0 ? point_.stretch(here.base).s.hi : point_.stretch(here.base).s.lo)) <= near_;
  if (at_base_end && base_ends) point_.refuse(here.base, direction);
  const Vec2 point = part().point(edge);
  const double named = part().boundary().base(edge);
  if (cell_is_over && finger_ends(here.cell - direction)) {
    throw InputError(fmt::format(
        "{}: the roll runs off the end of the finger {} at s = {:.9g}, ({:.6g}, {:.6g}), u = {:.9g}: expected "
        "a contact that stays in 0 <= u <= {:.9g}; start elsewhere on it or roll less far",
        part().name(), finger().name(), named, point.x(), point.y(), sum_ - edge, finger().outline()->perimeter()));
  }
  Piece ahead = here;  // on a corner of the finger the side that it would roll on
  if (here.stretch.is_finger_pivot && direction > 0) set_cell(ahead, here.cell - 1);
  const double of_part = turning(ahead.stretch, edge).curvature;
  const double of_finger = finger_curvature(ahead.stretch, edge);
  throw InputError(fmt::format(
      "{}: the finger {} {}, as at s = {:.9g}, ({:.6g}, {:.6g}), u = {:.9g}, where the curvatures are {:.9g} and "
      "{:.9g}: expected their sum above 0; choose {} or another roll",
      part().name(), finger().name(),
      of_part > -kLeastClearance && of_finger < kLeastClearance
          ? "would lie flat where it and the part are straight"
          : "can't roll where the part is curved inwards as much as the finger outwards",
      named, point.x(), point.y(), sum_ - edge, of_part, of_finger, of_part < 0 ? "a smaller finger" : "a round one"));
}

std::unique_ptr<Track> track_of(const Part& part, const Finger& finger, double start, std::optional<double> u) {
  require_valid(finger);
  if (finger.is_disk()) {
    require_not_lost(part, finger.length_per_u(), "a disk with a radius", ": give it in the outline's unit");
  }
  // A disk or a jaw is alike all around: its way does not depend on where it is touched.
  if (finger.outline() == nullptr) return std::make_unique<EvenTrack>(part, finger, u.value_or(0));
  const Interval ends = finger.ends();
  const double place = u.value_or(std::isfinite(ends.hi) ? ends.middle() : 0);
  if (!(place >= ends.lo && place <= ends.hi) || !std::isfinite(place)) {
    throw InputError(fmt::format("expected a first contact on the finger {}, {:g} <= u <= {:.9g}, found u = {}",
                                 finger.name(), ends.lo, ends.hi, place));
  }
  if (!std::isfinite(start)) throw InputError(fmt::format("expected a finite start of a roll, found {}", start));
  const double first = part.boundary().on_first_lap(start);
  return std::make_unique<OutlineTrack>(part, finger, first, place);
}

}  // namespace rollfix
