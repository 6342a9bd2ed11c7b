#include "bounds.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "outline/turn.hpp"
#include "profile.hpp"
#include "touch/measured.hpp"
#include "touch/problem.hpp"
#include "work/crew.hpp"

// Notation, as in docs/touch.md, "How it works":
//   q_i, delta_i    a touch's measured centre, and how far it may be off: `Measured::at`, `place_most`
//   tau_i, eps_i    tangent in the world by a measured normal: `tangent`, `angle_most`
//   (c, rho), theta +- w   disc of the centres at a cell, and its tangents: CentreCell
//   a, b, i         cells of the first two touches, the pair, and another touch
//   phi +- h        the part's headings: HeadingArc
// Tests: ||c_b - c_a| - |q_b - q_a|| <= rho_a + rho_b + delta_a + delta_b; |tau - theta - phi| <= w + eps; and
// |c_i - c_a - R(-phi)(q_i - q_a)| <= rho_a + rho_i + delta_a + delta_i + 2 |q_i - q_a| sin(h / 2), likewise from b.
// Follows docs/identify.md, "Touches".
// Idea: the search of src/touch/cell_search.cpp down to 256 cells, on what is kept of a part. It stops at the first
// pair of cells that may hold all touches, or when a look at the part itself costs no more: then the part is left.
namespace rollfix::catalog {
namespace {

using touch::HeadingArc;
using touch::Measured;

// Parts that a thread looks at in one go: each takes up to kMostLooks comparisons.
constexpr std::size_t kTouchBlock = 64;
// So many cells of the next finer level lie in one.
constexpr std::size_t kFiner = 4;
// Headings are rounded, radians.
constexpr double kHeadingGrain = 1e-9;
// More comparisons than these take longer than to search the part: it is left then, which is always right.
constexpr std::size_t kMostLooks = 4000;

/// The cells of one part: the finest are made when they are asked for.
class PartCells {
 public:
  PartCells(const Catalog& catalog, std::size_t part, double radius)
      : index_(catalog.index()),
        part_(part),
        perimeter_(catalog.entry(part).perimeter),
        radius_(radius),
        places_(index_.places(part)) {
    levels_[0] = centre_cells(index_.coarse[part], places_.coarse, perimeter_, radius_);
    levels_[1] = centre_cells(index_.cells[part], places_.cells, perimeter_, radius_);
  }

  /// Levels: 16, 64 and 256 cells.
  std::size_t size() const { return levels_.size(); }
  /// Cells of a level; the finest ones come from the file.
  const std::vector<CentreCell>& level(std::size_t level) {
    if (levels_[level].empty()) {
      levels_[level] = centre_cells(index_.fine({part_}).front(), places_.fine, perimeter_, radius_);
    }
    return levels_[level];
  }

 private:
  const Catalog::Index& index_;
  std::size_t part_;
  double perimeter_;
  double radius_;  // of the finger
  CellPlaces places_;
  std::array<std::vector<CentreCell>, 3> levels_;  // from coarse to fine; empty: not asked for yet
};

/// One part: whether there is a pair of cells, and a cell for each other touch, that may go together.
class CellPairs {
 public:
  CellPairs(const std::vector<Measured>& touches, const touch::TouchPair& pair, PartCells& cells)
      : touches_(touches),
        pair_(pair),
        cells_(cells),
        chord_(touches[pair.second].at - touches[pair.first].at),
        apart_(chord_.norm()) {
    for (std::size_t k = 0; k < touches.size(); ++k) {
      if (k != pair.first && k != pair.second) others_.push_back(k);
    }
  }

  /// Whether some pose may have all touches on the part. False is certain. From all pairs of coarse cells, depth first;
  /// it stops at the first pair of finest cells that holds all.
  bool may_hold_all() {
    const std::size_t count = cells_.level(0).size();
    Lists lists;
    // Every other touch can be in any coarse cell at first.
    for (std::size_t k = 0; k < others_.size(); ++k) {
      lists.emplace_back(candidates_.size(), candidates_.size() + count);
      for (std::size_t cell = 0; cell < count; ++cell) candidates_.push_back(cell);
    }
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        if (may_hold(0, a, b, lists)) return true;
      }
    }
    return false;
  }

 private:
  using Lists = std::vector<std::pair<std::size_t, std::size_t>>;  // of each other touch, in candidates_

  /// How far the distance of two touches may be off, length.
  double slack(std::size_t one, std::size_t other) const {
    return touches_[one].place_most + touches_[other].place_most;
  }

  /// Headings of the part by one measured normal at a cell: |tau - theta - phi| <= w + eps. Without a normal all of
  /// them.
  static HeadingArc by_normal(const Measured& touch, const CentreCell& cell) {
    if (!touch.tangent) return {};
    return {nearest_angle(*touch.tangent - cell.angle), cell.half_turn + touch.angle_most + kHeadingGrain};
  }

  /// Headings that the part can have with the pair in these cells; none where the chord is too long or too short, or
  /// the normals and the chord don't agree.
  HeadingArc headings(const CentreCell& a, const CentreCell& b) const {
    const Vec2 chord = b.middle - a.middle;
    const double reach = a.radius + b.radius + slack(pair_.first, pair_.second);
    const double most = apart_ + reach, least = apart_ - reach;
    // By squares: most pairs fail here, without a root.
    const double square = chord.squaredNorm();
    if (square > most * most || (least > 0 && square < least * least)) return touch::kNoHeading;
    const HeadingArc normals = common(by_normal(touches_[pair_.first], a), by_normal(touches_[pair_.second], b));
    return normals.is_empty() ? normals : common(normals, touch::headings_between(chord, chord_, reach));
  }

  /// Whether these two, with what they leave to the others, may hold all touches: in one of the finest cells in them.
  bool may_hold(std::size_t level, std::size_t a, std::size_t b, const Lists& lists) {
    if (++looks_ > kMostLooks) return true;
    const std::vector<CentreCell>& cells = cells_.level(level);
    const HeadingArc arc = headings(cells[a], cells[b]);
    if (arc.is_empty()) return false;
    // The lists of this pair lie on the stack above `top`, and go with it.
    const std::size_t top = candidates_.size();
    const bool is_finest = level + 1 == cells_.size();
    // Each pair narrows its own lists; those that it was given are the others' as well.
    Lists own = lists;
    bool fits = true;
    for (std::size_t k = 0; k < others_.size() && fits; ++k) {
      fits = narrow(level, {&cells[a], &cells[b]}, arc, others_[k], own[k]);
    }
    // All 16 pairs of finer cells in these two, until one holds all.
    if (fits && !is_finest) {
      fits = false;
      for (std::size_t i = 0; i < kFiner * kFiner && !fits; ++i) {
        fits = may_hold(level + 1, kFiner * a + i / kFiner, kFiner * b + i % kFiner, own);
      }
    }
    candidates_.resize(top);
    return fits;
  }

  /// Where another touch can be, with the pair in its cells.
  std::array<CentreCell, 2> expected(const std::array<const CentreCell*, 2>& pair, const HeadingArc& arc,
                                     std::size_t touch) const {
    std::array<CentreCell, 2> discs;
    // The part's heading is within h of the middle one: the vector between two touches swings by at most 2 sin(h / 2)
    // of its length.
    const double swing = arc.is_all() ? 2 : 2 * std::sin(0.5 * arc.half);
    const double cosine = std::cos(arc.middle), sine = std::sin(arc.middle);
    for (std::size_t k = 0; k < 2; ++k) {
      // As seen from either touch of the pair: the vector to the other touch, turned back by the part's heading.
      const std::size_t from = k == 0 ? pair_.first : pair_.second;
      const Vec2 vector = touches_[touch].at - touches_[from].at;
      discs[k].middle =
          pair[k]->middle + Vec2(cosine * vector.x() + sine * vector.y(), cosine * vector.y() - sine * vector.x());
      discs[k].radius = pair[k]->radius + slack(touch, from) + swing * vector.norm();
    }
    return discs;
  }

  /// Of a list of cells those in which another touch can be, as a new one on the stack: of the next finer cells, or of
  /// the finest at least one.
  bool narrow(std::size_t level, const std::array<const CentreCell*, 2>& pair, const HeadingArc& arc, std::size_t touch,
              std::pair<std::size_t, std::size_t>& list) {
    const bool is_finest = level + 1 == cells_.size();
    const std::vector<CentreCell>& cells = cells_.level(level);
    const std::array<CentreCell, 2> discs = expected(pair, arc, touch);
    const Measured& one = touches_[touch];
    const std::size_t top = candidates_.size();
    // Each cell of the list is compared once.
    looks_ += list.second - list.first;
    for (std::size_t k = list.first; k < list.second; ++k) {
      const std::size_t number = candidates_[k];
      const CentreCell& cell = cells[number];
      const auto is_beyond = [&](const CentreCell& disc) {
        const double most = disc.radius + cell.radius;
        return (disc.middle - cell.middle).squaredNorm() > most * most;
      };
      if (is_beyond(discs[0]) || is_beyond(discs[1])) continue;
      // Its normal has to fit a heading of the arc as well.
      if (one.tangent) {
        const double off = std::abs(nearest_angle(*one.tangent - cell.angle - arc.middle));
        if (off > cell.half_turn + one.angle_most + arc.half + kHeadingGrain) continue;
      }
      // One cell is enough on the finest level.
      if (is_finest) return true;
      for (std::size_t i = 0; i < kFiner; ++i) candidates_.push_back(kFiner * number + i);
    }
    list = {top, candidates_.size()};
    return list.first != list.second;
  }

  const std::vector<Measured>& touches_;
  touch::TouchPair pair_;
  PartCells& cells_;
  Vec2 chord_;                           // from the pair's first touch to its second, in the world
  double apart_;                         // how long that is
  std::vector<std::size_t> others_;      // all touches but the pair
  std::vector<std::size_t> candidates_;  // a stack
  std::size_t looks_ = 0;                // comparisons so far
};

}  // namespace

TouchBounds::TouchBounds(const Catalog& catalog, const TouchProblem& like)
    : catalog_(catalog), radius_(touch::radius_of(like)) {
  touches_ = touch::measured(like.mirrored ? touch::in_mirror(like) : like);
  // Only touches with a place: normals alone rule out few cells.
  std::erase_if(touches_, [](const touch::Measured& touch) { return !touch.has_place; });
  if (touches_.size() > 1) pair_ = touch::choose_pair(touches_);
}

std::vector<std::size_t> TouchBounds::left_of(const std::vector<std::size_t>& parts,
                                              const IdentifyOptions& options) const {
  // One place rules out nothing: it fits every part.
  if (touches_.size() < 2) return parts;
  std::vector<char> fits(parts.size(), 0);
  Crew crew(parts.size(), kTouchBlock);
  crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) {
      PartCells cells(catalog_, parts[k], radius_);
      fits[k] = CellPairs(touches_, pair_, cells).may_hold_all() ? 1 : 0;
    }
  });
  crew.require_done();
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (fits[k] != 0) left.push_back(parts[k]);
  }
  return left;
}

}  // namespace rollfix::catalog
