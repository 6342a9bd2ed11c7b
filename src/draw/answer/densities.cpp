#include "draw/answer/densities.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <unordered_map>
#include <utility>

// Notation:
//   [a, b], p       a piece of a density over the boundary and what it holds; a = b: a point, as at a pivot
//   bin             one of equal parts of a stretch of the boundary: what it holds, by its length, or the highest there
//   g(x) - h(y)     a function of both places of a pair, on the grid of its samples; its lines at a level c
//   C, V, lambda    covariance of two numbers, its directions and its eigenvalues: the ellipse is m + k V sqrt(lambda)
//                   e, e once round the unit circle
// Follows W. E. Lorensen and H. E. Cline, "Marching cubes" (1987), in the plane: a line enters and leaves a cell where
// its corners differ in sign; of four that alternate the mean says which two go together.
namespace rollfix::draw {
namespace {

constexpr double kTail = 4;  // standard deviations; beyond is nothing

/// Adds so much, evenly spread from lo to hi, which are in bins.
void spread(double lo, double hi, double amount, std::vector<double>& bins) {
  const auto end = static_cast<double>(bins.size());
  if (hi < 0 || lo > end) return;
  if (hi - lo < 1e-9) {
    bins[static_cast<std::size_t>(std::clamp(std::floor(lo), 0.0, end - 1))] += amount;
    return;
  }
  for (double k = std::max(0.0, std::floor(lo)); k < std::min(end, hi); ++k) {
    const double common = std::min(hi, k + 1) - std::max(lo, k);
    bins[static_cast<std::size_t>(k)] += amount * std::max(0.0, common) / (hi - lo);
  }
}

constexpr double kZero = 1e-12;

class MarchingSquares {
 public:
  MarchingSquares(const Samples& g, const Samples& h, double level) : g_(g), h_(h), level_(level) {}

  std::vector<std::vector<Vec2>> lines() {
    for (std::size_t j = 0; j + 1 < h_.at.size(); ++j) {
      for (std::size_t i = 0; i + 1 < g_.at.size(); ++i) cell(i, j);
    }
    std::vector<std::vector<Vec2>> lines;
    for (const std::size_t edge : order_) {  // open ones first, from an end
      if (points_.at(edge).count == 1 && !points_.at(edge).used) lines.push_back(walk(edge));
    }
    for (const std::size_t edge : order_) {
      if (points_.at(edge).used) continue;
      lines.push_back(walk(edge));
      lines.back().push_back(lines.back().front());
    }
    return lines;
  }

 private:
  /// Where a line crosses an edge of the grid, and where it goes from there.
  struct Point {
    Vec2 at = Vec2::Zero();
    std::array<std::size_t, 2> next{};
    std::size_t count = 0;
    bool used = false;
  };

  double value(std::size_t i, std::size_t j) const {
    const double value = g_.value[i] - h_.value[j] - level_;
    return std::abs(value) < kZero ? 0 : value;
  }
  bool above(std::size_t i, std::size_t j) const { return value(i, j) >= 0; }

  /// The edge from a node to the right or upward.
  std::size_t edge(std::size_t i, std::size_t j, bool up) const { return 2 * (j * g_.at.size() + i) + (up ? 1 : 0); }

  void cell(std::size_t i, std::size_t j) {
    const std::size_t below = edge(i, j, false), above_it = edge(i, j + 1, false);
    const std::size_t left = edge(i, j, true), right = edge(i + 1, j, true);
    const bool a = above(i, j), b = above(i + 1, j), c = above(i + 1, j + 1), d = above(i, j + 1);
    if (a == c && b == d && a != b) {  // two lines: the middle says which corners belong together
      const bool middle = value(i, j) + value(i + 1, j) + value(i, j + 1) + value(i + 1, j + 1) >= 0;
      join(below, a == middle ? right : left);
      join(above_it, a == middle ? left : right);
      return;
    }
    std::array<std::size_t, 2> crossed{};
    std::size_t count = 0;
    const auto note = [&](bool one, bool two, std::size_t which) {
      if (one != two) crossed[count++] = which;
    };
    note(a, b, below);
    note(b, c, right);
    note(d, c, above_it);
    note(a, d, left);
    if (count == 2) join(crossed[0], crossed[1]);
  }

  void join(std::size_t one, std::size_t two) {
    for (const auto& [from, to] : {std::pair(one, two), std::pair(two, one)}) {
      const auto [found, is_new] = points_.try_emplace(from);
      if (is_new) {
        found->second.at = place(from);
        order_.push_back(from);
      }
      found->second.next[found->second.count++] = to;
    }
  }

  Vec2 place(std::size_t edge) const {
    const std::size_t i = edge / 2 % g_.at.size(), j = edge / 2 / g_.at.size();
    const bool up = edge % 2 == 1;
    const double from = value(i, j), to = up ? value(i, j + 1) : value(i + 1, j);
    const double share = from / (from - to);
    return up ? Vec2(g_.at[i], h_.at[j] + share * (h_.at[j + 1] - h_.at[j]))
              : Vec2(g_.at[i] + share * (g_.at[i + 1] - g_.at[i]), h_.at[j]);
  }

  std::vector<Vec2> walk(std::size_t edge) {
    std::vector<Vec2> line;
    for (;;) {
      Point& point = points_.at(edge);
      point.used = true;
      line.push_back(point.at);
      std::size_t k = 0;
      while (k < point.count && points_.at(point.next[k]).used) ++k;
      if (k == point.count) return line;
      edge = point.next[k];
    }
  }

  const Samples& g_;
  const Samples& h_;
  double level_;
  std::unordered_map<std::size_t, Point> points_;
  std::vector<std::size_t> order_;  // of the edges, so that the same input gives the same lines
};

constexpr int kEllipsePoints = 96;

Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes_of(const Eigen::Matrix2d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(covariance);
  return solver;
}

}  // namespace

std::vector<double> binned(const Density& density, const Boundary& places, const Interval& range, std::size_t count) {
  std::vector<double> bins(count, 0.0);
  const double per_length = static_cast<double>(count) / range.width();
  for (const DensityPiece& piece : density) {
    for (const double lap : {-1.0, 0.0, 1.0}) {
      if (lap != 0 && !places.closed) continue;
      const double lo = piece.s.lo + lap * places.perimeter - range.lo;
      // A point at the seam is not counted at both ends.
      if (piece.s.width() == 0 && lo >= places.perimeter) continue;
      spread(lo * per_length, (lo + piece.s.width()) * per_length, piece.probability * per_length, bins);
    }
  }
  return bins;
}

std::vector<double> highest(const Density& density, const Boundary& places, const Interval& range, std::size_t count) {
  std::vector<double> heights(count, 0.0);
  std::vector<double> points(count, 0.0);
  const double per_length = static_cast<double>(count) / range.width();
  for (const DensityPiece& piece : density) {
    for (const double lap : {-1.0, 0.0, 1.0}) {
      if (lap != 0 && !places.closed) continue;
      const double lo = piece.s.lo + lap * places.perimeter - range.lo;
      if (piece.s.width() == 0) {
        if (lo < places.perimeter) spread(lo * per_length, lo * per_length, piece.probability * per_length, points);
        continue;
      }
      const double height = piece.probability / piece.s.width();
      const double begin = std::max(0.0, std::floor(lo * per_length));
      const double end = std::min(static_cast<double>(count), std::ceil((lo + piece.s.width()) * per_length));
      for (double k = begin; k < end; ++k) {
        double& here = heights[static_cast<std::size_t>(k)];
        here = std::max(here, height);
      }
    }
  }
  for (std::size_t k = 0; k < count; ++k) heights[k] += points[k];
  return heights;
}

std::vector<double> smoothed(const std::vector<double>& bins, double sd, bool around) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kTail * sd));
  const auto count = static_cast<std::ptrdiff_t>(bins.size());
  std::vector<double> weights;
  double total = 0;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    weights.push_back(std::exp(-0.5 * static_cast<double>(k * k) / (sd * sd)));
    total += weights.back();
  }
  std::vector<double> out(bins.size(), 0.0);
  for (std::ptrdiff_t at = 0; at < count; ++at) {
    if (bins[static_cast<std::size_t>(at)] <= 0) continue;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      std::ptrdiff_t to = at + k;
      if (around) to = ((to % count) + count) % count;
      if (to < 0 || to >= count) continue;
      const double weight = weights[static_cast<std::size_t>(k + reach)] / total;
      out[static_cast<std::size_t>(to)] += weight * bins[static_cast<std::size_t>(at)];
    }
  }
  return out;
}

std::vector<std::vector<Vec2>> level_lines(const Samples& g, const Samples& h, double level) {
  return MarchingSquares(g, h, level).lines();
}

std::vector<Vec2> ellipse(const Vec2& mean, const Eigen::Matrix2d& covariance, double sigmas) {
  const auto solver = axes_of(covariance);
  const Vec2 half = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  std::vector<Vec2> points;
  for (int k = 0; k < kEllipsePoints; ++k) {
    const double angle = 2 * std::numbers::pi * k / kEllipsePoints;
    const Vec2 by(half.x() * std::cos(angle), half.y() * std::sin(angle));
    points.emplace_back(mean + sigmas * solver.eigenvectors() * by);
  }
  return points;
}

Vec2 half_axes(const Eigen::Matrix2d& covariance) {
  const Vec2 half = axes_of(covariance).eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return {half.y(), half.x()};
}

}  // namespace rollfix::draw
