#include "along.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix_verify {
namespace {

bool is_at_corner(const Boundary& boundary, const Ball& s, double reach) {
  const long count = boundary.curves();
  const double period = boundary.perimeter().middle();
  const long first = boundary.closed() ? count * static_cast<long>(std::floor(s.middle() / period)) - 1 : 0;
  const long joints = boundary.closed() ? count + 2 : count - 1;
  for (long curve = first; curve < first + joints; ++curve) {
    if (boundary.is_corner(curve) && abs(boundary.front(curve + 1).s - s).is_below(reach)) return true;
  }
  return false;
}

}  // namespace

std::vector<Segment> segments(const Boundary& boundary, const Place& from, const Place& to) {
  std::vector<Segment> result;
  for (long curve = from.curve; curve <= to.curve; ++curve) {
    result.push_back(
        {curve == from.curve ? from : boundary.front(curve), curve == to.curve ? to : boundary.back(curve)});
  }
  return result;
}

Ball curvatures(const Boundary& boundary, const std::vector<Segment>& all) {
  const auto on = [&](const Segment& one) {
    return boundary.bend(one.from.curve, hull(one.from.u, one.to.u)).curvature;
  };
  Ball result = on(all.front());
  for (std::size_t k = 1; k < all.size(); ++k) result = hull(result, on(all[k]));
  return result;
}

Ball jumps(const Boundary& boundary, const std::vector<Segment>& all) {
  Ball sum = 0.0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) sum = sum + up_to(boundary.jump(all[k].from.curve));
  return sum;
}

std::vector<Ball> angles(const Boundary& boundary, const std::vector<Segment>& all) {
  std::vector<Ball> sets;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Segment& one = all[k];
    const Ball here =
        one.from.angle + up_to(one.to.u - one.from.u) * boundary.turning(one.from.curve, hull(one.from.u, one.to.u));
    const bool goes_on = k > 0 && boundary.jump(all[k - 1].from.curve).is_above(-kConcave);
    if (goes_on) {
      sets.back() = hull(sets.back(), here);
    } else {
      sets.push_back(here);
    }
  }
  return sets;
}

bool has_corner(const Boundary& boundary, const Place& from, const Place& to) {
  for (long curve = from.curve; curve < to.curve; ++curve) {
    if (boundary.is_corner(curve)) return true;
  }
  return false;
}

bool is_at_corner(const Boundary& boundary, const Ball& s, const std::vector<Ball>& lengths, double reach) {
  return std::any_of(lengths.begin(), lengths.end(),
                     [&](const Ball& length) { return is_at_corner(boundary, s + length, reach); });
}

}  // namespace rollfix_verify
