#include "plan/planning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

// Notation, with x, y as in planning.hpp and B as in planning.hpp:
//   x_i, y_j        nodes of both turns: `of_a`, `of_b`
//   m_ij            margin there: `margin_at`
//   w_ij            the best worst margin of a path from the start to there: `worst`, w_i+1,j = min(m, max w_i,j')
// Idea: which contacts roll together is a path in the plane of (x, y); what friction allows is a region of it. The
// widest path (Hu's maximum capacity route, by columns) gives the best margin, a second pass the cheapest path that
// keeps it, and chords across its corners make it smooth. docs/plan.md, "How the motion is chosen".
// Beside a wheel, on nodes of y the signs of B bracket every y that balances the wheel at a given x; from column to
// column the balance that goes on is the nearest one. Where a path goes on, B(x, y) has different signs at both of its
// neighbouring y halfway between the columns; where the wheel turns back it has not.
namespace rollfix::planning {
namespace {

// A margin beyond this is as good as any larger one: sensors, parts and friction are hardly known better.
constexpr double kComfort = 10 * std::numbers::pi / 180;
constexpr std::size_t kLeastSteps = 96;  // of each turn
constexpr std::size_t kMostJump = 8;     // nodes of b for one of a: how much faster it may roll
constexpr double kSlack = 0.02;          // of the best margin: what is given up for a smoother path
constexpr double kNever = -std::numeric_limits<double>::infinity();

/// How far a contact goes, in radians: what the finger turns by, and a whole turn for a perimeter of travel.
double step_length(const ContactPlace& from, const ContactPlace& to, double perimeter) {
  return std::abs(to.turned - from.turned) + 2 * std::numbers::pi * std::abs(to.s - from.s) / perimeter;
}

/// Knots by how far the finger goes that goes farther.
FoundPath timed(const std::vector<ContactPlace>& a, const std::vector<ContactPlace>& b, double perimeter) {
  FoundPath path;
  std::vector<double> sum{0};
  for (std::size_t k = 1; k < a.size(); ++k) {
    sum.push_back(sum.back() +
                  std::max(step_length(a[k - 1], a[k], perimeter), step_length(b[k - 1], b[k], perimeter)));
  }
  for (std::size_t k = 0; k < a.size(); ++k) {
    path.knots.push_back(k + 1 == a.size() ? 1.0 : sum[k] / sum.back());
    path.turned.push_back({a[k].turned, b[k].turned});
  }
  return path;
}

/// Nodes of both turns and the margins at all their pairs. Column i is a's node x_i, row j is b's node y_j.
class Grid {
 public:
  explicit Grid(const PathQuestion& question) : question_(question) {
    const double lo = std::min(0.0, question.goal_a);
    const double hi = std::max(0.0, question.goal_a);
    std::vector<double> x = question.a->nodes(lo, hi, kLeastSteps);
    // Columns go in the direction in which finger a rolls.
    if (question.goal_a < 0) std::reverse(x.begin(), x.end());
    std::vector<double> y = question.b->nodes(question.range_b.lo, question.range_b.hi, kLeastSteps);
    // The goal is a row of its own.
    if (question.goal_b) {
      const auto at = std::lower_bound(y.begin(), y.end(), *question.goal_b);
      if (at == y.end() || *at != *question.goal_b) y.insert(at, *question.goal_b);
    }
    of_a = question.a->places(x);
    of_b = question.b->places(y);
    start = row_of(0);
    // The grid's cost: one margin for each pair, as many as rows times columns.
    margins_.reserve(of_a.size() * of_b.size());
    for (const ContactPlace& a : of_a) {
      for (const ContactPlace& b : of_b) margins_.push_back(question.margin(a, b));
    }
  }

  /// m_ij, radians
  double margin_at(std::size_t i, std::size_t j) const { return margins_[i * of_b.size() + j]; }
  /// The row nearest to this y.
  std::size_t row_of(double y) const {
    const auto nearest =
        std::min_element(of_b.begin(), of_b.end(), [&](const ContactPlace& one, const ContactPlace& two) {
          return std::abs(one.turned - y) < std::abs(two.turned - y);
        });
    return static_cast<std::size_t>(nearest - of_b.begin());
  }
  /// The rows from which row j can be reached in one column, first and last.
  std::pair<std::size_t, std::size_t> near(std::size_t j) const {
    return {j > kMostJump ? j - kMostJump : 0, std::min(of_b.size() - 1, j + kMostJump)};
  }
  double perimeter() const { return question_.a->part().perimeter(); }

  /// of each column, and of each row
  std::vector<ContactPlace> of_a;
  std::vector<ContactPlace> of_b;
  /// row of the first contact, y = 0
  std::size_t start = 0;

 private:
  /// has to outlive the grid
  const PathQuestion& question_;
  std::vector<double> margins_;
};

/// The best worst margin with which each node of the last column is reached.
std::vector<double> widest(const Grid& grid) {
  std::vector<double> worst(grid.of_b.size(), kNever);
  worst[grid.start] = grid.margin_at(0, grid.start);
  // `worst`: w_ij of column i - 1. Only columns next to each other are needed, since finger a always rolls on.
  for (std::size_t i = 1; i < grid.of_a.size(); ++i) {
    // w of column i
    std::vector<double> next(worst.size(), kNever);
    for (std::size_t j = 0; j < worst.size(); ++j) {
      const auto [lo, hi] = grid.near(j);
      // The best predecessor: a path is as good as its worst node.
      const double best = *std::max_element(worst.begin() + static_cast<std::ptrdiff_t>(lo),
                                            worst.begin() + static_cast<std::ptrdiff_t>(hi) + 1);
      next[j] = std::min(best, grid.margin_at(i, j));
    }
    worst = std::move(next);
  }
  return worst;
}

/// The rows of the cheapest path to one of the ends through nodes with at least this margin. A step costs its length,
/// and more where the margin is small.
std::vector<std::size_t> cheapest(const Grid& grid, double floor, const std::vector<bool>& ends) {
  const std::size_t rows = grid.of_b.size();
  // infinite: not reached yet
  std::vector<double> cost(rows, -kNever);
  std::vector<std::vector<std::size_t>> from(grid.of_a.size(), std::vector<std::size_t>(rows));
  cost[grid.start] = 0;
  for (std::size_t i = 1; i < grid.of_a.size(); ++i) {
    const double along = step_length(grid.of_a[i - 1], grid.of_a[i], grid.perimeter());
    std::vector<double> next(rows, -kNever);
    for (std::size_t j = 0; j < rows; ++j) {
      const double margin = grid.margin_at(i, j);
      if (margin < floor) continue;
      // Up to a hundred times a step's length where the margin is small; its length alone above kComfort.
      const double dearer = std::max(1.0, kComfort / std::max(margin, 0.01 * kComfort));
      const auto [lo, hi] = grid.near(j);
      for (std::size_t before = lo; before <= hi; ++before) {
        // not reached with this floor
        if (std::isinf(cost[before])) continue;
        // Of b; together with `along` the length of the step in the plane of both contacts.
        const double across = step_length(grid.of_b[before], grid.of_b[j], grid.perimeter());
        const double total = cost[before] + dearer * std::hypot(along, across);
        if (total < next[j]) {
          next[j] = total;
          from[i][j] = before;
        }
      }
    }
    cost = std::move(next);
  }
  // The cheapest of the ends, and from there back along `from`.
  std::size_t end = 0;
  for (std::size_t j = 0; j < rows; ++j) {
    if (ends[j] && (!ends[end] || cost[j] < cost[end])) end = j;
  }
  std::vector<std::size_t> path{end};
  for (std::size_t i = grid.of_a.size() - 1; i > 0; --i) path.push_back(from[i][path.back()]);
  std::reverse(path.begin(), path.end());
  return path;
}

/// Draws chords of b over the path wherever every margin on them stays comfortable, or as it was: long ones first.
std::vector<ContactPlace> straightened(const PathQuestion& question, const std::vector<ContactPlace>& a,
                                       std::vector<ContactPlace> b, double floor) {
  // No margin may fall below the floor. It may fall by the slack; where it was more than comfortable, down to kComfort
  // less the slack.
  const auto is_good = [&](std::size_t k, const ContactPlace& candidate) {
    const double margin = question.margin(a[k], candidate);
    return margin >= std::max(floor, std::min(question.margin(a[k], b[k]), kComfort) - kSlack * kComfort);
  };
  /// Replaces b between two nodes by a straight line in the plane of (x, y), if all margins on it are good.
  const auto draw = [&](std::size_t from, std::size_t to) {
    std::vector<double> y;
    for (std::size_t k = from; k <= to; ++k) {
      // y is linear in x on a chord.
      const double share = (a[k].turned - a[from].turned) / (a[to].turned - a[from].turned);
      y.push_back(b[from].turned + share * (b[to].turned - b[from].turned));
    }
    const std::vector<ContactPlace> chord = question.b->places(y);
    for (std::size_t k = from + 1; k < to; ++k) {
      if (!is_good(k, chord[k - from])) return false;
    }
    // Both ends of a chord stay.
    std::copy(chord.begin() + 1, chord.end() - 1, b.begin() + static_cast<std::ptrdiff_t>(from) + 1);
    return true;
  };
  // From the whole path down to two steps, each stride at overlapping places: corners are cut from coarse to fine.
  for (std::size_t stride = a.size() - 1; stride > 1; stride /= 2) {
    for (std::size_t from = 0; from + stride < a.size(); from += std::max<std::size_t>(1, stride / 4)) {
      draw(from, from + stride);
    }
  }
  return b;
}

constexpr std::size_t kSteps = 96;  // at least, of each turn

/// B at two contacts, radians.
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

FoundPath widest_path(const PathQuestion& question) {
  // First the best worst margin, then the cheapest path that keeps it, then chords across its corners.
  const Grid grid(question);
  const std::vector<double> worst = widest(grid);
  double best = kNever;
  std::vector<bool> ends(worst.size());
  for (std::size_t j = 0; j < worst.size(); ++j) {
    if (!question.goal_b || grid.of_b[j].turned == *question.goal_b) best = std::max(best, worst[j]);
  }
  // What the path keeps: the best margin, less a little for a smoother path; beyond kComfort nothing is asked.
  const double floor = std::min(best, kComfort) - kSlack * std::abs(std::min(best, kComfort));
  for (std::size_t j = 0; j < worst.size(); ++j) {
    // Ends are the rows that keep the floor; with a goal only the goal's row.
    ends[j] = worst[j] >= floor && (!question.goal_b || grid.of_b[j].turned == *question.goal_b);
  }
  std::vector<ContactPlace> b;
  for (const std::size_t j : cheapest(grid, floor, ends)) b.push_back(grid.of_b[j]);
  b = straightened(question, grid.of_a, std::move(b), floor);
  return timed(grid.of_a, b, grid.perimeter());
}

FoundPath even_path(const ContactWay& a, double goal_a, const ContactWay* b, double goal_b) {
  // The finger that turns more has the nodes, so that neither makes a long step.
  const bool leads_a = b == nullptr || std::abs(goal_a) >= std::abs(goal_b);
  const ContactWay& leading = leads_a ? a : *b;
  const double goal = leads_a ? goal_a : goal_b;
  FoundPath path;
  // Nodes as shares of the goal: lambda.
  for (const double turned : leading.nodes(std::min(0.0, goal), std::max(0.0, goal), kLeastSteps)) {
    path.knots.push_back(turned / goal);
  }
  // From 0 to 1 also where the turns are below 0.
  if (goal < 0) std::reverse(path.knots.begin(), path.knots.end());
  for (double& knot : path.knots) {
    knot = std::abs(knot);
    path.turned.push_back({knot * goal_a, knot * goal_b});
  }
  return path;
}

std::vector<double> balances(const ContactWay& a, const ContactWay& b, const Interval& range_b) {
  const ContactPlace first = a.places({0}).front();
  // Between neighbouring nodes a sign change of B is one balance; two in one step are missed.
  const std::vector<double> y = b.nodes(range_b.lo, range_b.hi, kSteps);
  std::vector<double> x;
  std::vector<double> lo;
  std::vector<double> hi;
  for (const std::size_t j : brackets_at(first, b.places(y))) {
    // at the first contact of finger a
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
  // y at the nodes x_0 ... x_i-1: each the balance nearest to the one before.
  std::vector<double> found{start};
  BalancedPath result;
  for (std::size_t i = 1; i < x.size() && !result.turns_back; ++i) {
    std::vector<double> lo;
    std::vector<double> hi;
    for (const std::size_t j : brackets_at(of_a[i], of_b)) {
      lo.push_back(y[j]);
      hi.push_back(y[j + 1]);
    }
    // every balance of the wheel at x_i
    const std::vector<double> roots = balanced(a, b, std::vector<double>(lo.size(), x[i]), lo, hi);
    const auto nearest = std::min_element(roots.begin(), roots.end(), [&](double one, double two) {
      return std::abs(one - found.back()) < std::abs(two - found.back());
    });
    const double middle = 0.5 * (x[i - 1] + x[i]);
    // Halfway between the columns the same balance must lie between both y: else the nearest one is another one.
    result.turns_back = nearest == roots.end() || !goes_on(a, b, middle, found.back(), *nearest);
    if (!result.turns_back) found.push_back(*nearest);
  }
  // Beyond the node at which the wheel turns back there is no path.
  x.resize(found.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    result.path.knots.push_back(x.size() == 1 ? 0 : x[k] / x.back());
    result.path.turned.push_back({x[k], found[k]});
  }
  return result;
}

}  // namespace rollfix::planning
