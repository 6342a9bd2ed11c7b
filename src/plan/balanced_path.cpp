#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "plan/path_search.hpp"
#include "plan/squeeze.hpp"

// Notation: B, x, y as in squeeze.hpp and contact_way.hpp
// Idea: on nodes of y the signs of B bracket every y that balances the wheel at a given x; from column to column the
// bracket that goes on is the nearest with the same direction of crossing. Where a path goes on, B(x, y) has different
// signs at both of its neighbouring y halfway between the columns; where the wheel turns back it has not.
namespace rollfix {
namespace {

constexpr std::size_t kSteps = 96;  // at least, of each turn

double tilt(const ContactPlace& a, const ContactPlace& b) { return squeeze_of(a, b, false).at_b; }

/// A right angle or more is no balance: the force would pull, or the sign only wraps.
bool brackets(double before, double after) {
  constexpr double kPressing = 1.5;
  return std::signbit(before) != std::signbit(after) && std::abs(before) < kPressing && std::abs(after) < kPressing;
}

/// The indices j of all brackets [y_j, y_j+1].
std::vector<std::size_t> brackets_at(const ContactPlace& a, const std::vector<ContactPlace>& of_b) {
  std::vector<std::size_t> found;
  double before = tilt(a, of_b.front());
  for (std::size_t j = 1; j < of_b.size(); ++j) {
    const double after = tilt(a, of_b[j]);
    if (brackets(before, after)) found.push_back(j - 1);
    before = after;
  }
  return found;
}

/// Whether the wheel is in balance once between these, at this x.
bool goes_on(const ContactWay& a, const ContactWay& b, double x, double one, double other) {
  const ContactPlace at = a.places({x}).front();
  const std::vector<ContactPlace> ends = b.places({one, other});
  return std::signbit(tilt(at, ends[0])) != std::signbit(tilt(at, ends[1])) || one == other;
}

}  // namespace

std::vector<double> balances(const ContactWay& a, const ContactWay& b, const Interval& range_b) {
  const ContactPlace first = a.places({0}).front();
  const std::vector<double> y = b.nodes(range_b.lo, range_b.hi, kSteps);
  std::vector<double> x;
  std::vector<double> lo;
  std::vector<double> hi;
  for (const std::size_t j : brackets_at(first, b.places(y))) {
    x.push_back(0);
    lo.push_back(y[j]);
    hi.push_back(y[j + 1]);
  }
  return balanced(a, b, x, lo, hi);
}

BalancedPath balanced_path(const ContactWay& a, double goal_a, const ContactWay& b, double start,
                           const Interval& range_b) {
  std::vector<double> x = a.nodes(std::min(0.0, goal_a), std::max(0.0, goal_a), kSteps);
  if (goal_a < 0) std::reverse(x.begin(), x.end());
  const std::vector<double> y = b.nodes(range_b.lo, range_b.hi, kSteps);
  const std::vector<ContactPlace> of_a = a.places(x);
  const std::vector<ContactPlace> of_b = b.places(y);
  std::vector<double> found{start};
  BalancedPath result;
  for (std::size_t i = 1; i < x.size() && !result.turns_back; ++i) {
    std::vector<double> lo;
    std::vector<double> hi;
    for (const std::size_t j : brackets_at(of_a[i], of_b)) {
      lo.push_back(y[j]);
      hi.push_back(y[j + 1]);
    }
    const std::vector<double> roots = balanced(a, b, std::vector<double>(lo.size(), x[i]), lo, hi);
    const auto nearest = std::min_element(roots.begin(), roots.end(), [&](double one, double two) {
      return std::abs(one - found.back()) < std::abs(two - found.back());
    });
    const double middle = 0.5 * (x[i - 1] + x[i]);
    result.turns_back = nearest == roots.end() || !goes_on(a, b, middle, found.back(), *nearest);
    if (!result.turns_back) found.push_back(*nearest);
  }
  x.resize(found.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    result.path.knots.push_back(x.size() == 1 ? 0 : x[k] / x.back());
    result.path.turned.push_back({x[k], found[k]});
  }
  return result;
}

}  // namespace rollfix
