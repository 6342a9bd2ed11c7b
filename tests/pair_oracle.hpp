#pragma once

// The exhaustive check of the two-finger search: shares nothing with it but the curves. Pairs are the crossings of two
// planar curves drawn with very many points.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "pair_oracle_boundary.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/reading.hpp"

namespace pair_oracle {

using rollfix::Interval;
using rollfix::Vec2;

/// One equation: g(s) - h(t) = target, both the turn over a roll, or the angle at its end alone.
struct Equation {
  double length_a = 0;
  double length_b = 0;
  double target = 0;
  bool from_start = true;  // the turn, not the angle
};

struct Root {
  double s = 0;  // in [0, P)
  double t = 0;
  double error = 0;  // what 1e-12 rad in the equations moves it by, length
};

struct Scan {
  std::vector<Root> roots;
  double nearest_miss = 1e300;  // rad: how far from a double root (seen up to kHorizon)
};

/// Near misses up to here are noticed, rad.
inline constexpr double kHorizon = 1e-6;

/// An equation beyond the first two holds up to here, rad.
inline constexpr double kFits = 1e-10;

/// All pairs that fit these readings, and the facing equation where there is one.
class Exhaustive {
 public:
  explicit Exhaustive(const rollfix::Outline& outline) : boundary_(outline) {}

  const Boundary& boundary() const { return boundary_; }

  Scan scan(const std::vector<rollfix::Reading>& readings, std::optional<double> facing = {}) const {
    Scan found;
    if (facing) {
      // Theta(s) - Theta(t) = C + 2 pi k, and with it Theta(s + La) - Theta(t + Lb) = theta + C + 2 pi k.
      const double most = std::fabs(boundary_.total()) + 4 * kTwoPi + std::fabs(*facing);
      const double windings = std::ceil(most / kTwoPi);
      for (double k = -windings; k <= windings; ++k) {
        const double shift = *facing + kTwoPi * k;
        std::vector<Equation> equations{{0, 0, shift, false}};
        for (const auto& r : readings) equations.push_back({r.length[0], r.length[1], r.turn + shift, false});
        search(equations, found);
      }
    } else {
      std::vector<Equation> equations;
      for (const auto& r : readings) equations.push_back({r.length[0], r.length[1], r.turn, true});
      search(equations, found);
    }
    std::sort(found.roots.begin(), found.roots.end(),
              [](const Root& one, const Root& two) { return std::pair(one.s, one.t) < std::pair(two.s, two.t); });
    return found;
  }

  double distance(double a, double b) const {
    return boundary_.closed() ? std::fabs(std::remainder(a - b, boundary_.perimeter())) : std::fabs(a - b);
  }

 private:
  /// A short piece of a planar curve between two parameters, with the derivatives at its ends.
  struct Piece {
    double lo = 0, hi = 0;
    Vec2 front, back, front_slope, back_slope;
    Vec2 chord_slope;
    double sagitta = 0;  // how far it strays from its chord
    double spread = 0;   // and its derivative from the chord's

    void finish() {
      const double step = hi - lo;
      chord_slope = (back - front) / step;
      const double bend = (front_slope - chord_slope).norm() + (back_slope - chord_slope).norm();
      sagitta = 0.25 * step * bend + 1e-13;  // a cubic strays by 4/27 of it
      spread = 2 * bend;
    }
    Vec2 least() const { return front.cwiseMin(back) - Vec2::Constant(sagitta); }
    Vec2 most() const { return front.cwiseMax(back) + Vec2::Constant(sagitta); }
  };

  enum class Finger { a, b };
  using Two = std::array<Equation, 2>;

  double length_of(const Equation& equation, Finger finger) const {
    return finger == Finger::a ? equation.length_a : equation.length_b;
  }

  /// Where the roll lies on the boundary; a closed one is cut at a place that no reading singles out.
  Interval range(const std::vector<Equation>& equations, Finger finger) const {
    const double period = boundary_.perimeter();
    if (boundary_.closed()) return {-0.0314159 * period, (1 - 0.0314159) * period};
    Interval range{0, period};
    for (const Equation& equation : equations) {
      range.lo = std::max(range.lo, -length_of(equation, finger));
      range.hi = std::min(range.hi, period - length_of(equation, finger));
    }
    return range;
  }

  std::vector<double> places(const std::vector<Equation>& equations, Finger finger) const {
    constexpr int kEven = 3000;
    const Interval where = range(equations, finger);
    std::vector<double> places;
    for (int i = 0; i <= kEven; ++i) places.push_back(where.lo + where.width() * i / kEven);
    const auto add = [&](double length) {
      for (const double grade : boundary_.grades()) {
        double at = grade - length;
        if (boundary_.closed()) at -= std::floor((at - where.lo) / boundary_.perimeter()) * boundary_.perimeter();
        if (at > where.lo && at < where.hi) places.push_back(at);
      }
    };
    add(0);
    for (std::size_t k = 0; k < 2; ++k) add(length_of(equations[k], finger));
    std::sort(places.begin(), places.end());
    const double least = 1e-9 * boundary_.perimeter();
    std::vector<double> apart{places.front()};
    for (const double place : places) {
      if (place > apart.back() + least) apart.push_back(place);
    }
    return apart;
  }

  /// Point and derivative of a planar curve; finger b's with the targets added.
  std::pair<Vec2, Vec2> at(const Two& equations, Finger finger, double x, bool before) const {
    Vec2 point, slope;
    const Boundary::Turning start = boundary_.rough(x, before);
    for (int k = 0; k < 2; ++k) {
      const Equation& equation = equations[static_cast<std::size_t>(k)];
      const Boundary::Turning end = boundary_.rough(x + length_of(equation, finger), before);
      point[k] = end.angle - (equation.from_start ? start.angle : 0);
      slope[k] = end.curvature - (equation.from_start ? start.curvature : 0);
      if (finger == Finger::b) point[k] += equation.target;
    }
    return {point, slope};
  }

  Piece piece(const Two& equations, Finger finger, double lo, double hi) const {
    Piece piece;
    piece.lo = lo;
    piece.hi = hi;
    std::tie(piece.front, piece.front_slope) = at(equations, finger, lo, false);
    std::tie(piece.back, piece.back_slope) = at(equations, finger, hi, true);
    piece.finish();
    return piece;
  }

  std::vector<Piece> pieces(const std::vector<Equation>& equations, Finger finger) const {
    const std::vector<double> places = this->places(equations, finger);
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      pieces.push_back(piece({equations[0], equations[1]}, finger, places[i], places[i + 1]));
    }
    return pieces;
  }

  void search(const std::vector<Equation>& equations, Scan& found) const {
    if (equations.size() < 2) throw std::invalid_argument("two equations at least");
    for (const Finger finger : {Finger::a, Finger::b}) {
      if (!(range(equations, finger).width() > 0)) return;
    }
    const std::vector<Piece> of_a = pieces(equations, Finger::a), of_b = pieces(equations, Finger::b);
    Vec2 lo = of_a.front().least(), hi = of_a.front().most();
    for (const Piece& piece : of_a) {
      lo = lo.cwiseMin(piece.least());
      hi = hi.cwiseMax(piece.most());
    }
    // Pieces of a in the cells of a grid; those of b look into the cells that they touch.
    constexpr int kCells = 400;
    const Vec2 cell = ((hi - lo) / kCells).cwiseMax(1e-9);
    const auto index = [&](const Vec2& point, int axis) {
      return static_cast<int>(std::clamp((point[axis] - lo[axis]) / cell[axis], 0.0, kCells - 1.0));
    };
    std::vector<std::vector<const Piece*>> grid(static_cast<std::size_t>(kCells) * kCells);
    const auto cells = [&](const Vec2& from, const Vec2& to, auto&& visit) {
      for (int x = index(from, 0); x <= index(to, 0); ++x) {
        for (int y = index(from, 1); y <= index(to, 1); ++y) {
          visit(x, y, grid[static_cast<std::size_t>(x) * kCells + static_cast<std::size_t>(y)]);
        }
      }
    };
    for (const Piece& piece : of_a) {
      cells(piece.least(), piece.most(), [&](int, int, auto& held) { held.push_back(&piece); });
    }
    const Vec2 margin = Vec2::Constant(kHorizon);
    for (const Piece& piece : of_b) {
      const Vec2 least = piece.least() - margin, most = piece.most() + margin;
      if ((most.array() < lo.array()).any() || (least.array() > hi.array()).any()) continue;
      cells(least, most, [&](int x, int y, const auto& held) {
        for (const Piece* other : held) {
          if ((other->most().array() < least.array()).any() || (other->least().array() > most.array()).any()) continue;
          const Vec2 corner = least.cwiseMax(other->least());  // of what both share: look at them once
          if (index(corner, 0) == x && index(corner, 1) == y) examine(equations, *other, piece, 0, found);
        }
      });
    }
  }

  /// Where two chords come closest: the distance, and the shares of either.
  static double closest(const Piece& a, const Piece& b, double& share_a, double& share_b) {
    const Vec2 along_a = a.back - a.front, along_b = b.back - b.front, between = b.front - a.front;
    const double area = rollfix::cross(along_a, along_b);
    if (area != 0) {
      share_a = rollfix::cross(between, along_b) / area;
      share_b = rollfix::cross(between, along_a) / area;
      if (share_a >= 0 && share_a <= 1 && share_b >= 0 && share_b <= 1) return 0;
    }
    double least = 1e300;
    const auto offer = [&](double on_a, double on_b) {
      const double apart = (a.front + on_a * along_a - b.front - on_b * along_b).norm();
      if (apart >= least) return;
      least = apart;
      share_a = on_a;
      share_b = on_b;
    };
    const auto foot = [](const Vec2& point, const Vec2& from, const Vec2& along) {
      const double square = along.squaredNorm();
      return square > 0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0.0;
    };
    for (const double end : {0.0, 1.0}) {
      offer(end, foot(a.front + end * along_a, b.front, along_b));
      offer(foot(b.front + end * along_b, a.front, along_a), end);
    }
    return least;
  }

  static bool transversal(const Piece& a, const Piece& b) {
    const double size_a = a.chord_slope.norm(), size_b = b.chord_slope.norm();
    if (a.spread > 0.5 * size_a || b.spread > 0.5 * size_b) return false;
    const double sine = std::fabs(rollfix::cross(a.chord_slope, b.chord_slope)) / (size_a * size_b);
    return sine > 2 * (a.spread / size_a + b.spread / size_b) && sine > 1e-7;
  }

  void examine(const std::vector<Equation>& equations, const Piece& a, const Piece& b, int depth, Scan& found) const {
    constexpr int kDeepest = 24;
    double share_a = 0, share_b = 0;
    const double apart = closest(a, b, share_a, share_b);
    if (apart > a.sagitta + b.sagitta + kHorizon) return;
    if (transversal(a, b)) {  // at most one crossing
      if (polish(equations, a, b, a.lo + share_a * (a.hi - a.lo), b.lo + share_b * (b.hi - b.lo), found)) return;
    } else if (a.sagitta + b.sagitta < 0.05 * kHorizon || depth == kDeepest) {
      found.nearest_miss = std::min(found.nearest_miss, apart);
      return;
    }
    if (depth == kDeepest) throw std::runtime_error("the exhaustive check can't tell");
    const Two two{equations[0], equations[1]};
    const double middle_a = a.lo + 0.5 * (a.hi - a.lo), middle_b = b.lo + 0.5 * (b.hi - b.lo);
    for (const Piece& half_a : {piece(two, Finger::a, a.lo, middle_a), piece(two, Finger::a, middle_a, a.hi)}) {
      for (const Piece& half_b : {piece(two, Finger::b, b.lo, middle_b), piece(two, Finger::b, middle_b, b.hi)}) {
        examine(equations, half_a, half_b, depth + 1, found);
      }
    }
  }

  double residual(const Equation& equation, double s, double t) const {
    const double start = equation.from_start ? boundary_.angle(s) - boundary_.angle(t) : 0;
    return boundary_.angle(s + equation.length_a) - boundary_.angle(t + equation.length_b) - start - equation.target;
  }

  /// Newton on two pieces that cross once at most. False: it did not settle.
  bool polish(const std::vector<Equation>& equations, const Piece& a, const Piece& b, double s, double t,
              Scan& found) const {
    const double step_a = a.hi - a.lo, step_b = b.hi - b.lo, period = boundary_.perimeter();
    const Two two{equations[0], equations[1]};
    double error = 0;
    for (int round = 0;; ++round) {
      const Vec2 miss(residual(two[0], s, t), residual(two[1], s, t));
      const Vec2 slope_a = at(two, Finger::a, s, s >= a.hi).second, slope_b = at(two, Finger::b, t, t >= b.hi).second;
      const double area = rollfix::cross(slope_a, slope_b);
      if (area == 0) return false;
      const double move_s = -rollfix::cross(miss, slope_b) / area, move_t = -rollfix::cross(miss, slope_a) / area;
      s += move_s;
      t += move_t;
      error = 1e-12 * std::max(slope_a.norm(), slope_b.norm()) * 1.5 / std::fabs(area);
      if (std::max(std::fabs(move_s), std::fabs(move_t)) < std::max(1e-13 * period, 0.01 * error)) break;
      // It leaves: no crossing here, unless it only overshoots.
      if (s < a.lo - step_a || s > a.hi + step_a || t < b.lo - step_b || t > b.hi + step_b) return true;
      if (round == 30) return false;
    }
    const double margin = 1e-10 * period + error;
    if (s < a.lo - margin || s > a.hi + margin || t < b.lo - margin || t > b.hi + margin) return true;
    for (std::size_t k = 2; k < equations.size(); ++k) {
      const double miss = std::fabs(residual(equations[k], s, t));
      if (miss <= kFits) continue;
      found.nearest_miss = std::min(found.nearest_miss, miss);
      return true;
    }
    keep({once(s), once(t), error}, found);
    return true;
  }

  double once(double s) const {
    if (!boundary_.closed()) return s;
    s -= std::floor(s / boundary_.perimeter()) * boundary_.perimeter();
    return s < boundary_.perimeter() ? s : 0;
  }

  void keep(const Root& root, Scan& found) const {
    const double same = 1e-9 * boundary_.perimeter() + root.error;
    for (const Root& other : found.roots) {
      if (distance(root.s, other.s) <= same && distance(root.t, other.t) <= same) return;
    }
    found.roots.push_back(root);
  }

  Boundary boundary_;
};

}  // namespace pair_oracle
