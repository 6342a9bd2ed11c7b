#include "components.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace rollfix {
namespace {

// A family's line keeps no point that is closer than this share of the perimeter to the line through the others.
constexpr double kFamilyDetail = 1e-7;
// Lines that end closer together than this share of the perimeter continue each other.
constexpr double kJointWidth = 1e-8;

using Shift = std::array<double, 2>;  // whole periods

struct Link {
  std::size_t to;
  Shift shift;  // added to the other piece brings it here
};

double distance(const PairPoint& one, const PairPoint& two) { return std::hypot(one[0] - two[0], one[1] - two[1]); }

PairPoint moved(const PairPoint& point, const Shift& shift) { return {point[0] + shift[0], point[1] + shift[1]}; }

/// The part of a segment nearest to a point.
PairPoint nearest_on(const PairPoint& a, const PairPoint& b, const PairPoint& p) {
  const double x = b[0] - a[0];
  const double y = b[1] - a[1];
  const double square = x * x + y * y;
  const double share = square > 0 ? std::clamp(((p[0] - a[0]) * x + (p[1] - a[1]) * y) / square, 0.0, 1.0) : 0;
  return {a[0] + share * x, a[1] + share * y};
}

/// Does a segment come closer than `slack` to a box?
bool segment_meets(const PairPoint& a, const PairPoint& b, const PairBox& box, double slack) {
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

PairBox moved(const PairBox& box, const Shift& shift) {
  return {Interval{box[0].lo + shift[0], box[0].hi + shift[0]}, Interval{box[1].lo + shift[1], box[1].hi + shift[1]}};
}

bool boxes_meet(const PairBox& one, const PairBox& two, double slack) {
  return one[0].lo <= two[0].hi + slack && two[0].lo <= one[0].hi + slack && one[1].lo <= two[1].hi + slack &&
         two[1].lo <= one[1].hi + slack;
}

bool line_meets(const std::vector<PairPoint>& line, const Shift& shift, const PairBox& box, double slack) {
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    if (segment_meets(moved(line[k], shift), moved(line[k + 1], shift), box, slack)) return true;
  }
  return false;
}

std::vector<PairPoint> polygon_of(const PairPiece& piece, const Shift& shift) {
  std::vector<PairPoint> polygon;
  for (const PairPoint& point : piece.hull) polygon.push_back(moved(point, shift));
  if (!polygon.empty()) return polygon;
  const PairBox box = moved(piece.box, shift);
  return {{box[0].lo, box[1].lo}, {box[0].hi, box[1].lo}, {box[0].hi, box[1].hi}, {box[0].lo, box[1].hi}};
}

/// Is there a direction of `one`'s edges, or across them, in which the two convex polygons are apart?
bool separates(const std::vector<PairPoint>& one, const std::vector<PairPoint>& two, double slack) {
  for (std::size_t k = 0; k < one.size(); ++k) {
    const PairPoint& from = one[k];
    const PairPoint& to = one[(k + 1) % one.size()];
    const double length = distance(from, to);
    if (length == 0) continue;
    const PairPoint along{(to[0] - from[0]) / length, (to[1] - from[1]) / length};
    for (const PairPoint& axis : {along, PairPoint{-along[1], along[0]}}) {
      const auto span = [&](const std::vector<PairPoint>& polygon) {
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

bool pieces_meet(const PairPiece& one, const PairPiece& two, const Shift& shift, double slack) {
  const PairBox other = moved(two.box, shift);
  const double reach = slack + one.error + two.error;
  if (!boxes_meet(one.box, other, reach)) return false;
  if (one.line.empty() && two.line.empty()) {
    const std::vector<PairPoint> at_one = polygon_of(one, {0, 0});
    const std::vector<PairPoint> at_two = polygon_of(two, shift);
    return !separates(at_one, at_two, reach) && !separates(at_two, at_one, reach);
  }
  if (two.line.empty()) return line_meets(one.line, {0, 0}, other, reach);
  if (one.line.empty()) return line_meets(two.line, shift, one.box, reach);
  for (std::size_t k = 0; k + 1 < one.line.size(); ++k) {
    const PairPoint& a = one.line[k];
    const PairPoint& b = one.line[k + 1];
    const PairBox segment{Interval{std::min(a[0], b[0]), std::max(a[0], b[0])},
                          Interval{std::min(a[1], b[1]), std::max(a[1], b[1])}};
    if (line_meets(two.line, shift, segment, reach)) return true;
  }
  return false;
}

class Joiner {
 public:
  Joiner(const Part& part, const PairFindings& findings, double same_place)
      : pieces_(findings.pieces),
        roots_(findings.roots),
        period_(part.perimeter()),
        closed_(part.closed()),
        same_place_(same_place),
        links_(pieces_.size()) {}

  std::vector<PairCluster> run() {
    link();
    sort_links();
    std::vector<PairCluster> clusters;
    std::vector<bool> seen(pieces_.size(), false);
    root_taken_.assign(roots_.size(), false);
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (!seen[k]) clusters.push_back(cluster_of(k, seen));
    }
    return clusters;
  }

 private:
  std::vector<Shift> shifts() const {
    if (!closed_) return {{0, 0}};
    std::vector<Shift> all;
    for (const double s : {0.0, -period_, period_}) {
      for (const double t : {0.0, -period_, period_}) all.push_back({s, t});
    }
    return all;
  }

  double slack_of(const PairPiece& one, const PairPiece& two) const {
    const bool both_exact = one.exact && two.exact;
    return both_exact ? kJointWidth * period_ : same_place_;
  }

  /// Sweeps along s: a piece meets those whose interval of s is still open.
  void link() {
    std::vector<std::size_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (const Shift& shift : shifts()) {
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return pieces_[a].box[0].lo < pieces_[b].box[0].lo; });
      // Those whose shifted interval can reach: for every piece the others that begin before it ends.
      double widest = 0;
      double largest_error = 0;
      for (const PairPiece& piece : pieces_) {
        widest = std::max(widest, piece.box[0].width());
        largest_error = std::max(largest_error, piece.error);
      }
      for (std::size_t one = 0; one < pieces_.size(); ++one) {
        const double slack = kJointWidth * period_ + 2 * largest_error;
        const double from = pieces_[one].box[0].lo - shift[0] - widest - slack;
        auto next = std::lower_bound(order.begin(), order.end(), from,
                                     [&](std::size_t k, double value) { return pieces_[k].box[0].lo < value; });
        for (; next != order.end(); ++next) {
          const std::size_t two = *next;
          if (pieces_[two].box[0].lo > pieces_[one].box[0].hi - shift[0] + slack) break;
          if (two == one) continue;
          if (pieces_meet(pieces_[one], pieces_[two], shift, slack_of(pieces_[one], pieces_[two]))) {
            links_[one].push_back({two, shift});
          }
        }
      }
    }
  }

  /// Exact neighbours first, so that a walk along a family leaves it only where it must.
  void sort_links() {
    for (std::vector<Link>& links : links_) {
      std::stable_partition(links.begin(), links.end(), [&](const Link& link) { return pieces_[link.to].exact; });
    }
  }

  PairCluster cluster_of(std::size_t first, std::vector<bool>& seen) {
    PairCluster cluster;
    std::vector<std::size_t> members;
    std::vector<Shift> shift_of(pieces_.size(), Shift{0, 0});
    std::vector<std::size_t> waiting{first};
    seen[first] = true;
    cluster.extent = pieces_[first].box;
    cluster.corner = true;
    while (!waiting.empty()) {
      const std::size_t here = waiting.back();
      waiting.pop_back();
      members.push_back(here);
      const PairBox box = moved(pieces_[here].box, shift_of[here]);
      for (const std::size_t k : {0U, 1U}) {
        cluster.extent[k].lo = std::min(cluster.extent[k].lo, box[k].lo);
        cluster.extent[k].hi = std::max(cluster.extent[k].hi, box[k].hi);
      }
      cluster.exact = cluster.exact || pieces_[here].exact;
      cluster.corner = cluster.corner && pieces_[here].corner;
      for (const Link& link : links_[here]) {
        if (seen[link.to]) continue;
        seen[link.to] = true;
        shift_of[link.to] = {shift_of[here][0] + link.shift[0], shift_of[here][1] + link.shift[1]};
        waiting.push_back(link.to);
      }
    }
    // A set that goes all the way round covers the whole loop, wherever it was cut.
    for (const std::size_t k : {0U, 1U}) {
      if (closed_ && covers_loop(members, k)) {
        cluster.whole_loop[k] = true;
        cluster.extent[k] = {0, period_};
      }
    }
    hand_out_roots(members, shift_of, cluster);
    if (cluster.exact) trace(members, cluster);
    return cluster;
  }

  /// Do the members' intervals, together, cover all of one finger's boundary?
  bool covers_loop(const std::vector<std::size_t>& members, std::size_t finger) const {
    std::vector<Interval> intervals;
    for (const std::size_t k : members) {
      const Interval& interval = pieces_[k].box[finger];
      if (interval.width() > 0) intervals.push_back(interval);
    }
    std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
    const double slack = kJointWidth * period_;
    double reached = slack;
    for (const Interval& interval : intervals) {
      if (interval.lo > reached + slack) return false;
      reached = std::max(reached, interval.hi);
    }
    return reached >= period_ - slack;
  }

  void hand_out_roots(const std::vector<std::size_t>& members, const std::vector<Shift>& shift_of,
                      PairCluster& cluster) {
    for (std::size_t r = 0; r < roots_.size(); ++r) {
      if (root_taken_[r]) continue;
      for (const std::size_t k : members) {
        const PairPoint& at = roots_[r].at;
        const double slack = same_place_;
        const PairBox& box = pieces_[k].box;
        if (at[0] < box[0].lo - slack || at[0] > box[0].hi + slack || at[1] < box[1].lo - slack ||
            at[1] > box[1].hi + slack) {
          continue;
        }
        root_taken_[r] = true;
        PairRoot root = roots_[r];
        root.at = moved(root.at, shift_of[k]);
        cluster.roots.push_back(root);
        break;
      }
    }
  }

  // ---- a line through a family ----

  /// The nearest point of a piece to a place, by its position along the piece's line.
  struct OnPiece {
    PairPoint at;
    std::size_t segment = 0;
  };

  OnPiece nearest(const PairPiece& piece, const Shift& shift, const PairPoint& place) const {
    if (piece.line.empty()) {
      const PairBox box = moved(piece.box, shift);
      return {{std::clamp(place[0], box[0].lo, box[0].hi), std::clamp(place[1], box[1].lo, box[1].hi)}, 0};
    }
    OnPiece best{moved(piece.line.front(), shift), 0};
    double least = distance(best.at, place);
    for (std::size_t k = 0; k + 1 < piece.line.size(); ++k) {
      const PairPoint at = nearest_on(moved(piece.line[k], shift), moved(piece.line[k + 1], shift), place);
      const double far = distance(at, place);
      if (far < least) {
        least = far;
        best = {at, k};
      }
    }
    return best;
  }

  /// Walks along a piece's line from one of its points to another.
  void walk(const PairPiece& piece, const Shift& shift, const PairPoint& from, const PairPoint& to,
            std::vector<PairPoint>& path) const {
    if (!piece.line.empty()) {
      const std::size_t start = nearest(piece, shift, from).segment;
      const std::size_t stop = nearest(piece, shift, to).segment;
      for (std::size_t k = start + 1; k <= stop; ++k) path.push_back(moved(piece.line[k], shift));
      for (std::size_t k = start; k > stop; --k) path.push_back(moved(piece.line[k], shift));
    }
    path.push_back(to);
  }

  PairPoint middle_of(const PairPiece& piece, const Shift& shift) const {
    const PairBox box = moved(piece.box, shift);
    return {box[0].middle(), box[1].middle()};
  }

  /// Depth first through the exact pieces; where a branch ends the line goes back the way it came.
  void trace(const std::vector<std::size_t>& members, PairCluster& cluster) const {
    std::vector<std::size_t> exact;
    for (const std::size_t k : members) {
      if (pieces_[k].exact) exact.push_back(k);
    }
    struct Visit {
      std::size_t piece;
      Shift shift;
      PairPoint entry;
      std::size_t next = 0;
    };
    const auto exact_links = [&](std::size_t k) {
      std::vector<Link> links;
      for (const Link& link : links_[k]) {
        if (pieces_[link.to].exact) links.push_back(link);
      }
      return links;
    };
    // Begin at a loose end where there is one.
    std::size_t first = exact.front();
    for (const std::size_t k : exact) {
      if (exact_links(k).size() == 1) {
        first = k;
        break;
      }
    }
    std::vector<bool> wanted = on_the_way_to_exact(first);
    std::size_t left = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), true));
    std::vector<Visit> stack;
    std::vector<PairPoint> path;
    double error = 0;
    const auto enter = [&](std::size_t k, const Shift& shift, const PairPoint& entry) {
      const PairPiece& piece = pieces_[k];
      wanted[k] = false;
      --left;
      path.push_back(entry);
      PairPoint end = entry;
      if (piece.line.empty()) {
        end = middle_of(piece, shift);
        path.push_back(end);
        if (piece.exact) error = std::max(error, 0.5 * std::hypot(piece.box[0].width(), piece.box[1].width()));
      } else {
        const PairPoint front = moved(piece.line.front(), shift);
        const PairPoint back = moved(piece.line.back(), shift);
        const bool near_front = distance(entry, front) <= distance(entry, back);
        if (distance(entry, near_front ? front : back) > kJointWidth * period_) {
          walk(piece, shift, entry, near_front ? front : back, path);
          walk(piece, shift, near_front ? front : back, near_front ? back : front, path);
        } else {
          walk(piece, shift, entry, near_front ? back : front, path);
        }
        end = near_front ? back : front;
        error = std::max(error, piece.error);
      }
      stack.push_back({k, shift, end, 0});
    };
    const PairPiece& start = pieces_[first];
    PairPoint from = start.line.empty() ? middle_of(start, {0, 0}) : start.line.front();
    if (!start.line.empty() && !exact_links(first).empty()) {  // from the end that is not joined
      const Link link = exact_links(first).front();
      const PairPoint other = middle_of(pieces_[link.to], link.shift);
      if (distance(start.line.front(), other) < distance(start.line.back(), other)) from = start.line.back();
    }
    enter(first, {0, 0}, from);
    while (!stack.empty() && left > 0) {
      Visit& here = stack.back();
      if (here.next == links_[here.piece].size()) {
        stack.pop_back();
        if (stack.empty()) break;
        const Visit& below = stack.back();
        walk(pieces_[below.piece], below.shift, nearest(pieces_[below.piece], below.shift, path.back()).at, below.entry,
             path);
        continue;
      }
      const Link link = links_[here.piece][here.next++];
      if (!wanted[link.to]) continue;
      const Shift shift{here.shift[0] + link.shift[0], here.shift[1] + link.shift[1]};
      const PairPiece& piece = pieces_[here.piece];
      const PairPiece& other = pieces_[link.to];
      PairPoint entry = nearest(other, shift, here.entry).at;
      if (!other.line.empty()) {
        const PairPoint front = moved(other.line.front(), shift);
        const PairPoint back = moved(other.line.back(), shift);
        const double slack = kJointWidth * period_ + piece.error + other.error;
        if (distance(nearest(piece, here.shift, front).at, front) <= slack) {
          entry = front;
        } else if (distance(nearest(piece, here.shift, back).at, back) <= slack) {
          entry = back;
        }
      }
      const PairPoint exit = nearest(piece, here.shift, entry).at;
      walk(piece, here.shift, here.entry, exit, path);
      here.entry = exit;
      enter(link.to, shift, entry);
    }
    cluster.family = simplified(path, kFamilyDetail * period_);
    cluster.family_error = error + kFamilyDetail * period_;
  }

  /// The pieces that a walk from one of them must pass to come to every exact piece: a depth-first tree without the
  /// branches that lead to none.
  std::vector<bool> on_the_way_to_exact(std::size_t first) const {
    std::vector<bool> wanted(pieces_.size(), false);
    std::vector<bool> seen(pieces_.size(), false);
    std::vector<std::array<std::size_t, 2>> stack{{first, 0}};  // a piece and its next link
    seen[first] = true;
    while (!stack.empty()) {
      auto& [piece, next] = stack.back();
      if (next < links_[piece].size()) {
        const std::size_t to = links_[piece][next++].to;
        if (seen[to]) continue;
        seen[to] = true;
        stack.push_back({to, 0});
        continue;
      }
      const bool needed = pieces_[piece].exact || wanted[piece];
      wanted[piece] = needed;
      stack.pop_back();
      if (needed && !stack.empty()) wanted[stack.back()[0]] = true;
    }
    return wanted;
  }

  /// Drops points that the line runs through anyway (Douglas and Peucker).
  static std::vector<PairPoint> simplified(const std::vector<PairPoint>& path, double detail) {
    if (path.size() < 3) return path;
    std::vector<bool> kept(path.size(), false);
    kept.front() = true;
    kept.back() = true;
    std::vector<std::array<std::size_t, 2>> waiting{{0, path.size() - 1}};
    while (!waiting.empty()) {
      const auto [from, to] = waiting.back();
      waiting.pop_back();
      double most = detail;
      std::size_t farthest = 0;
      for (std::size_t k = from + 1; k < to; ++k) {
        const double far = distance(path[k], nearest_on(path[from], path[to], path[k]));
        if (far > most) {
          most = far;
          farthest = k;
        }
      }
      if (farthest == 0) continue;
      kept[farthest] = true;
      waiting.push_back({from, farthest});
      waiting.push_back({farthest, to});
    }
    std::vector<PairPoint> result;
    for (std::size_t k = 0; k < path.size(); ++k) {
      if (kept[k]) result.push_back(path[k]);
    }
    return result;
  }

  const std::vector<PairPiece>& pieces_;
  const std::vector<PairRoot>& roots_;
  double period_;
  bool closed_;
  double same_place_;
  std::vector<std::vector<Link>> links_;
  std::vector<bool> root_taken_;
};

}  // namespace

std::vector<PairCluster> join_pieces(const Part& part, const PairFindings& findings, double same_place) {
  return Joiner(part, findings, same_place).run();
}

}  // namespace rollfix
