#include "draw/answer/contours.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace rollfix::draw {
namespace {

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

}  // namespace

std::vector<std::vector<Vec2>> level_lines(const Samples& g, const Samples& h, double level) {
  return MarchingSquares(g, h, level).lines();
}

}  // namespace rollfix::draw
