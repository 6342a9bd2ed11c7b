#include "belief/nodes.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "belief/posterior.hpp"
#include "outline/turn.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/belief.md, "How far the finger travelled" and "How many rows are joined":
//   m, D2 m         means of a measurement over lots of as many neighbouring rows, and their second differences,
//                   m_(k-1) - 2 m_k + m_(k+1), or where lots have not as many rows each what they would be if all had
//                   as many as the one in the middle, by divided differences
//   m - D2 m / 24   what the measurement was in the middle of the lot, if it goes as a cubic from lot to lot
//   node            the mean of `rows` neighbouring rows; `group_` blocks of them
//   R, n            variance of a row's own errors, and number of rows: 1 / R summed in `Walk::length_rows`,
//                   `turn_rows`
//   G               what has gathered on the way in all: `Walk::length`, `Walk::turn`
//   k               sqrt(G n / R) / pi, as many sine modes of the course as G is seen in: `Walk::modes`
//   spread          variance of w among the rows of a node: a mean over a bend lies beside the boundary
//   share_in_mean   (n + 1) / (2 n) of what gathers; `share_averaged`, (n + 1)(n - 1) / (6 n^2), is less in the mean
//                   itself
// Follows docs/belief.md, the two paragraphs named above, and of even motions docs/two_fingers.md, "The errors".
// Idea: a row alone may be explained by a pivot at a corner, or by another pose of the part, that takes up its noise.
// The rows of a smooth motion say together what none of them says alone, and their mean has little noise to take up.
// And ten million rows take no more memory than a thousand; where gathered errors would let chance choose between
// places (k above half the number of nodes) there are fewer nodes.
namespace rollfix::belief {

namespace {

constexpr double kSmooth = 2;    // times the noise: what rows are off from their neighbours, in the mean square
constexpr double kNoKink = 3.5;  // standard deviations by which a bend may differ from those on both sides of it
// Of D2 m less the mean of what it is two lots before and after, or less the one of both that there is: in variances of
// a mean.
constexpr double kBothSides = 7;
constexpr double kOneSide = 10;

/// Second differences; at both ends that of the neighbour.
std::vector<double> bends(const Course& course) {
  const std::vector<double>& m = course.values;
  // Lots of unequal size: the middles of two neighbours are half the sum of both sizes apart.
  const auto rows = [&](std::size_t k) { return course.rows.empty() ? 1 : course.rows[k]; };
  const auto slope = [&](std::size_t k) { return (m[k + 1] - m[k]) / (0.5 * (rows(k) + rows(k + 1))); };
  std::vector<double> result(m.size());
  for (std::size_t k = 1; k + 1 < m.size(); ++k) {
    const double apart = 0.25 * rows(k - 1) + 0.5 * rows(k) + 0.25 * rows(k + 1);
    result[k] = (slope(k) - slope(k - 1)) / apart * rows(k) * rows(k);
  }
  result.front() = result[1];
  result.back() = result[m.size() - 2];
  return result;
}

}  // namespace

/// Of independent errors a second difference has the variance (1 + 4 + 1) sd^2.
bool is_even(const Course& rows) {
  double sum = 0;
  for (const double bend : bends(rows)) sum += bend * bend;
  const double of_noise = (1 + 4 + 1) * rows.sd * rows.sd;
  return sum <= kSmooth * of_noise * static_cast<double>(rows.values.size());
}

/// m - D2 m / 24, unless a second difference stands out: a kink of the motion, which a cubic does not follow.
std::optional<std::vector<double>> at_middles(const Course& means) {
  const std::vector<double> bent = bends(means);
  for (std::size_t k = 1; k + 1 < bent.size(); ++k) {
    // Those two lots away share fewer values with this one. The outermost are copies of their neighbours.
    const bool has_before = k > 2;
    const bool has_after = k + 3 < bent.size();
    const double before = bent[has_before ? k - 2 : k + 2];
    const double after = bent[has_after ? k + 2 : k - 2];
    const double variance = has_before && has_after ? kBothSides : kOneSide;
    if (std::abs(bent[k] - 0.5 * (before + after)) > kNoKink * std::sqrt(variance) * means.sd) return std::nullopt;
  }
  std::vector<double> result = means.values;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] -= bent[k] / 24;
  return result;
}

namespace {

// Where what gathers is seen, nodes are this many times as long as slip is one and the same: long enough that what
// gathers in neighbours is independent. There are at least so many, to tell a roll's course. Calibrated: chosen by
// simulation, not derived (docs/belief.md, "How many rows are joined"). On a boundary that turns to and fro more than
// kWavy times as much as a circle nodes are shorter by the square of that: a mean over a bend and back is off both.
constexpr double kPatches = 2.5;
constexpr double kFewestNodes = 24;
// A group in which the finger goes so many times as far as on average is several nodes. The margin is for chance: noise
// that gathers spreads the rows of an even roll a little, now more, now less.
constexpr double kFar = 1.3;
constexpr int kAnyHalvings = 64;  // down to single blocks

// A rest ends where two groups in a row are off it by more than 3 standard deviations, the same way, or one by as much
// as no noise is; or where all of them have a trend. As chi-squares of two degrees of freedom, the length's and the
// turn's.
constexpr double kTwiceOff = 11.8;
constexpr double kFarOff = 60;
constexpr double kTrend = 20;
// Shorter rests stay as they are; with so few rows chance has little to say. Where nothing has moved yet it has all.
constexpr std::size_t kShortestRest = 24;
constexpr std::size_t kShortestWhole = 8;

/// `gather`: what a node takes over of one that is passed over.
template <class AnyNodes, class Gather>
AnyNodes evenly(const AnyNodes& nodes, std::size_t most, const Gather& gather) {
  if (nodes.size() <= most) return AnyNodes(nodes, nodes.get_allocator());
  AnyNodes some(nodes.get_allocator());
  std::size_t next = 0;
  for (std::size_t k = 0; k < most; ++k) {
    // Evenly by index, from the first to the last. What the nodes between two have gathered is not lost.
    const std::size_t at = k * (nodes.size() - 1) / (most - 1);
    typename AnyNodes::value_type node = nodes[at];
    for (; next < at; ++next) gather(node, nodes[next]);
    next = at + 1;
    some.push_back(node);
  }
  return some;
}

}  // namespace

/// A group alone that is off is noise: as a node of its own it would be evidence for the places that weigh it least.
bool Rest::goes_on(const JoinedRows& group, const RowCovariance& own) const {
  if (groups_ == 0) return true;
  const Vec2 here(group.length, group.turn);
  const Eigen::Matrix2d inverse = matrix_of(own).inverse();
  const auto count = static_cast<double>(groups_);
  // How far this group is off the others, and whether the last one was so as well.
  const Vec2 off = here - sum_ / count;
  const Vec2 last_off = last_ - sum_ / count;
  const double squared = off.dot(inverse * off) / (1 + 1 / count);
  if (squared > kFarOff) return false;
  const bool is_twice = squared > kTwiceOff && last_off.dot(inverse * last_off) > kTwiceOff;
  if (is_twice && last_off.dot(inverse * off) > 0) return false;
  // With this group: sum of (k - mean of k) y, and of the squares of the former.
  const Vec2 led = by_index_ + count * here - 0.5 * count * (sum_ + here);
  const double squares = count * (count + 1) * (count + 2) / 12;
  return led.dot(inverse * led) <= kTrend * squares;
}

void Rest::add(const JoinedRows& group, const JoinedRows& joined, double travelled) {
  const Vec2 here(group.length, group.turn);
  by_index_ += static_cast<double>(groups_) * here;
  sum_ += here;
  last_ = here;
  ++groups_;
  rows_ = joined;
  travelled_ += travelled;
}

/// Blocks fill up, nodes are made of them. Where there are too many, all nodes are made again of longer groups.
void Nodes::add(const Row& row) {
  beat();
  ++rows_;
  if (!blocks_.add(row)) return;
  if (blocks_.is_full()) {
    blocks_.halve();
    // A block has twice as many rows now: half as many blocks make a node, one at least.
    group_ = (group_ + 1) / 2;
    make_again();
  } else if (blocks_.complete().size() % group_ == 0) {
    complete_node(group(taken_));
  }
  while (are_too_many()) {
    ++group_;
    make_again();
  }
}

/// Both: more nodes than `many` for the length travelled, and what gathers is seen in more than half of `many` modes.
bool Nodes::are_too_many() const {
  if (!by_walk_) return false;
  const double many = std::max(kFewestNodes, finer_ * travel_.so_far() / (kPatches * errors_.patch()));
  return static_cast<double>(nodes_.size() - parts_) > many && walk_.modes() > 0.5 * many;
}

/// The block behind all complete ones is the open one.
JoinedRows Nodes::joined(std::size_t begin, std::size_t blocks) const {
  const std::pmr::vector<JoinedRows>& all = blocks_.complete();
  JoinedRows rows = begin < all.size() ? all[begin] : blocks_.open();
  for (std::size_t k = begin + 1; k < begin + blocks; ++k) {
    rows = blocks_.joined(rows, k < all.size() ? all[k] : blocks_.open());
  }
  return rows;
}

/// All nodes anew, of `group_` blocks each. The travel is measured anew as well: means of more rows are less noisy, so
/// that it is known better.
void Nodes::make_again() {
  ++generation_;
  nodes_.clear();
  walk_ = {};
  parts_ = 0;
  travel_.restart();
  seconds_ = 0;
  taken_ = 0;
  begin_rest();
  while (taken_ + group_ <= blocks_.complete().size()) complete_node(group(taken_));
}

/// A group that goes on with a rest becomes part of one node; else a node of its own.
void Nodes::complete_node(const JoinedRows& rows) {
  const double travelled = travel_.add(mark(taken_, rows));
  way_ = std::max(way_, travel_.so_far());
  const std::size_t begin = std::exchange(taken_, taken_ + group_);
  if (!joins_rests()) return push_group(begin, group_, rows, travelled);
  if (!rest_.goes_on(rows, node_of(rows, travelled, behind()).own)) {
    if (is_held_) push(node_of(rest_.rows(), rest_.travelled(), behind()), rest_.rows().seconds);
    begin_rest();
  }
  rest_.add(rows, rest_.groups() == 0 ? rows : blocks_.joined(rest_.rows(), rows), travelled);
  const bool is_rest = rest_.groups() >= (nodes_before_ == 0 ? kShortestWhole : kShortestRest);
  if (!is_rest) return push_group(begin, group_, rows, travelled);
  if (is_held_) return;
  // Its nodes so far are one.
  is_held_ = true;
  parts_ -= nodes_.size() - nodes_before_ - (rest_.groups() - 1);
  nodes_.resize(nodes_before_);
  walk_ = walk_before_;
  seconds_ = seconds_before_;
  ++generation_;
}

void Nodes::begin_rest() {
  rest_ = {};
  is_held_ = false;
  nodes_before_ = nodes_.size();
  walk_before_ = walk_;
  seconds_before_ = seconds_;
}

/// Its mean says where rows are that are spread evenly over their way; others it puts beside a bend or a corner. By w,
/// which tells a pivot; and by length, for in a concave bend w may go on as before while the contact runs ahead.
bool Nodes::goes_far(const JoinedRows& rows, const Behind& behind) const {
  const double usual = kFar * way_ * rows_of_node() / static_cast<double>(rows_);
  if (std::sqrt(12 * spread_of(rows, behind)) > (tilt_ + errors_.turn_per_length()) * usual) return true;
  // `own` is of the mean. What chance makes of the rows' own errors counts as none.
  const double noise = (rows.rows - 1) * rows.own.length * (1 + kFarthest * std::sqrt(2 / rows.rows));
  return std::sqrt(12 * std::max(0.0, rows.length_scatter - noise)) > usual;
}

Nodes::Behind Nodes::behind() const {
  if (nodes_.empty()) return {true, 0, seconds_};
  return {false, nodes_.back().turn + tilt_ * nodes_.back().length, seconds_};
}

/// By halves. What was travelled is shared out by how far the means are apart.
template <class Take>
void Nodes::split(std::size_t begin, std::size_t blocks, const JoinedRows& rows, double travelled, int halvings,
                  Behind& behind, const Take& take) const {
  if (blocks == 1 || halvings == 0 || !goes_far(rows, behind)) {
    take(node_of(rows, travelled, behind), rows);
    behind = {false, rows.tilted(tilt_), rows.seconds};
    return;
  }
  const std::size_t half = blocks / 2;
  const JoinedRows first = joined(begin, half);
  const JoinedRows second = joined(begin + half, blocks - half);
  const double to_first = std::abs(first.tilted(tilt_) - behind.w);
  const double apart = std::abs(second.tilted(tilt_) - first.tilted(tilt_));
  const double share = to_first + apart > 0 ? to_first / (to_first + apart) : 0.5;
  split(begin, half, first, share * travelled, halvings - 1, behind, take);
  split(begin + half, blocks - half, second, (1 - share) * travelled, halvings - 1, behind, take);
}

void Nodes::push_group(std::size_t begin, std::size_t blocks, const JoinedRows& rows, double travelled) {
  const std::size_t before = nodes_.size();
  Behind behind = this->behind();
  split(begin, blocks, rows, travelled, kAnyHalvings, behind,
        [&](const Node& node, const JoinedRows& of_node) { push(node, of_node.seconds); });
  parts_ += nodes_.size() - before - 1;
}

void Nodes::push(const Node& node, double seconds) {
  nodes_.push_back(node);
  walk_.add(node);
  seconds_ = seconds;
}

/// Blocks of the group that is filling, with the rows of the block that is; nothing where there are no rows. They do
/// not become marks of the travel: they will change. The last rows of a roll may be in its only bend: a mean of them
/// and of those before it would not tell.
PendingNodes Nodes::pending() const {
  PendingNodes nodes;
  const std::size_t blocks = blocks_.complete().size() - taken_ + (blocks_.has_open() ? 1 : 0);
  if (blocks == 0) {
    if (is_held_) nodes.push_back(node_of(rest_.rows(), rest_.travelled(), behind()));
    return nodes;
  }
  const JoinedRows rows = joined(taken_, blocks);
  const double travelled = travel_.since_last(mark(taken_, rows));
  if (is_held_) {
    nodes.push_back(node_of(blocks_.joined(rest_.rows(), rows), rest_.travelled() + travelled, behind()));
    return nodes;
  }
  Behind behind = this->behind();
  split(taken_, blocks, rows, travelled, kPendingHalvings, behind,
        [&](const Node& node, const JoinedRows& /*rows*/) { nodes.push_back(node); });
  return nodes;
}

/// At the middle of its rows; of increments at the last one, which stands for them.
Travel::Mark Nodes::mark(std::size_t blocks, const JoinedRows& rows) const {
  const auto before = static_cast<double>(blocks * blocks_.rows_of_block());
  const double middle = errors_.gathers_rows() ? rows.rows - 1 : 0.5 * (rows.rows - 1);
  return {before + middle, rows.length, rows.own.length};
}

/// Rows that are off alike: their mean has the variance of `worth` rows, not of all.
Node Nodes::node_of(const JoinedRows& rows, double travelled, const Behind& behind) const {
  const double worth = errors_.worth(travelled, rows.rows);
  return {rows.length,
          rows.turn,
          rows.sensed,
          rows.middle,
          spread_of(rows, behind),
          rows.rows / worth * rows.own + (by_walk_ ? errors_.bent(travelled) : RowCovariance{}),
          errors_.gathered(travelled, rows.rows, {behind.seconds, rows.seconds}),
          errors_.gathers_rows() ? 1 : rows.rows,
          worth,
          rows.felt};
}

double Nodes::spread_of(const JoinedRows& rows, const Behind& behind) const {
  if (rows.rows < 2 || errors_.gathers_rows()) return 0;
  // What rows scatter by on their own moves no contact.
  const RowCovariance& own = rows.own;
  // `own` is of the mean, R / n: among n rows their own errors scatter by (n - 1) / n R, with this standard deviation.
  const double noise = (rows.rows - 1) * (tilt_ * tilt_ * own.length + 2 * tilt_ * own.both + own.turn);
  const double of_noise = noise * std::sqrt(2 / rows.rows);
  // Of a steady roll: so many rows of the way from the node before, or from the first contact.
  const double since = 0.5 * (rows.rows + (behind.is_first ? 1 : rows_of_node()));
  const double way = (rows.tilted(tilt_) - behind.w) * rows.rows / since;
  const double steady = way * way / 12;
  const double seen = rows.scatter - noise;
  // A difference from a steady roll that chance explains counts as none. Else the scatter counts as seen, less the
  // noise.
  return std::abs(seen - steady) <= kFarthest * of_noise ? steady : std::max(0.0, seen);
}

/// A node's part of what has gathered, and its information on one length and one turn.
void Nodes::Walk::add(const Node& node) {
  length += node.gathered.length;
  turn += node.gathered.turn;
  length_rows += 1 / node.own.length;
  turn_rows += 1 / node.own.turn;
}

/// k = sqrt(G n / R) / pi, the larger one of length and turn. The k-th sine of a Wiener process with variance G at its
/// end has the variance G / (k pi)^2. Errors with variance R in each of n rows give every sine R / n. Both are equal at
/// this k.
double Nodes::Walk::modes() const {
  return std::sqrt(std::max(length * length_rows, turn * turn_rows)) / std::numbers::pi;
}

/// A node that is worth less than one row counts as that share. Centres make three equations of one.
double Nodes::freedom() const {
  double sum = 0;
  for (const Node& node : nodes_) sum += std::min(1.0, node.worth);
  for (const Node& node : pending()) sum += std::min(1.0, node.worth);
  return sum * (errors_.centre_variance() > 0 ? 3 : 1);
}

/// Of all complete nodes and the rows after them. Radians.
double Nodes::turn_gathered() const {
  double turn = walk_.turn;
  for (const Node& node : pending()) turn += node.gathered.turn;
  return std::sqrt(turn);
}

/// At one instant: the direction from a to b in the world, less the mean of both normals, which turn with the part.
PairCentres PairCentres::of(const PerFinger<FeltCentre>& felt, const PerFinger<double>& normals) {
  const Vec2 way = felt[1].centre - felt[0].centre;
  return {way.norm(), std::atan2(way.y(), way.x()) - 0.5 * (normals[0] + normals[1]), {felt[0].arm, felt[1].arm}};
}

/// A node that stands for those passed over has gathered what they have.
std::pmr::vector<Node> some_of(const std::pmr::vector<Node>& nodes, std::size_t most) {
  return evenly(nodes, most, [](Node& node, const Node& passed) {
    node.gathered.length += passed.gathered.length;
    node.gathered.turn += passed.gathered.turn;
  });
}

std::vector<PairNode> some_of(const std::vector<PairNode>& nodes, std::size_t most) {
  return evenly(nodes, most, [](PairNode& node, const PairNode& passed) {
    node.gathered += passed.gathered;
    node.travelled[0] += passed.travelled[0];
    node.travelled[1] += passed.travelled[1];
  });
}

}  // namespace rollfix::belief
