#include "rollfix/solve.hpp"

#include <cstdint>
#include <limits>
#include <tuple>

#include "rollfix/error.hpp"
#include "work/crew.hpp"

// Many problems at once, each on its own.
// Idea: threads take problems in order. The table of answers is made in blocks, one for each `kBlock` problems, and
// joined at the end: so no thread waits for another, and the result does not depend on their number.
namespace rollfix {
namespace {

// Problems that a thread takes at once: so many that taking them costs nothing, so few that all threads end together.
constexpr std::size_t kBlock = 64;

/// One row of the table: a value for each column, for both fingers where there are two.
void add_placement(const Placement& placement, AnswerTable& table) {
  table.kind.push_back(static_cast<std::uint8_t>(placement.kind));
  bool whole = true;
  for (std::size_t which = 0; which < table.fingers; ++which) {
    table.start.push_back(placement.start[which]);
    table.end.push_back(placement.end[which]);
    table.extent.push_back(placement.extent[which].lo);
    table.extent.push_back(placement.extent[which].hi);
    table.point.push_back(placement.point[which].x());
    table.point.push_back(placement.point[which].y());
    table.tangent.push_back(placement.tangent[which]);
    whole = whole && placement.whole_loop[which];
  }
  table.error.push_back(placement.error);
  table.residual.push_back(placement.residual);
  table.probability.push_back(placement.probability);
  table.whole_loop.push_back(whole ? 1 : 0);
}

/// The rows of one problem are those between two `offsets`.
void add_answer(const Answer& answer, AnswerTable& table) {
  for (const Placement& placement : answer.placements) add_placement(placement, table);
  table.status.push_back(static_cast<std::uint8_t>(answer.status));
  table.verdict.push_back(static_cast<std::uint8_t>(answer.verdict.name));
  table.tolerance.push_back(answer.tolerance.value);
  table.offsets.push_back(static_cast<std::int64_t>(table.kind.size()));
}

/// A problem without an answer has a row nowhere.
void add_error(std::size_t k, const std::string& message, AnswerTable& table) {
  table.errors.emplace_back(k, message);
  table.status.push_back(static_cast<std::uint8_t>(Status::incomplete));
  table.verdict.push_back(static_cast<std::uint8_t>(Verdict::undecided));
  table.tolerance.push_back(std::numeric_limits<double>::quiet_NaN());
  table.offsets.push_back(static_cast<std::int64_t>(table.kind.size()));
}

/// Room for what a block of problems mostly has, in columns with a value for each problem, for each placement, and for
/// each finger of a placement.
void reserve(AnswerTable& table) {
  constexpr std::size_t kRows = 6 * kBlock;
  const std::size_t each = kRows * table.fingers;
  table.offsets.reserve(kBlock + 1);
  for (auto* column : {&table.status, &table.verdict}) column->reserve(kBlock);
  for (auto* column : {&table.kind, &table.whole_loop}) column->reserve(kRows);
  for (auto* column : {&table.error, &table.residual, &table.probability}) column->reserve(kRows);
  for (auto* column : {&table.start, &table.end, &table.tangent}) column->reserve(each);
  for (auto* column : {&table.extent, &table.point}) column->reserve(2 * each);
}

// All columns but `offsets`, which count rows across blocks.
constexpr auto kColumns = std::make_tuple(
    &AnswerTable::status, &AnswerTable::verdict, &AnswerTable::tolerance, &AnswerTable::errors, &AnswerTable::kind,
    &AnswerTable::start, &AnswerTable::end, &AnswerTable::extent, &AnswerTable::point, &AnswerTable::tangent,
    &AnswerTable::error, &AnswerTable::residual, &AnswerTable::probability, &AnswerTable::whole_loop);

/// One column of all blocks, one after the other; theirs is let go of on the way.
template <class Column>
void join_column(std::vector<AnswerTable>& blocks, Column AnswerTable::*column, AnswerTable& all) {
  std::size_t size = 0;
  for (const AnswerTable& block : blocks) size += (block.*column).size();
  (all.*column).reserve(size);
  for (AnswerTable& block : blocks) {
    (all.*column).insert((all.*column).end(), (block.*column).begin(), (block.*column).end());
    Column().swap(block.*column);
  }
}

/// Blocks in the order of the problems; `offsets` go on from block to block.
AnswerTable joined(std::vector<AnswerTable>& blocks, std::size_t fingers) {
  AnswerTable all;
  all.fingers = fingers;
  for (const AnswerTable& block : blocks) {
    // A block's offsets begin at 0: its rows come behind those of all blocks before.
    const std::int64_t rows = all.offsets.back();
    for (std::size_t k = 1; k < block.offsets.size(); ++k) all.offsets.push_back(rows + block.offsets[k]);
  }
  std::apply([&](auto... columns) { (join_column(blocks, columns, all), ...); }, kColumns);
  return all;
}

}  // namespace

/// `make` changes a copy of `like` into problem k; each block has its own copy. A problem is solved or has the message
/// of its InputError; other exceptions end the run: `require_done`.
AnswerTable solve_table(const Problem& like, std::size_t count, const ProblemMaker& make, std::size_t fingers,
                        const ManyOptions& options) {
  std::vector<AnswerTable> blocks((count + kBlock - 1) / kBlock);
  // A block is done by one thread, which alone writes to its table.
  Crew crew(count, kBlock);
  crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
    AnswerTable& table = blocks[lo / kBlock];
    table.fingers = fingers;
    reserve(table);
    Problem problem = like;
    for (std::size_t k = lo; k < hi; ++k) {
      try {
        make(k, problem);
        add_answer(solve(problem), table);
      } catch (const InputError& error) {
        add_error(k, error.what(), table);
      }
    }
  });
  crew.require_done();
  return joined(blocks, fingers);
}

}  // namespace rollfix
