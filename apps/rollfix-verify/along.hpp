#pragma once

#include <vector>

#include "boundary.hpp"

namespace rollfix_verify {

/// Up to here a joint is smooth, radians: one crossing is one up to jumps of that size.
inline constexpr double kSmooth = 1e-12;
/// A concave joint turns by at least this, radians; at others the finger pivots: the angle takes every value in
/// between.
inline constexpr double kConcave = 1e-3;
/// Places this share of the perimeter apart are one place: what is that near to a corner is at it.
inline constexpr double kSamePlace = 4e-12;
/// Rows keep this share of the perimeter from corners.
inline constexpr double kClear = 1e-12;

/// Both ends of a stretch of a curve.
struct Segment {
  Place from;
  Place to;
};

/// The stretch between two places, curve by curve. REQUIRES `to` ahead of `from`.
std::vector<Segment> segments(const Boundary& boundary, const Place& from, const Place& to);

/// The Taylor coefficients of all places on a segment.
Taylor taylor_along(const Boundary& boundary, const Segment& segment);

/// The curvatures on all segments.
Ball curvatures(const Boundary& boundary, const std::vector<Segment>& all);

/// What the jumps at the joints between the segments add up to, at most and at least.
Ball jumps(const Boundary& boundary, const std::vector<Segment>& all);

/// Whether there is no corner between two places, nor one where a curve is at rest: there angles change as fast.
bool is_smooth(const Boundary& boundary, const Place& from, const Place& to);

/// The tangent's angles: a set for each run of segments between concave corners.
std::vector<Ball> angles(const Boundary& boundary, const std::vector<Segment>& all);

/// Whether there is a corner, or a place where a curve is at rest, within so much of a place.
bool is_at_corner(const Boundary& boundary, const Ball& s, double reach);

/// [0, length]
inline Ball up_to(const Ball& length) { return hull(0.0, length); }

inline int sign_of(const Ball& value) { return value.is_above(0.0) ? 1 : value.is_below(0.0) ? -1 : 0; }

}  // namespace rollfix_verify
