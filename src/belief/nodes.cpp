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

}  // namespace

void Nodes::close_block(Node& sum, double& blocks) const {
  if (block_.empty()) return;
  const Reading middle = median_of(block_);
  const double length = middle.length[0];
  const double turn = middle.turn;
  // The variance among the blocks so far, times their number (Welford 1962).
  if (blocks > 0) {
    const double off = turn + tilt_ * length - (sum.turn + tilt_ * sum.length) / blocks;
    sum.spread += off * off * blocks / (blocks + 1);
  }
  sum.length += length;
  sum.turn += turn;
  sum.own += block_own_;  // as of one row: a median of rows on a slope is hardly better
  blocks += 1;
}

void Nodes::add(const Reading& reading, double finger_curvature) {
  sum_.gathered += errors_.gathered(reading.length[0] - length_);
  length_ = reading.length[0];
  ++rows_;
  ++pending_rows_;
  block_own_ = errors_.row(finger_curvature);
  block_.push_back(reading);
  if (block_.size() >= block_of(robust_, stride_)) {
    close_block(sum_, blocks_);
    block_.clear();
  }
  if (pending_rows_ < stride_) return;
  nodes_.push_back(*pending());
  sum_ = {};
  blocks_ = 0;
  pending_rows_ = 0;
  block_.clear();
  if (nodes_.size() >= kMostNodes) join_neighbours();
}

std::optional<Node> Nodes::pending() const {
  if (pending_rows_ == 0) return std::nullopt;
  Node sum = sum_;
  double blocks = blocks_;
  close_block(sum, blocks);
  return Node{sum.length / blocks, sum.turn / blocks, sum.spread / blocks, 1 / (blocks * blocks) * sum.own,
              sum.gathered};
}

void Nodes::join_neighbours() {
  for (std::size_t k = 0; 2 * k + 1 < nodes_.size(); ++k) {
    const Node& a = nodes_[2 * k];
    const Node& b = nodes_[2 * k + 1];
    const double apart = b.turn - a.turn + tilt_ * (b.length - a.length);
    const double spread = 0.5 * (a.spread + b.spread) + 0.25 * apart * apart;
    Node both{0.5 * (a.length + b.length), 0.5 * (a.turn + b.turn), spread, 0.25 * a.own, a.gathered};
    both.own += 0.25 * b.own;
    both.gathered += b.gathered;
    nodes_[k] = both;
  }
  nodes_.resize(nodes_.size() / 2);
  stride_ *= 2;
  ++generation_;
}

std::vector<PairNode> pair_nodes(const std::vector<Reading>& rows, const std::optional<double>& facing, bool absolute,
                                 bool robust) {
  std::vector<PairNode> nodes;
  if (facing) {
    PairNode first;
    first.is_facing = true;
    first.turn = *facing;
    nodes.push_back(first);
  }
  const double lift = absolute && facing ? *facing : 0;
  const std::size_t stride = std::max<std::size_t>(1, (rows.size() + kMostNodes - 1) / kMostNodes);
  const std::size_t block = block_of(robust, stride);
  std::array<double, 2> last{};
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
    node.rows = blocks;  // a median of rows on a slope is hardly better than one of them
    node.gathered = static_cast<double>(end - begin);
    node.travelled = {node.length[0] - last[0], node.length[1] - last[1]};
    last = node.length;
    nodes.push_back(node);
  }
  return nodes;
}

std::vector<PairNode> some_of(const std::vector<PairNode>& nodes, std::size_t most) {
  if (nodes.size() <= most) return nodes;
  std::vector<PairNode> some;
  std::size_t next = 0;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t at = k * (nodes.size() - 1) / (most - 1);
    PairNode node = nodes[at];
    for (; next < at; ++next) {
      node.gathered += nodes[next].gathered;
      node.travelled[0] += nodes[next].travelled[0];
      node.travelled[1] += nodes[next].travelled[1];
    }
    next = at + 1;
    some.push_back(node);
  }
  return some;
}

}  // namespace rollfix::belief
