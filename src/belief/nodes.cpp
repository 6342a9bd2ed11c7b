#include "belief/nodes.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::belief {

namespace {

// Rows of which a median is taken: enough that several stray ones don't matter, few enough to lie close together.
constexpr std::size_t kRowsOfMedian = 16;

void operator+=(RowCovariance& sum, const RowCovariance& term) {
  sum.length += term.length;
  sum.both += term.both;
  sum.turn += term.turn;
}

RowCovariance operator*(double factor, const RowCovariance& covariance) {
  return {factor * covariance.length, factor * covariance.both, factor * covariance.turn};
}

double median(std::vector<double> values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*upper + *std::max_element(values.begin(), upper));
}

/// What rows that are taken together come to: each number's median.
Reading median_of(const std::vector<Reading>& rows) {
  Reading middle = rows.front();
  if (rows.size() == 1) return middle;
  const auto median_by = [&](const auto& number) {
    std::vector<double> values;
    for (const Reading& row : rows) values.push_back(number(row));
    return median(std::move(values));
  };
  for (std::size_t finger = 0; finger < middle.fingers(); ++finger) {
    middle.length[finger] = median_by([&](const Reading& row) { return row.length[finger]; });
  }
  middle.turn = median_by([](const Reading& row) { return row.turn; });
  return middle;
}

/// Rows that are taken together before a mean is taken: of robust ones by their median.
std::size_t block_of(bool robust, std::size_t stride) { return robust ? std::min(stride, kRowsOfMedian) : 1; }

/// `gather`: what a node takes over of one that is passed over.
template <class AnyNode, class Gather>
std::vector<AnyNode> evenly(const std::vector<AnyNode>& nodes, std::size_t most, const Gather& gather) {
  if (nodes.size() <= most) return nodes;
  std::vector<AnyNode> some;
  std::size_t next = 0;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t at = k * (nodes.size() - 1) / (most - 1);
    AnyNode node = nodes[at];
    for (; next < at; ++next) gather(node, nodes[next]);
    next = at + 1;
    some.push_back(node);
  }
  return some;
}

}  // namespace

void Nodes::close_block(Together& sum, double& blocks) const {
  if (block_.empty()) return;
  std::vector<Reading> readings;
  FeltCentre felt;
  const double share = 1 / static_cast<double>(block_.size());
  for (const Row& row : block_) {
    readings.push_back(row.reading);
    felt.centre += share * row.felt.centre;
    felt.arm.at += share * row.felt.arm.at;
    felt.arm.per_length += share * row.felt.arm.per_length;
  }
  // Worth one row: a median of rows on a slope is hardly better.
  const Reading middle = median_of(readings);
  const double length = middle.length[0];
  const double turn = middle.turn;
  // The variance among the blocks so far, times their number (West 1979).
  if (blocks > 0) {
    const double off = turn + tilt_ * length - (sum.turn + tilt_ * sum.length) / blocks;
    sum.spread += off * off * blocks / (1 + blocks);
  }
  sum.length += length;
  sum.turn += turn;
  sum.own += block_own_;
  sum.felt.centre += felt.centre;
  sum.felt.arm.at += felt.arm.at;
  sum.felt.arm.per_length += felt.arm.per_length;
  blocks += 1;
}

void Nodes::add(const Reading& reading, double finger_curvature, double seconds, const FeltCentre& felt) {
  ++rows_;
  sum_.rows += 1;
  sum_.seconds = seconds;
  range_ = {std::min(range_.lo, reading.length[0]), std::max(range_.hi, reading.length[0])};
  block_own_ = errors_.row(finger_curvature, errors_.rows_alike(static_cast<double>(rows_), range_.width()));
  block_.push_back({reading, felt});
  if (block_.size() >= block_of(robust_, stride_)) {
    close_block(sum_, blocks_);
    block_.clear();
  }
  if (sum_.rows < static_cast<double>(stride_)) return;
  together_.push_back(closed());
  complete_node(together_.back());
  sum_ = {};
  blocks_ = 0;
  block_.clear();
  if (nodes_.size() >= most_) join_neighbours();
}

Nodes::Together Nodes::closed() const {
  Together rows = sum_;
  double blocks = blocks_;
  close_block(rows, blocks);
  const double share = 1 / blocks;
  rows.length *= share;
  rows.turn *= share;
  rows.spread *= share;
  rows.own = share * share * rows.own;
  rows.felt.centre *= share;
  rows.felt.arm.at *= share;
  rows.felt.arm.per_length *= share;
  return rows;
}

Travel::Mark Nodes::mark(const Together& rows) const {
  const double before = static_cast<double>(nodes_.size() * stride_);
  return {before + 0.5 * (rows.rows - 1), rows.length, rows.own.length};
}

Node Nodes::node_of(const Together& rows, double travelled) const {
  const double worth = errors_.worth(travelled, rows.rows);
  const double before = nodes_.empty() ? 0 : together_[nodes_.size() - 1].seconds;
  return {rows.length,
          rows.turn,
          rows.spread,
          rows.rows / worth * rows.own,
          errors_.gathered(travelled, rows.rows, {before, rows.seconds}),
          worth,
          rows.felt};
}

void Nodes::complete_node(const Together& rows) {
  const double travelled = travel_.add(mark(rows));
  nodes_.push_back(node_of(rows, travelled));
}

std::optional<Node> Nodes::pending() const {
  if (sum_.rows == 0) return std::nullopt;
  const Together rows = closed();
  return node_of(rows, travel_.since_last(mark(rows)));
}

double Nodes::freedom() const {
  double sum = 0;
  for (const Node& node : nodes_) sum += std::min(1.0, node.worth);
  if (const std::optional<Node> last = pending()) sum += std::min(1.0, last->worth);
  return sum * (errors_.centre_variance() > 0 ? 3 : 1);
}

void Nodes::join_neighbours() {
  for (std::size_t k = 0; 2 * k + 1 < together_.size(); ++k) {
    const Together& a = together_[2 * k];
    const Together& b = together_[2 * k + 1];
    const double apart = b.turn - a.turn + tilt_ * (b.length - a.length);
    Together both;
    both.length = 0.5 * (a.length + b.length);
    both.turn = 0.5 * (a.turn + b.turn);
    both.spread = 0.5 * (a.spread + b.spread) + 0.25 * apart * apart;
    both.own = 0.25 * a.own;
    both.own += 0.25 * b.own;
    both.felt = {0.5 * (a.felt.centre + b.felt.centre),
                 {0.5 * (a.felt.arm.at + b.felt.arm.at), 0.5 * (a.felt.arm.per_length + b.felt.arm.per_length)}};
    both.rows = a.rows + b.rows;
    both.seconds = b.seconds;
    together_[k] = both;
  }
  together_.resize(together_.size() / 2);
  stride_ *= 2;
  ++generation_;
  // The means are less noisy than what was joined: how far the finger travelled is known better.
  nodes_.clear();
  travel_.restart();
  for (const Together& rows : together_) complete_node(rows);
}

PairCentres PairCentres::of(const PerFinger<FeltCentre>& felt, const PerFinger<double>& facing) {
  const Vec2 way = felt[1].centre - felt[0].centre;
  return {way.norm(), std::atan2(way.y(), way.x()) - 0.5 * (facing[0] + facing[1]), {felt[0].arm, felt[1].arm}};
}

namespace {

PairCentres mean_of(const std::vector<PairCentres>& rows, std::size_t begin, std::size_t end) {
  PairCentres mean;
  const double share = 1 / static_cast<double>(end - begin);
  const double near = rows[begin].direction;
  mean.direction = near;
  for (std::size_t k = begin; k < end; ++k) {
    mean.distance += share * rows[k].distance;
    mean.direction +=
        share * (rows[k].direction - near - kHalfTurn * std::round((rows[k].direction - near) / kHalfTurn));
    for (const std::size_t finger : {0U, 1U}) {
      mean.arm[finger].at += share * rows[k].arm[finger].at;
      mean.arm[finger].per_length += share * rows[k].arm[finger].per_length;
    }
  }
  return mean;
}

}  // namespace

std::vector<PairNode> pair_nodes(const std::vector<Reading>& rows, const std::vector<PairCentres>& centres,
                                 const std::optional<double>& facing, bool absolute, bool robust,
                                 const PairErrors& errors) {
  std::vector<PairNode> nodes;
  if (facing) {
    PairNode first;
    if (!centres.empty()) first.centres = centres.front();
    first.is_facing = true;
    first.turn = *facing;
    nodes.push_back(first);
  }
  const double lift = absolute && facing ? *facing : 0;
  const std::size_t stride = std::max<std::size_t>(1, (rows.size() + kMostNodes - 1) / kMostNodes);
  const std::size_t block = block_of(robust, stride);
  std::array<Travel, 2> travel{errors.travel(), errors.travel()};
  for (std::size_t begin = 0; begin < rows.size(); begin += stride) {
    const std::size_t end = std::min(rows.size(), begin + stride);
    PairNode node;
    double blocks = 0;
    for (std::size_t from = begin; from < end; from += block) {
      const auto first = rows.begin() + static_cast<std::ptrdiff_t>(from);
      const auto last_row = rows.begin() + static_cast<std::ptrdiff_t>(std::min(end, from + block));
      const Reading middle = median_of({first, last_row});
      node.length[0] += middle.length[0];
      node.length[1] += middle.length[1];
      node.turn += middle.turn;
      blocks += 1;
    }
    node.length[0] /= blocks;
    node.length[1] /= blocks;
    node.turn = node.turn / blocks + lift;
    node.gathered = static_cast<double>(end - begin);
    for (const std::size_t finger : {0U, 1U}) {
      const double middle = 0.5 * static_cast<double>(begin + end - 1);
      const Travel::Mark mark{middle, node.length[finger], errors.contact_variance() / blocks};
      node.travelled[finger] = travel[finger].add(mark);
    }
    const double worth = errors.worth(std::max(node.travelled[0], node.travelled[1]), node.gathered);
    // A median of rows on a slope is hardly better than one of them.
    node.rows = blocks * worth / node.gathered;
    if (!centres.empty()) node.centres = mean_of(centres, begin + 1, end + 1);
    nodes.push_back(node);
  }
  return nodes;
}

std::vector<Node> some_of(const std::vector<Node>& nodes, std::size_t most) {
  return evenly(nodes, most, [](Node& node, const Node& passed) { node.gathered += passed.gathered; });
}

std::vector<PairNode> some_of(const std::vector<PairNode>& nodes, std::size_t most) {
  return evenly(nodes, most, [](PairNode& node, const PairNode& passed) {
    node.gathered += passed.gathered;
    node.travelled[0] += passed.travelled[0];
    node.travelled[1] += passed.travelled[1];
  });
}

}  // namespace rollfix::belief
