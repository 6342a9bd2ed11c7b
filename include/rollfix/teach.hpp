#pragma once

// An outline from a roll around a part that has no drawing: docs/teach.md.
//
//     const Part truth = load_part("gallery:limacon");
//     const NoisyIncrements lap = noisy_increments(truth, 0, 1.02 * truth.perimeter(), 400, {}, 1);
//     const Taught taught = teach(lap.log);
//     taught.turns;                                                             // 1
//     std::abs(taught.outline.closed ? Part(taught.outline).perimeter() - truth.perimeter() : 1) < 1e-3;  // true
//
// Degenerate cases: a roll that does not come back is kept open, or bridged if `bridge` asks for it; corners are where
// the turn changes and the length does not, or neighbouring rows turn by `corner_angle`.
//
// Accuracy: Taught states it, from the noise, the rows' distance and the gap; docs/teach.md, "How accurate", compares
// it with the truth.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// How to make an outline of a roll around it.
struct TeachOptions {
  std::optional<Finger> finger{};      // for logs of u and psi: a disk
  std::optional<Noise> noise{};        // none: only what the digits written and the rows' distance leave open
  bool bridge = false;                 // the gap is bridged by a piece, however much of it drift explains
  bool open = false;                   // the roll runs along an open curve: nothing is closed
  double corner_angle = kCornerAngle;  // radians: neighbouring rows that turn by at least this make a corner
};

enum class Closing {
  spread,     // within the drift: turn and gap were spread over the whole
  bridged,    // by a piece from the end to the start
  kept_open,  // not within the drift
  not_asked   // open, as the options say
};

/// An outline that was rolled around, and what had to be done to it.
struct Taught {
  Outline outline;  // for Part, with allow_crossing where the course crosses itself
  Closing closing = Closing::spread;
  double rolled = 0;        // length of the whole log
  double lap = 0;           // of it, what is in the part: up to where the roll came back to its start
  double overlap = 0;       // the rest: rolled again, left out
  int turns = 0;            // closed: the multiple of 2 pi that the turn was closed to; below 0: clockwise
  double turn = 0;          // of the tangent over the lap, as logged, radians
  double turn_gap = 0;      // that less the nearest multiple of 2 pi
  double turn_allowed = 0;  // as much the drift explains
  double gap = 0;           // from the lap's end to its start, the turn closed where that was allowed
  double gap_allowed = 0;   // as much the drift explains
  double bridge = 0;        // length of the bridging piece
  double correction = 0;    // the largest change of a tangent's direction by spreading, radians
  double deviation = 0;     // the largest difference between a row's turn and the fitted one, drift taken off, radians
  double row_sd = 0;        // with noise: standard deviation of the rows' turns about the fitted one, radians
  std::size_t rows = 0;     // in the lap
  std::size_t corners = 0;
  std::vector<std::string> notes;  // all that, for the user to read
};

/// The outline that a roll goes around, from nothing but its log: the turning function Theta(s) is made of the rows
/// (L, theta), and the curves' positions are its integral (TurningSpan).
///  * Theta is a cubic between nodes with a continuous curvature. Without noise every row is a node, and Theta monotone
///    where the rows are. With noise it is a spline of least squares, with as few knots as the noise allows: a span is
///    halved while its rows are off by more than chance makes of the noise. Increments add their errors up: there the
///    slopes are fitted
///  * a corner is where theta changes and L does not, or where it changes by at least corner_angle within a row
///  * a lap ends where the roll comes back to its start, as far as the drift allows. What goes on is laid over the
///    beginning: the lap's length is that at which both passes turn alike, and noisy rows of all passes count alike
///  * the drift is taken as three standard deviations: of the turn, both ends' rows and what a gyroscope gathers
///    (`drift_variance`); of the position, `contact`, `slip` times the lap, and the turn's times the part's size; and
///    what the rows' rounding and distance leave open
///  * within the drift the turn is closed to the nearest multiple of 2 pi in proportion to length (or to time, where
///    `drift` or `walk` say that it drifts with that), and the gap by the least change (in the mean square) of Theta
///    that does it; beyond, nothing is spread. The gap is that of the rows
///  * the outline has its accuracy: see Accuracy
///  * s = 0 is the first contact; a log that goes backwards (L below 0) gives the same outline as its reverse. The
///    outline's direction is that in which L grows: a course driven clockwise stays one, and Part says `reversed`. A
///    finger's log (u and psi) that turns clockwise has the material outside: a hole
///  * the place is the world's where the log has x and y, the direction where it has psi; else (0, 0) and along x
/// Throws InputError: u and psi without a disk, a finger or noise that is not valid, too few rows, a roll of no
/// length or one that goes back on itself, or no turn to close to (a figure of eight's is 0, which closes as well).
Taught teach(const Log& log, const TeachOptions& options = {});

}  // namespace rollfix
