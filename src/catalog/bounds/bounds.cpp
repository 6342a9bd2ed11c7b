#include "bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "part/turning_range.hpp"
#include "touch/measured.hpp"
#include "touch/problem.hpp"
#include "work/crew.hpp"

// Notation, as in docs/identify.md, "How parts are ruled out":
//   cells           16, 64 and 256 equal stretches of a part's boundary: `kCoarseCells`, `kCells`, `kFineCells`
//   profile         the least and the largest Theta on each cell
//   way             one of the ways in which the roll may have gone (either direction): RollClues
//   few, many       a dozen readings for cells, some more for stretches of the part
//   s, L            starts on a stretch of one part; a reading's length with its slack gives the interval of ends
//   tau             the tangent at the start: what Theta on the stretch and every reading leave of it: `tangent`
//   slack, box      how far a reading's turn may be off as if it had no error of its own, and with the most that it can
//                   have
//   cost            least sum of squares of all errors, in standard deviations: `least_cost`
// Follows docs/identify.md, "How parts are ruled out"; the last step with exact bounds on Theta (turning_range.hpp).
// Idea: a part is ruled out when no cell is left in which the roll can have started: by 16 cells, then by 64 in memory,
// by 256 from the file, then by stretches of the part itself. Each step only looks at what the one before has left. The
// last one does the same as cells.cpp, on stretches that are halved down to `kShortest` of the perimeter: there the
// search takes over.
namespace rollfix::catalog {
namespace {

// A stretch is not halved below this share of the perimeter: the search takes over. Smaller rules out more parts and
// takes longer for those that stay.
constexpr double kShortest = 1.0 / 4096;

/// One start at a time.
using One = Eigen::Array<double, 1, 1>;

/// The halves of stretches of one part.
class Halving {
 public:
  /// The clues have to be of one finger, and to outlive it.
  Halving(const Part& part, const Clues& clues) : part_(part), turning_(part.turning()), clues_(clues) {
    for (const Clue& clue : clues.clues) {
      slack_.push_back(clue.slack(turning_.most_curvature()) + kTurnRounding);
      box_.push_back(slack_.back() + std::sqrt(clues.most_cost) * (clue.turn_sd + clues.shared_sd));
    }
  }

  /// Whether a start may lie in this stretch. Depth first, so that the first short stretch that fits ends it. Exact
  /// bounds on Theta shrink with the stretch, so that what fits nowhere is found out soon.
  bool may_start(const Interval& stretch) const {
    if (!fits(stretch)) return false;
    if (stretch.width() <= kShortest * part_.perimeter()) return true;
    const double middle = stretch.lo + 0.5 * stretch.width();
    return may_start({stretch.lo, middle}) || may_start({middle, stretch.hi});
  }

 private:
  /// Whether all readings may start in this stretch with one tangent tau. False is certain: every bound is a cover, and
  /// roundings go outwards.
  bool fits(const Interval& stretch) const {
    const Interval start = angles_over(turning_, stretch);
    // tau lies in Theta of the stretch, and by each reading in Theta of its ends less the turn, both widened: eq. (5)
    // over stretches.
    Interval tangent = start;
    std::vector<Asked<One>> asked;
    for (std::size_t k = 0; k < slack_.size(); ++k) {
      const Clue& clue = clues_.clues[k];
      const double off = clue.length_slack + kShareRounding * (std::abs(clue.length[0]) + part_.perimeter());
      Interval end{stretch.lo + clue.length[0] - off, stretch.hi + clue.length[0] + off};
      // On an open outline a roll has to end on it.
      if (!part_.closed()) {
        end = {std::max(end.lo, 0.0), std::min(end.hi, part_.perimeter())};
        if (end.hi < end.lo) return false;
      }
      const Interval angles = angles_over(turning_, end);
      tangent = {std::max(tangent.lo, angles.lo - clue.turn - box_[k]),
                 std::min(tangent.hi, angles.hi - clue.turn + box_[k])};
      // No tangent is left: no start in this stretch fits.
      if (!(tangent.lo <= tangent.hi)) return false;
      // Only a row with an error of its own adds to the sum of squares.
      if (clue.turn_sd <= 0) continue;
      asked.push_back({One(angles.lo - clue.turn - slack_[k]), One(angles.hi - clue.turn + slack_[k]),
                       1 / (clue.turn_sd * clue.turn_sd)});
    }
    // Without noise there are no squares to add up.
    if (clues_.most_cost == 0) return true;
    const Start<One> one{One(start.lo), One(start.hi), clues_.shared_sd};
    return least_cost(one, asked, clues_.most_cost)[0] <= clues_.most_cost;
  }

  const Part& part_;
  const TurningFunction& turning_;
  const Clues& clues_;
  std::vector<double> slack_;  // of each clue's turn, radians, its own error aside
  std::vector<double> box_;    // the same with the most that its own and the shared error can be
};

}  // namespace

bool may_start(const Part& part, const Clues& clues, const Cells<kFineCells>& cells) {
  const Halving halving(part, clues);
  // Cells that are left are searched from the first on; the first start that may fit ends it.
  const double step = part.perimeter() / kFineCells;
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const auto at = static_cast<double>(k);
    if (cells[k] && halving.may_start({step * at, step * (at + 1)})) return true;
  }
  return false;
}

namespace {

// Parts that a thread looks at in one go: in memory, and with what is read from the file. Larger blocks take less time
// between threads, smaller ones share the work more evenly.
constexpr std::size_t kBlock = 1024;
constexpr std::size_t kReadBlock = 64;

}  // namespace

Bounds::Bounds(const Catalog& catalog, const Problem& like, double excess)
    : catalog_(catalog), index_(catalog.index()), clues_(clues_of(catalog, like, excess)) {}

const std::vector<RollClues>& Bounds::ways_on(std::size_t part) const {
  return clues_[catalog_.entry(part).reversed ? 1 : 0];
}

bool Bounds::look_in_memory(Candidate& candidate) const {
  const std::size_t part = candidate.part;
  candidate.cells.clear();
  bool is_any = false;
  for (const RollClues& way : ways_on(part)) {
    const Course& course = index_.courses[part];
    // From all 16 cells; then only the 64 within those that are left.
    const Cells<kCoarseCells> coarse = cells_left(index_.coarse[part], course, way.few, ~Cells<kCoarseCells / 4>());
    Cells<kCells> cells;
    if (coarse.any()) cells = cells_left(index_.cells[part], course, way.few, coarse);
    candidate.cells.push_back(cells);
    is_any = is_any || cells.any();
  }
  // Bounds on an outline that is not exact say nothing certain: such a part always stays.
  return is_any || index_.measured[part] != 0;
}

std::optional<PartLeft> Bounds::look_closely(const Candidate& candidate, const Profile<kFineCells>& fine) const {
  PartLeft left{candidate.part};
  // Without cells: anywhere.
  if (index_.measured[candidate.part] != 0) return left;
  // Each way by itself; a part stays if one of them does.
  const std::vector<RollClues>& ways = ways_on(candidate.part);
  std::optional<Part> part;
  bool is_any = false;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    Cells<kFineCells>& cells = left.cells.emplace_back();
    if (candidate.cells[k].none()) continue;
    // Of two fingers the squares of errors are not added up: `few` holds for pairs of cells.
    const bool is_one_finger = ways[k].few.fingers == 1;
    const Clues& clues = is_one_finger ? ways[k].many : ways[k].few;
    cells = cells_left(fine, index_.courses[candidate.part], clues, candidate.cells[k]);
    if (is_one_finger && cells.any()) {
      // Loading a part takes longer than its cells: only where these leave something.
      if (!part) part = catalog_.part(candidate.part);
      if (!may_start(*part, clues, cells)) cells.reset();
    }
    is_any = is_any || cells.any();
  }
  if (!is_any) return std::nullopt;
  return left;
}

std::vector<Bounds::Candidate> Bounds::candidates(const std::vector<std::size_t>& parts,
                                                  const IdentifyOptions& options) const {
  // A list for each block, so that the order is that of the parts however many threads there are.
  std::vector<std::vector<Candidate>> blocks((parts.size() + kBlock - 1) / kBlock);
  Crew crew(parts.size(), kBlock);
  // Too quick to be asked whether to go on.
  crew.run(options.threads, {}, [&](std::size_t lo, std::size_t hi) {
    Candidate candidate;
    for (std::size_t k = lo; k < hi; ++k) {
      candidate.part = parts[k];
      if (look_in_memory(candidate)) blocks[lo / kBlock].push_back(candidate);
    }
  });
  crew.require_done();
  std::vector<Candidate> all;
  for (std::vector<Candidate>& block : blocks) std::move(block.begin(), block.end(), std::back_inserter(all));
  return all;
}

std::vector<PartLeft> Bounds::left_of(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const {
  // First all parts by what is in memory, then those that are left by what has to be read.
  const std::vector<Candidate> in_memory = candidates(parts, options);
  std::vector<std::optional<PartLeft>> closely(in_memory.size());
  Crew crew(in_memory.size(), kReadBlock);
  crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
    std::vector<std::size_t> block;
    for (std::size_t k = lo; k < hi; ++k) block.push_back(in_memory[k].part);
    // One call for a block of parts, so that the file is locked and opened once.
    const std::vector<Profile<kFineCells>> fine = index_.fine(block);
    for (std::size_t k = lo; k < hi; ++k) closely[k] = look_closely(in_memory[k], fine[k - lo]);
  });
  crew.require_done();
  std::vector<PartLeft> left;
  for (std::optional<PartLeft>& one : closely) {
    if (one) left.push_back(std::move(*one));
  }
  return left;
}

// ---- touches
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
