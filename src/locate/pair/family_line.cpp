#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "components.hpp"
#include "line_search.hpp"
#include "locate/searches.hpp"

// Where curves run along each other: the other equations vanish all along the line that the guide leaves.
// Notation, as in line_search.cpp:
//   x, y, g         the free contact and the bound one; the guide, the equation that is solved for y: `guide_`
//   r_k(x)          the other equations along that line: `residual`
//   rounding        what an r_k that is 0 may be off, by the rates of all contacts: `residual_rounding`
//   overlap         a stretch of x, in the box, on which every r_k and its slope are 0 but for rounding
// Follows docs/search.md, "Two fingers", step 5.
// Idea: on one piece r_k has fewer degrees of freedom than there are samples: zero at all of them, it is zero in
// between. Where both fingers go straight, its two ends are enough.
namespace rollfix::locating {
namespace {

// Zero at more points than the functions have degrees of freedom on one piece: zero between them, too.
constexpr int kOverlapSamples = 19;
// On an overlap the slope along the line is 0 too, up to this share of the rates that it is made of.
constexpr double kOverlapSlope = 1e-8;
// An overlap shorter than this share of the perimeter can't be told from a root.
constexpr double kShortestOverlap = 1e-9;
// An arc length is rounded to this share of the perimeter: times the curvature, an angle.
constexpr double kResidualRounding = 4e-15;

}  // namespace

bool LineSearch::may_overlap() {
  if (!choose_guide() || is_apart_midway()) return false;
  Stretch all{place(free().lo()), place(free().hi()), 0, false};
  if (!clip(all, 0)) return false;
  return vanishes(place(0.5 * (all.lo.free.x + all.hi.free.x)));
}

/// Is another equation surely not 0 at a place of the line in the box? Looks about in the middle, where one point on
/// each side and the slopes' bounds nearly always tell that curves do not run along each other. False: not known.
bool LineSearch::is_apart_midway() const {
  const PlaneCurve::Component& of_free = free().component(guide_);
  const PlaneCurve::Component& of_bound = bound().component(guide_);
  const double shift = (free_is_a_ ? 1 : -1) * sides_.shift(guide_, limits_);
  const double rise = of_free.last - of_free.first;
  const auto reached = [&](double value) {  // along the chord, in the box
    return rise == 0 ? 0.5 : std::clamp((value + shift - of_free.first) / rise, 0.0, 1.0);
  };
  const double share = 0.5 * (reached(of_bound.first) + reached(of_bound.last));
  const double level = of_free.first + share * rise - shift;
  const double across = std::clamp((level - of_bound.first) / (of_bound.last - of_bound.first), 0.0, 1.0);
  const CurvePoint on_free = free().point(free().lo() + share * free().width());
  const CurvePoint on_bound = bound().point(bound().lo() + across * bound().width());
  // The guide is nearly 0 at the two points. Its slope's bounds tell how far y may be from the line there.
  const double off = on_free.value(guide_) - on_bound.value(guide_) - shift;
  const Range way = Range{off, off} / bound().slope(guide_);  // of the bound contact to where the guide is 0
  if (on_bound.x + way.least < bound().lo() || on_bound.x + way.most > bound().hi()) return false;
  const double rounding = residual_rounding({on_free, on_bound});
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row == guide_) continue;
    const double turns = (free_is_a_ ? 1 : -1) * sides_.shift(row, limits_);
    const double residual = on_free.value(row) - on_bound.value(row) - turns;
    // Bounds on r_k on the line itself.
    const Range there = Range{residual, residual} - way * bound().slope(row);
    if (there.least > rounding || there.most < -rounding) return true;
  }
  return false;
}

/// Are all residuals 0 but for rounding? The guide's is by construction.
bool LineSearch::vanishes(const Place& place) const {
  const double rounding = residual_rounding(place);
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row != guide_ && std::abs(residual(place, row)) > rounding) return false;
  }
  return true;
}

/// What a residual that is 0 may be computed as, radians: Theta's accuracy, and the rounding of places times all rates.
double LineSearch::residual_rounding(const Place& place) const {
  double rates = 0;
  for (const double rate : place.free.rates()) rates += std::abs(rate);
  for (const double rate : place.bound.rates()) rates += std::abs(rate);
  return 2 * kTurnAccuracy + kResidualRounding * limits_.perimeter * rates;
}

/// Do the curves coincide all along the part of a stretch that lies in the box?
bool LineSearch::overlaps(const Stretch& whole, std::vector<Place>& samples) const {
  for (const Place* end : {&whole.lo, &whole.hi}) {  // one that is not clipped: nearly always that settles it
    if (end->bound.x >= bound().lo() && end->bound.x <= bound().hi() && !vanishes(*end)) return false;
  }
  Stretch stretch = whole;
  if (turns_round(stretch)) {  // all of it must be in the box
    const Range reached = bounds(stretch).bound_x;
    if (reached.least < bound().lo() || reached.most > bound().hi()) return false;
  } else if (!clip(stretch, 0)) {
    return false;
  }
  const double width = stretch.hi.free.x - stretch.lo.free.x;
  if (width <= kShortestOverlap * (free().pivots() ? 1 : limits_.perimeter)) return false;
  if (!vanishes(stretch.lo) || !vanishes(stretch.hi)) return false;
  if (free().is_straight() && bound().is_straight()) {  // zero in between where it is at both ends
    if (!slopes_vanish(stretch.lo)) return false;
    samples = {stretch.lo, stretch.hi};
    return true;
  }
  samples.reserve(kOverlapSamples + 1);
  samples.push_back(stretch.lo);
  for (int k = 1; k < kOverlapSamples; ++k) {
    samples.push_back(place(stretch.lo.free.x + width * k / kOverlapSamples));
    if (!slopes_vanish(samples.back()) || !vanishes(samples.back())) return false;
  }
  samples.push_back(stretch.hi);
  return true;
}

bool LineSearch::slopes_vanish(const Place& at) const {
  double scale = 1 / limits_.perimeter;
  for (const double rate : at.free.rates()) scale += std::abs(rate);
  for (const double rate : at.bound.rates()) scale += std::abs(rate * direction(at));
  for (std::size_t row = 0; row < free().rows(); ++row) {
    if (row != guide_ && std::abs(residual_slope(at, row)) > kOverlapSlope * scale) return false;
  }
  return true;
}

/// Where dy/dx changes sign between two places: the line's extreme y there, by bisection to the last bit.
LineSearch::Place LineSearch::turn_between(const Place& one, const Place& two) const {
  double lo = one.free.x;
  double hi = two.free.x;
  const bool rises = direction(one) > 0;
  while (true) {
    const double middle = 0.5 * (lo + hi);
    if (!(middle > lo && middle < hi)) return place(lo);
    ((direction(place(middle)) > 0) == rises ? lo : hi) = middle;
  }
}

/// The set within the tolerance is a band about the line: it also holds what lies beyond the line's ends, where the
/// line leaves the box at a slant.
void LineSearch::take_overlap(const Stretch& whole, std::vector<Place> samples) {
  for (std::size_t k = samples.size() - 1; k > 0; --k) {  // backwards: what is put in moves the rest
    if (direction(samples[k - 1]) * direction(samples[k]) >= 0) continue;
    samples.insert(samples.begin() + static_cast<std::ptrdiff_t>(k), turn_between(samples[k - 1], samples[k]));
  }
  PairPiece piece;
  piece.exact = true;
  piece.corner = sides_.pivots();
  for (const Place& sample : samples) piece.line.push_back(contacts(sample));
  std::vector<PairPoint> around = piece.line;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    // Between two samples the line is no further from its chord than its change of direction allows; twice that, for
    // the direction may change more in between.
    const double width = samples[k].free.x - samples[k - 1].free.x;
    const double bend = 0.5 * width * std::abs(direction(samples[k]) - direction(samples[k - 1]));
    piece.error = std::max(piece.error, bend);
    for (const Vec2& corner : band(samples[k - 1], samples[k], bend)) around.push_back(contacts(corner));
  }
  piece.box = box_about(around);
  piece.error = length_of(piece.error + margin_);
  findings_.roots.push_back({piece.line.front(), 0, piece.corner});
  findings_.pieces.push_back(std::move(piece));
  if (whole.covered) return;
  if (whole.lo.free.x < samples.front().free.x) add_beyond(whole.lo, samples.front());
  if (whole.hi.free.x > samples.back().free.x) add_beyond(samples.back(), whole.hi);
}

/// What a line that has left the box still has within the tolerance in it.
void LineSearch::add_beyond(const Place& lo, const Place& hi) {
  const Range y = bounds({lo, hi, 0, false}).bound_x;
  if (!passes_by(lo, hi, y)) add_piece(lo, hi, y);
}

// ---- families
// Notation:
//   (s, t)          a pair of first contacts: PairPoint; unwrapped by `shift`, whole laps in s and in t
//   piece, link     nodes and edges of the graph of pieces that touch: `pieces_`, `links_`
//   exact           f = 0 on all of the piece; others are only passed through on the way to one
//   error           how far the line may be off the set on which f = 0: `error_` + `detail_`
// Follows docs/search.md, "Two fingers", step 5: the `family` of a stretch. Points are dropped as in D. H. Douglas and
// T. K. Peucker, "Algorithms for the reduction of the number of points required to represent a digitized line" (1973).
// Idea: depth-first through the exact pieces; where a branch ends the line goes back the way it came, so that it stays
// one line through all of them.

namespace {

// A family's line keeps no point that is closer than this share of the perimeter to the line through the others.
constexpr double kFamilyDetail = 1e-7;

/// The part of a segment nearest to a point.
PairPoint nearest_on(const PairPoint& a, const PairPoint& b, const PairPoint& p) {
  const double x = b[0] - a[0];
  const double y = b[1] - a[1];
  const double square = x * x + y * y;
  // The foot of the perpendicular from p, as a share of the segment, kept on it.
  const double share = square > 0 ? std::clamp(((p[0] - a[0]) * x + (p[1] - a[1]) * y) / square, 0.0, 1.0) : 0;
  return {a[0] + share * x, a[1] + share * y};
}

/// The nearest point of a piece to a place, by its position along the piece's line.
struct OnPiece {
  PairPoint at;
  std::size_t segment = 0;
};

/// Of a piece that is moved by `shift`. Without a line it is the box that counts.
OnPiece nearest(const PairPiece& piece, const Shift& shift, const PairPoint& place) {
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
          std::vector<PairPoint>& path) {
  if (!piece.line.empty()) {
    const std::size_t start = nearest(piece, shift, from).segment;
    const std::size_t stop = nearest(piece, shift, to).segment;
    for (std::size_t k = start + 1; k <= stop; ++k) path.push_back(moved(piece.line[k], shift));
    for (std::size_t k = start; k > stop; --k) path.push_back(moved(piece.line[k], shift));
  }
  path.push_back(to);
}

PairPoint middle_of(const PairPiece& piece, const Shift& shift) {
  const PairBox box = moved(piece.box, shift);
  return {box[0].middle(), box[1].middle()};
}

/// Drops points that the line runs through anyway (Douglas and Peucker).
std::vector<PairPoint> simplified(const std::vector<PairPoint>& path, double detail) {
  if (path.size() < 3) return path;
  std::vector<bool> kept(path.size(), false);
  kept.front() = true;
  kept.back() = true;
  std::vector<std::array<std::size_t, 2>> waiting{{0, path.size() - 1}};
  while (!waiting.empty()) {
    const auto [from, to] = waiting.back();
    waiting.pop_back();
    // The chord from..to is kept where no point in between is off it by more than the detail; else it is cut at the
    // farthest.
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

/// A walk through a set's exact pieces that leaves a line behind it: `path_`.
class Tracer {
 public:
  Tracer(const std::vector<PairPiece>& pieces, const std::vector<std::vector<PieceLink>>& links, double period)
      : pieces_(pieces), links_(links), joint_(kJointWidth * period), detail_(kFamilyDetail * period) {}

  /// REQUIRES an exact piece among the members.
  FamilyLine run(const std::vector<std::size_t>& members) {
    const std::size_t first = loose_end(members);
    wanted_ = on_the_way_to_exact(first);
    left_ = static_cast<std::size_t>(std::count(wanted_.begin(), wanted_.end(), true));
    enter(first, {0, 0}, free_end(first));
    // The stack holds the way from the first piece to the one in which the walk stands; ends when all wanted ones are
    // done.
    while (!stack_.empty() && left_ > 0) {
      Visit& here = stack_.back();
      if (here.next == links_[here.piece].size()) {
        turn_back();
      } else {
        const PieceLink& link = links_[here.piece][here.next++];
        if (wanted_[link.to]) cross_to(link);
      }
    }
    return {simplified(path_, detail_), error_ + detail_};
  }

 private:
  /// A piece that the walk is in, or will come back to.
  struct Visit {
    std::size_t piece;
    Shift shift;
    PairPoint at;          // where on it the walk stands
    std::size_t next = 0;  // of its links, to be tried
  };

  /// How many links lead to exact pieces.
  std::size_t exact_neighbours(std::size_t piece) const {
    return static_cast<std::size_t>(std::count_if(links_[piece].begin(), links_[piece].end(),
                                                  [&](const PieceLink& link) { return pieces_[link.to].exact; }));
  }

  /// An exact piece with one exact neighbour where there is one, or the first.
  std::size_t loose_end(const std::vector<std::size_t>& members) const {
    std::size_t first = pieces_.size();
    for (const std::size_t k : members) {
      if (!pieces_[k].exact) continue;
      if (exact_neighbours(k) == 1) return k;
      if (first == pieces_.size()) first = k;
    }
    return first;
  }

  /// Where on the first piece to begin: at the end that is not joined.
  PairPoint free_end(std::size_t first) const {
    const PairPiece& start = pieces_[first];
    if (start.line.empty()) return middle_of(start, {0, 0});
    if (exact_neighbours(first) == 0) return start.line.front();
    const PieceLink& link = links_[first].front();
    const PairPoint other = middle_of(pieces_[link.to], link.shift);
    const bool joins_at_front = distance(start.line.front(), other) < distance(start.line.back(), other);
    return joins_at_front ? start.line.back() : start.line.front();
  }

  /// Goes all along a piece, from where it is entered.
  void enter(std::size_t k, const Shift& shift, const PairPoint& entry) {
    const PairPiece& piece = pieces_[k];
    // Once for each piece: a piece that is passed again on the way back is not entered again.
    wanted_[k] = false;
    --left_;
    path_.push_back(entry);
    if (piece.line.empty()) {
      const PairPoint middle = middle_of(piece, shift);
      path_.push_back(middle);
      // All of the box is zero: its corners are half a diagonal off the point that stands for it.
      if (piece.exact) error_ = std::max(error_, 0.5 * std::hypot(piece.box[0].width(), piece.box[1].width()));
      stack_.push_back({k, shift, middle});
      return;
    }
    // From the entry to the nearer end first, if that is not the entry, then all the way to the other one.
    PairPoint near = moved(piece.line.front(), shift);
    PairPoint far = moved(piece.line.back(), shift);
    if (distance(entry, far) < distance(entry, near)) std::swap(near, far);
    if (distance(entry, near) > joint_) {
      walk(piece, shift, entry, near, path_);
      walk(piece, shift, near, far, path_);
    } else {
      walk(piece, shift, entry, far, path_);
    }
    error_ = std::max(error_, piece.error);
    stack_.push_back({k, shift, far});
  }

  /// To a neighbour that has not been visited.
  void cross_to(const PieceLink& link) {
    Visit& here = stack_.back();
    const Shift shift{here.shift[0] + link.shift[0], here.shift[1] + link.shift[1]};
    const PairPiece& piece = pieces_[here.piece];
    const PairPoint entry = entry_to(link.to, shift, here);
    // Along this piece to where the neighbour begins.
    const PairPoint exit = nearest(piece, here.shift, entry).at;
    walk(piece, here.shift, here.at, exit, path_);
    here.at = exit;
    enter(link.to, shift, entry);
  }

  /// The end of the other's line that this piece touches, or else the point of it that is nearest.
  PairPoint entry_to(std::size_t to, const Shift& shift, const Visit& here) const {
    const PairPiece& piece = pieces_[here.piece];
    const PairPiece& other = pieces_[to];
    if (!other.line.empty()) {
      const double slack = joint_ + piece.error + other.error;
      for (const PairPoint& end : {moved(other.line.front(), shift), moved(other.line.back(), shift)}) {
        if (distance(nearest(piece, here.shift, end).at, end) <= slack) return end;
      }
    }
    return nearest(other, shift, here.at).at;
  }

  /// A piece is done: back to where the walk left the one before it.
  void turn_back() {
    stack_.pop_back();
    if (stack_.empty()) return;
    const Visit& below = stack_.back();
    const PairPiece& piece = pieces_[below.piece];
    walk(piece, below.shift, nearest(piece, below.shift, path_.back()).at, below.at, path_);
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
      // All branches of this piece are done: it is needed if it is exact or one of them led to an exact one.
      const bool needed = pieces_[piece].exact || wanted[piece];
      wanted[piece] = needed;
      stack.pop_back();
      if (needed && !stack.empty()) wanted[stack.back()[0]] = true;
    }
    return wanted;
  }

  const std::vector<PairPiece>& pieces_;
  const std::vector<std::vector<PieceLink>>& links_;
  double joint_;              // lines that end closer together than this continue each other, length
  double detail_;             // points this near to the line through the others are dropped, length
  std::vector<bool> wanted_;  // pieces that are still to be visited
  std::size_t left_ = 0;      // how many
  std::vector<Visit> stack_;
  std::vector<PairPoint> path_;  // gone so far, unwrapped
  double error_ = 0;             // the largest of the pieces' own
};

}  // namespace

FamilyLine line_through_family(const std::vector<PairPiece>& pieces, const std::vector<std::vector<PieceLink>>& links,
                               const std::vector<std::size_t>& members, double period) {
  return Tracer(pieces, links, period).run(members);
}

}  // namespace rollfix::locating
