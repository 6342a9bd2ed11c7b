#pragma once

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <memory_resource>
#include <numbers>
#include <optional>
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
  double seconds = 0;         // at the last of them, ...
  double middle = 0;          // ... and as a mean, as of the others
  double length_scatter = 0;  // variance of the length among the rows

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

/// Of an even number of values the mean of the two in the middle. It sorts the values in part. REQUIRES at least one.
double median(std::span<double> values);

// Rows of which a median is taken: enough that several outliers don't matter, few enough to lie close together.
inline constexpr std::size_t kRowsOfMedian = 16;
/// What rows that are taken together come to: each number's median. REQUIRES no more than kRowsOfMedian.
Reading median_of(std::span<const Reading> rows);
/// Rows that are taken together before a mean is taken: of robust ones by their median.
std::size_t rows_of_median(bool robust, std::size_t stride);

// ---- nodes

/// One measurement of neighbouring rows, or of means over lots of them.
struct Course {
  std::vector<double> values;
  double sd = 0;               // of the noise of one of them
  std::vector<double> rows{};  // of each lot; none: as many in each
};

/// Of rows with noise no fewer means are taken, where few are enough.
inline constexpr std::size_t kFewestMeans = 12;

/// The fewest means, at most so many, that say what the rows say. `means_of(lots)` makes them of so many lots; none:
/// the motion goes too uneven for that.
template <class MeansOf>
auto fewest_means(std::size_t most, const MeansOf& means_of) {
  decltype(means_of(most)) means;
  for (std::size_t lots = kFewestMeans; lots <= most && !means; lots *= 2) means = means_of(lots);
  return means;
}

/// Whether rows follow a smooth motion, but for noise.
bool is_even(const Course& rows);

/// What the measurement was in the middle of each mean's rows; none: it goes too uneven for that.
/// REQUIRES kFewestMeans values or more.
std::optional<std::vector<double>> at_middles(const Course& means);

// A roll's rows are joined to at most this many nodes, however many rows there are, ...
inline constexpr std::size_t kMostNodes = 512;
// ... on a boundary that turns to and fro to as many more, up to so many times: a mean over rows on a bend is off it.
inline constexpr double kMostFiner = 16;
// A boundary that turns so many times as much as a circle, to and fro, has bends that are as many times shorter.
inline constexpr double kWavy = 4;

/// Neighbouring rows of a roll as one: their mean, which is as good as all of them where they are close together.
struct Node {
  double length = 0;
  double turn = 0;
  double sensed = 0;   // of the turn, what a gyroscope has measured
  double seconds = 0;  // from the roll's start, as a mean
  double spread = 0;   // variance of turn + tilt times length among the rows, of the course without its noise
  RowCovariance own;   // of the mean
  Gathered gathered;   // by the offsets, from the last row of the node before to this one's
  double rows = 1;     // that are joined
  double worth = 0;    // as many rows on their own; less than there are where they are off alike
  FeltCentre felt{};   // where centres are looked at: means

  /// What has gathered by the last row goes into the mean with this share: all of the first row's part does, and next
  /// to nothing of the last one's. The sums over rows that are evenly spaced.
  double share_in_mean() const { return (rows + 1) / (2 * rows); }
  /// Of the variance that this makes, so much less of what gathers is in the mean itself.
  double share_averaged() const { return (rows + 1) * (rows - 1) / (6 * rows * rows); }
};

/// Neighbouring groups of rows among which no motion shows: each is where the others are, and none of them leads away.
class Rest {
 public:
  /// Whether a group of rows, whose mean has this covariance, goes on with it.
  bool goes_on(const JoinedRows& group, const RowCovariance& own) const;
  void add(const JoinedRows& group, const JoinedRows& joined, double travelled);

  std::size_t groups() const { return groups_; }
  const JoinedRows& rows() const { return rows_; }  // joined
  double travelled() const { return travelled_; }   // length

 private:
  std::size_t groups_ = 0;
  JoinedRows rows_;
  double travelled_ = 0;
  Vec2 last_ = Vec2::Zero();      // (length, turn) of the last group
  Vec2 sum_ = Vec2::Zero();       // of all of them, ...
  Vec2 by_index_ = Vec2::Zero();  // ... and times their number, from 0
};

/// A group is halved so often at most while it fills.
inline constexpr int kPendingHalvings = 4;
using PendingNodes = boost::container::static_vector<Node, std::size_t{1} << kPendingHalvings>;

/// A roll's rows as no more than a fixed number of nodes, however many rows there are. Where what gathers on the way is
/// seen in many of them, there are far fewer, each of as many blocks of rows as it takes: a node's place on the path is
/// one more unknown, and at places that weigh the same errors otherwise such unknowns leave chance a say that grows
/// with their number. docs/belief.md derives it.
class Nodes {
 public:
  /// `robust`, `most`: see RowBlocks. `by_walk`: fewer where what gathers is seen, but more where the boundary `turns`,
  /// to and fro, so many times as much as a circle. `memory`: for all that it keeps.
  Nodes(const ErrorModel& errors, double tilt, bool robust, std::size_t most = kMostNodes, bool by_walk = true,
        double turns = 1, std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : errors_(errors),
        tilt_(tilt),
        by_walk_(by_walk),
        finer_(std::max(1.0, (turns / kWavy) * (turns / kWavy))),
        blocks_(errors, tilt, robust, most, memory),
        nodes_(memory),
        travel_(errors.travel(memory)) {}

  void add(const Row& row);

  /// Those that will not change until `generation` does.
  const std::pmr::vector<Node>& complete() const { return nodes_; }
  std::size_t generation() const { return generation_; }  // grows when nodes are joined
  /// The rows after them: one node, or several as of any group.
  PendingNodes pending() const;
  std::size_t rows() const { return rows_; }
  /// As many independent equations as the nodes are.
  double freedom() const;
  /// What the turn has gathered in all: a standard deviation.
  double turn_gathered() const;

 private:
  /// Whether rests are joined: among rows that do not move chance has a say that grows with their number.
  bool joins_rests() const { return by_walk_ && !errors_.gathers_rows() && errors_.centre_variance() <= 0; }
  /// Where the roll is when a node begins, by w from its start, and when; nothing before the first one.
  struct Behind {
    bool is_first = true;
    double w = 0;
    double seconds = 0;
  };
  Behind behind() const;
  /// One more complete node, with its last row at `seconds`.
  void push(const Node& node, double seconds);
  /// The blocks from `begin` on, which are these rows, as one node, or as several where the finger goes much farther in
  /// them than in other groups: `take` is given each. They are halved so often at most.
  template <class Take>
  void split(std::size_t begin, std::size_t blocks, const JoinedRows& rows, double travelled, int halvings,
             Behind& behind, const Take& take) const;
  void push_group(std::size_t begin, std::size_t blocks, const JoinedRows& rows, double travelled);
  bool goes_far(const JoinedRows& rows, const Behind& behind) const;
  /// None of the groups so far is part of it.
  void begin_rest();
  /// What has gathered, and how well the rows together would know one length and one turn.
  struct Walk {
    double length = 0;
    double turn = 0;
    double length_rows = 0;  // sum of 1 / variance
    double turn_rows = 0;

    void add(const Node& node);
    /// So many sines of the course are off more by what has gathered than by the rows' own errors.
    double modes() const;
  };
  /// There are more nodes than serve, for as far as the finger has travelled and for what has gathered on the way.
  bool are_too_many() const;
  /// Of the block that begins here and those after it.
  JoinedRows group(std::size_t begin) const { return joined(begin, group_); }
  JoinedRows joined(std::size_t begin, std::size_t blocks) const;
  void complete_node(const JoinedRows& rows);
  void make_again();
  Node node_of(const JoinedRows& rows, double travelled, const Behind& behind) const;
  /// How far the course leads from their mean, on average: see Node.
  double spread_of(const JoinedRows& rows, const Behind& behind) const;
  /// Rows behind so many blocks, as a place on the way.
  Travel::Mark mark(std::size_t blocks, const JoinedRows& rows) const;
  double rows_of_node() const { return static_cast<double>(group_ * blocks_.rows_of_block()); }

  ErrorModel errors_;
  double tilt_;
  bool by_walk_;  // see the constructor
  double finer_;  // nodes are so many times shorter than slip asks for
  std::size_t generation_ = 0;
  std::size_t rows_ = 0;   // of the roll so far
  RowBlocks blocks_;       // all complete rows, as blocks
  std::size_t group_ = 1;  // blocks of a node
  std::pmr::vector<Node> nodes_;
  Travel travel_;          // of them
  Walk walk_;              // likewise
  double seconds_ = 0;     // at the last one's last row
  Rest rest_;              // of the last groups
  bool is_held_ = false;   // it is a node that grows: not among the complete ones
  std::size_t taken_ = 0;  // blocks, by the nodes and the rest
  std::size_t parts_ = 0;  // nodes beyond one for each group
  double way_ = 0;         // that the finger has gone, length
  // As they were when it began.
  std::size_t nodes_before_ = 0;
  Walk walk_before_;
  double seconds_before_ = 0;
};

/// Some of the nodes, evenly, the first and the last among them.
std::pmr::vector<Node> some_of(const std::pmr::vector<Node>& nodes, std::size_t most);

/// Where two fingers' centres are as seen from one to the other, however the part has moved meanwhile.
struct PairCentres {
  double distance = 0;
  double direction = 0;      // of b from a, less the middle of both contacts' normals; radians, up to half turns
  std::array<Arm, 2> arm{};  // to the contacts

  /// `normals`: of both contacts, N(u) + psi.
  static PairCentres of(const PerFinger<FeltCentre>& felt, const PerFinger<double>& normals);
};

/// Neighbouring rows of two fingers' roll as one.
struct PairNode {
  bool is_facing = false;                // the first contacts' facing: a row of its own, without lengths
  std::array<double, 2> length{};        // of finger a and of finger b
  double turn = 0;                       // what Theta(s) - Theta(t) should be there, or how much it should have changed
  double rows = 1;                       // as many rows' worth
  double alike = 1;                      // so many nodes the part's outline is off for alike
  double gathered = 0;                   // rows since the node before
  std::array<double, 2> travelled{};     // by each finger, length since the node before, to and fro
  std::optional<PairCentres> centres{};  // where they are looked at: means
};

/// As of one finger's nodes.
std::vector<PairNode> some_of(const std::vector<PairNode>& nodes, std::size_t most);

}  // namespace rollfix::belief
