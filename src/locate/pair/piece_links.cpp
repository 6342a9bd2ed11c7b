#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "components.hpp"
#include "work/union_find.hpp"

// Notation:
//   piece           a connected set of pairs (s, t) within the tolerance: a box, a convex `hull`, or a `line`, off by
//                   `error` at the most
//   shift           whole laps by which a piece is moved in s and in t: (s, t) and (s + P, t) are one pair
//   slack           pieces that come as near as this are one: `same_place_`, or `kJointWidth` P where both are exact
//   slant           s + `kSlant` t, the direction that pieces are sorted along
//   clump           pieces too small and too near together to be told apart, joined beforehand
// Follows docs/search.md, "Two fingers", step 7.
// Idea: sweep along the slant, and link the pieces that touch while their reaches are open. Whether two do is seen by
// separating axes: pieces are convex sets, or lines of them.
namespace rollfix::locating {
namespace {

/// Does a segment come closer than `slack` to a box, along both axes? Clips the segment's parameter by the widened
/// box's four sides.
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
    // Parallel to these two sides: outside of both, or they cut nothing off.
    if (step == 0) {
      if (least > 0 || most < 0) return false;
      continue;
    }
    lo = std::max(lo, std::min(least / step, most / step));
    hi = std::min(hi, std::max(least / step, most / step));
  }
  return lo <= hi;
}

using Corners = boost::container::small_vector<PairPoint, 8>;

/// The corners of a piece's hull, or of its box where it has none, moved by `shift`.
Corners polygon_of(const PairPiece& piece, const Shift& shift) {
  Corners polygon;
  for (const PairPoint& point : piece.hull) polygon.push_back(moved(point, shift));
  if (!polygon.empty()) return polygon;
  const PairBox box = moved(piece.box, shift);
  return {{box[0].lo, box[1].lo}, {box[0].hi, box[1].lo}, {box[0].hi, box[1].hi}, {box[0].lo, box[1].hi}};
}

/// Is there a direction, along one of `one`'s edges or across it, in which the two convex polygons are further apart
/// than `slack`? Two convex polygons that are apart are so across an edge of one of them.
bool separates(const Corners& one, const Corners& two, double slack) {
  for (std::size_t k = 0; k < one.size(); ++k) {
    const PairPoint& from = one[k];
    const PairPoint& to = one[(k + 1) % one.size()];
    const double length = distance(from, to);
    if (length == 0) continue;
    const PairPoint along{(to[0] - from[0]) / length, (to[1] - from[1]) / length};
    for (const PairPoint& axis : {along, PairPoint{-along[1], along[0]}}) {
      // What a polygon takes up along the axis.
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

/// Do the boxes come as near as `slack` to each other?
bool boxes_meet(const PairBox& one, const PairBox& two, double slack) {
  return one[0].lo <= two[0].hi + slack && two[0].lo <= one[0].hi + slack && one[1].lo <= two[1].hi + slack &&
         two[1].lo <= one[1].hi + slack;
}

/// Do the pieces come as near as `slack`, the second one moved by `shift`? Both errors are added to the slack.
bool pieces_meet(const PairPiece& one, const PairPiece& two, const Shift& shift, double slack) {
  const PairBox other = moved(two.box, shift);
  const double reach = slack + one.error + two.error;
  if (!boxes_meet(one.box, other, reach)) return false;
  if (one.line.empty() && two.line.empty()) {
    // Two boxes meet where their intervals do. Else convex polygons: apart where an axis of either one separates them.
    if (one.hull.empty() && two.hull.empty()) return true;
    const Corners at_one = polygon_of(one, {0, 0});
    const Corners at_two = polygon_of(two, shift);
    return !separates(at_one, at_two, reach) && !separates(at_two, at_one, reach);
  }
  // With a line against a box, or against another line segment by segment.
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

// A strip with more pieces than this is cut into bands of about so many each.
constexpr std::size_t kPiecesOfBand = 1024;

// What is found where a finger pivots may be a million pieces at one place, and each meets each. Those that begin in
// the same square with sides of this share of the width below which places are one are joined to the first of them, a
// clump.
constexpr double kClump = 0.25;

/// Can nothing in the piece be told from its box's corner? `width` is a clump's.
bool is_a_point(const PairPiece& piece, double width) {
  return !piece.exact && piece.line.empty() &&
         std::max(piece.box[0].width(), piece.box[1].width()) + piece.error <= width;
}

/// Finds for each piece those that it touches, without looking at all pairs.
class Linker {
 public:
  Linker(const std::vector<PairPiece>& pieces, const Boundary& boundary, double same_place)
      : pieces_(pieces),
        boundary_(boundary),
        same_place_(same_place),
        room_(pieces_.size(), 0),
        joined_(pieces_.size()),
        links_(pieces_.size()) {}

  std::vector<std::vector<PieceLink>> run() {
    link();
    for (std::vector<PieceLink>& links : links_) {
      // Exact neighbours first, otherwise in the order in which they were found.
      std::stable_partition(links.begin(), links.end(), [&](const PieceLink& link) { return pieces_[link.to].exact; });
    }
    return std::move(links_);
  }

 private:
  /// The laps by which a piece can be moved to touch another one: none, or one either way in s and in t.
  std::vector<Shift> shifts() const {
    if (!boundary_.closed) return {{0, 0}};
    std::vector<Shift> all;
    for (const double s : {0.0, -boundary_.perimeter, boundary_.perimeter}) {
      for (const double t : {0.0, -boundary_.perimeter, boundary_.perimeter}) all.push_back({s, t});
    }
    return all;
  }

  double slack_of(bool both_exact) const { return both_exact ? kJointWidth * boundary_.perimeter : same_place_; }

  /// Where a piece can be, with its error, and with all of its clump.
  PairBox reach_box(std::size_t piece) const {
    return widened(pieces_[piece].box, pieces_[piece].error + room_[piece]);
  }

  /// Links both ways. `shift` brings `two` to `one`.
  void join(std::size_t one, std::size_t two, const Shift& shift) {
    joined_.join(one, two);
    links_[one].push_back({two, shift});
    links_[two].push_back({one, {-shift[0], -shift[1]}});
  }

  /// Would a link between two pieces change nothing? They hang together already, and one of them is not exact: only a
  /// family is walked along all of its links.
  bool adds_nothing(std::size_t one, std::size_t two) {
    return joined_.find(one) == joined_.find(two) && !(pieces_[one].exact && pieces_[two].exact);
  }

  /// Joins each clump to its first piece, which stands for it from here on: returns what is left to be swept.
  std::vector<std::size_t> clump() {
    std::vector<std::size_t> left;
    std::map<std::array<double, 2>, std::size_t> firsts;
    const double width = kClump * same_place_;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const PairBox& box = pieces_[k].box;
      if (!is_a_point(pieces_[k], width)) {
        left.push_back(k);
        continue;
      }
      // The square that the box's corner is in; the first piece of each square is kept.
      const auto [at, is_first] = firsts.try_emplace({std::floor(box[0].lo / width), std::floor(box[1].lo / width)}, k);
      if (is_first) {
        left.push_back(k);
        continue;
      }
      const std::size_t first = at->second;
      room_[first] = 2 * width;  // a square's side and a box in it
      join(first, k, {0, 0});
    }
    return left;
  }

  /// The box around all pieces' reaches. A piece that does not meet it, moved by a shift, meets nothing on that lap:
  /// most pieces are far from s = 0 and t = 0.
  PairBox box_around_all() const {
    PairBox all{Boundary::empty_arc(), Boundary::empty_arc()};
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const PairBox box = reach_box(k);
      for (const std::size_t axis : {0U, 1U}) {
        all[axis] = {std::min(all[axis].lo, box[axis].lo), std::max(all[axis].hi, box[axis].hi)};
      }
    }
    return all;
  }

  /// Orders neighbours that begin at the same s: by how far they reach along s, and by where from.
  void rank(const std::vector<std::size_t>& swept) {
    std::vector<Interval> along_s;
    along_s.reserve(swept.size());
    for (const std::size_t k : swept) along_s.push_back(reach_box(k)[0]);
    const auto width = [&](std::size_t at) {
      // Widths in powers of two, those below a joint's alike.
      return std::ilogb(std::max(along_s[at].width(), kJointWidth * boundary_.perimeter));
    };
    std::vector<std::size_t> order = by_place(along_s);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return width(a) < width(b); });
    rank_.resize(pieces_.size());
    for (std::size_t k = 0; k < order.size(); ++k) rank_[swept[order[k]]] = k;
  }

  /// Pieces that reach about as far along the slant, exact ones or others. Of many, those that begin at about the same
  /// t are a band: an area has as many on the same slant as it is wide. In each in order of where they begin on the
  /// slant.
  struct Strip {
    std::vector<std::vector<std::size_t>> bands;
    double band_from = 0;    // t at which the first begins
    double band_height = 0;  // along t
    double tallest = 0;      // piece along t
    double widest = 0;       // piece along the slant
    bool exact = false;

    std::size_t band_at(double t) const {
      const auto last = static_cast<double>(bands.size() - 1);
      return last > 0 ? static_cast<std::size_t>(std::clamp((t - band_from) / band_height, 0.0, last)) : 0;
    }
  };
  using Strips = std::map<std::pair<int, bool>, Strip>;

  /// Strips by the power of two of the pieces' reach along the slant, exact ones apart.
  Strips strips(const std::vector<std::size_t>& swept, const PairBox& whole) {
    Strips strips;
    for (const std::size_t k : swept) {
      const bool exact = pieces_[k].exact;
      Strip& strip = strips[{std::ilogb(std::max(reach_[k].width(), slack_of(exact))), exact}];
      if (strip.bands.empty()) strip.bands.resize(1);
      strip.bands.front().push_back(k);
      strip.widest = std::max(strip.widest, reach_[k].width());
      strip.exact = exact;
    }
    for (auto& [key, strip] : strips) {
      split_in_bands(strip, whole[1]);
      for (std::vector<std::size_t>& band : strip.bands) {
        std::sort(band.begin(), band.end(), [&](std::size_t a, std::size_t b) { return reach_[a].lo < reach_[b].lo; });
      }
    }
    return strips;
  }

  /// Cuts a strip of many pieces into bands of equal height along t.
  void split_in_bands(Strip& strip, const Interval& t) const {
    const std::size_t count = 1 + strip.bands.front().size() / kPiecesOfBand;
    if (count == 1 || !(t.width() > 0)) return;
    const std::vector<std::size_t> all = std::move(strip.bands.front());
    strip.bands.assign(count, {});
    strip.band_from = t.lo;
    strip.band_height = t.width() / static_cast<double>(count);
    for (const std::size_t k : all) {
      const Interval along_t = reach_box(k)[1];
      strip.bands[strip.band_at(along_t.lo)].push_back(k);
      strip.tallest = std::max(strip.tallest, along_t.width());
    }
  }

  /// Sweeps along the slant: a piece meets those whose reach is still open. Each width by itself, lest a wide piece, or
  /// one with a large error, has every narrow one looked at; and exact ones, which are joined from further off, too.
  void link() {
    if (pieces_.size() < 2) return;
    // From here on clumps are one piece each, with `room_` around it.
    const std::vector<std::size_t> swept = clump();
    reach_.reserve(pieces_.size());
    for (std::size_t k = 0; k < pieces_.size(); ++k) reach_.push_back(along_slant(reach_box(k)));
    rank(swept);
    const PairBox whole = box_around_all();
    const Strips all = strips(swept, whole);
    std::vector<std::size_t> near;
    for (const Shift& shift : shifts()) {
      const PairBox moved_whole = moved(whole, shift);
      for (const std::size_t one : swept) {
        // No other piece, so moved, comes near this one.
        if (!boxes_meet(reach_box(one), moved_whole, 2 * kJointWidth * boundary_.perimeter)) continue;
        near.clear();
        for (const auto& [key, strip] : all) add_near(strip, one, shift, near);
        // In an order that does not depend on strips and bands: which links are made first decides which ones add
        // nothing.
        std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
          return std::tie(pieces_[a].box[0].lo, rank_[a]) < std::tie(pieces_[b].box[0].lo, rank_[b]);
        });
        for (const std::size_t two : near) {
          if (adds_nothing(one, two)) continue;
          const bool both_exact = pieces_[one].exact && pieces_[two].exact;
          const double slack = slack_of(both_exact) + room_[one] + room_[two];
          if (!pieces_meet(pieces_[one], pieces_[two], shift, slack)) continue;
          if (both_exact) {  // the other way as well, when it is that one's turn
            joined_.join(one, two);
            links_[one].push_back({two, shift});
          } else {
            join(one, two, shift);
          }
        }
      }
    }
  }

  /// Those whose boxes, moved by the shift, meet the piece's.
  void add_near(const Strip& strip, std::size_t piece, const Shift& shift, std::vector<std::size_t>& near) {
    const PairPiece& one = pieces_[piece];
    const double slack = slack_of(one.exact && strip.exact);
    // Only those that begin in [from, to] along the slant can meet the piece: none is wider than `widest`.
    const double by = along_slant(shift);
    const double room = along_slant(PairPoint{slack, slack});
    const double from = reach_[piece].lo - by - strip.widest - room;
    const double to = reach_[piece].hi - by + room;
    const double t = strip.bands.size() > 1 ? reach_box(piece)[1].lo - shift[1] : 0;
    const double height = strip.bands.size() > 1 ? reach_box(piece)[1].width() : 0;
    // A piece of this strip that meets [t, t + height] begins no more than `tallest` below it.
    const std::size_t last = strip.band_at(t + height + slack);
    for (std::size_t at = strip.band_at(t - slack - strip.tallest); at <= last; ++at) {
      const std::vector<std::size_t>& band = strip.bands[at];
      auto next = std::lower_bound(band.begin(), band.end(), from,
                                   [&](std::size_t k, double value) { return reach_[k].lo < value; });
      for (; next != band.end() && reach_[*next].lo <= to; ++next) {
        if (*next != piece && !adds_nothing(piece, *next) &&
            boxes_meet(reach_box(piece), moved(reach_box(*next), shift), slack)) {
          near.push_back(*next);
        }
      }
    }
  }

  const std::vector<PairPiece>& pieces_;
  const Boundary& boundary_;
  double same_place_;
  std::vector<double> room_;       // around each piece for the rest of its clump
  UnionFind joined_;               // what hangs together by links
  std::vector<Interval> reach_;    // of each piece along the slant
  std::vector<std::size_t> rank_;  // of each piece
  std::vector<std::vector<PieceLink>> links_;
};

}  // namespace

bool line_meets(const std::vector<PairPoint>& line, const Shift& shift, const PairBox& box, double slack) {
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    if (segment_meets(moved(line[k], shift), moved(line[k + 1], shift), box, slack)) return true;
  }
  return false;
}

std::vector<std::vector<PieceLink>> links_of(const std::vector<PairPiece>& pieces, const Boundary& boundary,
                                             double same_place) {
  return Linker(pieces, boundary, same_place).run();
}

}  // namespace rollfix::locating
