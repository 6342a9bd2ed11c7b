#include "along.hpp"

#include <cmath>

namespace rollfix_verify {

std::vector<Segment> segments(const Boundary& boundary, const Place& from, const Place& to) {
  std::vector<Segment> result;
  for (long curve = from.curve; curve <= to.curve; ++curve) {
    result.push_back(
        {curve == from.curve ? from : boundary.front(curve), curve == to.curve ? to : boundary.back(curve)});
  }
  return result;
}

Taylor taylor_along(const Boundary& boundary, const Segment& segment) {
  return boundary.taylor(segment.from.curve, hull(segment.from.u, segment.to.u));
}

Ball curvatures(const Boundary& boundary, const std::vector<Segment>& all) {
  Ball result = taylor_along(boundary, all.front())[0];
  for (std::size_t k = 1; k < all.size(); ++k) result = hull(result, taylor_along(boundary, all[k])[0]);
  return result;
}

Ball jumps(const Boundary& boundary, const std::vector<Segment>& all) {
  Ball sum = 0.0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) sum = sum + hull(0.0, boundary.jump(all[k].from.curve));
  return sum;
}

bool is_smooth(const Boundary& boundary, const Place& from, const Place& to) {
  for (long curve = from.curve; curve < to.curve; ++curve) {
    if (!abs(boundary.jump(curve)).is_below(kSmooth) || boundary.is_at_rest(curve)) return false;
  }
  return true;
}

bool is_at_corner(const Boundary& boundary, const Ball& s, double reach) {
  const double period = boundary.perimeter().middle();
  const long count = boundary.curves();
  const long laps = boundary.closed() ? static_cast<long>(std::floor(s.middle() / period)) : 0;
  const long joints = boundary.closed() ? count : count - 1;
  for (long k = -1; k <= joints; ++k) {
    if (!boundary.closed() && (k < 0 || k >= joints)) continue;
    const long curve = k + laps * count;
    const bool is_corner = !abs(boundary.jump(curve)).is_below(kSmooth) || boundary.is_at_rest(curve);
    if (is_corner && abs(boundary.front(curve + 1).s - s).is_below(reach)) return true;
  }
  return false;
}

std::vector<Ball> angles(const Boundary& boundary, const std::vector<Segment>& all) {
  std::vector<Ball> sets;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Segment& one = all[k];
    const Ball here =
        one.from.angle + up_to(one.to.u - one.from.u) * boundary.turning(one.from.curve, hull(one.from.u, one.to.u));
    const bool is_new = k == 0 || !boundary.jump(all[k - 1].from.curve).is_above(-kConcave);
    if (is_new) {
      sets.push_back(here);
    } else {
      sets.back() = hull(sets.back(), here);
    }
  }
  return sets;
}

}  // namespace rollfix_verify
