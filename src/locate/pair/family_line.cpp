#include "components.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// Notation:
//   (s, t)          a pair of first contacts: PairPoint; unwrapped by `shift`, whole laps in s and in t
//   piece, link     nodes and edges of the graph of pieces that touch: `pieces_`, `links_`
//   exact           f = 0 on all of the piece; others are only passed through on the way to one
//   error           how far the line may be off the set on which f = 0: `error_` + `detail_`
// Follows docs/search.md, "Two fingers", step 5: the `family` of a stretch. Points are dropped as in D. H. Douglas and
// T. K. Peucker, "Algorithms for the reduction of the number of points required to represent a digitized line" (1973).
// Idea: depth-first through the exact pieces; where a branch ends the line goes back the way it came, so that it stays
// one line through all of them.
namespace rollfix::locating {
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
