#include "belief/two/pair_ripples.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "belief/posterior.hpp"
#include "outline/turn.hpp"

// Notation:
//   y           a channel: of all nodes a length, the turn, the distance or the direction
//   window      `size` neighbouring nodes
//   Q           orthonormal columns of 1, x, x^2 in a window: Q Q^T y is the parabola that is nearest to it
// Follows A. Savitzky and M. Golay, "Smoothing and differentiation of data by simplified least squares procedures"
// (1964); at the ends of the roll the parabola is that of the first or the last window.
namespace rollfix::belief {
namespace {

// A window is this share of the nodes, and no fewer than so many: a parabola takes 3 of them.
constexpr Eigen::Index kWindows = 6;
constexpr Eigen::Index kLeastWindow = 15;
constexpr Eigen::Index kParameters = 3;
// A window whose squares are this many standard deviations above what a quarter of the windows stay below, as if they
// were of noise alone, has a course that is no parabola: two above the mean.
constexpr double kNoParabola = 3;

using Channel = Eigen::VectorXd;

/// What is left of each node, and of its window in the mean square.
struct Left {
  Eigen::VectorXd of_node;
  Eigen::VectorXd of_window;
};

Eigen::MatrixXd parabolas(Eigen::Index size) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(size, -1, 1);
  Eigen::MatrixXd powers(size, kParameters);
  powers << Eigen::VectorXd::Ones(size), x, x.cwiseAbs2();
  return Eigen::HouseholderQR<Eigen::MatrixXd>(powers).householderQ() * Eigen::MatrixXd::Identity(size, kParameters);
}

Left left_of(const Channel& y, const Eigen::MatrixXd& Q) {
  const Eigen::Index size = Q.rows();
  Left left{Eigen::VectorXd(y.size()), Eigen::VectorXd(y.size())};
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const Eigen::Index begin = std::clamp<Eigen::Index>(k - size / 2, 0, y.size() - size);
    const Eigen::VectorXd parabola = Q * (Q.transpose() * y.segment(begin, size));
    const Eigen::VectorXd off = y.segment(begin, size) - parabola;
    left.of_node[k] = off[k - begin] / std::sqrt(1 - Q.row(k - begin).squaredNorm());
    left.of_window[k] = off.squaredNorm() / static_cast<double>(size - kParameters);
  }
  return left;
}

double lower_quartile(const Eigen::VectorXd& values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto quarter = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 4);
  std::nth_element(sorted.begin(), quarter, sorted.end());
  return *quarter;
}

/// Angles up to whole turns, or half ones, without jumps.
void unwrap(Channel& angles, double turn) {
  for (Eigen::Index k = 1; k < angles.size(); ++k) {
    angles[k] -= turn * std::round((angles[k] - angles[k - 1]) / turn);
  }
}

using Channels = std::vector<Channel>;  // in the order of PairRipple

Channels channels_of(const std::vector<PairNode>& nodes, std::size_t first) {
  const auto size = static_cast<Eigen::Index>(nodes.size() - first);
  Channels channels(nodes.back().centres ? 5 : 3, Channel(size));
  for (Eigen::Index k = 0; k < size; ++k) {
    const PairNode& node = nodes[first + static_cast<std::size_t>(k)];
    for (const std::size_t finger : {0U, 1U}) channels[finger][k] = node.length[finger];
    channels[2][k] = node.turn;
    if (!node.centres) continue;
    channels[3][k] = node.centres->distance;
    channels[4][k] = node.centres->direction;
  }
  unwrap(channels[2], kFullTurn);
  if (nodes.back().centres) unwrap(channels[4], kHalfTurn);
  return channels;
}

}  // namespace

PairRipples tell_ripples(std::vector<PairNode>& nodes) {
  const std::size_t first = !nodes.empty() && nodes.front().is_facing ? 1 : 0;
  const auto count = static_cast<Eigen::Index>(nodes.size() - first);
  const Eigen::Index size = std::max(kLeastWindow, count / kWindows | 1);
  PairRipples usual = PairRipples::Zero();
  if (count < 2 * size) return usual;
  const Eigen::MatrixXd Q = parabolas(size);
  const double deviation = std::sqrt(2.0 / static_cast<double>(size - kParameters));
  Eigen::Matrix<double, 5, Eigen::Dynamic> ripples = Eigen::Matrix<double, 5, Eigen::Dynamic>::Zero(5, count);
  std::vector<bool> is_smooth(nodes.size() - first, true);
  Eigen::Index row = 0;
  for (const Channel& channel : channels_of(nodes, first)) {
    const Left left = left_of(channel, Q);
    const double most = lower_quartile(left.of_window) * (1 + kNoParabola * deviation);
    for (std::size_t k = 0; k < is_smooth.size(); ++k) {
      if (left.of_window[static_cast<Eigen::Index>(k)] > most) is_smooth[k] = false;
    }
    ripples.row(row++) = left.of_node;
  }
  double smooth = 0;
  for (std::size_t k = 0; k < is_smooth.size(); ++k) {
    if (!is_smooth[k]) continue;
    const PairRipple ripple = ripples.col(static_cast<Eigen::Index>(k));
    nodes[first + k].ripple = ripple;
    usual += ripple * ripple.transpose();
    smooth += 1;
  }
  return usual / std::max(1.0, smooth);
}

}  // namespace rollfix::belief
