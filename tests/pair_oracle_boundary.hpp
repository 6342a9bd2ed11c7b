#pragma once

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "rollfix/outline.hpp"

// A boundary that shares nothing with the library but the curves: arc length by Boost's quadrature, turn as the
// tangent's direction.
namespace pair_oracle {

using rollfix::Interval;
using rollfix::Vec2;

inline constexpr double kTwoPi = 2 * std::numbers::pi;

/// The tangent's angle and the curvature by arc length, from a table of very many places.
class Boundary {
 public:
  struct Turning {
    double angle = 0;
    double curvature = 0;
  };

  explicit Boundary(const rollfix::Outline& outline) : outline_(outline) {
    for (std::size_t curve = 0; curve < outline_.curves.size(); ++curve) add_curve(curve);
    if (outline_.closed) {
      const Knot& last = knots_.back();
      total_ = last.angle - knots_.front().angle + corner(last, knots_.front());
    }
    grade();
  }

  bool closed() const { return outline_.closed; }
  double perimeter() const { return knots_.back().s; }
  double total() const { return total_; }

  /// To about 1e-9, fast: cubic between the table's places. `before`: the limit from below.
  Turning rough(double s, bool before = false) const {
    const auto [base, loops] = reduce(s, before);
    const Knot& one = knot_below(base, before);
    const Knot& two = *(&one + 1);
    const double step = two.s - one.s;
    const double x = (base - one.s) / step;
    const double rise = (two.angle - one.angle) / step;
    const double left = one.curvature - rise;
    const double right = two.curvature - rise;
    const double rest = 1 - x;
    return {loops * total_ + one.angle + step * (x * rise + x * rest * (rest * left - x * right)),
            rise + (rest - x) * (rest * left - x * right) + x * rest * (-left - right)};
  }

  /// To rounding: the place itself by Newton, its arc length by quadrature.
  double angle(double s) const {
    const auto [base, loops] = reduce(s, false);
    const Knot& one = knot_below(base, false);
    const Knot& two = *(&one + 1);
    double u = one.u + (base - one.s) * (two.u - one.u) / (two.s - one.s);
    for (int i = 0; i < 3; ++i) {  // the places are close: two steps suffice
      u += (base - one.s - length(one.curve, one.u, u)) / outline_.curves[one.curve].velocity(u).norm();
    }
    return loops * total_ + one.angle + std::remainder(direction(one.curve, u) - direction(one.curve, one.u), kTwoPi);
  }

  double phi(double s, double length) const { return angle(s + length) - angle(s); }

  /// Where one curve ends and the next begins, and places between which the tangent turns little.
  const std::vector<double>& grades() const { return grades_; }

 private:
  struct Knot {
    std::size_t curve = 0;
    double u = 0;
    double s = 0;
    double angle = 0;
    double curvature = 0;  // seen from its own curve
  };

  static constexpr std::size_t kKnots = 4000;
  static constexpr std::size_t kFewest = 48;  // on each curve
  static constexpr double kGrades = 1200;     // pieces of equal turn

  double direction(std::size_t curve, double u) const {
    const Vec2 velocity = outline_.curves[curve].velocity(u);
    return std::atan2(velocity.y(), velocity.x());
  }

  double corner(const Knot& before, const Knot& after) const {
    return std::remainder(direction(after.curve, after.u) - direction(before.curve, before.u), kTwoPi);
  }

  double length(std::size_t curve, double from, double to) const {
    if (from == to) return 0;
    return boost::math::quadrature::gauss_kronrod<double, 15>::integrate(
        [&](double u) { return outline_.curves[curve].velocity(u).norm(); }, from, to, 0, 1e-15);
  }

  void add_curve(std::size_t curve) {
    const Interval domain = outline_.curves[curve].domain();
    const auto curvature = [&](double u) { return rollfix::curvature(outline_.curves[curve].jet(u)); };
    Knot first{curve, domain.lo, 0, 0, curvature(domain.lo)};
    if (knots_.empty()) {
      first.angle = direction(curve, domain.lo);
    } else {
      first.s = knots_.back().s;
      first.angle = knots_.back().angle + corner(knots_.back(), first);
    }
    knots_.push_back(first);
    const std::size_t count = std::max(kFewest, kKnots / outline_.curves.size());
    for (std::size_t i = 1; i <= count; ++i) {
      const Knot last = knots_.back();
      const double share = static_cast<double>(i) / static_cast<double>(count);
      const double u = i == count ? domain.hi : domain.lo + domain.width() * share;
      knots_.push_back({curve, u, last.s + length(curve, last.u, u),
                        last.angle + std::remainder(direction(curve, u) - direction(curve, last.u), kTwoPi),
                        curvature(u)});
    }
  }

  void grade() {
    double turned = 0;
    for (std::size_t i = 1; i < knots_.size(); ++i) turned += std::fabs(knots_[i].angle - knots_[i - 1].angle);
    double since = 0;
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
      const bool joint = i == 0 || knots_[i].curve != knots_[i - 1].curve;
      if (i > 0) since += std::fabs(knots_[i].angle - knots_[i - 1].angle);
      if (!joint && since < turned / kGrades) continue;
      grades_.push_back(knots_[i].s);
      since = 0;
    }
  }

  std::pair<double, double> reduce(double s, bool before) const {
    double loops = 0;
    if (outline_.closed) {
      loops = std::floor(s / perimeter());
      s -= loops * perimeter();
      if (before && s <= 0) return {perimeter(), loops - 1};
    }
    return {std::clamp(s, 0.0, perimeter()), loops};
  }

  /// The knot that starts the piece with `base` in it.
  const Knot& knot_below(double base, bool before) const {
    const auto first = knots_.begin() + 1, last = knots_.end() - 1;
    auto after = before ? std::lower_bound(first, last, base, [](const Knot& knot, double s) { return knot.s < s; })
                        : std::upper_bound(first, last, base, [](double s, const Knot& knot) { return s < knot.s; });
    return *(after - 1);
  }

  const rollfix::Outline outline_;
  std::vector<Knot> knots_;
  std::vector<double> grades_;
  double total_ = 0;
};

}  // namespace pair_oracle
