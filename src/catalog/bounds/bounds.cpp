#include "bounds.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "answer/crew.hpp"
#include "halving.hpp"

// Notation, as in docs/identify.md, "How parts are ruled out":
//   cells           16, 64 and 256 equal stretches of a part's boundary: `kCoarseCells`, `kCells`, `kFineCells`
//   profile         the least and the largest Theta on each cell
//   way             one of the ways in which the roll may have gone (either direction): RollClues
//   few, many       a dozen readings for cells, some more for stretches of the part
// Follows docs/identify.md, "How parts are ruled out".
// Idea: a part is ruled out when no cell is left in which the roll can have started: by 16 cells, then by 64 in memory,
// by 256 from the file, then by stretches of the part itself. Each step only looks at what the one before has left.
namespace rollfix {
namespace {

// Parts that a thread looks at in one go: in memory, and with what is read from the file.
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
    const Cells<kCoarseCells> coarse = cells_left(index_.coarse[part], course, way.few, ~Cells<kCoarseCells / 4>());
    Cells<kCells> cells;
    if (coarse.any()) cells = cells_left(index_.cells[part], course, way.few, coarse);
    candidate.cells.push_back(cells);
    is_any = is_any || cells.any();
  }
  return is_any || index_.measured[part] != 0;
}

std::optional<PartLeft> Bounds::look_closely(const Candidate& candidate, const Profile<kFineCells>& fine) const {
  PartLeft left{candidate.part};
  if (index_.measured[candidate.part] != 0) return left;
  const std::vector<RollClues>& ways = ways_on(candidate.part);
  std::optional<Part> part;
  bool is_any = false;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    Cells<kFineCells>& cells = left.cells.emplace_back();
    if (candidate.cells[k].none()) continue;
    const bool is_one_finger = ways[k].few.fingers == 1;
    const Clues& clues = is_one_finger ? ways[k].many : ways[k].few;
    cells = cells_left(fine, index_.courses[candidate.part], clues, candidate.cells[k]);
    if (is_one_finger && cells.any()) {
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
  std::vector<std::vector<Candidate>> blocks((parts.size() + kBlock - 1) / kBlock);
  Crew crew(parts.size(), kBlock);
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
  const std::vector<Candidate> in_memory = candidates(parts, options);
  std::vector<std::optional<PartLeft>> closely(in_memory.size());
  Crew crew(in_memory.size(), kReadBlock);
  crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
    std::vector<std::size_t> block;
    for (std::size_t k = lo; k < hi; ++k) block.push_back(in_memory[k].part);
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

}  // namespace rollfix
