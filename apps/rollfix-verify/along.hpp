#pragma once

#include <vector>

#include "boundary.hpp"
#include "convex.hpp"

namespace rollfix_verify {

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
