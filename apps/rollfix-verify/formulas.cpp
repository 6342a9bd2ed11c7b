#include "formulas.hpp"

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

// Notation:
//   u, x            a curve's parameter, and what is added to it in a series
//   v, v'           its velocity (dx/du, dy/du), and the change of that
//   ds/du           |v|: Motion::speed
//   d(Theta)/du     (v cross v') / |v|^2, the rate of the tangent's angle: Motion::turning
// Follows docs/certificates.md, "What is in it": the table of curves and their numbers.
// Idea: most kinds are a path of power series over balls; speed and rate of the angle follow by differentiation. Where
// u is a wide ball, each coefficient holds those at all parameters in it.
namespace rollfix_verify {
namespace {

using Numbers = std::vector<double>;
using Path = std::function<Pair<Series>(const Series&)>;

const double kFullTurn = 2 * std::acos(-1.0);

// Products of two vectors of series.
Series cross(const Pair<Series>& a, const Pair<Series>& b) { return a.x * b.y - a.y * b.x; }
Series dot(const Pair<Series>& a, const Pair<Series>& b) { return a.x * b.x + a.y * b.y; }

/// A curve whose point is known as a function of its parameter.
/// Differentiates the path's power series: once for the velocity, twice for the change of angle.
Formula from_path(double lo, double hi, const Path& path) {
  const auto velocity = [path](const Ball& u) {
    const Pair<Series> point = path(Series::variable(u));
    return Pair<Series>{derivative(point.x), derivative(point.y)};
  };
  Formula formula;
  formula.lo = lo;
  formula.hi = hi;
  formula.motion = [velocity](const Ball& u) {
    const Pair<Series> first = velocity(u);
    const Pair<Series> second{derivative(first.x), derivative(first.y)};
    const Series square = dot(first, first);
    // ds/du and dTheta/du as in the notation; not finite where the speed may be 0.
    return Motion{sqrt(square), cross(first, second) / square};
  };
  // The constant terms of the path's series.
  formula.position = [path](const Ball& u) {
    const Pair<Series> point = path(Series(u));
    return Point{point.x[0], point.y[0]};
  };
  // The constant terms of its derivative.
  formula.velocity = [velocity](const Ball& u) {
    const Pair<Series> first = velocity(u);
    return Point{first.x[0], first.y[0]};
  };
  return formula;
}

// Two series multiplied, in expansions.
constexpr double kProductWork = 0.2;

// ---- other ways to run along a curve ----

/// a(-x).
Series mirrored(const Series& a) { return composed(a, -Series::variable(0.0)); }

/// The same curve from its end to its start: u runs from lo to hi as lo + hi - u did.
Formula reversed(const Formula& forward) {
  Formula formula = forward;
  // The parameter on the forward curve.
  const auto mirror = [lo = forward.lo, hi = forward.hi](const Ball& u) { return Ball(lo) + (Ball(hi) - u); };
  formula.position = [=](const Ball& u) { return forward.position(mirror(u)); };
  formula.velocity = [=](const Ball& u) {
    const Point v = forward.velocity(mirror(u));
    return Point{-v.x, -v.y};
  };
  formula.motion = [=](const Ball& u) {
    const Motion motion = forward.motion(mirror(u));
    // The speed stays; the tangent is turned by half a turn, and its angle changes the other way round.
    return Motion{mirrored(motion.speed), -mirrored(motion.turning)};
  };
  return formula;
}

/// Lengths times a factor; angles stay.
Formula scaled(const Formula& original, const Ball& factor) {
  Formula formula = original;
  const auto times = [factor](const Point& p) { return Point{factor * p.x, factor * p.y}; };
  formula.position = [=](const Ball& u) { return times(original.position(u)); };
  formula.velocity = [=](const Ball& u) { return times(original.velocity(u)); };
  formula.motion = [=](const Ball& u) {
    const Motion motion = original.motion(u);
    return Motion{Series(factor) * motion.speed, motion.turning};
  };
  return formula;
}

// ---- lines, arcs and what drawings are made of ----

// Angle and speed are constant: exact series without Taylor's remainder.
Formula line(const Numbers& n) {  // from, to
  // The whole way, of which u is the share.
  const Ball dx = Ball(n[2]) - n[0];
  const Ball dy = Ball(n[3]) - n[1];
  Formula formula = from_path(0, 1, [=](const Series& t) { return Pair<Series>{n[0] + t * dx, n[1] + t * dy}; });
  formula.motion = [length = sqrt(dx * dx + dy * dy)](const Ball&) { return Motion{length, 0.0}; };
  return formula;
}

// By the angle of the radius: ds/du = r, dTheta/du = +-1.
Formula arc(const Numbers& n) {  // centre, radius, direction of the first point, sweep
  // u runs from 0 to |sweep|, in the direction of its sign.
  const double sign = n[4] > 0 ? 1 : -1;
  const double r = n[2];
  if (!(r > 0)) throw std::runtime_error("an arc without a radius");
  Formula formula = from_path(0, std::abs(n[4]), [=](const Series& t) {
    const Series direction = n[3] + sign * t;
    return Pair<Series>{n[0] + r * cos(direction), n[1] + r * sin(direction)};
  });
  formula.motion = [=](const Ball&) { return Motion{r, sign}; };
  return formula;
}

// centre + cos(angle) * first half axis + sin(angle) * second one.
Formula elliptic_arc(const Numbers& n) {  // centre, two half axes, where it starts, sweep
  // As of an arc.
  const double sign = n[7] > 0 ? 1 : -1;
  return from_path(0, std::abs(n[7]), [=](const Series& t) {
    const Series angle = n[6] + sign * t;
    const Series c = cos(angle);
    const Series s = sin(angle);
    return Pair<Series>{n[0] + c * n[2] + s * n[4], n[1] + c * n[3] + s * n[5]};
  });
}

// The coefficient of t is what is left so that the curve ends at `to`.
Formula cubic(const Numbers& n) {  // from, to, and the coefficients of t^2 and t^3
  return from_path(0, 1, [=](const Series& t) {
    // One coordinate by Horner's scheme.
    const auto along = [&](std::size_t k) {
      const Ball slope = Ball(n[k + 2]) - n[k] - n[k + 4] - n[k + 6];
      return Series(n[k]) + t * (Series(slope) + t * (Series(n[k + 4]) + t * n[k + 6]));
    };
    return Pair<Series>{along(0), along(1)};
  });
}

// u is arc length: the speed is 1, and Theta is the cubic itself. The point is the integral of (cos, sin) of it.
Formula turning_span(const Numbers& n) {  // start, the cubic of its tangent's angle by arc length, length
  Formula formula;
  formula.hi = n[6];
  const auto angle = [n](const Series& s) { return Series(n[2]) + s * (Series(n[3]) + s * (Series(n[4]) + s * n[5])); };
  formula.motion = [angle](const Ball& u) { return Motion{1.0, derivative(angle(Series::variable(u)))}; };
  formula.velocity = [angle](const Ball& u) {
    const Ball at = angle(Series(u))[0];
    return Point{cos(at), sin(at)};
  };
  formula.position = [n, angle](const Ball& u) {  // in short steps, each by its Taylor series
    constexpr int kSteps = 64;
    Point at{n[0], n[1]};
    for (int k = 0; k < kSteps; ++k) {
      // u is a ball, and so is the step: the result holds the points of all its parameters.
      const Ball step = u / kSteps;
      const Ball from = step * k;
      const Series there = angle(Series::variable(from));
      const Series wide = angle(Series::variable(hull(from, from + step)));
      const auto advance = [&](const Series& thin, const Series& rest) {
        return value(integral(with_remainder(thin, rest, kOrder)), step);
      };
      at = {at.x + advance(cos(there), cos(wide)), at.y + advance(sin(there), sin(wide))};
    }
    return at;
  };
  return formula;
}

/// De Casteljau's algorithm.
Formula regular_bezier(const Numbers& n, std::size_t each) {
  const auto points = static_cast<double>(n.size()) / static_cast<double>(each);
  Formula formula = from_path(0, 1, [n, each](const Series& t) {
    std::vector<std::vector<Series>> row;
    for (std::size_t k = 0; k < n.size(); k += each) {
      // A plain curve has all weights 1.
      const Ball weight = each == 3 ? n[k + 2] : 1.0;
      // Homogeneous coordinates: rational curves divide by the third one at the end.
      row.push_back({weight * n[k], weight * n[k + 1], weight});
    }
    const Series rest = Series(1.0) - t;
    // Each round replaces neighbours by their mean with weights 1 - t and t.
    for (std::size_t left = row.size(); left > 1; --left) {
      for (std::size_t k = 0; k + 1 < left; ++k) {
        for (std::size_t i = 0; i < each; ++i) row[k][i] = rest * row[k][i] + t * row[k + 1][i];
      }
    }
    if (each == 2) return Pair<Series>{row[0][0], row[0][1]};
    return Pair<Series>{row[0][0] / row[0][2], row[0][1] / row[0][2]};
  });
  formula.work = 1 + kProductWork * points * points * static_cast<double>(each);
  return formula;
}

/// A curve that starts at rest, its first m control points being one, from which it is u^m n/w: its velocity is
/// u^(m-1) q, and q = (m n + u n')/w - u n w'/w^2 is not 0 there.
Formula bezier_from_rest(const Numbers& n, std::size_t each, std::size_t m) {
  const std::size_t degree = n.size() / each - 1;
  const auto weight = [n, each](std::size_t k) { return each == 3 ? n[k * each + 2] : 1.0; };
  const auto sums = [=](const Series& u) {  // n by its two coordinates, and w
    std::array<Series, 3> sum;
    for (std::size_t k = 0; k <= degree; ++k) {
      const Series rest = whole_power(Series(1.0) - u, degree - k) * choices(degree, k) * weight(k);
      sum[2] = sum[2] + whole_power(u, k) * rest;
      // The first m control points are the origin of n, and give nothing.
      if (k < m) continue;
      for (std::size_t i : {0U, 1U}) sum[i] = sum[i] + whole_power(u, k - m) * rest * (Ball(n[k * each + i]) - n[i]);
    }
    return sum;
  };
  // The quotient rule, with u^(m-1) taken out.
  const auto steady = [=](const Series& u) {  // q
    const std::array<Series, 3> sum = sums(u);
    const auto along = [&](const Series& a) {
      return (Series(static_cast<double>(m)) * a + u * derivative(a)) / sum[2] -
             u * a * derivative(sum[2]) / (sum[2] * sum[2]);
    };
    return Pair<Series>{along(sum[0]), along(sum[1])};
  };
  Formula formula;
  formula.work = 1 + 3 * kProductWork * static_cast<double>(degree * degree);
  formula.motion = [=](const Ball& at) {
    const Series u = Series::variable(at);
    const Pair<Series> q = steady(u);
    const Pair<Series> change{derivative(q.x), derivative(q.y)};
    const Series square = dot(q, q);
    // The factor u^(m-1) changes the speed but not the direction: the angle is that of q.
    return Motion{whole_power(u, m - 1) * sqrt(square), cross(q, change) / square};
  };
  formula.position = [=](const Ball& at) {
    const std::array<Series, 3> sum = sums(Series(at));
    const Series power = whole_power(Series(at), m);
    return Point{Ball(n[0]) + (power * sum[0] / sum[2])[0], Ball(n[1]) + (power * sum[1] / sum[2])[0]};
  };
  formula.velocity = [=](const Ball& at) {
    const Pair<Series> q = steady(Series::variable(at));
    return Point{q.x[0], q.y[0]};
  };
  return formula;
}

/// Control points as so many numbers each: x, y and, of rational ones, the weight. Those next to one end may be the
/// same as that one.
Formula bezier(const Numbers& n, std::size_t each) {
  if (n.empty() || n.size() % each != 0) throw std::runtime_error("a Bezier curve with half a control point");
  // How many control points at the front are equal.
  const auto same = [&](const Numbers& points) {  // as the first, which it is itself
    std::size_t k = each;
    while (k < points.size() && points[k] == points[0] && points[k + 1] == points[1]) k += each;
    return k / each;
  };
  Numbers backwards;
  // The same points from the last to the first: a curve at rest at its end is one from rest, reversed.
  for (std::size_t k = n.size(); k > 0; k -= each) backwards.insert(backwards.end(), &n[k - each], &n[k - each] + each);
  // 1: only itself, so that the curve has a speed there.
  const std::size_t first = same(n);
  const std::size_t last = same(backwards);
  // At rest at both ends the factor would be needed at both.
  if (first * each == n.size() || (first > 1 && last > 1)) {
    throw std::runtime_error("a Bezier curve that is a point, or at rest at both ends");
  }
  if (first > 1) return bezier_from_rest(n, each, first);
  if (last > 1) return reversed(bezier_from_rest(backwards, each, last));
  return regular_bezier(n, each);
}

// ---- the gallery ----

/// A curve by its distance from the origin, in each direction from 0 on.
Formula polar(double hi, const std::function<Series(const Series&)>& radius) {
  return from_path(0, hi, [radius](const Series& t) {
    const Series r = radius(t);
    return Pair<Series>{r * cos(t), r * sin(t)};
  });
}

/// r = a + b cos(t).
Formula limacon(const Numbers& n) {
  return polar(kFullTurn, [=](const Series& t) { return n[0] + n[1] * cos(t); });
}

/// r = base + lift ((1 + cos t) / 2)^2.
Formula cam(const Numbers& n) {
  return polar(kFullTurn, [=](const Series& t) { return n[0] + n[1] * whole_power((1.0 + cos(t)) * 0.5, 2); });
}

/// r = r_0 + depth cos(teeth t).
Formula gear(const Numbers& n) {
  return polar(kFullTurn, [=](const Series& t) { return n[0] + n[1] * cos(n[2] * t); });
}

/// r = a exp(b t).
Formula log_spiral(const Numbers& n) {
  return polar(kFullTurn * n[2], [=](const Series& t) { return n[0] * exp(n[1] * t); });
}

/// (scale t, scale exp(t)).
Formula exponential(const Numbers& n) {
  return from_path(n[1], n[2], [=](const Series& t) { return Pair<Series>{n[0] * t, n[0] * exp(t)}; });
}

/// |x/a|^n + |y/b|^n = 1 by the direction of (x/a, y/b), up to `hi`, turned by so many right angles.
Formula superellipse(const Numbers& n, double hi, double quarters) {
  const auto power = static_cast<ulong>(n[2]);
  // Only whole powers are expanded here.
  if (!(static_cast<double>(power) == n[2] && power >= 2))
    throw std::runtime_error("a superellipse whose exponent is not a whole number");
  if (quarters != 0 && quarters != 1 && quarters != 2 && quarters != 3)
    throw std::runtime_error("a quarter of a superellipse that is not 0, 1, 2 or 3");
  Formula formula = from_path(0, hi, [=](const Series& t) {
    const Series c = cos(t);
    const Series s = sin(t);
    // (|cos|^n + |sin|^n)^(-1/n); on a quarter, or with even n, no absolute value is needed.
    const Series radius = pow(whole_power(c, power) + whole_power(s, power), Ball(-1.0) / n[2]);
    Pair<Series> point{n[0] * radius * c, n[1] * radius * s};
    for (int k = 0; k < quarters; ++k) point = {-point.y, point.x};
    return point;
  });
  formula.work = 1 + 2 * kProductWork * n[2];
  return formula;
}

/// A NACA section of four digits: chord, thickness, camber and its place, the range of v = -+sqrt(x).
Formula naca(const Numbers& n, bool upper, bool fore) {
  const double sign = upper ? -1 : 1;
  return from_path(n[4], n[5], [=](const Series& v) {
    const Series w = sign * v;
    const Series x = w * w;
    const Ball ten_thousandth = Ball(1.0) / 10000.0;
    const auto k = [&](double digits) { return Series(Ball(5 * digits) * ten_thousandth); };
    // Half the thickness, by w = sqrt(x): so that the nose, where it grows as sqrt(x), is regular.
    const Series half =
        Series(-sign * n[1]) * (w * (k(2969) + w * (k(-1260) + x * (k(-3516) + x * (k(2843) + x * k(-1036))))));
    const Ball reach = fore ? Ball(n[3]) : Ball(1.0) - n[3];
    // The camber line is a parabola before its highest place and another one behind it.
    const Series share = (fore ? x : Series(1.0) - x) / reach;
    const Series camber = n[2] * share * (Series(2.0) - share);
    const Series slope = Series(Ball(-2 * n[2]) / (reach * reach)) * (x - n[3]);
    const Series long_side = sqrt(Series(1.0) + slope * slope);
    // Half the thickness across the camber line.
    return Pair<Series>{n[0] * (x - half * slope / long_side), n[0] * (camber + half / long_side)};
  });
}

/// Without camber; where it would be does not matter then.
Formula symmetric_naca(const Numbers& n, bool upper) {
  return naca({n[0], n[1], 0, 1, upper ? -1.0 : 0.0, upper ? 0.0 : 1.0}, upper, true);
}

struct Kind {
  std::size_t numbers;  // that it takes; 0: any
  std::function<Formula(const Numbers&)> make;
};

/// By the name in the certificate.
const std::map<std::string, Kind>& kinds() {
  static const std::map<std::string, Kind> table = {
      {"line", {4, line}},
      {"arc", {5, arc}},
      {"elliptic-arc", {8, elliptic_arc}},
      {"cubic", {8, cubic}},
      {"turning", {7, turning_span}},
      {"bezier", {0, [](const Numbers& n) { return bezier(n, 2); }}},
      {"rational-bezier", {0, [](const Numbers& n) { return bezier(n, 3); }}},
      {"limacon", {2, limacon}},
      {"cam", {2, cam}},
      {"gear", {3, gear}},
      {"log-spiral", {3, log_spiral}},
      {"exponential", {3, exponential}},
      {"superellipse", {3, [](const Numbers& n) { return superellipse(n, kFullTurn, 0); }}},
      {"superellipse-quarter", {4, [](const Numbers& n) { return superellipse(n, kFullTurn / 4, n[3]); }}},
      {"naca-upper", {2, [](const Numbers& n) { return symmetric_naca(n, true); }}},
      {"naca-lower", {2, [](const Numbers& n) { return symmetric_naca(n, false); }}},
      {"naca-upper-fore", {6, [](const Numbers& n) { return naca(n, true, true); }}},
      {"naca-upper-aft", {6, [](const Numbers& n) { return naca(n, true, false); }}},
      {"naca-lower-fore", {6, [](const Numbers& n) { return naca(n, false, true); }}},
      {"naca-lower-aft", {6, [](const Numbers& n) { return naca(n, false, false); }}},
  };
  return table;
}

}  // namespace

/// The words before a kind, from the outermost one: `reversed` twice is nothing, factors multiply.
/// So at most one of each is wrapped around the formula, however many words there are.
Formula formula_of(const std::string& kind, const Numbers& numbers) {
  std::string plain = kind;
  Numbers own = numbers;
  bool is_reversed = false;
  std::optional<Ball> factor;
  const auto take = [&](const std::string& word) {
    const bool is_there = plain.rfind(word, 0) == 0;
    if (is_there) plain.erase(0, word.size());
    return is_there;
  };
  for (;;) {
    if (take("reversed ")) {
      is_reversed = !is_reversed;
    } else if (take("scaled ")) {
      if (own.empty() || !(own.back() > 0)) throw std::runtime_error("a curve scaled by a factor that is not above 0");
      factor = factor.value_or(1.0) * own.back();
      own.pop_back();
    } else {
      break;
    }
  }
  const auto found = kinds().find(plain);
  if (found == kinds().end()) throw std::runtime_error("the curve kind '" + plain + "' is not known");
  const auto& [count, make] = found->second;
  if (count != 0 && count != own.size())
    throw std::runtime_error("a curve of kind '" + plain + "': expected " + std::to_string(count) + " numbers, found " +
                             std::to_string(own.size()));
  Formula formula = make(own);
  if (factor) formula = scaled(formula, *factor);
  return is_reversed ? reversed(formula) : formula;
}

}  // namespace rollfix_verify
