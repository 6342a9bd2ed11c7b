#include "ranges.hpp"

namespace rollfix_verify {
namespace {

// Stretches over more joints than this are halved first.
constexpr long kMostJoints = 6;

/// f between rows where it has the slopes given, one sign of them making it monotone.
Range between(const Row& from, const Row& to, const Ball& slope, const Ball& extra) {
  Range range;
  range.known = slope.is_finite();
  range.slope = sign_of(slope);
  const Ball ends = hull(from.f, to.f) + extra;
  range.parts = {range.slope != 0 ? ends : from.f + up_to(to.start.s - from.start.s) * slope + extra};
  return range;
}

/// No joint in between: by Taylor polynomials of both ends' angles in the arc length, which each start and its end have
/// in common.
Range smooth_range(const Boundary& boundary, const Row& from, const Row& to) {
  const Taylor& start = from.start_ahead;
  const Taylor& end = from.end_ahead;
  const Taylor all_starts = taylor_along(boundary, {from.start, to.start});
  const Taylor all_ends = taylor_along(boundary, {from.end, to.end});
  const Ball ahead = up_to(to.start.s - from.start.s);
  const auto last = static_cast<std::size_t>(kOrder) - 1;
  Ball slope = static_cast<double>(kOrder) * (all_ends[last] - all_starts[last]);
  for (std::size_t k = last; k-- > 0;) slope = slope * ahead + static_cast<double>(k + 1) * (end[k] - start[k]);
  const Ball plain = all_ends[0] - all_starts[0];
  return between(from, to, sign_of(slope) == 0 && sign_of(plain) != 0 ? plain : slope, 0.0);
}

}  // namespace

bool spans_corner(const Boundary& boundary, const Row& from, const Row& to) {
  return !is_smooth(boundary, from.start, to.start) || !is_smooth(boundary, from.end, to.end);
}

Range range_between(const Boundary& boundary, const Ball& turn, const Row& from, const Row& to) {
  const long joints = (to.start.curve - from.start.curve) + (to.end.curve - from.end.curve);
  if (joints > kMostJoints) return {};
  if (joints == 0) return smooth_range(boundary, from, to);
  const std::vector<Segment> starts = segments(boundary, from.start, to.start);
  const std::vector<Segment> ends = segments(boundary, from.end, to.end);
  if (!spans_corner(boundary, from, to)) {
    return between(from, to, curvatures(boundary, ends) - curvatures(boundary, starts),
                   jumps(boundary, ends) - jumps(boundary, starts));
  }
  Range range;
  range.known = true;
  range.corner = true;
  for (const Ball& end : angles(boundary, ends)) {
    for (const Ball& start : angles(boundary, starts)) range.parts.push_back(end - start - turn);
  }
  return range;
}

}  // namespace rollfix_verify
