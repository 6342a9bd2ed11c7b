#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "belief/nodes.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::belief {

/// Two fingers' rows as they come, in constant memory: as at most kMostNodes nodes of equally many rows each, a power
/// of two. What the rows come to does not depend on when that is asked.
class PairRows {
 public:
  /// `robust`: of the rows of a node medians are taken first, of up to 16 neighbours, so that an outlier does not move
  /// it.
  explicit PairRows(bool robust) : robust_(robust) {}

  /// `centres`: of a row where they are looked at: of all or of none.
  void add(const Reading& row, const std::optional<PairCentres>& centres);
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Reading& last() const { return last_; }  // REQUIRES !empty()
  /// Of every row so far.
  bool have_centres() const { return with_centres_ == size_; }

  /// All rows so far as nodes. `facing`: the first contacts'; where it is given it is the first node, with their
  /// `centres`. `errors`: what is even motion, and what a row is worth.
  std::vector<PairNode> nodes(const std::optional<double>& facing, const std::optional<PairCentres>& centres,
                              const PairErrors& errors) const;

 private:
  /// Neighbouring rows together.
  struct Block {
    std::array<double, 2> length{};  // sums over medians; so is the turn
    double turn = 0;
    double medians = 0;
    std::size_t rows = 0;
    PairCentres centres{};  // mean, where they are looked at
  };

  /// Both as one; the centres are means by the numbers of rows.
  static Block joined(const Block& a, const Block& b);
  Block block_of(std::size_t begin, std::size_t end, std::size_t of_median) const;
  /// All rows so far as blocks of equally many; the last one may have fewer.
  std::vector<Block> blocks() const;
  std::vector<Course> courses_of(const std::vector<Block>& blocks, const PairErrors& errors) const;
  std::optional<std::vector<Block>> middles_of(std::vector<Block> means, const PairErrors& errors) const;
  std::vector<Block> joined_where_even(std::vector<Block> blocks, const PairErrors& errors) const;
  /// From rows that are all kept to blocks of medians; from then on no row is kept longer than its unit fills.
  void condense();
  /// Each two neighbouring blocks as one.
  void halve();

  bool robust_;                   // see the constructor
  std::size_t size_ = 0;          // rows so far
  std::size_t with_centres_ = 0;  // of these, the rows with centres
  Reading last_;
  std::vector<Reading> rows_;         // all of them, while they are few; then those that are in no block yet
  std::vector<PairCentres> centres_;  // of the rows in rows_
  std::vector<Block> blocks_;         // complete ones
  Block open_;                        // the one that is filling, of whole units
  std::size_t rows_of_block_ = 0;     // 0: there are no blocks yet
};

}  // namespace rollfix::belief
