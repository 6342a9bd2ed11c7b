#include "bounds.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "cells.hpp"
#include "part/turning_range.hpp"
#include "profile.hpp"
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

}  // namespace rollfix::catalog
