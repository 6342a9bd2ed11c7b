#pragma once

// Every pair of first contacts of two fingers, by looking everywhere: f_k(s, t) = g_k(s) - h_k(t) - theta_k may all be
// near 0 only on rectangles that bounds on g and h and on their slopes do not exclude. Those are halved, down to a
// floor.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "oracle/roll_path.hpp"

namespace oracle {

struct PairQuestion {
  struct Reading {
    Real length_a = 0, length_b = 0, turn = 0;
  };
  std::vector<Reading> readings;
  std::optional<Real> facing;
  Real tolerance = 0;  // radians: every |f_k| up to here fits
  Real doubt = 0;      // radians: by how much the library may have f wrong
};

using Pair = std::array<Real, 2>;
using Rectangle = std::array<Interval, 2>;

/// Pairs that may fit and hang together; none outside of all of them does.
struct PairCluster {
  std::vector<Rectangle> starts;
  std::optional<Pair> fit;  // this one does, beyond doubt
  bool is_root = false;     // ... exactly, and f is regular there: a crossing
};

class TwoFingers {
 public:
  static constexpr Real kFloor = 2e-7L;             // of the perimeter
  static constexpr std::size_t kMostPairs = 25000;  // looked at: more is a continuum

  TwoFingers(const Boundary& boundary, const PairQuestion& question)
      : boundary_(boundary),
        question_(question),
        a_(boundary, lengths(0), question.facing.has_value()),
        b_(boundary, lengths(1), question.facing.has_value()) {
    is_told_ = !a_.is_branched() && !b_.is_branched() && search();
    if (is_told_) gather();
  }

  /// False: a continuum, or two corners at once. Then nothing is said.
  bool is_told() const { return is_told_; }
  const std::vector<PairCluster>& clusters() const { return clusters_; }

 private:
  struct Box {
    std::size_t a, b;
  };

  std::vector<Real> lengths(std::size_t finger) const {
    std::vector<Real> lengths;
    for (const auto& reading : question_.readings) {
      lengths.push_back(finger == 0 ? reading.length_a : reading.length_b);
    }
    return lengths;
  }

  std::size_t rows() const { return a_.rows(); }
  bool is_facing(std::size_t row) const { return row == question_.readings.size(); }
  Real reach() const { return question_.tolerance + question_.doubt; }

  Real residual(std::size_t row, Real g, Real h) const {
    if (!is_facing(row)) return g - h - question_.readings[row].turn;
    return std::remainder(g - h - *question_.facing, 2 * kPi);
  }

  // ---- search ----

  bool search() {
    std::vector<Box> open;
    for (std::size_t i = 1; i <= a_.roots(); ++i) {
      for (std::size_t j = 1; j <= b_.roots(); ++j) open.push_back({i, j});
    }
    for (std::size_t seen = 0; !open.empty(); ++seen) {
      if (seen > kMostPairs) return false;
      const Box box = open.back();
      open.pop_back();
      if (excludes(box)) continue;
      const Real wide_a = a_.width(a_.node(box.a)), wide_b = b_.width(b_.node(box.b));
      if (std::max(wide_a, wide_b) <= kFloor * boundary_.perimeter()) {
        left_.push_back(box);
      } else if (wide_a >= wide_b) {
        const std::size_t half = a_.halves(box.a);
        open.push_back({half, box.b});
        open.push_back({half + 1, box.b});
      } else {
        const std::size_t half = b_.halves(box.b);
        open.push_back({box.a, half});
        open.push_back({box.a, half + 1});
      }
    }
    return true;
  }

  bool excludes(const Box& box) const {
    const PathNode& a = a_.node(box.a);
    const PathNode& b = b_.node(box.b);
    for (std::size_t k = 0; k < rows(); ++k) {
      const Interval range = a.values[k] - b.values[k];
      const Real half = range.width() / 2;
      if (is_facing(k) && half >= kPi) continue;
      if (std::abs(residual(k, range.middle(), 0)) > half + reach()) return true;
    }
    for (std::size_t i = 0; i < rows(); ++i) {
      for (std::size_t j = i + 1; j < rows(); ++j) {
        if (excludes(a, b, i, j)) return true;
      }
    }
    return false;
  }

  /// Two rows, combined so that one of them hardly depends on s and the other hardly on t.
  bool excludes(const PathNode& a, const PathNode& b, std::size_t i, std::size_t j) const {
    const Real half_a = (a.hi - a.lo) / 2, half_b = (b.hi - b.lo) / 2;
    const auto row = [&](std::size_t k) {
      const Interval at_middle =
          both(around_middle(a, k, half_a), a.values[k]) - both(around_middle(b, k, half_b), b.values[k]);
      return Interval(residual(k, at_middle.middle(), 0)) + Interval(-at_middle.width() / 2, at_middle.width() / 2);
    };
    for (const std::size_t k : {i, j}) {
      if (is_facing(k) && (a.values[k] - b.values[k]).width() >= kPi) return false;
    }
    const Interval f = row(i), g = row(j);
    const auto misses = [&](Real weight_i, Real weight_j) {
      const Interval middle = Interval(weight_i) * f + Interval(weight_j) * g;
      const Interval by_s = Interval(weight_i) * a.slope[i] + Interval(weight_j) * a.slope[j];
      const Interval by_t = Interval(weight_i) * b.slope[i] + Interval(weight_j) * b.slope[j];
      const Real room =
          by_s.size() * half_a + by_t.size() * half_b + (std::abs(weight_i) + std::abs(weight_j)) * reach();
      return middle.lo > room || middle.hi < -room;
    };
    return misses(a.slope[j].middle(), -a.slope[i].middle()) || misses(b.slope[j].middle(), -b.slope[i].middle());
  }

  static Interval around_middle(const PathNode& node, std::size_t k, Real half) {
    return both(Interval(node.first[k]) + node.slope[k] * Interval(half),
                Interval(node.last[k]) - node.slope[k] * Interval(half));
  }

  // ---- clusters ----

  Rectangle rectangle(const Box& box) const { return {a_.starts(a_.node(box.a)), b_.starts(b_.node(box.b))}; }

  bool touch(const Interval& one, const Interval& other) const {
    const Real slack = 1e-3L * kFloor * boundary_.perimeter();
    for (const int lap : {-1, 0, 1}) {
      const Real off = lap * boundary_.perimeter();
      if (lap != 0 && !boundary_.closed()) continue;
      if (one.lo <= other.hi + off + slack && other.lo + off <= one.hi + slack) return true;
    }
    return false;
  }

  void gather() {
    std::vector<bool> taken(left_.size());
    for (std::size_t k = 0; k < left_.size(); ++k) {
      if (taken[k]) continue;
      taken[k] = true;
      std::vector<std::size_t> members{k};
      for (std::size_t next = 0; next < members.size(); ++next) {
        const Rectangle one = rectangle(left_[members[next]]);
        for (std::size_t other = 0; other < left_.size(); ++other) {
          if (taken[other]) continue;
          const Rectangle two = rectangle(left_[other]);
          if (!touch(one[0], two[0]) || !touch(one[1], two[1])) continue;
          taken[other] = true;
          members.push_back(other);
        }
      }
      clusters_.push_back(cluster(members));
    }
  }

  PairCluster cluster(const std::vector<std::size_t>& members) const {
    constexpr std::size_t kTried = 8;
    PairCluster cluster;
    Real least = question_.tolerance - question_.doubt;
    for (std::size_t k = 0; k < members.size(); ++k) {
      cluster.starts.push_back(rectangle(left_[members[k]]));
      if (k % (members.size() / kTried + 1) != 0) continue;
      const Polished polished = polish(left_[members[k]]);
      if (polished.miss > least) continue;
      least = polished.miss;
      cluster.fit = polished.pair;
      cluster.is_root = rows() == 2 && polished.is_regular && polished.miss <= kExact;
    }
    return cluster;
  }

  struct Polished {
    Pair pair{};
    Real miss = 0;
    bool is_regular = false;
  };

  /// By Newton's method (of more rows than two Gauss's and his) within the box's pieces.
  Polished polish(const Box& box) const {
    const PathNode& a = a_.node(box.a);
    const PathNode& b = b_.node(box.b);
    Real x = (a.lo + a.hi) / 2, y = (b.lo + b.hi) / 2;
    Polished best;
    best.miss = std::numeric_limits<Real>::infinity();
    for (int round = 0; round < 12; ++round) {
      const auto [g, g_slope] = a_.at(a.piece, x);
      const auto [h, h_slope] = b_.at(b.piece, y);
      Real miss = 0, xx = 0, xy = 0, yy = 0, xf = 0, yf = 0;
      for (std::size_t k = 0; k < rows(); ++k) {
        const Real f = residual(k, g[k], h[k]);
        miss = std::max(miss, std::abs(f));
        xx += g_slope[k] * g_slope[k];
        xy -= g_slope[k] * h_slope[k];
        yy += h_slope[k] * h_slope[k];
        xf += g_slope[k] * f;
        yf -= h_slope[k] * f;
      }
      const Real determinant = xx * yy - xy * xy;
      if (miss < best.miss) {
        best.pair = {a_.piece(a).is_pivot ? a_.piece(a).s : x, b_.piece(b).is_pivot ? b_.piece(b).s : y};
        best.miss = miss;
        best.is_regular = determinant > kRegular * kRegular * xx * yy;
      }
      if (miss <= kExact || !(determinant > 0)) break;
      x = std::clamp(x - (yy * xf - xy * yf) / determinant, a_.piece(a).lo, a_.piece(a).hi);
      y = std::clamp(y - (xx * yf - xy * xf) / determinant, b_.piece(b).lo, b_.piece(b).hi);
    }
    return best;
  }

  static constexpr Real kExact = 1e-16L;   // radians
  static constexpr Real kRegular = 1e-3L;  // the sine of the angle between both curves

  const Boundary& boundary_;
  PairQuestion question_;
  RollPath a_, b_;
  bool is_told_ = false;
  std::vector<Box> left_;
  std::vector<PairCluster> clusters_;
};

}  // namespace oracle
