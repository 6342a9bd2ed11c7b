#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "belief/centres.hpp"
#include "belief/error_model.hpp"
#include "belief/travel.hpp"
#include "rollfix/contact/reading.hpp"
#include "rollfix/outline/curve.hpp"

namespace rollfix::belief {

// A roll's rows are joined to at most this many nodes, however many rows there are, ...
inline constexpr std::size_t kMostNodes = 512;
// ... on a boundary that turns to and fro to as many more, up to so many times: a mean over rows on a bend is off it.
inline constexpr double kMostFiner = 4;

/// Neighbouring rows of a roll as one: their mean, which is as good as all of them where they are close together.
struct Node {
  double length = 0;
  double turn = 0;
  double spread = 0;       // variance of turn + tilt times length among the rows
  RowCovariance own;       // of the mean
  RowCovariance gathered;  // by the offsets since the node before
  double worth = 0;        // as many rows on their own; less than there are where they are off alike
  FeltCentre felt{};       // where centres are looked at: means

  /// The least variance that what a place makes of such a node can have, whatever the curvature there.
  double least_variance(double tilt) const {
    return (own.length * own.turn - own.both * own.both) / (tilt * tilt * own.length + 2 * tilt * own.both + own.turn);
  }
};

/// A roll's rows as no more than a fixed number of nodes, however many rows there are: when they are too many,
/// neighbours are joined, and from then on twice as many rows make one.
class Nodes {
 public:
  /// `robust`: of rows that make a node together medians are taken first, so that a stray one does not move it.
  Nodes(const ErrorModel& errors, double tilt, bool robust, std::size_t most = kMostNodes)
      : errors_(errors), tilt_(tilt), robust_(robust), most_(most), travel_(errors.travel()) {}

  /// `finger_curvature`: where the finger touches. `seconds`: since the roll's start. `felt`: where its centre is, if
  /// that is looked at.
  void add(const Reading& reading, double finger_curvature, double seconds, const FeltCentre& felt = {});

  /// Those that will not change until `generation` does.
  const std::vector<Node>& complete() const { return nodes_; }
  std::size_t generation() const { return generation_; }  // grows when nodes are joined
  /// The rows after them.
  std::optional<Node> pending() const;
  std::size_t rows() const { return rows_; }
  /// As many independent equations as the nodes are.
  double freedom() const;

 private:
  struct Row {
    Reading reading;
    FeltCentre felt;
  };
  /// Rows that are taken together: a node, but for what follows from how far the finger travelled for it.
  struct Together {
    double length = 0;
    double turn = 0;
    double spread = 0;
    RowCovariance own;  // of the mean, where each row is off on its own
    FeltCentre felt{};
    double rows = 0;
    double seconds = 0;  // at the last of them
  };
  void close_block(Together& sum, double& blocks) const;
  /// The pending rows.
  Together closed() const;
  Node node_of(const Together& rows, double travelled) const;
  void complete_node(const Together& rows);
  void join_neighbours();
  /// The next node's rows, as a place on the way.
  Travel::Mark mark(const Together& rows) const;

  ErrorModel errors_;
  double tilt_;
  bool robust_;
  std::size_t most_;
  std::size_t stride_ = 1;  // rows of a node
  std::size_t generation_ = 0;
  std::size_t rows_ = 0;
  Interval range_;  // of all lengths so far
  std::vector<Together> together_;
  std::vector<Node> nodes_;
  Travel travel_;  // of them
  // Of the node that is being made: sums over blocks of rows, and the rows of the block that is being filled.
  Together sum_;
  double blocks_ = 0;
  std::vector<Row> block_;
  RowCovariance block_own_;  // of one of its rows
};

/// Some of the nodes, evenly, the first and the last among them.
std::vector<Node> some_of(const std::vector<Node>& nodes, std::size_t most);

/// Where two fingers' centres are as seen from one to the other, however the part has moved meanwhile.
struct PairCentres {
  double distance = 0;
  double direction = 0;      // of b from a, less the middle of both contacts' normals; radians, up to half turns
  std::array<Arm, 2> arm{};  // to the contacts

  /// `facing`: of both contacts, N(u) + psi.
  static PairCentres of(const PerFinger<FeltCentre>& felt, const PerFinger<double>& facing);
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

/// A roll's rows as at most kMostNodes nodes. `facing`: the first contacts', then the first node. `robust`: as above.
/// `centres`: of the first contacts, then of every row; empty where they are not looked at.
std::vector<PairNode> pair_nodes(const std::vector<Reading>& rows, const std::vector<PairCentres>& centres,
                                 const std::optional<double>& facing, bool absolute, bool robust,
                                 const PairErrors& errors);

/// See above.
std::vector<PairNode> some_of(const std::vector<PairNode>& nodes, std::size_t most);

}  // namespace rollfix::belief
