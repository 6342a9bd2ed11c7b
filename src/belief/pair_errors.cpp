#include "belief/pair_errors.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::belief {

namespace {

// As for one finger: no sensor is better than this, a share of the perimeter and radians.
constexpr double kLeastPairContactShare = 1e-7;
constexpr double kLeastPairAngle = 1e-7;
// The part of an increment that is under way when it is read.
constexpr double kPairShareUnderWay = 0.25;
// Slip is one and the same over this share of the perimeter.
constexpr double kPairSlipPatch = 0.01;
// Rows of which a median is taken.
constexpr std::size_t kPairRowsOfMedian = 16;

double squared(double x) { return x * x; }

double median_of(std::vector<double>& values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*upper + *std::max_element(values.begin(), upper));
}

double mean_of(std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

PairErrors::PairErrors(const BeliefOptions& options, LogKind kind, const std::array<double, 2>& finger_curvature,
                       bool facing, double perimeter)
    : kind_(kind),
      bare_(options.bare),
      absolute_(facing && kind == LogKind::contact),
      contact_variance_(squared(std::max(options.noise.contact, kLeastPairContactShare * perimeter))),
      angle_variance_(squared(std::max(options.noise.angle, kLeastPairAngle))),
      row_contact_variance_(contact_variance_),
      perimeter_(perimeter) {
  turn_variance_ = facing_variance_ = 2 * angle_variance_;  // both fingers'
  if (kind_ == LogKind::increments) {
    turn_variance_ *= kPairShareUnderWay;
    contact_variance_ *= kPairShareUnderWay;
  }
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    if (kind_ == LogKind::contact) normal_turn_[finger] = finger_curvature[finger];
    // The first contact is measured once and taken off every row.
    if (kind_ != LogKind::increments && !bare_) start_(i, i) = contact_variance_;
    // A radius that is off by a share has every length off by it.
    start_(2 + i, 2 + i) = squared(options.noise.slip) + squared(options.noise.radius * finger_curvature[finger]);
  }
  if (!absolute_ && kind_ != LogKind::increments && !bare_) start_(4, 4) = turn_variance_;
}

PairErrors PairErrors::with_scale(double sd) const {
  PairErrors other = *this;
  other.start_(2, 2) = other.start_(3, 3) = squared(sd);
  return other;
}

PairErrors PairErrors::with_slip(double per_length) const {
  PairErrors other = *this;
  other.slip_ = per_length;
  return other;
}

double PairErrors::contact_sd() const { return std::sqrt(contact_variance_); }

bool PairErrors::drifts() const {
  return slip_ > 0 || kind_ == LogKind::increments || (kind_ == LogKind::travelled && !bare_);
}

PairShared PairErrors::gathered(const PairNode& node) const {
  PairShared sum = PairShared::Zero();
  const double slip = squared(slip_) * kPairSlipPatch * perimeter_;
  sum[0] = slip * std::abs(node.travelled[0]);
  sum[1] = slip * std::abs(node.travelled[1]);
  if (kind_ == LogKind::increments) {
    sum[0] += node.gathered * row_contact_variance_;
    sum[1] += node.gathered * row_contact_variance_;
    sum[4] += node.gathered * 2 * angle_variance_;
  }
  // An integrated gyroscope drifts: over a whole perimeter as much as one row is off.
  if (kind_ == LogKind::travelled && !bare_) {
    sum[4] += angle_variance_ * (std::abs(node.travelled[0]) + std::abs(node.travelled[1])) / perimeter_;
  }
  return sum;
}

std::vector<PairNode> pair_nodes(const std::vector<PairReading>& rows, const std::optional<double>& facing,
                                 bool absolute, bool robust, std::size_t most) {
  std::vector<PairNode> nodes;
  if (facing) {
    PairNode first;
    first.is_facing = true;
    first.turn = *facing;
    nodes.push_back(first);
  }
  const double lift = absolute && facing ? *facing : 0;
  const std::size_t stride = std::max<std::size_t>(1, (rows.size() + most - 1) / most);
  const std::size_t block = robust ? std::min(stride, kPairRowsOfMedian) : stride;
  std::array<double, 2> last{};
  for (std::size_t begin = 0; begin < rows.size(); begin += stride) {
    const std::size_t end = std::min(rows.size(), begin + stride);
    PairNode node;
    double blocks = 0;
    for (std::size_t from = begin; from < end; from += block) {
      std::vector<double> a;
      std::vector<double> b;
      std::vector<double> turn;
      for (std::size_t k = from; k < std::min(end, from + block); ++k) {
        a.push_back(rows[k].length_a);
        b.push_back(rows[k].length_b);
        turn.push_back(rows[k].turn);
      }
      const auto middle = [&](std::vector<double>& values) { return robust ? median_of(values) : mean_of(values); };
      node.length[0] += middle(a);
      node.length[1] += middle(b);
      node.turn += middle(turn);
      blocks += 1;
    }
    node.length[0] /= blocks;
    node.length[1] /= blocks;
    node.turn = node.turn / blocks + lift;
    // A median of rows on a slope is hardly better than one of them.
    node.rows = robust ? blocks : static_cast<double>(end - begin);
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
