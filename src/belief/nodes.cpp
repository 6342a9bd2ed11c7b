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

void Nodes::close_block(Node& sum, double& weight) const {
  if (block_.empty()) return;
  std::vector<Reading> readings;
  FeltCentre felt;
  const double share = 1 / static_cast<double>(block_.size());
  double worth = 0;
  for (const Row& row : block_) {
    readings.push_back(row.reading);
    worth += row.worth;
    felt.centre += share * row.felt.centre;
    felt.arm.at += share * row.felt.arm.at;
    felt.arm.per_length += share * row.felt.arm.per_length;
  }
  // As of one row: a median of rows on a slope is hardly better. Rows that say the same again count for less.
  worth *= share;
  const Reading middle = median_of(readings);
  const double length = middle.length[0];
  const double turn = middle.turn;
  // The variance among the blocks so far, times their weight (West 1979).
  if (weight > 0) {
    const double off = turn + tilt_ * length - (sum.turn + tilt_ * sum.length) / weight;
    sum.spread += off * off * worth * weight / (worth + weight);
  }
  sum.length += worth * length;
  sum.turn += worth * turn;
  sum.own += worth * block_own_;
  sum.felt.centre += worth * felt.centre;
  sum.felt.arm.at += worth * felt.arm.at;
  sum.felt.arm.per_length += worth * felt.arm.per_length;
  weight += worth;
}

void Nodes::add(const Reading& reading, double finger_curvature, double seconds, const FeltCentre& felt) {
  const double step = reading.length[0] - length_;
  const double worth = errors_.worth(step);
  sum_.gathered += errors_.gathered(step, {seconds_, seconds});
  sum_.worth += worth;
  seconds_ = seconds;
  length_ = reading.length[0];
  ++rows_;
  ++pending_rows_;
  range_ = {std::min(range_.lo, length_), std::max(range_.hi, length_)};
  block_own_ = errors_.row(finger_curvature, errors_.rows_alike(static_cast<double>(rows_), range_.width()));
  block_.push_back({reading, felt, worth});
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
  if (nodes_.size() >= most_) join_neighbours();
}

std::optional<Node> Nodes::pending() const {
  if (pending_rows_ == 0) return std::nullopt;
  Node sum = sum_;
  double weight = blocks_;
  close_block(sum, weight);
  const FeltCentre felt{sum.felt.centre / weight, {sum.felt.arm.at / weight, sum.felt.arm.per_length / weight}};
  return Node{sum.length / weight,
              sum.turn / weight,
              sum.spread / weight,
              1 / (weight * weight) * sum.own,
              sum.gathered,
              sum.worth,
              felt};
}

double Nodes::freedom() const {
  double sum = 0;
  for (const Node& node : nodes_) sum += std::min(1.0, node.worth);
  if (const std::optional<Node> last = pending()) sum += std::min(1.0, last->worth);
  return sum * (errors_.centre_variance() > 0 ? 3 : 1);
}

void Nodes::join_neighbours() {
  for (std::size_t k = 0; 2 * k + 1 < nodes_.size(); ++k) {
    const Node& a = nodes_[2 * k];
    const Node& b = nodes_[2 * k + 1];
    const double of_a = a.worth / (a.worth + b.worth);
    const double of_b = 1 - of_a;
    const double apart = b.turn - a.turn + tilt_ * (b.length - a.length);
    const FeltCentre felt{
        of_a * a.felt.centre + of_b * b.felt.centre,
        {of_a * a.felt.arm.at + of_b * b.felt.arm.at, of_a * a.felt.arm.per_length + of_b * b.felt.arm.per_length}};
    Node both{of_a * a.length + of_b * b.length,
              of_a * a.turn + of_b * b.turn,
              of_a * a.spread + of_b * b.spread + of_a * of_b * apart * apart,
              of_a * of_a * a.own,
              a.gathered,
              a.worth + b.worth,
              felt};
    both.own += of_b * of_b * b.own;
    both.gathered += b.gathered;
    nodes_[k] = both;
  }
  nodes_.resize(nodes_.size() / 2);
  stride_ *= 2;
  ++generation_;
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
    double worth = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const PerFinger<double> before = k > 0 ? rows[k - 1].length : PerFinger<double>(0, 0);
      worth += errors.worth(std::max(std::abs(rows[k].length[0] - before[0]), std::abs(rows[k].length[1] - before[1])));
    }
    // A median of rows on a slope is hardly better than one of them.
    node.rows = blocks * worth / static_cast<double>(end - begin);
    node.gathered = static_cast<double>(end - begin);
    node.travelled = {node.length[0] - last[0], node.length[1] - last[1]};
    last = node.length;
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
