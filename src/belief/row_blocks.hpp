#pragma once

#include <cstddef>
#include <memory_resource>
#include <numbers>
#include <span>
#include <vector>

#include "belief/error_model.hpp"
#include "belief/tilted_boundary.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::belief {

// The fingers' centres in the world as evidence: they go along the part's offset curve.

inline constexpr double kHalfTurn = std::numbers::pi;

/// Positions along the boundary as a table: cubics between places so close together that they are as good as the
/// outline.
class BoundaryPath {
 public:
  explicit BoundaryPath(const Part& part);

  /// Any s on a closed boundary; beyond an open one's ends it goes on straight.
  Vec2 at(double s) const;

 private:
  struct Cell {
    double s;       // where it begins
    double length;  // of the cell, above 0
    Vec2 from;      // positions at both ends
    Vec2 to;
    Vec2 by_from;  // derivatives by the share of the cell
    Vec2 by_to;
  };

  bool closed_;  // the outline's
  double perimeter_;
  std::vector<Cell> cells_;  // in order of s, without gaps
  Buckets buckets_;
};

/// What a row says of a finger's centre.
struct FeltCentre {
  Vec2 centre = Vec2::Zero();  // in the world
  Arm arm;                     // from it to the contact
};

/// What all hypotheses about one finger's roll have in common.
struct CentreModel {
  const Part* part = nullptr;          // that is rolled on
  const BoundaryPath* path = nullptr;  // where centres are evidence
  bool has_place = false;              // the centre was felt; else only the normal
  FeltCentre first;                    // at the first contact
  double normal = 0;                   // N(u) + psi at the first contact, radians
  double variance = 0;      // of a coordinate, each row on its own; 0: they are no evidence, but tell the pose
  double radius_share = 0;  // of the variance of the scale of lengths, as far as it is a wrong radius
};

/// What one finger read at an instant.
struct Row {
  Reading reading;
  double finger_curvature = 0;  // where the finger touches
  double seconds = 0;           // since the roll's start
  double sensed = 0;            // of the turn, what a gyroscope would have measured; radians
  FeltCentre felt{};            // where its centre is, if that is looked at
};

/// Whether a log's first row is not its start: what it says was measured on the way to it.
inline bool has_way_to_first(LogKind kind, double length, double turn) {
  return kind != LogKind::contact && (length != 0 || turn != 0);
}

/// When such a log started: its first row is taken to have lasted as long as the second. Seconds.
inline double start_before(double first, double second) { return first - (second - first); }

/// Rows that are taken together: their means, or of increments the last of them.
struct JoinedRows {
  double length = 0;
  double turn = 0;
  double sensed = 0;   // of the turn, by a gyroscope
  double scatter = 0;  // variance of turn + tilt times length among the rows
  RowCovariance own;   // of the mean, where each row is off on its own
  FeltCentre felt{};   // where centres are looked at
  double rows = 0;
  double seconds = 0;  // at the last of them, ...
  double middle = 0;   // ... and as a mean, as of the others

  double tilted(double tilt) const { return turn + tilt * length; }
};

/// A roll's rows, joined to blocks of equally many: when there are too many blocks, neighbours are joined, and from
/// then on twice as many rows make one.
class RowBlocks {
 public:
  /// `robust`: medians of the rows of a block are taken first, so that an outlier does not move its mean. `most`:
  /// blocks at which neighbours are to be joined.
  RowBlocks(const ErrorModel& errors, double tilt, bool robust, std::size_t most, std::pmr::memory_resource* memory)
      : errors_(errors), tilt_(tilt), robust_(robust), most_(most), blocks_(memory), of_median_(memory) {}

  /// True: a block is complete with it.
  bool add(const Row& row);
  /// There are too many blocks.
  bool is_full() const { return blocks_.size() >= most_ && blocks_.size() % 2 == 0; }
  void halve();
  /// Two neighbours as one: their mean, but of increments the last row.
  JoinedRows joined(const JoinedRows& a, const JoinedRows& b) const;

  const std::pmr::vector<JoinedRows>& complete() const { return blocks_; }
  std::size_t rows_of_block() const { return stride_; }
  /// After the complete blocks there are rows, ...
  bool has_open() const { return sum_.rows > 0; }
  /// ... these.
  JoinedRows open() const;

 private:
  void close_median(JoinedRows& sum, double& medians) const;

  ErrorModel errors_;
  double tilt_;             // c of w = Theta + c s
  bool robust_;             // medians are taken
  std::size_t most_;        // blocks
  std::size_t stride_ = 1;  // rows of a block
  double rows_ = 0;         // of the roll so far
  Interval range_;          // of all lengths so far
  std::pmr::vector<JoinedRows> blocks_;
  // Of the block that is being made: sums over medians of rows, and the rows of the median that is being filled.
  JoinedRows sum_;
  double medians_ = 0;
  std::pmr::vector<Row> of_median_;
  RowCovariance own_;  // of one of its rows
};

// Rows of which a median is taken: enough that several outliers don't matter, few enough to lie close together.
inline constexpr std::size_t kRowsOfMedian = 16;
/// What rows that are taken together come to: each number's median. REQUIRES no more than kRowsOfMedian.
Reading median_of(std::span<const Reading> rows);
/// Rows that are taken together before a mean is taken: of robust ones by their median.
std::size_t rows_of_median(bool robust, std::size_t stride);

}  // namespace rollfix::belief
