#pragma once

// The exhaustive check of the march: shares nothing with it but the curves. Arc length by Boost's adaptive quadrature,
// turn as the tangent's direction, other densities by Boost again; roots by looking at very many places.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "rollfix/outline.hpp"

namespace march_oracle {

/// Integral along the boundary from s = 0, as a function of a place (curve, u) close to a known one.
enum class Measure { turn, curvature, other };

class Exhaustive {
 public:
  using F = std::function<double(const rollfix::Jet&)>;

  /// phi(s) is the turn over [s, s + L].
  explicit Exhaustive(const rollfix::Outline& outline) : Exhaustive(outline, Measure::turn, {}) {}
  /// phi(s) is the change of the curvature, or the integral of f by arc length.
  Exhaustive(const rollfix::Outline& outline, Measure measure, F f)
      : outline_(outline), measure_(measure), f_(std::move(f)) {
    for (std::size_t curve = 0; curve < outline_.curves.size(); ++curve) add_curve(curve);
  }

  double perimeter() const { return knots_.back().s; }
  double total() const { return measure_ == Measure::curvature && outline_.closed ? 0 : knots_.back().value; }

  /// The integral over [0, s], any s when closed.
  double value(double s) const {
    double loops = 0;
    if (outline_.closed) {
      loops = std::floor(s / perimeter());
      s -= loops * perimeter();
    }
    return loops * total() + value_once(std::clamp(s, 0.0, perimeter()));
  }

  double phi(double s, double length) const { return value(s + length) - value(s); }

  struct Scan {
    std::vector<double> roots;
    double nearest_miss = 1e300;  // least |phi - C| at an extremum of phi: how far from a double root
  };

  /// All roots of phi(s) = C over one loop, or where [s, s + L] lies on the open curve: sign changes between very many
  /// places, all kinks, and the extrema next to them.
  Scan scan(double length, double target) const {
    const int places = std::max<int>(600, 60 * static_cast<int>(outline_.curves.size()));
    // A closed outline is looked at from a place that no reading singles out.
    const double lo = outline_.closed ? -0.0314159 * perimeter() : std::max(0.0, -length);
    const double hi = outline_.closed ? lo + perimeter() : std::min(perimeter(), perimeter() - length);
    const auto f = [&](double s) { return phi(s, length) - target; };
    std::vector<double> starts;
    for (int i = 0; i <= places; ++i) starts.push_back(lo + (hi - lo) * i / places);
    for (const Knot& knot : knots_) {  // where an end passes from one curve to the next, phi may have a kink
      if (knot.u != outline_.curves[knot.curve].domain().lo) continue;
      for (const double start : {knot.s, knot.s - length}) {
        const double once = outline_.closed ? start - std::floor((start - lo) / perimeter()) * perimeter() : start;
        if (once > lo && once < hi) starts.push_back(once);
      }
    }
    std::sort(starts.begin(), starts.end());
    std::vector<std::pair<double, double>> places_seen;
    for (const double start : starts) places_seen.emplace_back(start, f(start));
    Scan found;
    for (std::size_t i = 1; i + 1 < starts.size(); ++i) {
      const double before = places_seen[i - 1].second, here = places_seen[i].second, after = places_seen[i + 1].second;
      if ((here - before) * (after - here) > 0) continue;
      const double sign = here > before ? -1 : 1;
      const auto best = boost::math::tools::brent_find_minima([&](double x) { return sign * f(x); },
                                                              places_seen[i - 1].first, places_seen[i + 1].first, 40);
      found.nearest_miss = std::min(found.nearest_miss, std::fabs(best.second));
      places_seen.emplace_back(best.first, sign * best.second);
    }
    std::sort(places_seen.begin(), places_seen.end());
    for (std::size_t i = 0; i + 1 < places_seen.size(); ++i) {
      if ((places_seen[i].second < 0) != (places_seen[i + 1].second < 0)) {
        const double at = root(f, places_seen[i].first, places_seen[i + 1].first);
        found.roots.push_back(at < 0 ? at + perimeter() : at);
      }
    }
    std::sort(found.roots.begin(), found.roots.end());
    return found;
  }

 private:
  struct Knot {
    std::size_t curve = 0;
    double u = 0;
    double s = 0;
    double value = 0;
  };

  static constexpr int kKnots = 100;

  double density(std::size_t curve, double u) const {
    const rollfix::Jet jet = outline_.curves[curve].jet(u);
    return f_(jet) * jet.first.norm();
  }
  double angle(std::size_t curve, double u) const {
    const rollfix::Vec2 direction = outline_.curves[curve].jet(u).first;
    return std::atan2(direction.y(), direction.x());
  }

  template <class G>
  static double integrate(const G& g, double from, double to) {
    return from == to ? 0 : boost::math::quadrature::gauss_kronrod<double, 15>::integrate(g, from, to, 1, 1e-13);
  }
  double length(std::size_t curve, double from, double to) const {
    return integrate([&](double u) { return outline_.curves[curve].jet(u).first.norm(); }, from, to);
  }
  /// What the measure gains between two places less than half a turn apart.
  double gain(std::size_t curve, double from, double to) const {
    switch (measure_) {
      case Measure::turn:
        return std::remainder(angle(curve, to) - angle(curve, from), 2 * M_PI);
      case Measure::curvature:
        return rollfix::curvature(outline_.curves[curve].jet(to)) -
               rollfix::curvature(outline_.curves[curve].jet(from));
      default:
        return integrate([&](double u) { return density(curve, u); }, from, to);
    }
  }

  void add_curve(std::size_t curve) {
    const rollfix::Interval domain = outline_.curves[curve].domain();
    const double s0 = knots_.empty() ? 0 : knots_.back().s;
    const double value0 = knots_.empty() ? 0 : knots_.back().value;
    knots_.push_back({curve, domain.lo, s0, value0});
    for (int i = 1; i <= kKnots; ++i) {
      const Knot last = knots_.back();
      const double u = i == kKnots ? domain.hi : domain.lo + domain.width() * i / kKnots;
      knots_.push_back({curve, u, last.s + length(curve, last.u, u), last.value + gain(curve, last.u, u)});
    }
  }

  double value_once(double s) const {
    auto after =
        std::upper_bound(knots_.begin(), knots_.end(), s, [](double x, const Knot& knot) { return x < knot.s; });
    if (after == knots_.begin()) ++after;
    const Knot& knot = *(after - 1);
    if (after == knots_.end() || s == knot.s) return knot.value;
    double u = knot.u + (s - knot.s) * (after->u - knot.u) / (after->s - knot.s);
    for (int i = 0; i < 3; ++i) {  // Newton; the knots are close
      u += (s - knot.s - length(knot.curve, knot.u, u)) / outline_.curves[knot.curve].jet(u).first.norm();
    }
    return knot.value + gain(knot.curve, knot.u, u);
  }

  template <class G>
  static double root(const G& g, double lo, double hi) {
    std::uintmax_t rounds = 100;
    const auto bracket =
        boost::math::tools::toms748_solve(g, lo, hi, boost::math::tools::eps_tolerance<double>(50), rounds);
    return 0.5 * (bracket.first + bracket.second);
  }

  const rollfix::Outline outline_;
  Measure measure_;
  F f_;
  std::vector<Knot> knots_;
};

}  // namespace march_oracle
