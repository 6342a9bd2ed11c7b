#include "pieces_meet.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <limits>
#include <vector>

// Convex sets are compared by separating axes: docs/search.md, "Two fingers", step 7.
namespace rollfix {
namespace {

/// Does a segment come closer than `slack` to a box?
bool segment_meets(const PairPoint& a, const PairPoint& b, const PairBox& box, double slack) {
  for (const std::size_t k : {0U, 1U}) {
    if (std::max(a[k], b[k]) < box[k].lo - slack || std::min(a[k], b[k]) > box[k].hi + slack) return false;
  }
  double lo = 0;
  double hi = 1;
  for (const std::size_t k : {0U, 1U}) {
    const double step = b[k] - a[k];
    const double least = box[k].lo - slack - a[k];
    const double most = box[k].hi + slack - a[k];
    if (step == 0) {
      if (least > 0 || most < 0) return false;
      continue;
    }
    lo = std::max(lo, std::min(least / step, most / step));
    hi = std::min(hi, std::max(least / step, most / step));
  }
  return lo <= hi;
}

bool line_meets(const std::vector<PairPoint>& line, const Shift& shift, const PairBox& box, double slack) {
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    if (segment_meets(moved(line[k], shift), moved(line[k + 1], shift), box, slack)) return true;
  }
  return false;
}

using Corners = boost::container::small_vector<PairPoint, 8>;

Corners polygon_of(const PairPiece& piece, const Shift& shift) {
  Corners polygon;
  for (const PairPoint& point : piece.hull) polygon.push_back(moved(point, shift));
  if (!polygon.empty()) return polygon;
  const PairBox box = moved(piece.box, shift);
  return {{box[0].lo, box[1].lo}, {box[0].hi, box[1].lo}, {box[0].hi, box[1].hi}, {box[0].lo, box[1].hi}};
}

/// Is there a direction of `one`'s edges, or across them, in which the two convex polygons are apart?
bool separates(const Corners& one, const Corners& two, double slack) {
  for (std::size_t k = 0; k < one.size(); ++k) {
    const PairPoint& from = one[k];
    const PairPoint& to = one[(k + 1) % one.size()];
    const double length = distance(from, to);
    if (length == 0) continue;
    const PairPoint along{(to[0] - from[0]) / length, (to[1] - from[1]) / length};
    for (const PairPoint& axis : {along, PairPoint{-along[1], along[0]}}) {
      const auto span = [&](const Corners& polygon) {
        Interval interval{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const PairPoint& point : polygon) {
          // From a corner of one, so that small polygons keep their digits.
          const double x = axis[0] * (point[0] - from[0]) + axis[1] * (point[1] - from[1]);
          interval.lo = std::min(interval.lo, x);
          interval.hi = std::max(interval.hi, x);
        }
        return interval;
      };
      const Interval a = span(one);
      const Interval b = span(two);
      if (a.lo > b.hi + slack || b.lo > a.hi + slack) return true;
    }
  }
  return false;
}

}  // namespace

bool boxes_meet(const PairBox& one, const PairBox& two, double slack) {
  return one[0].lo <= two[0].hi + slack && two[0].lo <= one[0].hi + slack && one[1].lo <= two[1].hi + slack &&
         two[1].lo <= one[1].hi + slack;
}

bool pieces_meet(const PairPiece& one, const PairPiece& two, const Shift& shift, double slack) {
  const PairBox other = moved(two.box, shift);
  const double reach = slack + one.error + two.error;
  if (!boxes_meet(one.box, other, reach)) return false;
  if (one.line.empty() && two.line.empty()) {
    if (one.hull.empty() && two.hull.empty()) return true;
    const Corners at_one = polygon_of(one, {0, 0});
    const Corners at_two = polygon_of(two, shift);
    return !separates(at_one, at_two, reach) && !separates(at_two, at_one, reach);
  }
  if (two.line.empty()) return line_meets(one.line, {0, 0}, other, reach);
  if (one.line.empty()) return line_meets(two.line, shift, one.box, reach);
  for (std::size_t k = 0; k + 1 < one.line.size(); ++k) {
    const PairPoint& a = one.line[k];
    const PairPoint& b = one.line[k + 1];
    const PairBox segment{Interval{std::min(a[0], b[0]), std::max(a[0], b[0])},
                          Interval{std::min(a[1], b[1]), std::max(a[1], b[1])}};
    if (boxes_meet(segment, other, 2 * reach) && line_meets(two.line, shift, segment, reach)) return true;
  }
  return false;
}

}  // namespace rollfix
